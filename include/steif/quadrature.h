/* steif/quadrature.h: integrals beside the solution, q' = g(t, y; p), q(t0) = 0.
 *
 *   static int energy(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
 *   {
 *     value[0] = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
 *     return 0;
 *   }
 *   steif_quadrature quadrature = {.count = 1, .value = energy};
 *   problem.quadrature = &quadrature;
 *   ... steif_solve_to(s, 10); steif_quadrature_values(s, 10, q);
 *
 * They are never part of Newton's iteration. A step of a Runge-Kutta method adds h sum b_i g(t_n + c_i h, Y_i), the
 * integral of its own order; every other step, a part of a step, up to an event or inside of it, and other methods
 * integrate g along dense output by Gauss' formula, whose order is one above that of dense output at most.
 * Events and breaks do not change q; g may jump there, and nowhere else: g of a break is asked for just before and just after it.
 *
 * Where velocities or charges jump to fulfil new equations, multipliers have impulses, and an integral of one of them is
 * STEIF_UNSUPPORTED.
 *
 * With sensitivities (sensitivity.h) dq/dp_k is integrated the same way, from g_y S + dg/dp_k; at an event of time
 * tau(p) it gains (g- - g+) dtau/dp, g- and g+ being the values on both sides.
 *
 * Errors of q do not decide on steps; options.test_quadratures adds a test, of collocation and DIRK: the difference
 * between the integral of a step and that of the polynomial through g at the start and all stages but the last stays below
 * rtol |q| + atol.
 *
 * Checkpoints, copies and restarts of such runs: STEIF_UNSUPPORTED. Serial vectors and those with a host
 * array; over ranks the callback returns the same values on all of them, or the run ends with STEIF_BAD_INPUT.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_QUADRATURE_H
#define STEIF_QUADRATURE_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

struct steif_quadrature {
  int count;
  steif_values value;      /* g(t, y), all of them */
  const char *const *name; /* NULL: q1, q2, ... */
  /* out = g_y dy + dg/dp_k; NULL: a difference along (dy, p_k), to about 1e-10. */
  int (*slope)(sunrealtype t, N_Vector y, N_Vector dy, int k, sunrealtype *out, void *user);
  void *user; /* of these; NULL: that of the problem */
};

/* q(t), `count` numbers, at t inside the last step, or where the solution is shown. STEIF_BAD_INPUT elsewhere, or where
 * the problem has no quadrature. */
STEIF_EXPORT int steif_quadrature_values(steif_solver *s, sunrealtype t, sunrealtype *q);
/* dq(t)/dp_k, k from 0, likewise, of a run with sensitivities. */
STEIF_EXPORT int steif_quadrature_sensitivity(steif_solver *s, sunrealtype t, int k,
                                              sunrealtype *dq);

#ifdef __cplusplus
}
#endif
#endif
