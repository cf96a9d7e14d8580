/* main.c: the suites of the discrete room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_tables[], tests_of_matrices[];

SUITE_MAIN({.pName = "tables", .pTests = tests_of_tables},
           {.pName = "matrices", .pTests = tests_of_matrices})
