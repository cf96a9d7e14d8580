/* main.c: the tests of jumps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_impact[], tests_of_jumps[];

SUITE_MAIN({.pName = "impact", .pTests = tests_of_impact},
           {.pName = "jumps", .pTests = tests_of_jumps})
