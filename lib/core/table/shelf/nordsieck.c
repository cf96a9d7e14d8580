/* nordsieck.c: BDF and Adams-Moulton formulas of order p on Nordsieck's vector z_j = h^j y^(j)
 * / j!, j = 0 .. p: z <- P z + l (h f - (P z)_1), P Pascal's matrix. The polynomial sum l_j x^j
 * is proportional to prod_{i=1}^p (x + i) for BDF; for Adams its slope is to prod_{i=1}^{p-1}
 * (x + i), and it vanishes at -1; l_1 = 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <math.h>
#include <string.h>

enum { HIGHEST = 12 };

/* x^j of prod_{i=1}^count (x + i) */
static void product(int count, long double *c)
{
  c[0] = 1;
  for (int i = 1; i <= count; i++) {
    c[i] = 0;
    for (int j = i; j >= 0; j--) c[j] = c[j] * i + (j ? c[j - 1] : 0);
  }
}

static void bdf(int p, long double *l)
{
  product(p, l);
  for (int j = 0; j <= p; j++)
    if (j != 1) l[j] /= l[1];
  l[1] = 1;
}

static void adams(int p, long double *l)
{
  long double slope[HIGHEST + 1];
  product(p - 1, slope);
  l[0] = 0;
  for (int j = 1; j <= p; j++) {
    l[j] = slope[j - 1] / slope[0] / j;
    l[0] -= j % 2 ? -l[j] : l[j];
  }
}

static void step(int p, const long double *l, steif_glm *g)
{
  const int k = p + 1;
  long double P[(HIGHEST + 1) * (HIGHEST + 1)] = {0}, factorial = 1;
  for (int j = 0; j < k; j++) {
    P[j * k + j] = 1;
    for (int i = j - 1; i >= 0; i--)
      P[i * k + j] = P[i * k + j - 1] + (i ? P[(i - 1) * k + j - 1] : 0);
  }
  g->k = k, g->r = 1, g->order = p, g->xi[0] = 1, g->C[0] = (sunrealtype)l[0];
  for (int j = 0; j < k; j++) {
    for (int i = 0; i < k; i++) g->V[i * k + j] = (sunrealtype)(P[i * k + j] - l[i] * P[k + j]);
    g->U[j] = g->V[j], g->D[j] = (sunrealtype)l[j];
    factorial *= j ? j : 1;
    g->W[j * k + j] = (sunrealtype)(1 / factorial);
  }
}

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  long double l[HIGHEST + 1];
  const char *of = stf_spec_word(spec, "of");
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "of", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, HIGHEST, 2, &p));
  const bool is_adams = of && !strcmp(of, "am");
  STEIF_CHECK(!of || is_adams || !strcmp(of, "bdf"), ctx, STEIF_UNKNOWN_NAME,
              "nordsieck of=%s is not there; take of=bdf or of=am", of);
  (is_adams ? adams : bdf)(p, l);
  step(p, l, glm);
  if (p <= 2)
    self->claims = is_adams && p == 2 ? STEIF_A_STABLE : STEIF_A_STABLE | STEIF_L_STABLE;
  return STEIF_OK;
}

const steif_table steif_table_nordsieck = {
  .name = "nordsieck",
  .about = "BDF (of=bdf) and Adams-Moulton (of=am) with Nordsieck's vector: A. Nordsieck, "
           "Math. Comp. 16 "
           "(1962); C. W. Gear (1971)",
  .kind = STEIF_GLM,
  .fill = fill,
};
