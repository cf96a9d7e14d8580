/* trbdf2.c: trapezoidal rule to gamma = 2 - sqrt(2), then BDF2: order 2 with embedded order 3,
 * L-stable and stiffly accurate. D = gamma/2, W = sqrt(2)/4; embedded (1 - W, 3W + 1, D)/3.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

#define D 0.29289321881345247560
#define W 0.35355339059327376220
static const sunrealtype A[] = {0, 0, 0, D, D, 0, W, W, D};
static const sunrealtype bhat[] = {(1 - W) / 3, (3 * W + 1) / 3, D / 3};

const steif_table steif_table_trbdf2 = {
  .name = "trbdf2",
  .about =
    "R. E. Bank et al., IEEE Trans. CAD 4 (1985); M. E. Hosea, L. F. Shampine, Appl. Numer. "
    "Math. 20 (1996)",
  .kind = STEIF_DIRK,
  .s = 3,
  .order = 2,
  .stage_order = 2,
  .A = A,
  .b = A + 6,
  .bhat = bhat,
  .order_hat = 3,
  .claims = STEIF_A_STABLE | STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE,
};
