/* bdf.c: backward differentiation formulas of order p, X = (y_{n-p+1}, .., y_n):
 *   sum_{j=1}^p (1/j) nabla^j y_{n+1} = h f_{n+1}.
 * From p = 7 on they are not stable and refused.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <stdio.h>

enum { HIGHEST = 12 };

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  sunrealtype alpha[HIGHEST + 1], beta[HIGHEST + 1] = {0};
  long double sum[HIGHEST + 1] = {0},
                            power[HIGHEST + 1] = {1}; /* (1 - z)^j, z: shift backwards */
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, HIGHEST, 2, &p));
  for (int j = 1; j <= p; j++) {
    for (int i = j; i > 0; i--) power[i] -= power[i - 1];
    for (int i = 0; i <= j; i++) sum[p - i] += power[i] / j;
  }
  for (int j = 0; j <= p; j++) alpha[j] = (sunrealtype)sum[j];
  beta[p] = 1;
  if (p <= 2) self->claims = STEIF_A_STABLE | STEIF_L_STABLE;
  char name[16];
  snprintf(name, sizeof name, "bdf:p=%d", p);
  return steif_glm_multistep(ctx, name, p, alpha, beta, glm);
}

const steif_table steif_table_bdf = {
  .name = "bdf",
  .about =
    "backward differentiation, order p: C. F. Curtiss, J. O. Hirschfelder (1952); Gear (1971)",
  .kind = STEIF_GLM,
  .fill = fill,
};
