/* dimsim2.c: DIMSIMs of type 2 with p = q = r = k = 2 .. 4. C below its diagonal and v are chosen so
 * that M(z) has one eigenvalue besides 0, R(z) = N(z) / (1 - lambda z)^p, N the terms up to z^p of
 * e^z (1 - lambda z)^p, of which the last is 0: lambda = 1 - 1/sqrt(2) and the roots of
 * lambda^3 - 3 lambda^2 + 3 lambda / 2 - 1/6 and lambda^4 - 4 lambda^3 + 3 lambda^2 - 2 lambda / 3
 * + 1/24 that make R A-stable. Orders 3 and 4: the conditions solved here in 34 digits; a history
 * made for another step excites stiff components, so they take equal steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

#define R2 1.41421356237309504880L /* sqrt 2 */

static const long double lambda[] = {1 - R2 / 2, 0.435866521508458999416L,
                                     0.572816062482134855408L};
/* C_21, C_31, C_32, ..; v_1 .. v_{p-1} */
static const long double two[] = {(6 + 2 * R2) / 7, (3 - R2) / 2};
static const long double three[] = {0.2505148808977192816913L, -1.211594287777005633927L,
                                    1.001274599881185558396L, 0.5520909620403633848319L,
                                    0.7348566598712919886191L};
static const long double four[] = {
  0.02784734147706416054414L, 2.82021003022385972232L,   -1.700697184405062102952L,
  11.92253811343588448894L,   -8.27589634638381755062L,  0.599510893583602586674L,
  1.179454106705016719058L,   -5.348898982870566271984L, 9.013736286792915513214L};

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  (void)self;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 2, 4, 2, &p));
  stf_glm_dimsim(glm, p, lambda[p - 2], p == 2 ? two : p == 3 ? three : four);
  return STEIF_OK;
}

const steif_table steif_table_dimsim2 = {
  .name = "dimsim2",
  .about = "DIMSIM of type 2, order p = 2 .. 4, L-stable: J. C. Butcher, Appl. Numer. Math. 11 "
           "(1993); "
           "Butcher and Z. Jackiewicz, Appl. Numer. Math. 21 (1996)",
  .kind = STEIF_GLM,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE,
  .fill = fill,
};
