/* Tests of the problem room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_form[], tests_of_system[], tests_of_differ[], tests_of_fill[],
  tests_of_pattern[], tests_of_operator[], tests_of_start[], tests_of_parameters[];

SUITE_MAIN({.pName = "fill", .pTests = tests_of_fill},
           {.pName = "form", .pTests = tests_of_form},
           {.pName = "system", .pTests = tests_of_system},
           {.pName = "differences", .pTests = tests_of_differ},
           {.pName = "patterns", .pTests = tests_of_pattern},
           {.pName = "operators", .pTests = tests_of_operator},
           {.pName = "start", .pTests = tests_of_start},
           {.pName = "parameters", .pTests = tests_of_parameters})
