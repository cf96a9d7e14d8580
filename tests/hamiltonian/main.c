/* main.c: tests of invariants, of maps of one step and of linear Hamiltonian systems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_energy[], tests_of_kepler[], tests_of_stepmap[],
  tests_of_hamiltonian[];

SUITE_MAIN({.pName = "energy", .pTests = tests_of_energy},
           {.pName = "kepler", .pTests = tests_of_kepler},
           {.pName = "map of a step", .pTests = tests_of_stepmap},
           {.pName = "hamiltonian", .pTests = tests_of_hamiltonian})
