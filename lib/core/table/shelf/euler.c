/* euler.c: explicit Euler method, order 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static const sunrealtype A[] = {0}, b[] = {1};

const steif_table steif_table_euler = {
  .name = "euler",
  .about = "L. Euler, Institutiones calculi integralis (1768)",
  .kind = STEIF_EXPLICIT,
  .s = 1,
  .order = 1,
  .stage_order = 1,
  .A = A,
  .b = b,
};
