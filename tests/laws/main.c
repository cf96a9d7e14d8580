/* The laws of the house: loops over everything on the shelves.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_law_propagator[], tests_of_law_retry[], tests_of_law_stumble[],
  tests_of_law_backends[], tests_of_law_memory[], tests_of_law_order[], tests_of_law_claims[],
  tests_of_law_symplectic[], tests_of_law_chosen[], tests_of_law_checkpoint[];

SUITE_MAIN({.pName = "propagator", .pTests = tests_of_law_propagator},
           {.pName = "retry", .pTests = tests_of_law_retry},
           {.pName = "chosen steps", .pTests = tests_of_law_chosen},
           {.pName = "stumble", .pTests = tests_of_law_stumble},
           {.pName = "back ends", .pTests = tests_of_law_backends},
           {.pName = "memory", .pTests = tests_of_law_memory},
           {.pName = "order", .pTests = tests_of_law_order},
           {.pName = "claims", .pTests = tests_of_law_claims},
           {.pName = "symplectic", .pTests = tests_of_law_symplectic},
           {.pName = "checkpoint", .pTests = tests_of_law_checkpoint})
