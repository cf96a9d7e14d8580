/* main.c: tests of Lyapunov exponents, of counterexamples and of the supervisor.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_lyapunov[], tests_of_attractors[], tests_of_leading[],
  tests_of_errors[], tests_of_laws[], tests_of_algebra[], tests_of_growth[],
  tests_of_underlying[], tests_of_counterexample[], tests_of_supervisor[],
  tests_of_supervised_forms[], tests_of_decay[], tests_of_periods[], tests_of_dae_exponents[],
  tests_of_windows[];

SUITE_MAIN({.pName = "lyapunov", .pTests = tests_of_lyapunov},
           {.pName = "attractors", .pTests = tests_of_attractors},
           {.pName = "leading exponents", .pTests = tests_of_leading},
           {.pName = "standard errors of exponents", .pTests = tests_of_errors},
           {.pName = "laws of exponents", .pTests = tests_of_laws},
           {.pName = "algebra of exponents", .pTests = tests_of_algebra},
           {.pName = "growth", .pTests = tests_of_growth},
           {.pName = "underlying", .pTests = tests_of_underlying},
           {.pName = "counterexample", .pTests = tests_of_counterexample},
           {.pName = "supervisor", .pTests = tests_of_supervisor},
           {.pName = "supervised forms", .pTests = tests_of_supervised_forms},
           {.pName = "windows", .pTests = tests_of_windows},
           {.pName = "decay", .pTests = tests_of_decay},
           {.pName = "periods", .pTests = tests_of_periods},
           {.pName = "exponents of DAEs", .pTests = tests_of_dae_exponents})
