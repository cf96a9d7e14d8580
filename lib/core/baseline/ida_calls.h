/* ida_calls.h: every function of IDA that its engines call.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_IDA_CALLS_H
#define STF_IDA_CALLS_H

#include <ida/ida.h>
#include <ida/ida_ls.h>

/* clang-format off */
#define STF_IDA_CALLS(X) \
  X(IDACalcIC) X(IDACreate) X(IDAFree) X(IDAGetConsistentIC) X(IDAGetCurrentOrder) \
  X(IDAGetCurrentStep) X(IDAGetCurrentTime) X(IDAGetDky) X(IDAGetLastStep) \
  X(IDAGetNumErrTestFails) X(IDAGetNumJacEvals) X(IDAGetNumLinIters) \
  X(IDAGetNumLinResEvals) X(IDAGetNumLinSolvSetups) X(IDAGetNumNonlinSolvIters) \
  X(IDAGetNumResEvals) X(IDAGetNumStepSolveFails) X(IDAGetNumSteps) X(IDAInit) \
  X(IDAReInit) X(IDASStolerances) X(IDASVtolerances) X(IDASetConstraints) X(IDASetId) \
  X(IDASetInitStep) X(IDASetJacFn) X(IDASetJacTimes) X(IDASetLinearSolver) \
  X(IDASetMaxNumSteps) X(IDASetMaxOrd) X(IDASetMaxStep) X(IDASetNonlinConvCoef) \
  X(IDASetPreconditioner) X(IDASetStopTime) X(IDASetSuppressAlg) X(IDASetUserData) \
  X(IDASolve) X(IDAWFtolerances)
/* clang-format on */

#define STF_IDA_MEMBER(name) __typeof__(name) *name;
typedef struct stf_ida_calls {
  STF_IDA_CALLS(STF_IDA_MEMBER)
#if SUNDIALS_VERSION_MAJOR < 7
  STF_IDA_MEMBER(IDASetErrHandlerFn)
#endif
  const char *package;
} stf_ida_calls;

extern const stf_ida_calls stf_ida_linked;

#endif
