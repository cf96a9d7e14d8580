/* main.c: the tests of fits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_fits[], tests_of_statistics[], tests_of_measurements[],
  tests_of_bad_fits[], tests_of_models[], tests_of_intervals[], tests_of_no_minimum[];

SUITE_MAIN({.pName = "fits", .pTests = tests_of_fits},
           {.pName = "statistics", .pTests = tests_of_statistics},
           {.pName = "intervals", .pTests = tests_of_intervals},
           {.pName = "measurements", .pTests = tests_of_measurements},
           {.pName = "no minimum", .pTests = tests_of_no_minimum},
           {.pName = "bad fits", .pTests = tests_of_bad_fits},
           {.pName = "models that name their measurements", .pTests = tests_of_models})
