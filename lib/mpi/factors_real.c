/* factors_real.c: MUMPS in real arithmetic.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <dmumps_c.h>
#define MUMPS dmumps_c
#define STRUCTURE DMUMPS_STRUC_C
#define NUMBER double
#define RESULT factors_real
#include "factors_any.h"
