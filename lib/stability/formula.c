/* formula.c: Runge-Kutta tables and BDF as general linear methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "method.h"
#include "variation.h"
#include <string.h>

/* rho and the left eigenvector of BDF of order p: sum_j (1/j) nabla^j x = h f, alpha_p = 1, and
 * ell the coefficients of rho(zeta)/(zeta - 1) over their sum. */
static void bdf(int p, stf_formula *g)
{
  sunrealtype alpha[STF_PAST + 1] = {0}, power[STF_PAST + 1] = {1}, sum = 0;
  for (int j = 1; j <= p; j++) { /* power: (1 - z)^j, z the shift backwards */
    for (int i = j; i > 0; i--) power[i] -= power[i - 1];
    for (int i = 0; i <= j; i++) alpha[p - i] += power[i] / j;
  }
  const sunrealtype beta = 1 / alpha[p];
  *g = (stf_formula){.k = p, .r = 1, .lower = true};
  for (int j = 0; j < p; j++) {
    g->U[j] = g->V[(p - 1) * p + j] = -alpha[j] * beta;
    if (j + 1 < p) g->V[j * p + j + 1] = 1;
  }
  g->C[0] = beta, g->D[p - 1] = beta, g->xi[0] = 1;
  /* Horner: the quotient from its highest coefficient downwards. */
  for (int j = p - 1; j >= 0; j--) {
    g->ell[j] = alpha[j + 1] + (j + 1 < p ? g->ell[j + 1] : 0);
    sum += g->ell[j];
  }
  for (int j = 0; j < p; j++) g->ell[j] /= sum;
  g->weight[0] = g->ell[p - 1] * beta;
}

static void runge_kutta(const steif_table *table, stf_formula *g)
{
  const int s = table->s;
  *g = (stf_formula){.k = 1,
                     .r = s,
                     .lower = table->kind != STEIF_COLLOCATION,
                     .explicit_ = table->kind == STEIF_EXPLICIT};
  g->V[0] = g->ell[0] = 1;
  for (int i = 0; i < s; i++) {
    sunrealtype row = 0;
    for (int j = 0; j < s; j++)
      g->C[i * s + j] = table->A[i * s + j], row += table->A[i * s + j];
    g->U[i] = 1, g->D[i] = g->weight[i] = table->b[i];
    g->xi[i] = table->c ? table->c[i] : row;
  }
}

int stf_formula_find(steif_context *ctx, const char *method, stf_formula *g)
{
  steif_method_info info;
  steif_spec spec;
  const steif_method *family;
  steif_table *table;
  STEIF_TRY(steif_method_find(ctx, method, &info));
  const bool ours = strcmp(info.family, "baseline") && strcmp(info.family, "auto");
  if (ours && !strcmp(info.family, "bdf")) {
    bdf(info.order, g);
    return STEIF_OK;
  }
  table = NULL;
  if (ours) {
    STEIF_TRY(steif_spec_parse(ctx, method, &spec));
    STEIF_TRY(stf_method_find(ctx, &spec, &family, &table));
  }
  STEIF_CHECK(
    table, ctx, STEIF_UNSUPPORTED,
    "one step of %s is no recurrence that is followed here: take a Runge-Kutta method "
    "(gauss:s=2, dirk:alexander2, rk4) or bdf:p=1..6",
    method);
  runge_kutta(table, g);
  steif_table_free(ctx, &table);
  return STEIF_OK;
}
