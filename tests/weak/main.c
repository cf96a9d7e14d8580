/* main.c: the tests of weak convergence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_bdf[], tests_of_breaks[], tests_of_cobb[], tests_of_duality[],
  tests_of_euler[], tests_of_exact[], tests_of_exact_norms[], tests_of_functions[],
  tests_of_layer[], tests_of_many_digits[], tests_of_mesh[], tests_of_moments[],
  tests_of_norm[], tests_of_pair[], tests_of_restarts[], tests_of_rk[], tests_of_rounding[],
  tests_of_subject[], tests_of_ut5[], tests_of_verdict[], tests_of_weak[];

SUITE_MAIN(
  {.pName = "bdf", .pTests = tests_of_bdf}, {.pName = "breaks", .pTests = tests_of_breaks},
  {.pName = "cobb", .pTests = tests_of_cobb}, {.pName = "duality", .pTests = tests_of_duality},
  {.pName = "euler", .pTests = tests_of_euler}, {.pName = "exact", .pTests = tests_of_exact},
  {.pName = "exact norms", .pTests = tests_of_exact_norms},
  {.pName = "functions", .pTests = tests_of_functions},
  {.pName = "layer", .pTests = tests_of_layer},
  {.pName = "many digits", .pTests = tests_of_many_digits},
  {.pName = "mesh", .pTests = tests_of_mesh}, {.pName = "moments", .pTests = tests_of_moments},
  {.pName = "norm", .pTests = tests_of_norm}, {.pName = "pair", .pTests = tests_of_pair},
  {.pName = "restarts", .pTests = tests_of_restarts}, {.pName = "rk", .pTests = tests_of_rk},
  {.pName = "rounding", .pTests = tests_of_rounding},
  {.pName = "subject", .pTests = tests_of_subject}, {.pName = "ut5", .pTests = tests_of_ut5},
  {.pName = "verdict", .pTests = tests_of_verdict}, {.pName = "weak", .pTests = tests_of_weak})
