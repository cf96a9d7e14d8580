/* extended.h: systems y' = q(y) of polynomials of degree 2 in 31 digits, by two methods: Taylor series and the
 * extrapolated midpoint rule of W. B. Gragg (SIAM J. Numer. Anal. 2, 1965; Hairer, Norsett and Wanner I, II.9).
 * Numbers are pairs hi + lo with |lo| <= ulp(hi) / 2: T. J. Dekker, Numer. Math. 18 (1971) 224-242.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef EXTENDED_H
#define EXTENDED_H

typedef struct pair {
  double hi, lo;
} pair;

pair pair_of(double x);
pair pair_add(pair a, pair b);
pair pair_multiply(pair a, pair b);
pair pair_divide(pair a, double b);

/* y_to' = the sum of c y_a y_b; ONE stands for the factor 1. */
enum { ONE = -1, LARGEST = 40 };
typedef struct term {
  int to, a, b;
  pair c;
} term;

/* From y at 0 to t, in this number of equal steps. */
void extended_taylor(int n, const term *terms, int count, pair *y, double t, int steps);
void extended_midpoint(int n, const term *terms, int count, pair *y, double t, int steps);

#endif
