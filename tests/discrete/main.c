/* main.c: the suites of the discrete room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_tables[], tests_of_matrices[], tests_of_traps[],
  tests_of_refusals[], tests_of_claims[], tests_of_finite[];

SUITE_MAIN({.pName = "tables", .pTests = tests_of_tables},
           {.pName = "matrices", .pTests = tests_of_matrices},
           {.pName = "traps", .pTests = tests_of_traps},
           {.pName = "refusals", .pTests = tests_of_refusals},
           {.pName = "claims", .pTests = tests_of_claims},
           {.pName = "finite part", .pTests = tests_of_finite})
