/* main.c: the tests of the index.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_scales[], tests_of_shelf[], tests_of_verdicts[];

SUITE_MAIN({.pName = "scales", .pTests = tests_of_scales},
           {.pName = "shelf", .pTests = tests_of_shelf},
           {.pName = "verdicts", .pTests = tests_of_verdicts})
