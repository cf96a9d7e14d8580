/* main.c: the tests of runs of linear systems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_ends[], tests_of_ida[], tests_of_renewed[], tests_of_run[],
  tests_of_starts[], tests_of_steady[], tests_of_storage[];

SUITE_MAIN({.pName = "ends", .pTests = tests_of_ends}, {.pName = "ida", .pTests = tests_of_ida},
           {.pName = "renewed", .pTests = tests_of_renewed},
           {.pName = "run", .pTests = tests_of_run},
           {.pName = "starts", .pTests = tests_of_starts},
           {.pName = "steady", .pTests = tests_of_steady},
           {.pName = "storage", .pTests = tests_of_storage})
