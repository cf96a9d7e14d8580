/* reduce.c: a system of index 1 with the smooth solutions of one of index k. Where the parts of the
 * pencil are decoupled, N w' + w = g beside E_f v' + F_f v = f_f, a smooth solution has
 *   w = sum_{j<k} (-N)^j g^(j),
 * and this stands in the place of the differential equation, or its derivative. Unknowns remain x
 * and rows without derivatives are so exactly: methods have their classical orders and estimates
 * mean what they say, where runs on (E, F) lose an order for each index above 1 with collocation,
 * all meaning of the error at a change of the step with BDF, and a factor h^(-2 (k-1)) to rounding.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reduce.h"
#include "dense_algebra.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* out += rows first .. first + rows - 1 of G_j f^(order)(t). */
static int add(const stf_reduced *r, sunrealtype t, int order, int j, int first, int rows,
               sunrealtype *out)
{
  const sunrealtype *G = r->maps.G + (size_t)j * (size_t)r->n * (size_t)r->n + first;
  const int code = r->from->f(t, order, r->g, r->from->user);
  if (!code)
    stf_gemm('N', 'N', rows, 1, r->n, 1, G, r->n, NV_DATA_S(r->g), r->n, 1, out + first, r->n);
  return code;
}

/* Derivatives of this right-hand side are not known. */
static int force(sunrealtype t, int derivative, N_Vector out, void *user)
{
  const stf_reduced *r = user;
  sunrealtype *value = N_VGetArrayPointer(out);
  const int m = r->maps.algebraic;
  if (derivative) return 1;
  memset(value, 0, (size_t)r->n * sizeof *value);
  int code = add(r, t, 0, 0, m, r->n - m, value);
  for (int j = 0; j < r->maps.terms && !code; j++)
    code = add(r, t, j + r->slope, j, 0, m, value);
  return code;
}

/* E <- F and F <- 0 in the algebraic rows. */
static void differentiate(stf_reduced *r)
{
  for (sunindextype j = 0; j < r->n; j++)
    for (sunindextype i = 0; i < r->maps.algebraic; i++) {
      SM_ELEMENT_D(r->linear.E, i, j) = SM_ELEMENT_D(r->linear.F, i, j);
      SM_ELEMENT_D(r->linear.F, i, j) = 0;
    }
}

static int claim(stf_reduced *r, int index)
{
  const steif_linear *l = r->from;
  const size_t size = (size_t)r->n * (size_t)r->n;
  const SUNContext sun = steif_sundials(r->ctx);
  r->linear.E = SUNDenseMatrix(r->n, r->n, sun);
  r->linear.F = SUNDenseMatrix(r->n, r->n, sun);
  r->g = N_VNew_Serial(r->n, sun);
  STEIF_CHECK(r->linear.E && r->linear.F && r->g, r->ctx, STEIF_NO_MEMORY,
              "no memory for dense matrices of order %d", r->n);
  r->maps = (stf_reduction){
    .terms = l->f ? index : 0, .E = SM_DATA_D(r->linear.E), .F = SM_DATA_D(r->linear.F)};
  r->maps.G = stf_allocate(r->ctx, (size_t)r->maps.terms * size + 1, sizeof *r->maps.G);
  if (!r->maps.G) return STEIF_NO_MEMORY;
  if (l->f) r->linear.f = force, r->linear.user = r;
  STEIF_TRY(stf_dense_parts(r->ctx, l->E, l->F, &(steif_analysis){0},
                            &(stf_separated){.reduction = &r->maps}));
  if (r->slope) differentiate(r);
  return STEIF_OK;
}

bool stf_reducible(const steif_structure *s, bool keeps)
{
  const bool dense = !strcmp(s->method, "staircase") || !strcmp(s->method, "qz");
  return dense && s->index > (keeps ? 0 : 1);
}

int stf_reduced_open(steif_context *ctx, const steif_linear *from,
                     const steif_structure *structure, bool keeps, stf_reduced *r)
{
  *r = (stf_reduced){.ctx = ctx, .from = from, .n = (int)structure->n, .slope = keeps};
  if (!stf_reducible(structure, keeps)) return STEIF_OK;
  const int code = claim(r, structure->index);
  if (code) stf_reduced_close(r);
  return code;
}

void stf_reduced_close(stf_reduced *r)
{
  if (!r->ctx) return;
  if (r->linear.E) SUNMatDestroy(r->linear.E);
  if (r->linear.F) SUNMatDestroy(r->linear.F);
  if (r->g) N_VDestroy(r->g);
  stf_release(r->ctx, r->maps.G);
  *r = (stf_reduced){0};
}
