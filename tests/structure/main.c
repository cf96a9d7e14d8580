/* main.c: the tests of the structure of a DAE.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_exact[], tests_of_matching[], tests_of_scaling[], tests_of_weyr[];

SUITE_MAIN({.pName = "exact", .pTests = tests_of_exact},
           {.pName = "matching", .pTests = tests_of_matching},
           {.pName = "scaling", .pTests = tests_of_scaling},
           {.pName = "weyr", .pTests = tests_of_weyr})
