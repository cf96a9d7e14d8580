/* steyer1.c: table 1 of A. Steyer and E. Van Vleck, arXiv 1709.02059: BDF2 on their equation (3),
 * h = 0.75 to 0.00075. lte: |x_{n+2} - X(t_{n+2}, t_{n+1}) x_{n+1}|; mu: the largest
 * ln |w_n| / t_n in the second half, w = (3 x_{n+1} - x_n)/2.
 *
 * References: the closed fundamental matrix in double, and again in 40 digits. The printed figures
 * need a start whose weights sum to 5/6, as rk4 without its last stage has: its error of order h,
 * decaying like 3^{-n}, is the largest local error they show. The first two rows are not
 * reproduced by any start, nor mu of the last; the signs of mu are.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_growth_line lines[] = {
  {"steyer",
   "h = 3/4",
   0.75,
   0.75,
   53,
   {4.128571e5, 3.812720e6, .4829992},
   {4.32e5, 3.96e6, .489},
   {1.37e10, 1.51e11, .768}},
  {"steyer",
   "h = 3/40",
   0.075,
   0.075,
   533,
   {4.700390e-4, 2.088722e-3, .01433958},
   {3.26e-4, 6.08e-3, 2.01e-3},
   {3.75e-3, 9.42e-3, 9.03e-3}},
  {"steyer",
   "h = 3/400",
   0.0075,
   0.0075,
   5333,
   {1.901443e-7, 1.741899e-6, -.07961949},
   {3.37e-7, 6.03e-4, -9.99e-2},
   {3.60e-7, 6.38e-4, -9.70e-2}},
  {"steyer",
   "h = 3/4000",
   0.00075,
   0.00075,
   53333,
   {1.890493e-10, 1.738487e-9, -.08115292},
   {1.892e-9, 6.07e-5, -8.29e-2},
   {1.95e-9, 6.24e-5, -9.04e-2}},
};

static const stf_growths data = {sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_steyer1 = {
  .about =
    "BDF2 with long steps grows where the equation decays: table 1 of Steyer and Van Vleck",
  .frame = {.title = "Growth of BDF2 by the step", .x_label = "h", .y_label = "mu", .log_x = 1},
  .run = stf_growth_table,
  .data = &data,
};
