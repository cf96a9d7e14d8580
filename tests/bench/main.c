/* Tests of the bench room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_phi[];

SUITE_MAIN({.pName = "phi", .pTests = tests_of_phi})
