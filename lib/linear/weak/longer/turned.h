/* turned.h: a system with its unknowns and equations in another order, in coordinates of its own: what a run
 * there differs by is the rounding of coordinates.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TURNED_H
#define STF_TURNED_H

#include "apart.h"

enum { STF_TURNS = 3 };

/* It stays where it is until it is closed. */
typedef struct stf_turned {
  steif_context *ctx;
  const steif_linear *from;
  int n, turn;
  steif_linear linear; /* in the other order; matrices are its own */
  sunrealtype *x0;     /* n; NULL: not open */
  sunrealtype *f;      /* n, room */
  stf_apart apart;
} stf_turned;

/* turn: 0 .. STF_TURNS - 1. */
int stf_turned_open(steif_context *ctx, const steif_linear *from,
                    const steif_structure *structure, const sunrealtype *x0, int turn,
                    stf_turned *turned);
void stf_turned_close(stf_turned *turned);
/* Where unknown m is. */
int stf_turned_place(const stf_turned *turned, int m);

#endif
