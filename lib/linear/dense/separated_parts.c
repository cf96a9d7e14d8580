/* separated_parts.c: what the separation of a dense or small pencil is used for, back in the unknowns and
 * right-hand sides as they were given.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_units.h"
#include "staircase.h"

/* A := diag(left) A diag(right); NULL: I. */
static void stretch(int n, const sunrealtype *left, const sunrealtype *right, bool over,
                    sunrealtype *A)
{
  const size_t m = (size_t)n;
  for (size_t j = 0; j < m; j++)
    for (size_t i = 0; i < m; i++)
      A[j * m + i] *= (left ? left[i] : 1) * (right ? over ? 1 / right[j] : right[j] : 1);
}

/* Back to the unknowns and the right-hand sides as they were given. */
static void restore(const stf_dense_units *p, const stf_separated *parts)
{
  const stf_reduction *r = parts->reduction;
  const stf_decoupling *d = parts->decoupling;
  const size_t size = (size_t)p->n * (size_t)p->n;
  if (parts->slow) stretch(p->n, p->column, p->column, true, parts->slow);
  if (r) {
    stretch(p->n, NULL, p->column, true, r->E);
    stretch(p->n, NULL, p->column, true, r->F);
  }
  for (int k = 0; r && k < r->terms; k++)
    stretch(p->n, NULL, p->row, false, r->G + (size_t)k * size);
  if (!d) return;
  stretch(p->n, NULL, p->row, false, d->G);
  stretch(p->n, NULL, p->column, true, d->to);
  stretch(p->n, p->column, NULL, false, d->back);
}

static int verdict(steif_context *ctx, const steif_structure *s)
{
  STEIF_CHECK(s->regular, ctx, STEIF_SINGULAR,
              "the pencil is singular (reciprocal condition %.1e at best): it has no slow "
              "projector",
              s->rcond);
  STEIF_CHECK(s->index >= 0, ctx, STEIF_NOT_CERTIFIED,
              "the index is undecided (gap %.0e, 1e3 is needed), and so is the slow projector: "
              "scale the equations",
              s->gap);
  return STEIF_OK;
}

static int separate(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, const stf_separated *parts)
{
  stf_dense_units units;
  steif_structure found = {0};
  STEIF_TRY(stf_dense_units_choose(ctx, pool, analysis, E, F, &units));
  int code = stf_staircase(ctx, units.n, units.E, units.F, analysis, NULL, &found, NULL, parts);
  if (!code && found.regular) restore(&units, parts);
  if (!code) code = verdict(ctx, &found);
  steif_structure_clear(ctx, &found);
  return code;
}

int stf_dense_parts(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                    const steif_analysis *analysis, const stf_separated *parts)
{
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = separate(ctx, pool, E, F, analysis, parts);
  stf_pool_free(&pool);
  return code;
}
