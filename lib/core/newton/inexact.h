/* inexact.h: how far GMRES solves the systems of Newton's iteration.
 *
 * Sweep m of an inexact Newton iteration leaves eta_m of its residual (R. S. Dembo, S. C. Eisenstat & T. Steihaug,
 * SIAM J. Numer. Anal. 19, 1982): less than the nonlinear part leaves is wasted, and so is less than what the
 * iteration may leave at its end. The residual is P^{-1} r, of the size of the correction, in units of the
 * error test; a solve ends where it has become FORCING of what it was, or the part FLOOR of Newton's
 * tolerance, whichever is larger. The last sweep ends at the latter, so that the order does not suffer. What
 * GMRES leaves counts in the rate of convergence that is measured.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INEXACT_H
#define STF_INEXACT_H

#include "newton.h"

/* Before solves that are no corrections of anything: to all digits that Newton's tolerance asks for. */
void stf_inexact_whole(stf_newton *newton);

/* Callbacks from here to the next solve may fail on some ranks only: that solve tells all. It has to follow. */
void stf_inexact_defer(stf_newton *newton, bool on);

/* Before the solves of sweep m = 1, 2, ...; m = 0: of those that follow the iteration, error estimates. */
void stf_inexact_sweep(stf_newton *newton, int m);

#endif
