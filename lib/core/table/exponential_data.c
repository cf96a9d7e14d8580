/* exponential_data.c: coefficients of exponential Runge-Kutta and Rosenbrock methods.
 *
 * Hochbruck and Ostermann, Acta Numerica 19 (2010), write a_i1 and b_1 as well, which make the
 * rows sum up to c_i phi_1(c_i hL) and phi_1(hL).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential_data.h"
#include <string.h>

#define TERMS(list) .count = sizeof list / sizeof *list, .term = list

static const stf_exp_term midpoint[] = {{2, 1, 0, 1, 1}};
static const stf_exp_term linear[] = {{2, 2, 0, 1, 1}};

/* b_2 = b_3 = 2 phi_2 - 4 phi_3, b_4 = -phi_2 + 4 phi_3 */
#define CUBIC                                                                                  \
  {4, 2, 0, 1, 2}, {4, 3, 0, 1, -4}, {4, 2, 0, 2, 2}, {4, 3, 0, 2, -4}, {4, 2, 0, 3, -1},      \
  {                                                                                            \
    4, 3, 0, 3, 4                                                                              \
  }
static const stf_exp_term etdrk4[] = {{2, 1, 1, 1, 0.5}, {3, 1, 1, 2, 1}, CUBIC};
static const stf_exp_term krogstad[] = {{2, 2, 1, 1, 1}, {3, 2, 0, 2, 2}, CUBIC};

/* a_52 = a_53 = phi_2(1/2)/2 - phi_3(1/2)/2 + phi_2(1)/4 - phi_3(1), a_54 = phi_2(1/2)/4 - a_52,
 * b_4 = -phi_2 + 4 phi_3, b_5 = 4 phi_2 - 8 phi_3 */
static const stf_exp_term hochost4[] = {
  {2, 2, 1, 1, 1},    {3, 2, 0, 1, 1},     {3, 2, 0, 2, 1},  {4, 2, 1, 1, 0.5},
  {4, 3, 1, 1, -0.5}, {4, 2, 0, 1, 0.25},  {4, 3, 0, 1, -1}, {4, 2, 1, 2, 0.5},
  {4, 3, 1, 2, -0.5}, {4, 2, 0, 2, 0.25},  {4, 3, 0, 2, -1}, {4, 2, 1, 3, -0.25},
  {4, 3, 1, 3, 0.5},  {4, 2, 0, 3, -0.25}, {4, 3, 0, 3, 1},  {5, 2, 0, 3, -1},
  {5, 3, 0, 3, 4},    {5, 2, 0, 4, 4},     {5, 3, 0, 4, -8}};

static const stf_exp_term exprb32[] = {{3, 3, 0, 1, 2}};
static const stf_exp_term exprb43[] = {
  {2, 1, 0, 1, 1}, {3, 3, 0, 1, 16}, {3, 3, 0, 2, -2}, {4, 4, 0, 1, -48}, {4, 4, 0, 2, 12}};

const stf_exponential stf_exponential_rk[] = {
  {.name = "exp-euler",
   .about = "N held over the step, ETD1: Hochbruck and Ostermann, Acta Numerica 19 (2010)",
   .order = 1,
   .s = 1,
   .nodes = 1,
   .node = {1}},
  {.name = "exp-midpoint",
   .about = "N held at the midpoint, which exp-euler predicts: Hochbruck and Ostermann, Acta "
            "Numerica 19 (2010)",
   .order = 2,
   .s = 2,
   .at = {0, 1},
   .nodes = 2,
   .node = {1, 0.5},
   TERMS(midpoint)},
  {.name = "exp-trapezoidal",
   .about = "N linear over the step, whose end exp-euler predicts, ETD2RK: S. M. Cox and P. C. "
            "Matthews, J. Comput. Phys. 176 (2002)",
   .order = 2,
   .s = 2,
   .nodes = 1,
   .node = {1},
   TERMS(linear)},
  {.name = "etd2",
   .about =
     "N linear through the last two points, two steps, begun by exp-trapezoidal: Cox and "
     "Matthews, J. Comput. Phys. 176 (2002)",
   .order = 2,
   .s = 2,
   .history = true,
   .nodes = 1,
   .node = {1},
   TERMS(linear)},
  {.name = "etdrk4",
   .about = "ETDRK4, stiff order 2: Cox and Matthews, J. Comput. Phys. 176 (2002)",
   .order = 4,
   .s = 4,
   .at = {0, 1, 1, 0},
   .nodes = 2,
   .node = {1, 0.5},
   TERMS(etdrk4)},
  {.name = "krogstad",
   .about = "ETDRK4-B, stiff order 3: S. Krogstad, J. Comput. Phys. 203 (2005)",
   .order = 4,
   .s = 4,
   .at = {0, 1, 1, 0},
   .nodes = 2,
   .node = {1, 0.5},
   TERMS(krogstad)},
  {.name = "hochost4",
   .about =
     "five stages, stiff order 4: M. Hochbruck and A. Ostermann, SIAM J. Numer. Anal. 43 "
     "(2005)",
   .order = 4,
   .s = 5,
   .at = {0, 1, 1, 0, 1},
   .nodes = 2,
   .node = {1, 0.5},
   TERMS(hochost4)},
};
const size_t stf_exponential_rk_count = sizeof stf_exponential_rk / sizeof *stf_exponential_rk;

const stf_exponential stf_exponential_rb[] = {
  {.name = "exprb32",
   .about =
     "exponential Rosenbrock 3(2): M. Hochbruck, A. Ostermann and J. Schweitzer, SIAM J. "
     "Numer. Anal. 47 (2009)",
   .order = 3,
   .embedded = 2,
   .s = 2,
   .nodes = 1,
   .node = {1},
   TERMS(exprb32)},
  {.name = "exprb43",
   .about =
     "exponential Rosenbrock 4(3): M. Hochbruck, A. Ostermann and J. Schweitzer, SIAM J. "
     "Numer. Anal. 47 (2009)",
   .order = 4,
   .embedded = 3,
   .s = 3,
   .at = {0, 1, 0},
   .nodes = 2,
   .node = {1, 0.5},
   TERMS(exprb43)},
};
const size_t stf_exponential_rb_count = sizeof stf_exponential_rb / sizeof *stf_exponential_rb;

const stf_exponential *stf_exponential_find(const stf_exponential *list, size_t count,
                                            const char *name)
{
  for (size_t i = 0; i < count; i++)
    if (!strcmp(list[i].name, name)) return list + i;
  return NULL;
}
