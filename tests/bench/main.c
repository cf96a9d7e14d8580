/* Tests of the bench room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_phi[], tests_of_lyapunov[], tests_of_growth[], tests_of_step[];

SUITE_MAIN({.pName = "phi", .pTests = tests_of_phi}, {.pName = "step", .pTests = tests_of_step},
           {.pName = "growth", .pTests = tests_of_growth},
           {.pName = "lyapunov", .pTests = tests_of_lyapunov})
