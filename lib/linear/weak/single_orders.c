/* single_orders.c: does the method converge on impulses of every order that the solution has? A run is linear
 * in its start: the error of order q is c_q times what the method makes of the Jordan block of index q + 2
 * from the last unit vector, the same for every pencil. Where c_q is small, rows of the whole do not
 * show that it does not become smaller.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "measure.h"
#include <math.h>
#include <stdio.h>
#include <sunmatrix/sunmatrix_dense.h>

/* Impulses below so much of the largest, or of x(0-), are rounding. */
#define NONE 1e-13

/* The largest |c_q| / t1^(q + 1) of the components measured. */
static sunrealtype size_of(const stf_measure *w, int q)
{
  const stf_subject *s = &w->subject;
  const size_t n = (size_t)s->n;
  const sunrealtype *c = s->block.k ? s->block.c : s->impulse.c;
  sunrealtype most = 0;
  for (int m = w->first; m < w->first + w->count; m++)
    most = fmax(most, fabs(c[(size_t)q * n + (size_t)m]));
  return most / pow((sunrealtype)s->weight.t1, q + 1);
}

/* On the block of index q + 2; rows: room. */
static int judge(const stf_measure *w, int q, steif_weak_row *rows, int *converges)
{
  const int n = q + 2;
  steif_weak_query query = *w->query;
  steif_weak_result result;
  sunrealtype x0[STF_DERIVATIVES] = {0};
  SUNMatrix E = SUNDenseMatrix(n, n, steif_sundials(w->ctx)),
            F = SUNDenseMatrix(n, n, steif_sundials(w->ctx));
  int code = E && F
               ? STEIF_OK
               : STEIF_FAIL(w->ctx, STEIF_NO_MEMORY, "no memory for matrices of order %d", n);
  for (int i = 0; i < n && !code; i++) {
    SM_ELEMENT_D(F, i, i) = 1;
    if (i + 1 < n) SM_ELEMENT_D(E, i, i + 1) = 1;
  }
  const steif_linear block = {E, F, NULL, NULL};
  x0[n - 1] = 1;
  query.problem = NULL, query.linear = &block, query.x0 = x0;
  query.component = 0, query.break_count = 0, query.values = query.exacts = NULL;
  query.h = w->h;
  if (!code) code = steif_weak_measure(w->ctx, &query, rows, &result);
  *converges = code ? -1 : result.converges;
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

int stf_measure_orders(const stf_measure *w, steif_weak_result *result)
{
  const int count = w->subject.index - 1;
  sunrealtype most = 0;
  int present = 0, code = STEIF_OK;
  for (int m = 0; m < w->subject.n; m++) most = fmax(most, fabs(w->subject.problem.y0[m]));
  for (int q = 0; q < count; q++) most = fmax(most, size_of(w, q));
  for (int q = 0; q < count; q++) present += size_of(w, q) > NONE * most;
  if (present < 2 || count + 1 >= STF_DERIVATIVES) return STEIF_OK;
  steif_weak_row *rows = stf_allocate(w->ctx, w->query->rows, sizeof *rows);
  if (!rows) return STEIF_NO_MEMORY;
  for (int q = count - 1; q >= 0 && !code && result->converges == 1; q--) {
    int converges = 1;
    if (size_of(w, q) > NONE * most) code = judge(w, q, rows, &converges);
    if (code || converges != 0) continue;
    result->converges = -1;
    snprintf(
      result->verdict, sizeof result->verdict,
      "undecided: on impulses of order %d by themselves the method does not converge; here "
      "they are %.1e of the largest, too small for these rows",
      q, size_of(w, q) / most);
  }
  stf_release(w->ctx, rows);
  return code;
}
