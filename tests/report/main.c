/* The report room. SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_forms[], tests_of_files[], tests_of_pictures[], tests_of_axes[],
  tests_of_arrays[];

SUITE_MAIN({.pName = "forms of a report", .pTests = tests_of_forms},
           {.pName = "output files", .pTests = tests_of_files},
           {.pName = "axes", .pTests = tests_of_axes},
           {.pName = "pictures", .pTests = tests_of_pictures},
           {.pName = "arrays", .pTests = tests_of_arrays})
