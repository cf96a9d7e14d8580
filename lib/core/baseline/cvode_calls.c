/* cvode_calls.c: the functions of CVODE, linked or loaded.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "cvode_calls.h"
#include "cvode_family.h"

#define LINKED(name) .name = name,
const stf_cvode_calls stf_cvode_linked = {STF_CVODE_CALLS(LINKED)
#if SUNDIALS_VERSION_MAJOR < 7
                                            LINKED(CVodeSetErrHandlerFn)
#endif
                                              .package = "CVODE"};

#define LOAD(name)                                                                             \
  if (stf_library_function(library, #name, &call->name)) return NULL;

const stf_cvode_calls *stf_cvode_load(stf_run *run, stf_library *library)
{
  stf_cvode_calls *call = stf_pool_array(run->pool, 1, sizeof *call);
  if (!call) return NULL;
  call->package = "CVODES";
  STF_CVODE_CALLS(LOAD)
#if SUNDIALS_VERSION_MAJOR < 7
  LOAD(CVodeSetErrHandlerFn)
#endif
  return call;
}
