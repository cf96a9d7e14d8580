/* compat.h: what differs between SUNDIALS 6.4 and 7.x, and nothing else.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COMPAT_H
#define STF_COMPAT_H

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

/* Rows of a vector on this rank; deprecated in 6.4, but the only way there. */
#define stf_local_length(v)                                                                    \
  ((v)->ops->nvgetlocallength ? (v)->ops->nvgetlocallength(v) : N_VGetLength(v))

#if SUNDIALS_VERSION_MAJOR >= 7
#define STF_NO_COMM SUN_COMM_NULL
#define STF_SILENT_ERRORS(sun) SUNContext_ClearErrHandlers(sun) /* the one there is prints */
#else
#define STF_NO_COMM NULL
#define STF_SILENT_ERRORS(sun) (void)0
#endif

#endif
