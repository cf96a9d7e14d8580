/* exptrapezoidal.c: the exponential trapezoidal rule against hold and bilinear rule on the softer
 * oscillator q'' + q'/2 + 2 q = sin 2t. References: the recurrences in NumPy against the closed
 * solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_scheme_line lines[] = {
  {"forward", {0, 0, 0, 0, 5.0325496392e-02}},
  {"zoh",
   {2.0478423817e-01, 1.0338651716e-01, 5.1401745049e-02, 2.5678474554e-02, 1.2816160194e-02}},
  {"bilinear",
   {8.0259602488e-02, 2.0929295509e-02, 5.3647670821e-03, 1.3439479095e-03, 3.3615893860e-04}},
  {"exp-trapezoidal",
   {3.4183191183e-02, 8.6615028903e-03, 2.1726066647e-03, 5.4538690861e-04, 1.3637431602e-04}},
};

static const stf_schemes data = {2, sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_exptrapezoidal = {
  .about = "convergence of the exponential trapezoidal rule, q'' + q'/2 + 2 q = sin 2t",
  .frame = {.title = "q'' + q'/2 + 2 q = sin 2t on [0, 4]",
            .x_label = "dt",
            .y_label = "largest error of q",
            .log_x = 1,
            .log_y = 1},
  .run = stf_scheme_table,
  .data = &data,
};
