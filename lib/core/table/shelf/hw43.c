/* hw43.c: five-stage SDIRK of order 4 with embedded order 3, L-stable and stiffly accurate,
 * gamma = 1/4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

/* clang-format off */
static const sunrealtype A[] = {
  1 / 4.0,    0,             0,          0,          0,
  1 / 2.0,    1 / 4.0,       0,          0,          0,
  17 / 50.0,  -1 / 25.0,     1 / 4.0,    0,          0,
  371 / 1360.0, -137 / 2720.0, 15 / 544.0, 1 / 4.0,    0,
  25 / 24.0,  -49 / 48.0,    125 / 16.0, -85 / 12.0, 1 / 4.0
};
/* clang-format on */
static const sunrealtype c[] = {1 / 4.0, 3 / 4.0, 11 / 20.0, 1 / 2.0, 1};
static const sunrealtype bhat[] = {59 / 48.0, -17 / 96.0, 225 / 32.0, -85 / 12.0, 0};

const steif_table steif_table_hw43 = {
  .name = "hw43",
  .about = "E. Hairer, G. Wanner: Solving ODEs II, IV.6, table 6.5 (SDIRK4)",
  .kind = STEIF_DIRK,
  .s = 5,
  .order = 4,
  .stage_order = 1,
  .A = A,
  .b = A + 20,
  .c = c,
  .bhat = bhat,
  .order_hat = 3,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
};
