/* alexander2.c: two-stage SDIRK of order 2, L-stable and stiffly accurate, gamma =
 * 1 - 1/sqrt(2).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define G 0.29289321881345247560 /* 1 - 1/sqrt(2) */
static const sunrealtype A[] = {G, 0, 1 - G, G};

const steif_table steif_table_alexander2 = {
  .name = "alexander2",
  .about = "R. Alexander, SIAM J. Numer. Anal. 14 (1977)",
  .kind = STEIF_DIRK,
  .s = 2,
  .order = 2,
  .stage_order = 1,
  .A = A,
  .b = A + 2,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
};
