/* steyer2.c: table 2 of A. Steyer and E. Van Vleck, arXiv 1709.02059: BDF2 on their equation (3),
 * h = 0.05, for four amplitudes. lte: |x_{n+2} - X(t_{n+2}, t_{n+1}) x_{n+1}|; mu: the largest
 * ln |w_n| / t_n in the second half, w = (3 x_{n+1} - x_n)/2.
 *
 * References: the closed fundamental matrix in double, and again in 40 digits. The printed figures
 * need a start whose weights sum to 5/6, as rk4 without its last stage has: its error of order h,
 * decaying like 3^{-n}, is the largest local error they show. Its b1 is -0.05; the
 * printed -0.5 gives figures 8 to 30 times smaller.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

#define AMPLITUDE(a) "steyer:a=" a ",b1=-0.05,b2=-0.055,beta=1", "a = " a

static const stf_growth_line lines[] = {
  {AMPLITUDE("1.15"),
   0.05,
   1.15,
   2000,
   {6.589222e-5, 5.383358e-4, -.01409366},
   {5.49e-5, 4.28e-3, -2.34e-2},
   {5.50e-5, 4.38e-3, -2.33e-2}},
  {AMPLITUDE("1.45"),
   0.05,
   1.45,
   2000,
   {1.428557e-4, 8.841968e-4, .004440235},
   {1.17e-4, 4.98e-3, -2.05e-3},
   {1.18e-4, 5.02e-3, -1.69e-3}},
  {AMPLITUDE("1.75"),
   0.05,
   1.75,
   2000,
   {3.450986e-4, 1.420003e-3, .02232313},
   {2.82e-4, 5.72e-3, 1.73e-2},
   {2.88e-4, 5.70e-3, 1.78e-2}},
  {AMPLITUDE("2.05"),
   0.05,
   2.05,
   2000,
   {9.333316e-4, 4.570511e-3, .03981980},
   {7.69e-4, 6.48e-3, 3.56e-2},
   {7.96e-4, 6.4e-3, 3.64e-2}},
};

static const stf_growths data = {sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_steyer2 = {
  .about = "BDF2 grows for wide oscillations: table 2 of Steyer and Van Vleck, its start found",
  .frame = {.title = "Growth of BDF2 by the amplitude", .x_label = "a", .y_label = "mu"},
  .run = stf_growth_table,
  .data = &data,
};
