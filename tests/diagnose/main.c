/* main.c: the tests of the diagnoses.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_verdicts[], tests_of_starts[], tests_of_causes[];

SUITE_MAIN({.pName = "verdicts", .pTests = tests_of_verdicts},
           {.pName = "starts", .pTests = tests_of_starts},
           {.pName = "causes", .pTests = tests_of_causes})
