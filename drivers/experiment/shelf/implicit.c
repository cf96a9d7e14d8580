/* implicit.c: implicit methods on x' = diag(-1, -1000) x, (1, 1), at t = 4. References: the closed
 * forms R(h lambda)^n and the recurrences of BDF in 50 digits; a BDF started by lower orders
 * (start=ramp) keeps the order of its first step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"

static const stf_order_line lines[] = {
  {"be",
   {2.0702803422e-02, 9.8318587823e-03, 4.7581694934e-03, 2.3356861264e-03, 1.1564669106e-03}},
  {"bdf:p=2",
   {3.9927222221e-03, 8.3222219986e-04, 1.8601182957e-04, 4.4038988300e-05, 1.0717276289e-05}},
  {"bdf:p=2,start=exact",
   {7.7512226567e-03, 1.6929526392e-03, 4.0062291749e-04, 9.7693934388e-05, 2.4131733262e-05}},
  {"bdf:p=3,start=exact",
   {3.0039438896e-03, 3.2747384385e-04, 3.8372016402e-05, 4.6334814379e-06, 5.6903412908e-07}},
  {"bdf:p=4,start=exact",
   {1.2272227274e-03, 6.8445678371e-05, 3.9338248084e-06, 2.3470212679e-07, 1.4320508866e-08}},
  {"bdf:p=5,start=exact",
   {5.4125003373e-04, 1.4826719388e-05, 4.1995187824e-07, 1.2387371726e-08, 3.7549680e-10}},
  {"bdf:p=6,start=exact",
   {2.3818729142e-04, 3.3327355372e-06, 4.592576715e-08, 6.72506429e-10, 1.012956e-11}},
  {"bdf:p=3,start=ramp", {0, 0, 1.9369749022e-04, 4.6934922341e-05, 1.1571511267e-05}},
  {"dirk:cranknicolson",
   {9.3800467936e-01, 7.7413774079e-01, 3.5912405440e-01, 1.6615837687e-02, 5.9620249676e-06}},
  {"dirk:alexander2",
   {7.7456083585e-04, 1.8939439156e-04, 4.6820042606e-05, 1.1639078752e-05, 2.9015359108e-06}},
  {"dirk:alexander3",
   {1.8571276010e-04, 2.5924093701e-05, 3.4533775468e-06, 4.4674346619e-07, 5.6848609636e-08}},
  {"radau:s=2",
   {1.1324758654e-04, 1.4940705004e-05, 1.9244358185e-06, 2.4438693393e-07, 3.0797279636e-08}},
  {"radau:s=3",
   {2.9523378511e-07, 9.5472066641e-09, 3.0415989172e-10, 9.6023675e-12, 3.01e-13}},
  {"gauss:s=2",
   {8.2530686856e-01, 4.6394002372e-01, 4.6328422126e-02, 4.6068015e-06, 9.7046e-11}},
};

static const stf_orders data = {.problem = "stiffpair",
                                .t1 = 4,
                                .h = 0.5,
                                .rows = 5,
                                .lines = sizeof lines / sizeof *lines,
                                .line = lines,
                                .digits = 1e-8,
                                .floor = 1e-15};

const steif_experiment steif_experiment_implicit = {
  .about = "orders of implicit methods on a stiff linear pair",
  .frame = {.title = "x' = diag(-1, -1000) x at t = 4",
            .x_label = "h",
            .y_label = "error",
            .log_x = 1,
            .log_y = 1},
  .run = stf_order_table,
  .data = &data,
};
