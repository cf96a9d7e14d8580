/* steif/sensitivity.h: forward sensitivities S = dy/dp, beside the solution.
 *
 *   double k[] = {0.04, 1e4, 3e7};
 *   steif_parameters par = {.count = 3, .value = k, .dFdp = dFdk};
 *   problem.parameters = &par;
 *   steif_options opt = steif_defaults();
 *   opt.rtol = 1e-8, opt.sensitivities = 1;
 *   steif_solver *s = steif_solver_new(ctx, &problem, "radau:s=3", &opt);
 *   if (s && steif_solve_to(s, 40) == STEIF_OK) steif_sensitivity(s, 40, 0, dy);
 *
 * Differentiated is the step, not the equation. A step solves F(t_j, Y_j, Y_j'; p) = 0 at its stages,
 * Y_j = base_j + Z_j, Y_j' = offset_j + (1/h) sum_m B_jm Z_m, and with h, order and coefficients held,
 *   F_y dY_j + F_y' dY_j' = -dF/dp_k
 * at the converged stages is a linear system for column k of S. Of few unknowns it is factored; else iterated with the
 * factors of Newton's iteration as preconditioner, all columns together, from the polynomial of the last step, to 0.003
 * of the tolerance of S, or 0.3 with the one real matrix that collocation takes for sparse storage (1e-4 where the index
 * is above 1; prescribed steps: as Newton's iteration). S is thus the derivative
 * of the numbers that the run returns, on its mesh: central differences of runs on one mesh (options.mesh)
 * agree with it to their own errors, and its order is that of y.
 *
 * Column k has the unit of y over that of p_k; scale_k S, scale_k = parameters.scale or |p_k| (1 where that is
 * 0), has that of y. Errors of S are tested in every adaptive step, by the estimate of the method, differentiated,
 * against rtol |S_ik| + atol_i / scale_k; a step passes when y and each column do. Those of one step may be up to 30
 * times as large as those of y, whose sum is to stay below the tolerance (index 0 and 1; never above a tolerance).
 *
 * Served: collocation (gauss, radau, radau1a, lobatto3c, any number of stages), DIRK, BDF, general linear methods and
 * explicit Runge-Kutta methods, starting procedures too, splittings (verlet), with dense, band and sparse matrices, of the
 * indices that these methods serve; `auto` takes collocation and BDF. Rosenbrock methods hold J = dF/dy in their steps and
 * are served where jac and dFdp are given: the derivative of J is a difference of both along the stages, to about 1e-11.
 * Krylov storage: products with E and A at the stages are those of Ev and Av, else of matrices, else differences of F
 * along S on both sides, to about 1e-10.
 * STEIF_UNSUPPORTED: exponential methods, Rosenbrock methods for M(t, y) y' = f; constraints; options.ewt.
 *
 * Starts. dy0/dp is parameters.start, and has to fulfil the derivatives of the constraints. Adaptive runs of nonlinear
 * DAEs of index 1 begin with the nearest S that does, E S held (a start that is consistent for one p alone jumps for
 * others); else algebraic equations are checked, and hidden constraints of at most STEIF_DIAGNOSE_LARGEST unknowns, by
 * differences of the consistent start next to it (STEIF_UNSUPPORTED with the equation or unknown that is off). Where the
 * start was repaired S begins with such differences, to about 1e-9.
 * Components of index 2 and 3 have S of the orders of their y.
 *
 * Differences. Where dF/dy or dF/dp are made by differences, S has their relative error too, about 1e-10: tolerances of one step near
 * that are not kept, and BDF at rtol below 1e-6 may then make far too many steps: give dFdp and jac.
 *
 * Wrong derivatives. Entries of dFdp are compared with differences of F by p, products of jac (idajac, E and A, Av and Ev)
 * with a vector with differences of F along it: at the start, in the second half of the run, and at points near these. One that is
 * off by ten times their errors, of truncation and of rounding, and by 1e-3 of itself is STEIF_BAD_INPUT with
 * parameter or unknown, equation and both values. What cannot be evaluated there, or is not smooth, is not judged.
 *
 * Events and breaks. At an event g(tau, y, p) = 0 with y+ = R(tau, y-, p) after it,
 *   dtau/dp = -(g_y S- + g_p) / (g_y f- + g_t),   S+ = R_y S- + R_p + (R_y f- + R_t - f+) dtau/dp,
 * f- and f+ being the slopes of y on both sides, f- that of dense output. Derivatives of g are differences of two
 * lengths, extrapolated, to about 1e-12; those of R come from parameters.reset or are such differences of
 * handle_event (and options.reinitialise), which must then be the same each time: problems with `begin` need
 * `save` and `restore`. Algebraic unknowns of index 1 follow after events and breaks, in y and in S. Where
 * unknowns with a derivative jump to new equations there, S is the derivative of the jump, by differences of order 4.
 * At the time of an event S is that after it where the run restarts, else that before it. Breaks move with p where parameters.break_slope says so. STEIF_UNSUPPORTED: events that graze (|g_y f- + g_t| below 1e-6 of
 * |g_y| |f-|), two of them, or one and a break where y' jumps, at once whose times have different derivatives, functions without
 * derivatives.
 * Infinitely many events in a finite time end the run, as without S.
 *
 * Checkpoints, copies and restarts of such runs: STEIF_UNSUPPORTED.
 *
 * Sources: U. Maly and L. R. Petzold, Appl. Numer. Math. 20 (1996) 57-79; L. Petzold, S. Li, Y. Cao and R. Serban,
 * Comput. Chem. Engrg. 30 (2006) 1553-1559; E. Hairer and G. Wanner, Solving ODEs II, IV.8.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_SENSITIVITY_H
#define STEIF_SENSITIVITY_H

#include <steif/parameters.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* dy = dy(t)/dp_k, k from 0, at t inside the last step, by the dense output of the method differentiated; before the
 * first step at t0. STEIF_BAD_INPUT: k is not carried, or t lies elsewhere. */
