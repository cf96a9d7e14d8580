/* parabolic.c: exponential methods on u_t = u_xx + 1/(1 + u^2) + Phi with u = x(1 - x) e^t on 199
 * interior points, at t = 1: Cox and Matthews' method, of stiff order 2, loses half of its order,
 * Krogstad's and Hochbruck and Ostermann's keep it (M. Hochbruck and A. Ostermann, SIAM J. Numer.
 * Anal. 43, 2005). References: recomputed in NumPy with phi functions of the matrix.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_order_line lines[] = {
  {"exp-euler",
   {1.02357302e-01, 4.62214884e-02, 2.15359981e-02, 1.03859944e-02, 5.10289267e-03,
    2.52858931e-03, 1.25853637e-03}},
  {"exp-midpoint",
   {2.86437713e-02, 7.20430121e-03, 1.71991395e-03, 4.34714188e-04, 1.10149405e-04,
    2.78831682e-05, 7.04188307e-06}},
  {"exp-trapezoidal",
   {7.51799848e-03, 2.17411677e-03, 5.74811477e-04, 1.46725709e-04, 3.69739580e-05,
    9.26781674e-06, 2.31804278e-06}},
  {"etdrk4",
   {2.27106982e-05, 1.97376862e-06, 5.25452877e-07, 1.13205178e-07, 1.73758289e-08,
    2.24391400e-09, 2.57913718e-10}},
  {"krogstad",
   {1.26616922e-04, 9.70847134e-06, 6.21635226e-07, 3.78200644e-08, 2.31139019e-09,
    1.40893519e-10, 8.64e-12}},
  {"hochost4",
   {8.85564755e-05, 6.00138100e-06, 3.55500226e-07, 2.17842361e-08, 1.31868039e-09, 8.1028e-11,
    5.07e-12}},
};

static const stf_orders data = {.problem = "parabolic",
                                .t1 = 1,
                                .h = 0.25,
                                .rows = 7,
                                .lines = sizeof lines / sizeof *lines,
                                .line = lines,
                                .digits = 1e-8,
                                .floor = 2e-13};

const steif_experiment steif_experiment_parabolic = {
  .about = "order reduction of exponential methods on a semilinear parabolic equation",
  .frame = {.title = "u_t = u_xx + 1/(1 + u^2) + Phi at t = 1",
            .x_label = "h",
            .y_label = "largest error",
            .log_x = 1,
            .log_y = 1},
  .run = stf_order_table,
  .data = &data,
};
