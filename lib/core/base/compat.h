/* compat.h: what differs between SUNDIALS 6.4 and 7.x, and nothing else.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COMPAT_H
#define STF_COMPAT_H

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

#if SUNDIALS_VERSION_MAJOR >= 7
#define STF_NO_COMM SUN_COMM_NULL
#define STF_SILENT_ERRORS(sun) SUNContext_ClearErrHandlers(sun) /* the one there is prints */
#else
#define STF_NO_COMM NULL
#define STF_SILENT_ERRORS(sun) (void)0
#endif

#endif
