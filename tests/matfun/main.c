/* main.c: the suites of the matfun room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_scalar[], tests_of_expm[], tests_of_range[], tests_of_frechet[],
  tests_of_action[], tests_of_frame[];

SUITE_MAIN({.pName = "scalar", .pTests = tests_of_scalar},
           {.pName = "expm", .pTests = tests_of_expm},
           {.pName = "range", .pTests = tests_of_range},
           {.pName = "frechet", .pTests = tests_of_frechet},
           {.pName = "action", .pTests = tests_of_action},
           {.pName = "frame", .pTests = tests_of_frame})
