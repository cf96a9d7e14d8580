/* sundials_build.h: was the SUNDIALS that is linked compiled with optimisation?
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SUNDIALS_BUILD_H
#define SUNDIALS_BUILD_H

#include <steif/base.h>

/* Time of its N_VLinearSum of 1000 numbers over that of a plain loop compiled like steif: 1 for a library
 * compiled with optimisation, above SUNDIALS_SLOW without. NaN when memory is short, or steif
 * itself is compiled without optimisation. */
#define SUNDIALS_SLOW 2.5
double sundials_ratio(steif_context *ctx);
/* "SUNDIALS 6.4.1 compiled without optimisation: its vector sums take 8 times as long as a plain loop". */
double sundials_describe(steif_context *ctx, char *text, size_t room);
/* The same in two parts, for the title and the axis of a picture; "" where it is not measured. */
void sundials_caption(steif_context *ctx, char title[64], char axis[96]);

#endif
