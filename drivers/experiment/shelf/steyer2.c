/* steyer2.c: table 2 of A. Steyer and E. Van Vleck, arXiv 1709.02059: BDF2 on their equation (3),
 * h = 0.05, for four amplitudes. lte: |x_{n+2} - X(t_{n+2}, t_{n+1}) x_{n+1}|; mu: the largest
 * ln |w_n| / t_n in the second half, w = (3 x_{n+1} - x_n)/2.
 *
 * References: the recurrence in 30 digits with the closed fundamental matrix. The printed figures
 * need a start whose weights sum to 5/6, as rk4 without its last stage has: its error of order h,
 * decaying like 3^{-n}, is the largest local error they show. Its b1 is -0.05; the
 * printed -0.5 gives figures 8 to 30 times smaller.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>

#define AMPLITUDE(a) "steyer:a=" a ",b1=-0.05,b2=-0.055,beta=1", "a = " a

/* clang-format off */
static const stf_growth_line lines[] = {
  {AMPLITUDE("1.15"), 0.05, 1.15, 2000,
   {6.5892221e-5, 0.00053833579, 1.0684719, -0.014093655,
    -0.036295997, 0.02662555, 1.119274, -0.031552081},
   {5.49e-5, 4.28e-3, NAN, -2.34e-2}, {5.50e-5, 4.38e-3, 1.068, -2.33e-2}},
  {AMPLITUDE("1.45"), 0.05, 1.45, 2000,
   {0.00014285566, 0.00088419681, 1.0857004, 0.0044402355,
    -0.024212365, 0.034355779, 1.4347291, -0.018864126},
   {1.17e-4, 4.98e-3, NAN, -2.05e-3}, {1.18e-4, 5.02e-3, 1.086, -1.69e-3}},
  {AMPLITUDE("1.75"), 0.05, 1.75, 2000,
   {0.00034509862, 0.0014200027, 1.1056915, 0.022323134,
    -0.013369069, 0.04202436, 1.7483899, -0.0080572794},
   {2.82e-4, 5.72e-3, NAN, 1.73e-2}, {2.88e-4, 5.70e-3, 1.11, 1.78e-2}},
  {AMPLITUDE("2.05"), 0.05, 2.05, 2000,
   {0.00093333157, 0.0045705107, 1.1260631, 0.039819801,
    -0.0030746878, 0.049670427, 2.0617642, 0.0020283545},
   {7.69e-4, 6.48e-3, NAN, 3.56e-2}, {7.96e-4, 6.4e-3, 1.23, 3.64e-2}},
};
/* clang-format on */

static const stf_growths data = {sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_steyer2 = {
  .about = "BDF2 grows for large oscillations: table 2 of Steyer and Van Vleck, with the start "
           "that gives it",
  .frame = {.title = "Growth of BDF2 by the amplitude", .x_label = "a", .y_label = "mu"},
  .run = stf_growth_table,
  .data = &data,
};
