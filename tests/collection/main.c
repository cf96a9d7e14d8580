/* main.c: the tests of the collection.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_find[], tests_of_digits[], tests_of_exact[], tests_of_jordan[],
  tests_of_small[], tests_of_jacobian[], tests_of_published[], tests_of_start[],
  tests_of_descriptor[], tests_of_generated[], tests_of_semilinear[];

SUITE_MAIN({.pName = "find", .pTests = tests_of_find},
           {.pName = "digits", .pTests = tests_of_digits},
           {.pName = "exact", .pTests = tests_of_exact},
           {.pName = "jordan", .pTests = tests_of_jordan},
           {.pName = "small", .pTests = tests_of_small},
           {.pName = "jacobian", .pTests = tests_of_jacobian},
           {.pName = "published", .pTests = tests_of_published},
           {.pName = "start", .pTests = tests_of_start},
           {.pName = "descriptor", .pTests = tests_of_descriptor},
           {.pName = "generated", .pTests = tests_of_generated},
           {.pName = "semilinear", .pTests = tests_of_semilinear})
