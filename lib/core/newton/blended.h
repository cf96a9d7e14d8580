/* blended.h: the blended iteration: one real shift for the stages of any collocation method.
 *
 * With P = (sigma E - A)^{-1}, sigma = 1/(gamma h) of the step that was factored, and the residuals
 * R_j = F at the stages, two equivalent forms of the stage equations, h (A x I) R = 0 and R = 0, are
 * blended so that each takes the part of the spectrum where its own matrix is close to that of the
 * factors:
 *   dZ = P (R + sigma E P (sigma h A - I) R).
 * On y' = lambda y an eigenvalue mu of A is damped by q (mu - gamma)^2 / (mu (1 - gamma q)^2),
 * q = h lambda: 0 at q = 0 and at infinity. The choice gamma = 1/|lambda*|, lambda* the eigenvalue of
 * A^{-1} of largest argument phi, makes the largest of it in the left half plane least, 1 - cos phi
 * (L. Brugnano and C. Magherini, Blended implementation of block implicit methods for ODEs, Appl.
 * Numer. Math. 42, 2002). Factors of another step converge for ratios up to about 2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_BLEND_H
#define STF_BLEND_H

#include "newton.h"

/* dZ from the residuals, in newton->dZ. */
int stf_blend_correction(stf_newton *newton);

#endif
