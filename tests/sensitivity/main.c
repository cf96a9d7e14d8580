/* main.c: the tests of derivatives by parameters.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_figures[], tests_of_quadrature[], tests_of_events[],
  tests_of_higher_index[], tests_of_forward[], tests_of_families[], tests_of_same_mesh[],
  tests_of_sensitivity_input[], tests_of_index_one[], tests_of_start_slopes[];

SUITE_MAIN({.pName = "figures", .pTests = tests_of_figures},
           {.pName = "quadrature", .pTests = tests_of_quadrature},
           {.pName = "higher index", .pTests = tests_of_higher_index},
           {.pName = "events", .pTests = tests_of_events},
           {.pName = "index 1", .pTests = tests_of_index_one},
           {.pName = "forward", .pTests = tests_of_forward},
           {.pName = "families", .pTests = tests_of_families},
           {.pName = "same mesh", .pTests = tests_of_same_mesh},
           {.pName = "starts", .pTests = tests_of_start_slopes},
           {.pName = "input", .pTests = tests_of_sensitivity_input})
