/* pair.c: a sequence at unequal times read as a function (conventions P, R, C) and paired with the test
 * function; box averages as in pairing.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak_inside.h"
#include <math.h>

/* Zeros of the Legendre polynomial P_8 and weights, Abramowitz and Stegun, table 25.4. */
const sunrealtype stf_rule_node[STF_RULE] = {-0.96028985649753623168, -0.79666647741362673959,
                                             -0.52553240991632898582, -0.18343464249564980494,
                                             0.18343464249564980494,  0.52553240991632898582,
                                             0.79666647741362673959,  0.96028985649753623168};
const sunrealtype stf_rule_weight[STF_RULE] = {0.10122853629037625915, 0.22238103445337447054,
                                               0.31370664587788728734, 0.36268378337836198297,
                                               0.36268378337836198297, 0.31370664587788728734,
                                               0.22238103445337447054, 0.10122853629037625915};

/* int_a^b g, cut at t = 1 where g is not analytic. */
static long double box(sunrealtype a, sunrealtype b)
{
  const sunrealtype end = b < 1 ? b : 1;
  if (a >= end) return 0;
  const long double middle = ((long double)a + end) / 2, half = ((long double)end - a) / 2;
  long double sum = 0;
  for (int i = 0; i < STF_RULE; i++) {
    const long double u = 1 - (middle + half * stf_rule_node[i]), u2 = u * u, u4 = u2 * u2;
    sum += stf_rule_weight[i] * u4 * u4;
  }
  return sum * half;
}

/* What multiplies x_i. In C the comb is h g(t_i) with h the step that produced x_i (the first step
 * for x_0). */
static long double weight(enum steif_convention convention, size_t m, const sunrealtype *t,
                          size_t i)
{
  if (convention == STEIF_P) return i < m ? box(t[i], t[i + 1]) : 0;
  if (convention == STEIF_R) return i > 0 ? box(t[i - 1], t[i]) : 0;
  const sunrealtype h = i > 0 ? t[i] - t[i - 1] : t[1] - t[0];
  return (long double)h * steif_test_function(t[i], 0);
}

sunrealtype steif_pair(enum steif_convention convention, size_t m, const sunrealtype *t,
                       const sunrealtype *x)
{
  long double sum = 0;
  if (convention == STEIF_STAGE) return NAN;
  for (size_t i = 0; i <= m && m > 0; i++) sum += weight(convention, m, t, i) * x[i];
  return (sunrealtype)sum;
}
