/* dimsim2.c: DIMSIM of type 2 with p = q = r = k = 2, lambda = 1 - 1/sqrt(2); rho(M(z)) is the
 * |R(z)| of the SDIRK method of that lambda.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define R2 1.41421356237309504880 /* sqrt 2 */
#define LAMBDA (1 - R2 / 2)

static const steif_glm glm = {
  .k = 2,
  .r = 2,
  .xi = {0, 1},
  .C = {LAMBDA, 0, (6 + 2 * R2) / 7, LAMBDA},
  .U = {1, 0, 0, 1},
  .D = {(73 - 34 * R2) / 28, (4 * R2 - 5) / 4, (87 - 48 * R2) / 28, (34 * R2 - 45) / 28},
  .V = {(3 - R2) / 2, (R2 - 1) / 2, (3 - R2) / 2, (R2 - 1) / 2},
};

const steif_table steif_table_dimsim2 = {
  .name = "dimsim2",
  .about = "DIMSIM of type 2, order 2, L-stable: J. C. Butcher, Appl. Numer. Math. 11 (1993)",
  .kind = STEIF_GLM,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE,
  .general = &glm,
};
