/* drazin.h: x(0+) and impulses by one real factorisation and a Krylov space, to compare with the
 * algorithms of the library.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DRAZIN_H
#define DRAZIN_H

#include "linear_system.h"

/* E and F: CSC; structure: with the index and a radius beyond the finite eigenvalues. The answer is
 * never certified. */
int drazin_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                   const sunrealtype *x0, const stf_sources *sources,
                   steif_structure *structure, steif_impulse *impulse);

#endif
