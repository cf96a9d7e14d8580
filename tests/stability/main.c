/* main.c: the tests of the stability room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_region[], tests_of_boundary[], tests_of_order[],
  tests_of_lyapunov[], tests_of_growth[], tests_of_energy[], tests_of_kepler[],
  tests_of_stepmap[], tests_of_hamiltonian[], tests_of_supervisor[], tests_of_counterexample[],
  tests_of_attractors[];

extern CU_TestInfo tests_of_underlying[], tests_of_general_regions[], tests_of_laws[],
  tests_of_supervised_forms[], tests_of_leading[], tests_of_errors[], tests_of_algebra[];

SUITE_MAIN({.pName = "underlying", .pTests = tests_of_underlying},
           {.pName = "general regions", .pTests = tests_of_general_regions},
           {.pName = "region", .pTests = tests_of_region},
           {.pName = "boundary", .pTests = tests_of_boundary},
           {.pName = "order", .pTests = tests_of_order},
           {.pName = "lyapunov", .pTests = tests_of_lyapunov},
           {.pName = "leading exponents", .pTests = tests_of_leading},
           {.pName = "errors of exponents", .pTests = tests_of_errors},
           {.pName = "algebra of exponents", .pTests = tests_of_algebra},
           {.pName = "laws of exponents", .pTests = tests_of_laws},
           {.pName = "growth", .pTests = tests_of_growth},
           {.pName = "energy", .pTests = tests_of_energy},
           {.pName = "kepler", .pTests = tests_of_kepler},
           {.pName = "map of a step", .pTests = tests_of_stepmap},
           {.pName = "hamiltonian", .pTests = tests_of_hamiltonian},
           {.pName = "supervisor", .pTests = tests_of_supervisor},
           {.pName = "supervised forms", .pTests = tests_of_supervised_forms},
           {.pName = "counterexample", .pTests = tests_of_counterexample},
           {.pName = "attractors", .pTests = tests_of_attractors})
