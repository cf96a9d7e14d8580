/* main.c: the tests of the diagnoses.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_verdicts[], tests_of_starts[], tests_of_causes[],
  tests_of_jacobians[], tests_of_scales[], tests_of_shelf[], tests_of_misuse[],
  tests_of_failure[], tests_of_drift[], tests_of_jumps[];

SUITE_MAIN({.pName = "verdicts", .pTests = tests_of_verdicts},
           {.pName = "starts", .pTests = tests_of_starts},
           {.pName = "causes", .pTests = tests_of_causes},
           {.pName = "Jacobians", .pTests = tests_of_jacobians},
           {.pName = "scales", .pTests = tests_of_scales},
           {.pName = "shelf", .pTests = tests_of_shelf},
           {.pName = "misuse", .pTests = tests_of_misuse},
           {.pName = "failure", .pTests = tests_of_failure},
           {.pName = "drift", .pTests = tests_of_drift},
           {.pName = "jumps", .pTests = tests_of_jumps})
