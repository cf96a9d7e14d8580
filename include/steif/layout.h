/* steif/layout.h: where the members of the open structs lie, for callers from other languages.
 *
 * A module that calls the library without a C compiler fills steif_problem and steif_options, and reads
 * results, by these offsets, and so fits whatever version it finds.
 *
 *   steif_layout("problem")           sizeof (steif_problem)
 *   steif_layout("problem.y0")        offsetof (steif_problem, y0)
 *   steif_layout("options.rtol"), steif_layout("stats.steps"), ...
 *   steif_layout("sunindextype")      its size: 8, or 4 where SUNDIALS is built so
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_LAYOUT_H
#define STEIF_LAYOUT_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes; -1: no struct or member of that name is known here. */
STEIF_EXPORT long steif_layout(const char *member);

#ifdef __cplusplus
}
#endif
#endif
