/* steyer1.c: table 1 of A. Steyer and E. Van Vleck, arXiv 1709.02059: BDF2 on their equation (3),
 * h = 0.75 to 0.00075. lte: |x_{n+2} - X(t_{n+2}, t_{n+1}) x_{n+1}|; mu: the largest
 * ln |w_n| / t_n in the second half, w = (3 x_{n+1} - x_n)/2.
 *
 * References: the recurrence in 30 digits with the closed fundamental matrix. The printed figures
 * need a start whose weights sum to 5/6, as rk4 without its last stage has: its error of order h,
 * decaying like 3^{-n}, is the largest local error they show. The first two rows are not
 * reproduced by any start, nor mu of the last; the signs of mu are.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>

/* clang-format off */
static const stf_growth_line lines[] = {
  {"steyer", "h = 3/4", 0.75, 0.75, 53,
   {412857.12, 3812719.6, 62.099144, 0.48299923,
    0.36386503, 0.21135103, 2.2783111, 0.32213224},
   {4.32e5, 3.96e6, NAN, .489}, {1.37e10, 1.51e11, NAN, .768}},
  {"steyer", "h = 3/40", 0.075, 0.075, 533,
   {0.00047003895, 0.0020887215, 1.1511333, 0.014339575,
    0.0022063314, 0.0065871528, 0.40182677, -0.0062103542},
   {3.26e-4, 6.08e-3, NAN, 2.01e-3}, {3.75e-3, 9.42e-3, NAN, 9.03e-3}},
  {"steyer", "h = 3/400", 0.0075, 0.0075, 5333,
   {1.9014434e-7, 1.7418989e-6, 1.0104376, -0.079619493,
    -0.11437044, 0.0027270496, 0.34246885, -0.14515733},
   {3.37e-7, 6.03e-4, NAN, -9.99e-2}, {3.60e-7, 6.38e-4, NAN, -9.70e-2}},
  {"steyer", "h = 3/4000", 0.00075, 0.00075, 53333,
   {1.8904927e-10, 1.7384862e-9, 1.0010105, -0.081152922,
    -0.11761778, 0.0026524177, 0.34864082, -0.1500367},
   {1.892e-9, 6.07e-5, NAN, -8.29e-2}, {1.95e-9, 6.24e-5, NAN, -9.04e-2}},
};
/* clang-format on */

static const stf_growths data = {sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_steyer1 = {
  .about = "BDF2 with long steps grows where the equation decays: table 1 of Steyer and Van "
           "Vleck; no start "
           "reproduces its rows 3/4 and 3/40 and the mu of 3/4000",
  .frame = {.title = "Growth of BDF2 by the step", .x_label = "h", .y_label = "mu", .log_x = 1},
  .run = stf_growth_table,
  .data = &data,
};
