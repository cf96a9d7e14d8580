/* general.c: what follows from the coefficients of a general linear method: W and the orders,
 * strict stability, the left eigenvector, the error constant.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <math.h>
#include <string.h>

#define CIRCLE 1e-9 /* distance from 1 and from the circle that eigenvalues of V are told by */

/* xi^j / j! */
static sunrealtype monomial(sunrealtype xi, int j)
{
  sunrealtype value = 1;
  for (int i = 1; i <= j; i++) value *= xi / i;
  return value;
}

void stf_glm_stage_side(const steif_glm *g, int j, sunrealtype *stage)
{
  for (int i = 0; i < g->r; i++) {
    stage[i] = monomial(g->xi[i], j);
    for (int l = 0; l < g->r && j > 0; l++)
      stage[i] -= g->C[i * g->r + l] * monomial(g->xi[l], j - 1);
  }
}

void stf_glm_step_side(const steif_glm *g, int j, const sunrealtype *W, sunrealtype *step)
{
  for (int i = 0; i < g->k; i++) {
    step[i] = 0;
    for (int l = 0; l < g->r && j > 0; l++)
      step[i] += g->D[i * g->r + l] * monomial(g->xi[l], j - 1);
    for (int m = 0; m < j; m++) step[i] -= W[m * g->k + i] * monomial(1, j - m);
  }
}

/* Columns of W while they are found. */
typedef struct columns {
  steif_glm *g;
  sunrealtype W[(STEIF_PAST + 2) * STEIF_PAST];
  sunrealtype M[(STEIF_PAST + STEIF_STAGES) * STEIF_PAST]; /* I - V above U */
  int order, stage_order;
} columns;

static void matrix(columns *w)
{
  const steif_glm *g = w->g;
  const int k = g->k;
  for (int i = 0; i < k * k; i++) w->M[i] = (i % (k + 1) == 0) - g->V[i];
  memcpy(w->M + k * k, g->U, (size_t)(g->r * k) * sizeof *g->U);
}

/* Column j: 2 when the conditions of steps and stages hold, 1 for steps alone, 0 for neither.
 * */
static int column(steif_context *ctx, columns *w, int j, int *holds)
{
  const steif_glm *g = w->g;
  sunrealtype side[STEIF_PAST + STEIF_STAGES], off, *W = w->W + j * g->k;
  stf_glm_step_side(g, j, w->W, side);
  stf_glm_stage_side(g, j, side + g->k);
  *holds = 2;
  STEIF_TRY(stf_least_squares(ctx, g->k + g->r, g->k, 1, w->M, side, W, &off));
  if (off <= STF_GLM_TOLERANCE) return STEIF_OK;
  STEIF_TRY(stf_least_squares(ctx, g->k, g->k, 1, w->M, side, W, &off));
  *holds = off <= STF_GLM_TOLERANCE;
  return STEIF_OK;
}

static int find_columns(steif_context *ctx, columns *w)
{
  int holds = 2;
  matrix(w);
  w->order = w->stage_order = -1;
  for (int j = 0; j <= STEIF_PAST && holds == 2; j++) {
    STEIF_TRY(column(ctx, w, j, &holds));
    if (holds == 2) w->stage_order = j;
    if (holds) w->order = j;
  }
  return STEIF_OK;
}

/* A Runge-Kutta method may have an order far above its stage order. */
static int runge_kutta_order(steif_context *ctx, steif_glm *g)
{
  const steif_table table = {.name = g->name, .s = g->r, .A = g->C, .b = g->D, .c = g->xi};
  if (g->k > 1 || g->V[0] != 1) return STEIF_OK;
  for (int p = g->order + 1; p <= 8; p++) {
    sunrealtype defect;
    STEIF_TRY(steif_table_defect(ctx, &table, p, 0, &defect));
    if (defect > STF_GLM_TOLERANCE) break;
    g->order = p;
  }
  return STEIF_OK;
}

/* W by rows, or the given one compared with it. */
static int keep_columns(steif_context *ctx, columns *w)
{
  steif_glm *g = w->g;
  const int given = g->order, p = given > 0 ? given : w->order;
  STEIF_CHECK(w->order >= 1, ctx, STEIF_BAD_INPUT,
              "'%s' is inconsistent: %s; check its coefficients", g->name,
              w->order < 0 || w->stage_order < 0
                ? "no vector u has V u = u and U u = 1"
                : "a step does not move the solution by h y' (order 0)");
  STEIF_CHECK(given <= w->order, ctx, STEIF_BAD_INPUT,
              "'%s' is said to have order %d and has %d; check its coefficients", g->name,
              given, w->order);
  for (int i = 0; i < g->k; i++)
    for (int j = 0; j <= p; j++) {
      const sunrealtype found = w->W[j * g->k + i];
      sunrealtype *kept = g->W + i * (p + 1) + j;
      STEIF_CHECK(given == 0 || fabs(*kept - found) <= STF_GLM_TOLERANCE * (1 + fabs(found)),
                  ctx, STEIF_BAD_INPUT,
                  "W of '%s' has %.12g at (%d, %d) where its conditions ask for %.12g", g->name,
                  *kept, i + 1, j + 1, found);
      if (given == 0) *kept = found;
    }
  g->order = p, g->stage_order = w->stage_order;
  return STEIF_OK;
}

