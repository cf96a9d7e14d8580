/* units.h: a sparse pencil in units of its own.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_UNITS_H
#define STF_UNITS_H

#include "linear_system.h"

/* Sparse E and F (CSC): as given, copies of dense ones, or scaled by powers of 2 where the entries
 * given are far apart and there are units in which all are near to one size. */
typedef struct stf_units {
  SUNMatrix E, F;
  int *exponent; /* of n rows and n columns; NULL: as given */
} stf_units;

/* What is new belongs to the pool. */
int stf_units_open(steif_context *ctx, stf_pool *pool, SUNMatrix E, SUNMatrix F, stf_units *u);
/* Sources of the equations in these units; x0 of the unknowns. */
int stf_units_enter(stf_pool *pool, const stf_units *u, const sunrealtype **x0,
                    stf_sources *sources);
/* x(0+), its error and c_i back in the units given. */
void stf_units_leave(const stf_units *u, steif_impulse *impulse, sunrealtype *apart);

#endif
