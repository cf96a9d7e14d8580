/* factors_complex.c: MUMPS in complex arithmetic.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <zmumps_c.h>
#define MUMPS zmumps_c
#define STRUCTURE ZMUMPS_STRUC_C
#define NUMBER mumps_double_complex
#define RESULT factors_complex
#include "factors_any.h"
