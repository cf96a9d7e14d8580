/* rk4.c: the classical explicit method of order 4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

/* clang-format off */
static const sunrealtype A[] = {
  0,   0,   0, 0,
  0.5, 0,   0, 0,
  0,   0.5, 0, 0,
  0,   0,   1, 0
};
/* clang-format on */
static const sunrealtype b[] = {1 / 6.0, 1 / 3.0, 1 / 3.0, 1 / 6.0};

const steif_table steif_table_rk4 = {
  .name = "rk4",
  .about = "W. Kutta, Z. Math. Phys. 46 (1901)",
  .kind = STEIF_EXPLICIT,
  .s = 4,
  .order = 4,
  .stage_order = 1,
  .A = A,
  .b = b,
};
