/* main.c: the tests of consistent start values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_chain[], tests_of_newcomers[], tests_of_drift[], tests_of_repair[],
  tests_of_kinetic[], tests_of_starts[], tests_of_machines[], tests_of_higher[],
  tests_of_diode[], tests_of_singular[];

SUITE_MAIN({.pName = "diode", .pTests = tests_of_diode},
           {.pName = "singular", .pTests = tests_of_singular},
           {.pName = "newcomers", .pTests = tests_of_newcomers},
           {.pName = "machines", .pTests = tests_of_machines},
           {.pName = "higher", .pTests = tests_of_higher},
           {.pName = "chain", .pTests = tests_of_chain},
           {.pName = "drift", .pTests = tests_of_drift},
           {.pName = "repair", .pTests = tests_of_repair},
           {.pName = "kinetic", .pTests = tests_of_kinetic},
           {.pName = "starts", .pTests = tests_of_starts})
