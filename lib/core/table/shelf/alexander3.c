/* alexander3.c: three-stage SDIRK of order 3, L-stable and stiffly accurate. gamma is the root
 * of g^3 - 3 g^2 + 3 g/2 - 1/6 in (1/6, 1/2), a_21 = (1 - gamma)/2,
 * b_1 = -(6 gamma^2 - 16 gamma + 1)/4, b_2 = (6 gamma^2 - 20 gamma + 5)/4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define G 0.43586652150845899942
/* clang-format off */
static const sunrealtype A[] = {
  G,                      0,                       0,
  0.28206673924577050029, G,                       0,
  1.2084966491760100703,  -0.64436317068446906975, G
};
/* clang-format on */

const steif_table steif_table_alexander3 = {
  .name = "alexander3",
  .about = "R. Alexander, SIAM J. Numer. Anal. 14 (1977)",
  .kind = STEIF_DIRK,
  .s = 3,
  .order = 3,
  .stage_order = 1,
  .A = A,
  .b = A + 6,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
};
