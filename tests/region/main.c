/* main.c: tests of stability regions and observed orders.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_region[], tests_of_general_regions[], tests_of_boundary[],
  tests_of_order[], tests_of_deviation[];

SUITE_MAIN({.pName = "region", .pTests = tests_of_region},
           {.pName = "general regions", .pTests = tests_of_general_regions},
           {.pName = "boundary", .pTests = tests_of_boundary},
           {.pName = "order", .pTests = tests_of_order},
           {.pName = "deviation", .pTests = tests_of_deviation})
