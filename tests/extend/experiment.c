/* halving.c: an experiment of the test of extensions. Two explicit methods of order 2 on y' = -y are
 * y_n = (1 - h + h^2/2)^n; references from that.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

#define ERRORS                                                                                 \
  {                                                                                            \
    6.61543662109576e-04, 1.5918050041402e-04, 3.904854541831e-05, 9.67058425083e-06           \
  }

static const stf_order_line lines[] = {{"heun", ERRORS}, {"midpoint", ERRORS}};

static const stf_orders data = {.problem = "cooling",
                                .t1 = 1,
                                .h = 0.1,
                                .rows = 4,
                                .lines = sizeof lines / sizeof *lines,
                                .line = lines,
                                .digits = 1e-9,
                                .floor = 2e-15};

const steif_experiment steif_experiment_halving = {
  .about = "order 2, twice",
  .frame = {.title = "y' = -y at t = 1", .x_label = "h", .y_label = "error"},
  .run = stf_order_table,
  .data = &data,
};
