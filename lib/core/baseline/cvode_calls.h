/* cvode_calls.h: every function of CVODE that its engines call.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_CVODE_CALLS_H
#define STF_CVODE_CALLS_H

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>

/* clang-format off */
#define STF_CVODE_CALLS(X) \
  X(CVode) X(CVodeCreate) X(CVodeFree) X(CVodeGetCurrentOrder) X(CVodeGetCurrentStep) \
  X(CVodeGetCurrentTime) X(CVodeGetDky) X(CVodeGetLastStep) X(CVodeGetNumErrTestFails) \
  X(CVodeGetNumJacEvals) X(CVodeGetNumLinIters) X(CVodeGetNumLinRhsEvals) \
  X(CVodeGetNumLinSolvSetups) X(CVodeGetNumNonlinSolvIters) X(CVodeGetNumRhsEvals) \
  X(CVodeGetNumStepSolveFails) X(CVodeGetNumSteps) X(CVodeInit) X(CVodeReInit) \
  X(CVodeSStolerances) X(CVodeSVtolerances) X(CVodeSetConstraints) X(CVodeSetInitStep) \
  X(CVodeSetJacFn) X(CVodeSetJacTimes) X(CVodeSetLinearSolver) X(CVodeSetMaxHnilWarns) \
  X(CVodeSetMaxNumSteps) X(CVodeSetMaxOrd) X(CVodeSetMaxStep) X(CVodeSetNonlinConvCoef) \
  X(CVodeSetNonlinearSolver) X(CVodeSetPreconditioner) X(CVodeSetStabLimDet) \
  X(CVodeSetStopTime) X(CVodeSetUserData) X(CVodeWFtolerances)
/* clang-format on */

#define STF_CVODE_MEMBER(name) __typeof__(name) *name;
typedef struct stf_cvode_calls {
  STF_CVODE_CALLS(STF_CVODE_MEMBER)
#if SUNDIALS_VERSION_MAJOR < 7
  STF_CVODE_MEMBER(CVodeSetErrHandlerFn)
#endif
  const char *package;
} stf_cvode_calls;

extern const stf_cvode_calls stf_cvode_linked;

#endif
