/* main.c: the tests of the descriptor room.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_exact[], tests_of_pair[], tests_of_moments[], tests_of_euler[],
  tests_of_bdf[], tests_of_ut5[], tests_of_rk[], tests_of_duality[], tests_of_mesh[],
  tests_of_layer[], tests_of_weak[], tests_of_matching[], tests_of_contour[],
  tests_of_regular[], tests_of_structure[], tests_of_families[], tests_of_impulse_dense[],
  tests_of_run[], tests_of_subject[], tests_of_ida[], tests_of_array[], tests_of_units[],
  tests_of_circle[], tests_of_ends[], tests_of_impact[], tests_of_demand[],
  tests_of_hidden[], tests_of_renewed[], tests_of_steady[];

SUITE_MAIN(
  {.pName = "impact", .pTests = tests_of_impact},
  {.pName = "demand", .pTests = tests_of_demand},
  {.pName = "hidden", .pTests = tests_of_hidden},
  {.pName = "exact", .pTests = tests_of_exact}, {.pName = "pair", .pTests = tests_of_pair},
  {.pName = "moments", .pTests = tests_of_moments},
  {.pName = "euler", .pTests = tests_of_euler}, {.pName = "bdf", .pTests = tests_of_bdf},
  {.pName = "ut5", .pTests = tests_of_ut5}, {.pName = "rk", .pTests = tests_of_rk},
  {.pName = "duality", .pTests = tests_of_duality}, {.pName = "mesh", .pTests = tests_of_mesh},
  {.pName = "layer", .pTests = tests_of_layer}, {.pName = "weak", .pTests = tests_of_weak},
  {.pName = "matching", .pTests = tests_of_matching},
  {.pName = "contour", .pTests = tests_of_contour},
  {.pName = "circle", .pTests = tests_of_circle},
  {.pName = "array", .pTests = tests_of_array},
  {.pName = "regular", .pTests = tests_of_regular},
  {.pName = "structure", .pTests = tests_of_structure},
  {.pName = "families", .pTests = tests_of_families},
  {.pName = "impulse dense", .pTests = tests_of_impulse_dense},
  {.pName = "run", .pTests = tests_of_run}, {.pName = "subject", .pTests = tests_of_subject},
  {.pName = "ida", .pTests = tests_of_ida}, {.pName = "units", .pTests = tests_of_units},
  {.pName = "ends", .pTests = tests_of_ends},
  {.pName = "renewed", .pTests = tests_of_renewed},
  {.pName = "steady", .pTests = tests_of_steady})
