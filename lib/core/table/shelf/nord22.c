/* nord22.c: two stages on (y, h y', h^2 y''), order and stage order 2, stiffly accurate; U and
 * V by Wright's formulas from C, D and xi, which were found by a search for rho(M(inf)) = 0.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static const steif_glm glm = {
  .k = 3,
  .r = 2,
  .xi = {1 / 2.0, 1},
  .C = {1 / 2.0, 0, 1 / 2.0, 1 / 2.0},
  .U = {1, 0, -1 / 8.0, 1, 0, -1 / 4.0},
  .D = {1 / 2.0, 1 / 2.0, 0, 1, -2, 2},
  .V = {1, 0, -1 / 4.0, 0, 0, 0, 0, 0, 0},
  .order = 2,
  .W = {1, 0, 0, 0, 1, 0, 0, 0, 1},
};

const steif_table steif_table_nord22 = {
  .name = "nord22",
  .about = "two stages on (y, h y', h^2 y''), order and stage order 2, L-stable, by the "
           "formulas of W. M. "
           "Wright, thesis, Auckland (2002)",
  .kind = STEIF_GLM,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
  .general = &glm,
};
