/* main.c: the tests of the stability room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_region[], tests_of_boundary[], tests_of_order[],
  tests_of_lyapunov[], tests_of_growth[];

SUITE_MAIN({.pName = "region", .pTests = tests_of_region},
           {.pName = "boundary", .pTests = tests_of_boundary},
           {.pName = "order", .pTests = tests_of_order},
           {.pName = "lyapunov", .pTests = tests_of_lyapunov},
           {.pName = "growth", .pTests = tests_of_growth})
