/* portrait.c: the pendulum H = p^2/2 - cos q from (1, 0), 3142 steps of 0.1: 46.89 of its periods
 * 4 K(sin^2 1/2) = 6.69998. The exact end is (0.7992660155679068, 0.5602334227181494). References:
 * recomputed in NumPy.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

#define ON(method, drawn) "pendulum", method, NULL, 0.1, 3142, drawn

static const stf_constant_run lines[] = {
  {ON("verlet", true),
   {{STF_FIRST_END, 0.8586573283, 1e-9},
    {STF_SECOND_END, 0.4753372023, 1e-9},
    {STF_MAX, 0, 1e-12},
    {STF_MIN, -1.0612339990e-03, 1e-12},
    {STF_FINAL, -1.7937967584e-04, 1e-12}}},
  {ON("rk4", true),
   {{STF_FIRST_END, 0.7993509296, 1e-9},
    {STF_SECOND_END, 0.5600988671, 1e-9},
    {STF_MAX, 0, 1e-12},
    {STF_MIN, -1.4503089743e-05, 1e-12},
    {STF_FINAL, -1.4500852036e-05, 1e-12}}},
  {ON("symeuler:first=p", true),
   {{STF_FIRST_END, 0.8625238546, 1e-9},
    {STF_SECOND_END, 0.5089972116, 1e-9},
    {STF_MAX, 2.2622015482e-02, 1e-12},
    {STF_MIN, -2.0798987897e-02, 1e-12},
    {STF_FINAL, 1.9318678792e-02, 1e-12}}},
  {ON("symeuler:first=q", false),
   {{STF_FIRST_END, 0.8116241334, 1e-9},
    {STF_SECOND_END, 0.5089972116, 1e-9},
    {STF_MAX, 2.2622012215e-02, 1e-12},
    {STF_MIN, -2.0798992450e-02, 1e-12},
    {STF_FINAL, -1.8479798477e-02, 1e-12}}},
  {ON("gauss:s=1", true),
   {{STF_FIRST_END, 0.6837473884, 1e-9},
    {STF_SECOND_END, 0.6854655140, 1e-9},
    {STF_MAX, 8.7891657968e-05, 1e-12},
    {STF_MIN, -3.26e-10, 1e-12},
    {STF_FINAL, 2.2858441307e-05, 1e-12}}},
};

static const stf_constant_runs data = {STF_ORBIT, 6.69997566437045271,
                                       sizeof lines / sizeof *lines, lines};

const steif_experiment steif_experiment_portrait = {
  .about = "phase portrait of the pendulum",
  .frame = {.title = "Pendulum, h = 0.1", .x_label = "q", .y_label = "p", .equal = 1},
  .run = stf_constant_table,
  .data = &data,
};
