/* main.c: the suites of the ensemble room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_ensembles[], tests_of_points[], tests_of_varied[], tests_of_queue[];

SUITE_MAIN({.pName = "ensembles", .pTests = tests_of_ensembles},
           {.pName = "points", .pTests = tests_of_points},
           {.pName = "varied", .pTests = tests_of_varied},
           {.pName = "queue", .pTests = tests_of_queue})
