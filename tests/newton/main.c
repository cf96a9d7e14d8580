/* Tests of the newton room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_solve[], tests_of_refusal[], tests_of_factors[], tests_of_blend[];

SUITE_MAIN({.pName = "solve", .pTests = tests_of_solve},
           {.pName = "refusal", .pTests = tests_of_refusal},
           {.pName = "factors", .pTests = tests_of_factors},
           {.pName = "blend", .pTests = tests_of_blend})
