/* Tests of lib/data/model: models as text.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"

extern CU_TestInfo tests_of_examples[];
extern CU_TestInfo tests_of_derivatives[];
extern CU_TestInfo tests_of_events[];
extern CU_TestInfo tests_of_sides[];
extern CU_TestInfo tests_of_conditions[];
extern CU_TestInfo tests_of_circuits[];
extern CU_TestInfo tests_of_growth[];
extern CU_TestInfo tests_of_modes[];
extern CU_TestInfo tests_of_starts[];
extern CU_TestInfo tests_of_interface[];
extern CU_TestInfo tests_of_products[];
extern CU_TestInfo tests_of_grids[];
extern CU_TestInfo tests_of_sensitivities[];
extern CU_TestInfo tests_of_low_orders[];
extern CU_TestInfo tests_of_passages[];
extern CU_TestInfo tests_of_integrands[];
extern CU_TestInfo tests_of_wrong_models[];

SUITE_MAIN({.pName = "the examples reach their end values", .pTests = tests_of_examples},
           {.pName = "derivatives against differences", .pTests = tests_of_derivatives},
           {.pName = "events", .pTests = tests_of_events},
           {.pName = "events of algebraic unknowns", .pTests = tests_of_sides},
           {.pName = "conditions", .pTests = tests_of_conditions},
           {.pName = "circuits with diodes", .pTests = tests_of_circuits},
           {.pName = "errors that grow again", .pTests = tests_of_growth},
           {.pName = "modes of a DAE", .pTests = tests_of_modes},
           {.pName = "starts", .pTests = tests_of_starts},
           {.pName = "the interface", .pTests = tests_of_interface},
           {.pName = "grids, and compiled models", .pTests = tests_of_grids},
           {.pName = "products with derivatives", .pTests = tests_of_products},
           {.pName = "derivatives by parameters", .pTests = tests_of_sensitivities},
           {.pName = "derivatives through events", .pTests = tests_of_passages},
           {.pName = "unknowns of low order", .pTests = tests_of_low_orders},
           {.pName = "integrands", .pTests = tests_of_integrands},
           {.pName = "wrong models and their sentences", .pTests = tests_of_wrong_models})
