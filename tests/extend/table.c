/* heun.c: a table of the test of extensions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static const sunrealtype A[] = {0, 0, 1, 0}, b[] = {0.5, 0.5};

const steif_table steif_table_heun = {
  .name = "heun",
  .about = "K. Heun, Z. Math. Phys. 45 (1900)",
  .kind = STEIF_EXPLICIT,
  .s = 2,
  .order = 2,
  .stage_order = 1,
  .A = A,
  .b = b,
};
