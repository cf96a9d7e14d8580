/* alexander2b.c: two-stage SDIRK of order 2, L-stable, gamma = 1 - 1/sqrt(2) as alexander2,
 * with weights (1/2, 1/2): not stiffly accurate.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define G 0.29289321881345247560 /* 1 - 1/sqrt(2) */
static const sunrealtype A[] = {G, 0, 1 - 2 * G, G}, b[] = {0.5, 0.5};

const steif_table steif_table_alexander2b = {
  .name = "alexander2b",
  .about =
    "S. P. Norsett, University of Trondheim report 6/74 (1974); M. Crouzeix, thesis, Paris "
    "(1975)",
  .kind = STEIF_DIRK,
  .s = 2,
  .order = 2,
  .stage_order = 1,
  .A = A,
  .b = b,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE,
};
