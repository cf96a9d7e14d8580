/* Tests of the bench room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_phi[], tests_of_lyapunov[], tests_of_growth[], tests_of_step[],
  tests_of_made[], tests_of_planted[], tests_of_verdicts[], tests_of_scale[];

SUITE_MAIN({.pName = "phi", .pTests = tests_of_phi}, {.pName = "step", .pTests = tests_of_step},
           {.pName = "planted", .pTests = tests_of_planted},
           {.pName = "made", .pTests = tests_of_made},
           {.pName = "growth", .pTests = tests_of_growth},
           {.pName = "lyapunov", .pTests = tests_of_lyapunov},
           {.pName = "verdicts", .pTests = tests_of_verdicts},
           {.pName = "scale", .pTests = tests_of_scale})
