/* doubled.h: a system and its derivative in one of twice the size.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DOUBLED_H
#define STF_DOUBLED_H

#include "linear_system.h"
#include <steif/slopes.h>

/* [E 0; u E_p E], [F 0; u F_p F], (x0, u x0_p) and (f, u f_p), with the step u of p. */
typedef struct stf_doubled {
  steif_context *ctx;
  const steif_linear *system;
  const steif_impulse_direction *direction;
  sunindextype n;
  sunrealtype unit;
  SUNMatrix E, F;
  sunrealtype *x0;
  N_Vector part; /* n, for forcings */
} stf_doubled;

/* Zeroed before; closed in any case. */
int stf_doubled_open(stf_doubled *d, const sunrealtype *x0, sunrealtype unit);
void stf_doubled_close(stf_doubled *d);
/* steif_forcing of twice the size, user: the system. */
int stf_doubled_force(sunrealtype t, int derivative, N_Vector g, void *user);

/* E + by E_p as `from`, new. NULL: short of memory, said. */
SUNMatrix stf_moved_matrix(steif_context *ctx, SUNMatrix from, SUNMatrix slope, sunrealtype by);

/* Visits the entries of a dense matrix or of one by columns, from column j up to `end`; 0: all. */
typedef struct stf_entries {
  SUNMatrix M;
  sunindextype j, k, end;
} stf_entries;
bool stf_entries_next(stf_entries *at, sunindextype *i, sunindextype *j, sunrealtype *value);
sunindextype stf_matrix_order(SUNMatrix M);

#endif
