/* main.c: the suites of gradients.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_gradients[], tests_of_checkpoints[], tests_of_duality[],
  tests_of_gradient_input[], tests_of_directions[], tests_of_hessians[], tests_of_forms[],
  tests_of_passages[], tests_of_differences[], tests_of_operators[],
  tests_of_wrong_derivatives[];

SUITE_MAIN({.pName = "gradients", .pTests = tests_of_gradients},
           {.pName = "checkpoints", .pTests = tests_of_checkpoints},
           {.pName = "duality", .pTests = tests_of_duality},
           {.pName = "input", .pTests = tests_of_gradient_input},
           {.pName = "directions", .pTests = tests_of_directions},
           {.pName = "hessians", .pTests = tests_of_hessians},
           {.pName = "forms", .pTests = tests_of_forms},
           {.pName = "passages", .pTests = tests_of_passages},
           {.pName = "differences", .pTests = tests_of_differences},
           {.pName = "operators", .pTests = tests_of_operators},
           {.pName = "wrong derivatives", .pTests = tests_of_wrong_derivatives})
