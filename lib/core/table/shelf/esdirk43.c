/* esdirk43.c: six-stage ESDIRK of order 4 with embedded order 3, stage order 2, L-stable and
 * stiffly accurate: ESDIRK4(3)6L[2]SA, the implicit part of ARK4(3)6L[2]SA, gamma = 1/4.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

/* clang-format off */
static const sunrealtype A[] = {
  0, 0, 0, 0, 0, 0,
  1 / 4.0, 1 / 4.0, 0, 0, 0, 0,
  8611 / 62500.0, -1743 / 31250.0, 1 / 4.0, 0, 0, 0,
  5012029 / 34652500.0, -654441 / 2922500.0, 174375 / 388108.0, 1 / 4.0, 0, 0,
  15267082809 / 155376265600.0, -71443401 / 120774400.0, 730878875 / 902184768.0,
    2285395 / 8070912.0, 1 / 4.0, 0,
  82889 / 524892.0, 0, 15625 / 83664.0, 69875 / 102672.0, -2260 / 8211.0, 1 / 4.0
};
/* clang-format on */
static const sunrealtype c[] = {0, 1 / 2.0, 83 / 250.0, 31 / 50.0, 17 / 20.0, 1};
static const sunrealtype bhat[] = {4586570599 / 29645900160.0, 0,
                                   178811875 / 945068544.0,    814220225 / 1159782912.0,
                                   -3700637 / 11593932.0,      61727 / 225920.0};

const steif_table steif_table_esdirk43 = {
  .name = "esdirk43",
  .about = "C. A. Kennedy, M. H. Carpenter, Appl. Numer. Math. 44 (2003)",
  .kind = STEIF_DIRK,
  .s = 6,
  .order = 4,
  .stage_order = 2,
  .A = A,
  .b = A + 30,
  .c = c,
  .bhat = bhat,
  .order_hat = 3,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
};
