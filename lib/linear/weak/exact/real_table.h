/* real_table.h: Runge-Kutta methods with regular A in many digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REAL_TABLE_H
#define STF_REAL_TABLE_H

#include "real.h"
#include "random.h"
#include "table.h"

/* omega = A^{-1}, w = b^T omega. Collocation and its relatives have all digits, other tables those they
 * are given with. */
typedef struct stf_real_table {
  int s;
  bool stiffly;        /* accurate */
  bool full;           /* has all digits */
  stf_real *omega;     /* s x s by rows; allocated, with what follows */
  stf_real *A;         /* s x s */
  stf_real *b, *c, *w; /* s */
  int pivot[STEIF_STAGES];
} stf_real_table;

/* shaken NULL: as given; else coefficients known to double only are changed by random parts of eps. */
int stf_real_table_open(steif_context *ctx, const char *method, int limbs, stf_random *shaken,
                        stf_real_table *table);
void stf_real_table_close(steif_context *ctx, stf_real_table *table);

#endif
