/* dimsim1.c: DIMSIMs of type 1 (explicit) with p = q = r = k = 2 .. 4. C below its diagonal and v are
 * chosen so that M(z) has one eigenvalue besides 0, that of a Runge-Kutta method of p stages. Order 4:
 * the conditions solved here in 34 digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"

/* C_21, C_31, C_32, ..; v_1 .. v_{p-1} */
static const long double two[] = {2, 1 / 2.0L};
static const long double three[] = {1, 1 / 4.0L, 1, -2 / 3.0L, 4 / 3.0L};
static const long double four[] = {
  1.111816664372059078913L,  1.137282780744119467511L,  0.5345236063849780280416L,
  -.5236126294226416811217L, 1.304369266785169133723L,  0.2489732785228858509934L,
  2.438959987312412371978L,  -5.925059195712801321137L, 5.080576418797422319345L};

static int fill(steif_context *ctx, const steif_spec *spec, steif_table *self, steif_glm *glm)
{
  int p;
  (void)self;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"", "p", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "p", 2, 4, 2, &p));
  stf_glm_dimsim(glm, p, 0, p == 2 ? two : p == 3 ? three : four);
  return STEIF_OK;
}

const steif_table steif_table_dimsim1 = {
  .name = "dimsim1",
  .about = "DIMSIM of type 1, order p = 2 .. 4, explicit: J. C. Butcher, Appl. Numer. Math. 11 "
           "(1993); "
           "Butcher and Z. Jackiewicz, Appl. Numer. Math. 21 (1996)",
  .kind = STEIF_GLM,
  .fill = fill,
};