STEIF_EXPORT int steif_sensitivity(steif_solver *s, sunrealtype t, int k, N_Vector dy);

/* The same with unknowns of index 2 and 3 computed from the others, as steif_output does for y, where it does so
 * (solver.h): derivatives of that by differences, four times its cost a column or more. So they have the order of
 * components of index 1, instead of that of stages: the multiplier of a pendulum by radau:s=3 order 5 instead of 2, down
 * to the error of the differences, about 1e-7 of its size. The program shows these. */
STEIF_EXPORT int steif_sensitivity_output(steif_solver *s, sunrealtype t, int k, N_Vector dy);

/* The time tau(p) of the last event: *dt = dtau/dp_k, and dy = d y(tau(p); p)/dp_k with y before the event, dy/dp_k +
 * y' dtau/dp_k; either may be NULL. In on_event, observe and until the next step. STEIF_BAD_INPUT: there was no event;
 * STEIF_UNSUPPORTED: its function grazes, or has no derivative. */
STEIF_EXPORT int steif_sensitivity_event(steif_solver *s, int k, sunrealtype *dt, N_Vector dy);

/* What S has cost so far, beside the statistics of the run, which count its solves and factors. */
typedef struct steif_sensitivity_cost {
  int columns;
  int tested;     /* 1: their errors are tested */
  long sweeps;    /* of the iteration, each over all columns */
  long jacobians; /* at stages */
  sunrealtype
    noise; /* rounding of differences by p in a step, where there is no dFdp, the largest in tolerances of S:
                        above 1 the tolerance was raised to it */
} steif_sensitivity_cost;
STEIF_EXPORT int steif_sensitivity_costs(const steif_solver *s, steif_sensitivity_cost *cost);

#ifdef __cplusplus
}
#endif
#endif
