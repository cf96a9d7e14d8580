/* main.c: the tests of the experiment room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_shelf[], tests_of_claims[];

SUITE_MAIN({.pName = "shelf", .pTests = tests_of_shelf},
           {.pName = "claims", .pTests = tests_of_claims})
