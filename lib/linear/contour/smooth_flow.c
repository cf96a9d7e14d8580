/* smooth_flow.c: x(t) = Phi_{-1} E x + sum_j Phi_j f^(j)(t), the smooth solution that has the
 * slow part of x, by the residue of
 *   (s E + F)^{-1} (E x + sum_j f^(j)(t) s^{-j-1})
 * at infinity: one solve for each node of a circle whose factors are kept. What a method
 * makes of the fast part is thrown away. Every method with constant coefficients works on the
 * two parts apart, diag(I, N) z' + diag(J, I) z = (g, w): errors of the fast one are not in
 * the slow one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "smooth_flow.h"
#include <math.h>
#include <string.h>

/* The first run factors; what it solves for is of no interest. */
static int factor(stf_smooth_flow *w, sunrealtype radius)
{
  const size_t n = (size_t)w->circle->scaled.n;
  memset(w->rows, 0, n * sizeof *w->rows);
  w->rows[0] = 1;
  STEIF_TRY(stf_circle_widen(w->circle));
  w->circle->count = 1;
  STEIF_TRY(stf_circle_run(w->circle, radius, &(stf_polynomial){.constant = w->rows}));
  for (size_t i = 0; i < n; i++)
    w->left[i] = w->units.exponent ? ldexp(w->circle->scaled.row[i], w->units.exponent[i])
                                   : w->circle->scaled.row[i];
  return STEIF_OK;
}

static int open(stf_smooth_flow *w, const steif_linear *l, const steif_analysis *analysis,
                const steif_structure *structure, sunrealtype radius)
{
  const size_t n = (size_t)structure->n;
  if (!(w->pool = stf_pool_new(w->ctx))) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_units_open(w->ctx, w->pool, l->E, l->F, &w->units));
  w->rows = stf_pool_array(w->pool, n * (size_t)(w->index + 1), sizeof *w->rows);
  w->left = stf_pool_array(w->pool, n, sizeof *w->left);
  N_Vector like = N_VNewEmpty_Serial(structure->n, steif_sundials(w->ctx));
  STEIF_CHECK(like, w->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  w->g = stf_pool_vector(w->pool, like);
  N_VDestroy(like);
  if (!w->rows || !w->left || !w->g) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_circle_open(w->ctx, w->units.E, w->units.F, analysis, 0, &w->circle));
  w->circle->careful |= stf_circle_kept(structure)->careful;
  return factor(w, radius);
}

int stf_smooth_flow_open(steif_context *ctx, const steif_linear *l,
                         const steif_analysis *analysis, const steif_structure *structure,
                         sunrealtype radius, stf_smooth_flow *w)
{
  *w = (stf_smooth_flow){.ctx = ctx, .E = l->E, .index = structure->index};
  const int code = open(w, l, analysis, structure, radius);
  if (code) stf_smooth_flow_close(w);
  return code;
}

void stf_smooth_flow_close(stf_smooth_flow *w)
{
  if (!w->ctx) return;
  stf_circle_close(w->ctx, &w->circle);
  stf_pool_free(&w->pool);
  *w = (stf_smooth_flow){0};
}

int stf_smooth_flow_state(stf_smooth_flow *w, sunrealtype t, steif_forcing f, void *user,
                          sunrealtype *x)
{
  const stf_circle *c = w->circle;
  const sunindextype n = c->scaled.n;
  memset(w->rows, 0, (size_t)n * sizeof *w->rows);
  stf_sources_product(w->E, x, w->rows);
  if (f) STEIF_TRY(stf_sources_force(w->ctx, f, user, t, w->index - 1, w->g, w->rows + n));
  const stf_polynomial g = {f ? w->index : 0, w->rows, w->rows + n, w->left};
  STEIF_TRY(stf_circle_again(w->circle, &g));
  const int *unknown = c->sequence->unknown, *exponent = w->units.exponent;
  for (sunindextype i = 0; i < n; i++) {
    const sunindextype j = unknown[i];
    const sunrealtype value = c->radius * c->scaled.column[j] * c->sum[i];
    x[j] = exponent ? ldexp(value, exponent[n + j]) : value;
  }
  return STEIF_OK;
}
