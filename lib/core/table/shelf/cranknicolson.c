/* cranknicolson.c: trapezoidal rule (Lobatto IIIA with two stages), order 2, A-stable with
 * R(inf) = -1. Its first stage is explicit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"

static const sunrealtype A[] = {0, 0, 0.5, 0.5};

const steif_table steif_table_cranknicolson = {
  .name = "cranknicolson",
  .about = "J. Crank, P. Nicolson, Proc. Camb. Phil. Soc. 43 (1947)",
  .kind = STEIF_DIRK,
  .s = 2,
  .order = 2,
  .stage_order = 2,
  .A = A,
  .b = A + 2,
  .claims = STEIF_A_STABLE | STEIF_STIFFLY_ACCURATE | STEIF_SYMMETRIC,
};
