/* cvode_family.h: the engines cvode and cvodes are one, by the functions of CVODE that the library is linked with or by those
 * of CVODES, which has the same names and is loaded privately.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CVODE_FAMILY_H
#define STF_CVODE_FAMILY_H

#include "baseline.h"
#include "private_library.h"
#include <sundials/sundials_nonlinearsolver.h>

typedef struct stf_cvode {
  stf_baseline base;
  void *memory;
  const struct stf_cvode_calls *call; /* NULL when opened: those that are linked */
  const char *const *keys;            /* of the spec; NULL when opened: those of cvode */
  int order, stald;
  bool adams; /* with fixed-point iteration: no matrix */
  SUNNonlinearSolver iteration;
  sunrealtype newton; /* coefficient of its convergence test; 0: its default */
} stf_cvode;

/* The same functions of CVODES; they live in the pool of the run. */
const struct stf_cvode_calls *stf_cvode_load(stf_run *run, stf_library *library);

#endif
