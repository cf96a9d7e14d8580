/* Tests of the march room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_steps[], tests_of_run[], tests_of_options[], tests_of_dense[],
  tests_of_digits[], tests_of_counts[], tests_of_breaks[], tests_of_engines[],
  tests_of_weights[], tests_of_events[], tests_of_reactions[], tests_of_limits[],
  tests_of_auto[], tests_of_rivals[], tests_of_constraints[], tests_of_record[],
  tests_of_success[], tests_of_references[], tests_of_krylov[], tests_of_bad_input[],
  tests_of_clock[], tests_of_corners[], tests_of_varying_mass[], tests_of_algebraic_noise[],
  tests_of_history[], tests_of_cubes[], tests_of_index_three[], tests_of_inexact[],
  tests_of_hidden[], tests_of_hidden_breaks[], tests_of_extended[], tests_of_between[];

SUITE_MAIN(
  {.pName = "steps", .pTests = tests_of_steps},
  {.pName = "corners", .pTests = tests_of_corners}, {.pName = "run", .pTests = tests_of_run},
  {.pName = "options", .pTests = tests_of_options},
  {.pName = "bad input", .pTests = tests_of_bad_input},
  {.pName = "dense output", .pTests = tests_of_dense},
  {.pName = "between", .pTests = tests_of_between},
  {.pName = "digits", .pTests = tests_of_digits},
  {.pName = "counts", .pTests = tests_of_counts},
  {.pName = "breaks", .pTests = tests_of_breaks},
  {.pName = "engines", .pTests = tests_of_engines},
  {.pName = "weights", .pTests = tests_of_weights},
  {.pName = "events", .pTests = tests_of_events},
  {.pName = "reactions", .pTests = tests_of_reactions},
  {.pName = "limits", .pTests = tests_of_limits}, {.pName = "auto", .pTests = tests_of_auto},
  {.pName = "rivals", .pTests = tests_of_rivals},
  {.pName = "constraints", .pTests = tests_of_constraints},
  {.pName = "record", .pTests = tests_of_record}, {.pName = "clock", .pTests = tests_of_clock},
  {.pName = "varying mass", .pTests = tests_of_varying_mass},
  {.pName = "algebraic noise", .pTests = tests_of_algebraic_noise},
  {.pName = "history", .pTests = tests_of_history},
  {.pName = "cubes", .pTests = tests_of_cubes}, {.pName = "krylov", .pTests = tests_of_krylov},
  {.pName = "index three", .pTests = tests_of_index_three},
  {.pName = "inexact", .pTests = tests_of_inexact},
  {.pName = "hidden errors", .pTests = tests_of_hidden},
  {.pName = "hidden breaks", .pTests = tests_of_hidden_breaks},
  {.pName = "success", .pTests = tests_of_success},
  {.pName = "references", .pTests = tests_of_references},
  {.pName = "extended", .pTests = tests_of_extended})
