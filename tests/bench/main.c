/* Tests of the bench room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_phi[], tests_of_lyapunov[];

SUITE_MAIN({.pName = "phi", .pTests = tests_of_phi},
           {.pName = "lyapunov", .pTests = tests_of_lyapunov})