static int strict(steif_context *ctx, steif_glm *g)
{
  long double V[STEIF_PAST * STEIF_PAST];
  stf_complex lambda[STEIF_STAGES];
  int count, ones = 0;
  for (int i = 0; i < g->k * g->k; i++) V[i] = (long double)g->V[i];
  STEIF_TRY(stf_eigen_values(ctx, g->k, V, lambda, &count));
  g->second = 0;
  for (int i = 0; i < count; i++) {
    const sunrealtype re = (sunrealtype)creall(lambda[i]), im = (sunrealtype)cimagl(lambda[i]);
    const sunrealtype size = hypot(re, im);
    const bool one = hypot(re - 1, im) <= CIRCLE && !ones;
    ones += one;
    STEIF_CHECK(one || size < 1 - CIRCLE, ctx, STEIF_BAD_INPUT,
                "'%s' is not strictly stable: besides 1, V has the eigenvalue %.6g%+.6gi of "
                "modulus %.6g, and what rounding puts into that mode does not decay; take "
                "another method",
                g->name, re, im, size);
    if (!one && size > g->second) g->second = size;
  }
  return STEIF_OK;
}

/* [V^T - I, u; u^T, 0] (ell, 0) = (0, 1). */
static int left_eigenvector(steif_context *ctx, steif_glm *g)
{
  const int k = g->k, n = k + 1;
  stf_complex K[(STEIF_PAST + 1) * (STEIF_PAST + 1)], x[STEIF_PAST + 1];
  for (int j = 0; j < k; j++) {
    for (int i = 0; i < k; i++) K[j * n + i] = g->V[i * k + j] - (i == j);
    K[j * n + k] = K[k * n + j] = g->W[j * (g->order + 1)];
    x[j] = 0;
  }
  K[n * n - 1] = 0, x[k] = 1;
  STEIF_CHECK(stf_solve(n, 1, K, x, CIRCLE), ctx, STEIF_BAD_INPUT,
              "the eigenvalue 1 of V of '%s' is not simple: the method is not strictly stable",
              g->name);
  for (int i = 0; i < k; i++) g->ell[i] = (sunrealtype)creall(x[i]);
  return STEIF_OK;
}

/* X_n off W Z by w h^{p+1} y^{(p+1)} stays so when (I - V) w = step side - error u, ell w = 0.
 * */
static int error_constant(steif_context *ctx, columns *w)
{
  steif_glm *g = w->g;
  const int k = g->k, p = g->order;
  sunrealtype side[STEIF_PAST + 1], off;
  g->error = 0;
  memset(g->shift, 0, sizeof g->shift);
  if (g->stage_order < p) return STEIF_OK;
  stf_glm_step_side(g, p + 1, w->W, side);
  for (int i = 0; i < k; i++) g->error += g->ell[i] * side[i];
  for (int i = 0; i < k; i++) side[i] -= g->error * g->W[i * (p + 1)];
  memcpy(w->M + k * k, g->ell, (size_t)k * sizeof *g->ell);
  side[k] = 0;
  return stf_least_squares(ctx, k + 1, k, 1, w->M, side, g->shift, &off);
}

static int check(steif_context *ctx, const steif_glm *g)
{
  STEIF_CHECK(g->k >= 1 && g->k <= STEIF_PAST && g->r >= 1 && g->r <= STEIF_STAGES, ctx,
              STEIF_BAD_INPUT,
              "'%s' has %d external values and %d stages; 1 to %d and 1 to %d are possible",
              g->name, g->k, g->r, STEIF_PAST, STEIF_STAGES);
  bool finite = true;
  for (int i = 0; i < g->r; i++) {
    finite = finite && isfinite(g->xi[i]);
    for (int j = 0; j < g->r; j++) finite = finite && isfinite(g->C[i * g->r + j]);
    for (int j = 0; j < g->k; j++)
      finite = finite && isfinite(g->U[i * g->k + j]) && isfinite(g->D[j * g->r + i]);
  }
  for (int i = 0; i < g->k * g->k; i++) finite = finite && isfinite(g->V[i]);
  STEIF_CHECK(finite, ctx, STEIF_NOT_FINITE, "'%s' has a coefficient that is no finite number",
              g->name);
  return STEIF_OK;
}

int steif_glm_complete(steif_context *ctx, steif_glm *glm)
{
  STEIF_CHECK(glm, ctx, STEIF_BAD_INPUT, "a general linear method is needed, got NULL");
  columns w = {.g = glm};
  STEIF_TRY(check(ctx, glm));
  STEIF_TRY(strict(ctx, glm));
  STEIF_TRY(find_columns(ctx, &w));
  STEIF_TRY(keep_columns(ctx, &w));
  STEIF_TRY(left_eigenvector(ctx, glm));
  STEIF_TRY(error_constant(ctx, &w));
  return runge_kutta_order(ctx, glm);
}

enum steif_table_kind stf_glm_shape(const steif_glm *g)
{
  enum steif_table_kind shape = STEIF_EXPLICIT;
  for (int i = 0; i < g->r; i++)
    for (int j = i; j < g->r; j++)
      if (g->C[i * g->r + j] != 0) {
        if (j > i) return STEIF_COLLOCATION;
        shape = STEIF_DIRK;
      }
  return shape;
}
