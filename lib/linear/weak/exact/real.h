/* real.h: real numbers of many digits, for runs whose rounding would decide: binary floating point with up
 * to STF_LIMBS digits of 32 bits, results chopped. The memory is the caller's, so that nothing can fail or
 * end the program; this is why it is not GMP or MPFR, which abort when memory is short.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REAL_H
#define STF_REAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { STF_LIMBS = 48 };

/* sign (0.l_0 l_1 l_2 ...) B^exponent with B = 2^32 and l_0 > 0; sign 0: zero. */
typedef struct stf_real {
  int sign; /* -1, 0, 1 */
  int exponent;
  uint32_t limb[STF_LIMBS];
} stf_real;

/* Exact for finite v; 0 for others. */
stf_real stf_real_of(long double v);
/* Chopped; infinite beyond the range of long double. */
long double stf_real_value(const stf_real *x);

/* Results to so many limbs; they may be one of the operands. */
void stf_real_add(int limbs, const stf_real *a, const stf_real *b, stf_real *sum);
void stf_real_subtract(int limbs, const stf_real *a, const stf_real *b, stf_real *out);
void stf_real_multiply(int limbs, const stf_real *a, const stf_real *b, stf_real *out);
/* By b, not 0. */
void stf_real_divide(int limbs, const stf_real *a, const stf_real *b, stf_real *out);
/* sum += sign a b. */
void stf_real_gather(int limbs, int sign, const stf_real *a, const stf_real *b, stf_real *sum);
/* a / b of whole numbers. */
stf_real stf_real_ratio(int limbs, long a, long b);
/* -1, 0, 1 as a < b, a = b, a > b. */
int stf_real_compare(int limbs, const stf_real *a, const stf_real *b);

/* Square matrices by rows, factored with partial pivoting. */
typedef struct stf_real_matrix {
  int n;
  stf_real *a; /* n x n */
  int *pivot;  /* n */
} stf_real_matrix;
/* False: singular. */
bool stf_real_factor(int limbs, stf_real_matrix *m);
void stf_real_solve(int limbs, const stf_real_matrix *m, stf_real *x);
/* y += factor A x. */
void stf_real_apply(int limbs, int n, const stf_real *a, const stf_real *factor,
                    const stf_real *x, stf_real *y);

#endif
