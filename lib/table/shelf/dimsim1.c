/* dimsim1.c: DIMSIM of type 1 (explicit) with p = q = r = k = 2.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static const steif_glm glm = {
  .k = 2,
  .r = 2,
  .xi = {0, 1},
  .C = {0, 0, 2, 0},
  .U = {1, 0, 0, 1},
  .D = {5 / 4.0, 1 / 4.0, 3 / 4.0, -1 / 4.0},
  .V = {0.5, 0.5, 0.5, 0.5},
  .order = 2,
  .W = {1, 0, 0, 1, -1, 1 / 2.0},
};

const steif_table steif_table_dimsim1 = {
  .name = "dimsim1",
  .about = "DIMSIM of type 1, order 2, explicit: J. C. Butcher, Appl. Numer. Math. 11 (1993)",
  .kind = STEIF_GLM,
  .general = &glm,
};
