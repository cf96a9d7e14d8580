/* multistep.c: multistep formulas and Runge-Kutta tables as general linear methods, and the
 * general form with Nordsieck's vector.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* X = (x_n .. x_{n+s-1}), and behind it h f of the same times when some beta_j, j < s, is not
 * 0. */
int steif_glm_multistep(steif_context *ctx, const char *name, int steps,
                        const sunrealtype *alpha, const sunrealtype *beta, steif_glm *g)
{
  STEIF_CHECK(name && alpha && beta && g, ctx, STEIF_BAD_INPUT,
              "a multistep method needs a name, alpha, beta and a place for the result");
  STEIF_CHECK(
    steps >= 1 && steps <= STEIF_PAST && alpha[steps] != 0, ctx, STEIF_BAD_INPUT,
    "'%s' has %d steps and alpha of the new value %g; 1 to %d steps and a value that is "
    "not 0 are possible",
    name, steps, steps >= 1 && steps <= STEIF_PAST ? alpha[steps] : NAN, STEIF_PAST);
  bool slopes = false;
  for (int j = 0; j < steps; j++) slopes = slopes || beta[j] != 0;
  const int k = slopes ? 2 * steps : steps;
  STEIF_CHECK(k <= STEIF_PAST, ctx, STEIF_BAD_INPUT,
              "'%s' with %d steps and as many slopes keeps %d values; %d are possible", name,
              steps, k, STEIF_PAST);
  memset(g, 0, sizeof *g);
  snprintf(g->name, sizeof g->name, "%s", name);
  g->k = k, g->r = 1, g->xi[0] = 1, g->C[0] = beta[steps] / alpha[steps];
  for (int j = 0; j < steps; j++) {
    g->U[j] = -alpha[j] / alpha[steps];
    if (slopes) g->U[steps + j] = beta[j] / alpha[steps];
  }
  for (int i = 0; i + 1 < k; i++) g->V[i * k + i + 1] = 1;
  memset(g->V + (steps - 1) * k, 0, (size_t)k * sizeof *g->V);
  memcpy(g->V + (steps - 1) * k, g->U, (size_t)k * sizeof *g->V);
  g->D[steps - 1] = g->C[0];
  if (slopes) g->D[k - 1] = 1;
  return steif_glm_complete(ctx, g);
}

static void runge_kutta(const steif_table *t, steif_glm *g)
{
  const int s = t->s;
  memset(g, 0, sizeof *g);
  snprintf(g->name, sizeof g->name, "%s", t->name ? t->name : "");
  g->k = 1, g->r = s, g->order = t->order, g->stage_order = t->stage_order;
  g->V[0] = g->W[0] = g->ell[0] = 1;
  for (int i = 0; i < s; i++) {
    sunrealtype row = 0;
    for (int j = 0; j < s; j++) row += g->C[i * s + j] = t->A[i * s + j];
    g->U[i] = 1, g->D[i] = t->b[i], g->xi[i] = t->c ? t->c[i] : row;
  }
}

int steif_table_glm(steif_context *ctx, const steif_table *table, steif_glm *glm)
{
  STEIF_CHECK(glm, ctx, STEIF_BAD_INPUT, "a place for the general linear method is needed");
  if (table && table->kind == STEIF_GLM && table->general)
    *glm = *table->general;
  else {
    STEIF_TRY(stf_table_check(ctx, table));
    runge_kutta(table, glm);
  }
  return STEIF_OK;
}

/* from - sum_l a_l y_l, 0 when rounding is all that is left; y NULL: zeros. */
static sunrealtype left_over(const steif_glm *g, long double from, const sunrealtype *a,
                             const long double *y, int stride)
{
  long double sum = from, size = fabsl(from);
  for (int l = 0; y && l < g->r; l++) {
    const long double term = a[l] * y[l * stride];
    sum -= term, size += fabsl(term);
  }
  return fabsl(sum) <= 4 * STF_EPS * size ? 0 : (sunrealtype)sum;
}

void stf_glm_nordsieck(steif_glm *g, int p)
{
  const int k = p + 1;
  g->k = k, g->order = p;
  long double Y[STEIF_STAGES * STEIF_PAST], factorial[STEIF_PAST] = {1};
  for (int j = 1; j < k; j++) factorial[j] = j * factorial[j - 1];
  for (int i = 0; i < g->r; i++)
    for (int j = 0; j < k; j++) Y[i * k + j] = j ? Y[i * k + j - 1] * g->xi[i] / j : 1;
  for (int j = 0; j < k; j++) {
    for (int i = 0; i < g->r; i++) {
      g->U[i * k + j] = left_over(g, Y[i * k + j], g->C + i * g->r, j ? Y + j - 1 : NULL, k);
    }
    for (int i = 0; i < k; i++) {
      g->V[i * k + j] = left_over(g, j >= i ? 1 / factorial[j - i] : 0, g->D + i * g->r,
                                  j ? Y + j - 1 : NULL, k);
      g->W[i * k + j] = i == j;
    }
  }
}
