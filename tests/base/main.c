/* main.c: the suites of the base room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_context[], tests_of_nulls[], tests_of_pool[], tests_of_space[],
  tests_of_spec[];

SUITE_MAIN({.pName = "context", .pTests = tests_of_context},
           {.pName = "nulls", .pTests = tests_of_nulls},
           {.pName = "pool", .pTests = tests_of_pool},
           {.pName = "space", .pTests = tests_of_space},
           {.pName = "spec", .pTests = tests_of_spec})
