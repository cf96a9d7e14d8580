/* Tests of the method room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_sympl[], tests_of_separable[], tests_of_stiffpair[],
  tests_of_nonlinear[], tests_of_start[], tests_of_expo[], tests_of_interleaved[],
  tests_of_rodas[];

extern CU_TestInfo tests_of_glm[], tests_of_gain[];

SUITE_MAIN({.pName = "glm", .pTests = tests_of_glm}, {.pName = "gain", .pTests = tests_of_gain},
           {.pName = "sympl", .pTests = tests_of_sympl},
           {.pName = "separable", .pTests = tests_of_separable},
           {.pName = "stiff pair", .pTests = tests_of_stiffpair},
           {.pName = "nonlinear", .pTests = tests_of_nonlinear},
           {.pName = "starts", .pTests = tests_of_start},
           {.pName = "exponential", .pTests = tests_of_expo},
           {.pName = "interleaved", .pTests = tests_of_interleaved},
           {.pName = "rodas", .pTests = tests_of_rodas})
