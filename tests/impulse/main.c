/* main.c: the tests of structure and impulses of linear systems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_certificates[], tests_of_circle[], tests_of_contour[],
  tests_of_demand[], tests_of_eigenvalues[], tests_of_families[], tests_of_hidden[],
  tests_of_impulse_dense[], tests_of_regular[], tests_of_slopes[], tests_of_slope_directions[],
  tests_of_structure[], tests_of_teams[], tests_of_units[], tests_of_whole_numbers[];

SUITE_MAIN({.pName = "certificates", .pTests = tests_of_certificates},
           {.pName = "circle", .pTests = tests_of_circle},
           {.pName = "contour", .pTests = tests_of_contour},
           {.pName = "demand", .pTests = tests_of_demand},
           {.pName = "eigenvalues", .pTests = tests_of_eigenvalues},
           {.pName = "families", .pTests = tests_of_families},
           {.pName = "hidden", .pTests = tests_of_hidden},
           {.pName = "impulse dense", .pTests = tests_of_impulse_dense},
           {.pName = "regular", .pTests = tests_of_regular},
           {.pName = "slopes", .pTests = tests_of_slopes},
           {.pName = "slope directions", .pTests = tests_of_slope_directions},
           {.pName = "structure", .pTests = tests_of_structure},
           {.pName = "teams", .pTests = tests_of_teams},
           {.pName = "units", .pTests = tests_of_units},
           {.pName = "whole numbers", .pTests = tests_of_whole_numbers})
