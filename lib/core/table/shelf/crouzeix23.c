/* crouzeix23.c: two-stage SDIRK of order 3, A-stable with R(inf) = 1 - sqrt(3),
 * gamma = (3 + sqrt(3))/6.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define G 0.78867513459481288225
static const sunrealtype A[] = {G, 0, 1 - 2 * G, G}, b[] = {0.5, 0.5};

const steif_table steif_table_crouzeix23 = {
  .name = "crouzeix23",
  .about = "M. Crouzeix, thesis, Paris (1975); S. P. Norsett, report 6/74, Trondheim (1974)",
  .kind = STEIF_DIRK,
  .s = 2,
  .order = 3,
  .stage_order = 1,
  .A = A,
  .b = b,
  .claims = STEIF_A_STABLE,
};
