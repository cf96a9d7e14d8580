/* ida_calls.c: the functions of IDA, linked or loaded.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ida_calls.h"
#include "ida_family.h"

#define LINKED(name) .name = name,
const stf_ida_calls stf_ida_linked = {STF_IDA_CALLS(LINKED)
#if SUNDIALS_VERSION_MAJOR < 7
                                        LINKED(IDASetErrHandlerFn)
#endif
                                          .package = "IDA"};

#define LOAD(name)                                                                             \
  if (stf_library_function(library, #name, &call->name)) return NULL;

const stf_ida_calls *stf_ida_load(stf_run *run, stf_library *library)
{
  stf_ida_calls *call = stf_pool_array(run->pool, 1, sizeof *call);
  if (!call) return NULL;
  call->package = "IDAS";
  STF_IDA_CALLS(LOAD)
#if SUNDIALS_VERSION_MAJOR < 7
  LOAD(IDASetErrHandlerFn)
#endif
  return call;
}
