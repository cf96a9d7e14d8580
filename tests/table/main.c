/* main.c: the suites of the table room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_estimates[], tests_of_general[], tests_of_irks[], tests_of_read[];
extern CU_TestInfo tests_of_splitting[], tests_of_nodes[], tests_of_shelf[], tests_of_claims[],
  tests_of_stability[], tests_of_transform[], tests_of_stored[], tests_of_rosenbrock_data[];

SUITE_MAIN({.pName = "general", .pTests = tests_of_general},
           {.pName = "estimates", .pTests = tests_of_estimates},
           {.pName = "irks", .pTests = tests_of_irks},
           {.pName = "read", .pTests = tests_of_read},
           {.pName = "splitting", .pTests = tests_of_splitting},
           {.pName = "nodes", .pTests = tests_of_nodes},
           {.pName = "shelf", .pTests = tests_of_shelf},
           {.pName = "claims", .pTests = tests_of_claims},
           {.pName = "stability", .pTests = tests_of_stability},
           {.pName = "transform", .pTests = tests_of_transform},
           {.pName = "stored", .pTests = tests_of_stored},
           {.pName = "rosenbrock data", .pTests = tests_of_rosenbrock_data})
