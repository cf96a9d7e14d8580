/* main.c: the tests of the baseline room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_engines[], tests_of_forms[], tests_of_index[], tests_of_failures[],
  tests_of_tables[], tests_of_public[], tests_of_linear[], tests_of_settings[],
  tests_of_coloured[], tests_of_columns[];

SUITE_MAIN({.pName = "engines", .pTests = tests_of_engines},
           {.pName = "forms", .pTests = tests_of_forms},
           {.pName = "index", .pTests = tests_of_index},
           {.pName = "failures", .pTests = tests_of_failures},
           {.pName = "tables", .pTests = tests_of_tables},
           {.pName = "public", .pTests = tests_of_public},
           {.pName = "linear", .pTests = tests_of_linear},
           {.pName = "settings", .pTests = tests_of_settings},
           {.pName = "coloured", .pTests = tests_of_coloured},
           {.pName = "columns", .pTests = tests_of_columns})
