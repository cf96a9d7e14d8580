/* main.c: the tests of explanations of failures.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_causes[], tests_of_failure[], tests_of_jacobians[],
  tests_of_misuse[], tests_of_campaign[];

SUITE_MAIN({.pName = "causes", .pTests = tests_of_causes},
           {.pName = "failure", .pTests = tests_of_failure},
           {.pName = "jacobians", .pTests = tests_of_jacobians},
           {.pName = "campaign", .pTests = tests_of_campaign},
           {.pName = "misuse", .pTests = tests_of_misuse})
