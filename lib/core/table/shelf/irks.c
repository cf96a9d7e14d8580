/* irks.c: methods with inherent Runge-Kutta stability, order and stage order p = 1 .. 4, p + 1
 * stages on (y, h y', .., h^p y^(p)): B A = X B and B U = X V - V X but for the first row, X
 * doubly companion with the one eigenvalue lambda, so that M(z) has one eigenvalue besides 0,
 *   R(z) = N(z) / (1 - lambda z)^{p+1},  N the terms up to z^p of e^z (1 - lambda z)^{p+1},
 * L-stable. The last stage is the end value and its slope the new h y'. These conditions with
 * lower triangular A and strictly lower triangular V behind the first row and column are linear
 * in Psi^{-1} B, X Psi = Psi (J + lambda); solved in 40 digits for lambda, xi and the last
 * column (beta_p, .., beta_1) of -X, beta_p = 0:
 *   1/2, (1/2, 1);  1/4, (1/4, 3/4, 1), beta_1 = 0.425;  1/4, (1/2, 1, 3/4, 1), (0.474,
 * 0.0707);
 *   1/4, (1/2, 1, 1/4, 3/4, 1), (0.594, 0.1378, 0.00817).
 * They were searched for small coefficients and rho(M(inf) diag(q^j)) < 1 for changes q = 1/2
 * .. 2 of the step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include <string.h>

static const sunrealtype xi1[] = {0.5, 1}, A1[] = {0.5, 0, 0.5, 0.5};

/* clang-format off */
static const sunrealtype xi2[] = {0.25, 0.75, 1};
static const sunrealtype A2[] = {
  0.25, 0, 0,
  0.299043062200956937799, 0.25, 0,
  0.221636363636363636364, 0.2565, 0.25
};
static const sunrealtype B2[] = {
  -0.237037037037037037037, -0.562962962962962962963, 1.48148148148148148148
};

static const sunrealtype xi3[] = {0.5, 1, 0.75, 1};
static const sunrealtype A3[] = {
  0.25, 0, 0, 0,
  0.530568898232512836757, 0.25, 0, 0,
  0.579350328762213508765, -0.165808565380422698129, 0.25, 0,
  0.557073774044704979481, -0.187126443751705797569, 0.225912389312775097249, 0.25
};
static const sunrealtype B3[] = {
  -2.7872, 0.729959793404847040127, -1.61706666666666666667, 2.87644020659515295987,
  -5.03585940705778042706, 1.23966865698527491272, -3.47322225064465006601,
  3.97298371076678585618
};

static const sunrealtype xi4[] = {0.5, 1, 0.25, 0.75, 1};
static const sunrealtype A4[] = {
  0.25, 0, 0, 0, 0,
  0.332957009404906022344, 0.25, 0, 0, 0,
  1.37402257242680510468, -0.197640070968230994736, 0.25, 0, 0,
  0.460051321052660907847, -0.0680193996489477091326, -0.0633161950844179080349, 0.25, 0,
  -0.368503305932928983858, -0.185017190665281126032, -0.369993191788862626196,
  0.61596616764290237365, 0.25
};
static const sunrealtype B4[] = {
  -0.54912, 2.58447874174268637936, 3.03274666666666666667, -7.63392, 3.65733459159064695397,
  -3.12166209988645685463, 9.66021078195632701518, 10.3229553018112827929,
  -29.1106187895935770602, 8.84974310579846912027,
  -3.74147129241246741385, 13.5480657385500982921, 13.6660299066014173662,
  -42.143742003660994792, 10.4854776135052951662
};
/* clang-format on */

/* The first row of B is the last of A, the second the last unit vector. */
static const struct {
  const sunrealtype *xi, *A, *B;
} tables[] = {{xi1, A1, NULL}, {xi2, A2, B2}, {xi3, A3, B3}, {xi4, A4, B4}};

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *g)
{
  int p;
  (void)self;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 1, 4, 2, &p));
  const size_t s = (size_t)p + 1;
  g->r = p + 1;
  memcpy(g->xi, tables[p - 1].xi, s * sizeof *g->xi);
  memcpy(g->C, tables[p - 1].A, s * s * sizeof *g->C);
  memcpy(g->D, g->C + (s - 1) * s, s * sizeof *g->D);
  g->D[2 * s - 1] = 1;
  if (p > 1) memcpy(g->D + 2 * s, tables[p - 1].B, (s - 2) * s * sizeof *g->D);
  stf_glm_nordsieck(g, p);
  return STEIF_OK;
}

const steif_table steif_table_irks = {
  .name = "irks",
  .about =
    "inherent Runge-Kutta stability, order and stage order p, L-stable: J. C. Butcher, W. M. "
    "Wright, BIT 43 (2003); Wright, thesis, Auckland (2002)",
  .kind = STEIF_GLM,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
  .fill = fill,
};
