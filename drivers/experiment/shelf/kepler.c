/* kepler.c: Kepler's orbit of eccentricity 0.6 from the pericentre over 200 periods: RK4 sinks,
 * Verlet stays in a band and keeps the angular momentum. References: a program of a few lines in
 * extended precision.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

#define ON "kepler:e=0.6"

static const stf_constant_run lines[] = {
  {ON,
   "rk4",
   "rk4, h = 0.1",
   0.1,
   12566,
   true,
   {{STF_FINAL, -2.548944e-01, 1e-6}, {STF_MAX, 0, 1e-14}}},
  {ON,
   "rk4",
   "rk4, h = 0.05",
   0.05,
   25133,
   true,
   {{STF_FINAL, -6.782026e-03, 1e-8}, {STF_MAX, 0, 1e-14}}},
  {ON,
   "verlet",
   "verlet, h = 0.05",
   0.05,
   25133,
   true,
   {{STF_MAX, 9.3887e-03, 1e-7}, {STF_SECOND, 0, 3e-15}}},
};

static const stf_constant_runs data = {STF_DRIFT, 6.28318530717958647692,
                                       sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_kepler = {
  .about = "energy on Kepler's orbit of eccentricity 0.6 over 200 periods",
  .frame = {.title = "Kepler, e = 0.6", .x_label = "t", .y_label = "E(t) - E(0)"},
  .run = stf_constant_table,
  .data = &data,
};
