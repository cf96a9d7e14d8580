/* discretisation.c: all discretisations of a forced, damped oscillator. Forward Euler is unstable for
 * dt > 1/8: its order shows from 0.05 on. References: the recurrences in NumPy against the closed
 * solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_scheme_line lines[] = {
  {"forward",
   {2.0322973607e+00, 6.0697603949e-01, 2.2902620262e-01, 1.0008364709e-01, 4.6907315379e-02}},
  {"backward",
   {3.3472906776e-01, 2.2707103128e-01, 1.3931223972e-01, 7.8100465587e-02, 4.1445822033e-02}},
  {"zoh",
   {2.4661348081e-01, 1.2535008830e-01, 6.2542641661e-02, 3.1237363282e-02, 1.5606825478e-02}},
  {"bilinear",
   {1.0847729955e-01, 2.9978349812e-02, 7.6680308457e-03, 1.9276911247e-03, 4.8258770116e-04}},
  {"exp-trapezoidal",
   {2.8219084437e-02, 7.1742377965e-03, 1.8225958952e-03, 4.5607686509e-04, 1.1413634186e-04}},
  {"exp-midpoint",
   {1.4752462577e-02, 3.7372654063e-03, 9.5126582207e-04, 2.3779489360e-04, 5.9447392924e-05}},
  {"averaged",
   {5.6300564941e-02, 1.4414653016e-02, 3.6251602492e-03, 9.0807696708e-04, 2.2734169904e-04}},
  {"quadrature",
   {2.5412538498e-02, 6.1468974332e-03, 1.5245501497e-03, 3.8154774081e-04, 9.5340144921e-05}},
};

static const stf_schemes data = {4, sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_discretisation = {
  .about = "orders of discretisations of q'' + q'/2 + 4 q = sin 2t",
  .frame = {.title = "q'' + q'/2 + 4 q = sin 2t on [0, 4]",
            .x_label = "dt",
            .y_label = "largest error of q",
            .log_x = 1,
            .log_y = 1},
  .run = stf_scheme_table,
  .data = &data,
};
