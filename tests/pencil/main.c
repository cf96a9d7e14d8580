/* main.c: the suites of the pencil room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_multishift[], tests_of_crew[], tests_of_frame[], tests_of_krylov[],
  tests_of_incomplete[], tests_of_solve[], tests_of_sparse[], tests_of_multifrontal[],
  tests_of_transposed[];

SUITE_MAIN({.pName = "solve", .pTests = tests_of_solve},
           {.pName = "frame", .pTests = tests_of_frame},
           {.pName = "sparse", .pTests = tests_of_sparse},
           {.pName = "transposed", .pTests = tests_of_transposed},
           {.pName = "multifrontal", .pTests = tests_of_multifrontal},
           {.pName = "krylov", .pTests = tests_of_krylov},
           {.pName = "incomplete", .pTests = tests_of_incomplete},
           {.pName = "multishift", .pTests = tests_of_multishift},
           {.pName = "crew", .pTests = tests_of_crew})
