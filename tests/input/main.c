/* main.c: the suites of the input room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_market[], tests_of_malformed[], tests_of_write[], tests_of_mat[],
  tests_of_series[], tests_of_grammar[], tests_of_function[], tests_of_samples[],
  tests_of_memory[], tests_of_names[], tests_of_hdf5[], tests_of_mat_bytes[];

SUITE_MAIN({.pName = "market", .pTests = tests_of_market},
           {.pName = "malformed", .pTests = tests_of_malformed},
           {.pName = "write", .pTests = tests_of_write},
           {.pName = "mat", .pTests = tests_of_mat},
           {.pName = "mat_bytes", .pTests = tests_of_mat_bytes},
           {.pName = "hdf5", .pTests = tests_of_hdf5},
           {.pName = "names", .pTests = tests_of_names},
           {.pName = "series", .pTests = tests_of_series},
           {.pName = "grammar", .pTests = tests_of_grammar},
           {.pName = "function", .pTests = tests_of_function},
           {.pName = "samples", .pTests = tests_of_samples},
           {.pName = "memory", .pTests = tests_of_memory})
