/* symplectic.c: symplectic methods, and RK4 for contrast, on the harmonic oscillator from (1, 0) at
 * t = 1.5. References: powers of the step's 2 x 2 matrix in 50 digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_order_line lines[] = {
  {"symeuler:first=p",
   {5.0563566511e-02, 2.5101350733e-02, 1.2508663540e-02, 6.2442110883e-03, 3.1196228949e-03}},
  {"symeuler:first=q",
   {4.9315265347e-02, 2.4789544120e-02, 1.2430728656e-02, 6.2247284151e-03, 3.1147522921e-03}},
  {"verlet:first=kick",
   {1.2036388210e-03, 3.0072574188e-04, 7.5169950909e-05, 1.8791770146e-05, 4.6978976906e-06}},
  {"verlet:first=drift",
   {1.2933319754e-03, 3.2291044377e-04, 8.0701250319e-05, 2.0173665801e-05, 5.0433135388e-06}},
  {"gauss:s=1",
   {1.2449463422e-03, 3.1159688509e-04, 7.7921774860e-05, 1.9481853861e-05, 4.8705516079e-06}},
  {"rk4",
   {1.2350590929e-06, 7.7629534759e-08, 4.8622985777e-09, 3.0416906494e-10, 1.9018689e-11}},
  {"gauss:s=2",
   {2.0768775660e-07, 1.2986282966e-08, 8.1173355537e-10, 5.0734999e-11, 3.1707e-12}},
  {"gauss:s=2,compensated=1",
   {2.0768775660e-07, 1.2986282966e-08, 8.1173355537e-10, 5.0734999e-11, 3.1707e-12}},
  {"gauss:s=3", {1.4837576e-11, 2.3149538e-13}},
  {"yoshida4",
   {9.9131155439e-06, 6.1879545019e-07, 3.8662651233e-08, 2.4162262607e-09, 1.5101152e-10}},
};

static const stf_orders data = {.problem = "harmonic",
                                .t1 = 1.5,
                                .h = 0.1,
                                .rows = 5,
                                .lines = sizeof lines / sizeof *lines,
                                .line = lines,
                                .digits = 1e-9,
                                .floor = 2e-15};

const steif_experiment steif_experiment_symplectic = {
  .about = "orders of symplectic methods on the harmonic oscillator",
  .frame = {.title = "q'' = -q at t = 1.5",
            .x_label = "h",
            .y_label = "error",
            .log_x = 1,
            .log_y = 1},
  .run = stf_order_table,
  .data = &data,
};
