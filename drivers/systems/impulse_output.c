/* impulse_output.c: y = C x + D u: its jump, impulses and last value.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static size_t outputs(const struct descriptor *l)
{
  return (size_t)(SUNMatGetID(l->C) == SUNMATRIX_SPARSE ? SUNSparseMatrix_Rows(l->C)
                                                        : SUNDenseMatrix_Rows(l->C));
}

/* u(t) where D asks for it; NULL: 0, or not known. */
static double *inputs(const struct descriptor *l, double t)
{
  double *u =
    l->D && l->function ? malloc(steif_function_count(l->function) * sizeof *u) : NULL;
  if (u && !steif_function_inputs(t, l->function, u)) return u;
  free(u);
  return NULL;
}

void report_output(steif_report *r, const char *name, const struct descriptor *l, double t,
                   const double *x)
{
  if (!l->C) return;
  double *u = inputs(l, t), *y = malloc(outputs(l) * sizeof *y);
  if (y) {
    steif_output_value(l->C, l->D, x, u, y);
    steif_report_list(r, name, outputs(l), y);
  }
  free(y);
  free(u);
}

void report_output_jump(steif_report *r, const struct descriptor *l, const steif_impulse *i)
{
  if (!l->C) return;
  const size_t p = outputs(l), count = (size_t)i->count;
  report_output(r, "y_plus", l, l->t0, i->x_plus);
  double *y = malloc((p * count + 1) * sizeof *y);
  for (size_t q = 0; y && q < count; q++)
    steif_output_value(l->C, NULL, i->c + q * (size_t)i->n, NULL, y + q * p);
  if (y) steif_report_matrix(r, "y_impulses", count, p, y);
  free(y);
}
