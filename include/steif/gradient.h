/* steif/gradient.h: gradients of functionals of a solution by all parameters and start values, in one run backwards.
 *
 *     J_i(p) = G_i(y(T), p) + int_{t0}^T g_i(t, y, p) dt
 *
 *     steif_functional J = {.count = 1, .integrand = g};
 *     steif_gradient a = {0};
 *     if (!steif_gradient_find(ctx, &problem, "radau:s=3", &options, &J, &a)) use(a.value, a.dp, a.dy0);
 *     steif_gradient_free(ctx, &a);
 *
 * Differentiated is the run, not the equation: J is the number that the steps of the run give, integrals by the
 * quadrature of the method (BDF: by BDF; STEIF_NOT_CERTIFIED where that is off what dense output gives), and with mesh and orders held its derivative is exact up to rounding and
 * what Newton's iteration left. With stages Y_j, their matrix K (sensitivity.h), E = F_y', and weights w_j
 * and b_j of the end and of the quadrature, a step is gone through backwards by
 *
 *     K^T w = w_j lambda + h b_j g_y^T,   lambda <- lambda + sum_j (h b_j g_y^T - F_y^T w_j),
 *     mu <- mu + sum_j (h b_j g_p - F_p^T w_j),
 *
 * from lambda = G_y^T at T; then dJ/dp = mu + (dy0/dp)^T lambda and dJ/dy0 = lambda. E, F_y are made anew
 * at the stages, one factorisation (DIRK: one per stage) serves all functionals and parameters. Of sparse matrices in
 * adaptive runs one real factorisation serves steps of similar length: K^T w is solved by GMRES to rtol/1000, from the w of the
 * step before; elsewhere to rounding.
 *
 * Krylov storage: (s E - A)^T of each shift is solved by GMRES, complex shifts with the conjugate transpose, and the
 * equations of the step by sweeps with their residuals, to the same rtol/1000 or rounding, so that gradients are as near
 * to forward derivatives as those of factors. Products E^T x and A^T x are problem.Etv and .Atv, else those of the
 * matrices that Krylov storage keeps. Preconditioners: precsolve_transposed, else none; of matrices the transposed ILU(0).
 * precsetup is called at every step on the way back, at its middle stage. Without Atv (and Etv where E is not I), problems
 * that fill matrices, or differences of which a band or pattern tells, go back with the factors of these: jac, idajac, or E and A,
 * with nnz where storage is Krylov.
 *
 * lambda at t0 is the derivative by free start values; with algebraic equations only derivatives along
 * consistent starts mean something (parameters.start), others say what the step makes of inconsistent ones: Radau and
 * BDF do not read algebraic components, and of index 3 a velocity off the constraint is projected.
 *
 * Memory. The forward run keeps its stages while they fit into `memory`; else it logs 24 bytes a step and keeps images of
 * the solver, in memory or in files, every few steps (16, 32, ...). With sqrt(steps) of them each step is made again once.
 * Where fewer fit, segments are repeated from images placed by the binomial schedule of A. Griewank and A. Walther (ACM
 * TOMS 26, 2000). Repeated steps come to the same bits, which a hash of each step is asked for
 * (STEIF_UNSUPPORTED names the step otherwise): results do not depend on the limit.
 *
 * Events and breaks. With the names of sensitivity.h, sigma = -lambda . (R_y f- + R_t - f+) / (g_y f- + g_t), plus what an
 * integrand jumps by in place of lambda . (...), an event is gone through by
 *
 *     lambda <- R_y^T lambda + sigma g_y^T,   mu <- mu + R_p^T lambda + sigma g_p^T;
 *
 * its slopes are found on the way forward, as there, with one direction for each unknown. In a step that it cuts y is that of
 * dense output, and integrals are those along it. A terminal event (or STEIF_FINISH) ends J at its own time, which
 * moves: J(tau(p), p) is differentiated, G by t too. Problems that remember something (begin) need save and restore.
 *
 * Wrong derivatives. dFdp and the matrices of F are compared with differences at the start and at the end, as by
 * sensitivity.h, slopes of functionals and dFdp_transposed too: STEIF_BAD_INPUT with what is wrong, values and the error of
 * the difference.
 *
 * Derivatives along a direction, J v: direction.h; those of the gradient, H v: hessian.h.
 *
 * "auto" takes what it would choose where that is served, else radau:s=5. Served: collocation (gauss, radau, radau1a,
 * lobatto3c), BDF with start=ramp, DIRK; dense, band and sparse matrices, serial vectors, any index that the method
 * integrates. STEIF_UNSUPPORTED: other methods, Krylov storage with neither transposed products nor matrices, events
 * that graze, two at once whose times differ for other y or p, reactions without derivatives, constraints,
 * options.reinitialise, options.sensitivities, starts that had to be repaired, constant steps of BDF that do not end at T.
 *
 * Sources: W. W. Hager, Numer. Math. 87 (2000) 247-282; A. Sandu, Lect. Notes Comput. Sci. 3994 (2006); Y. Cao,
 * S. Li, L. Petzold and R. Serban, SIAM J. Sci. Comput. 24 (2003) 1076-1089.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_GRADIENT_H
#define STEIF_GRADIENT_H

#include <steif/parameters.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_functional {
  int count;              /* of functionals, 1 at least */
  steif_values integrand; /* g, all of them; NULL: none */
  steif_values end;       /* G, all of them; NULL: none */
  /* Of functional i: dy = dg/dy and dp[k] = dg/dp_k, or of G at the end; both come as zeros, dp is NULL without
   * parameters. NULL: central differences, 2 (n + P) evaluations at each stage. */
  int (*slopes)(sunrealtype t, N_Vector y, int i, int at_end, N_Vector dy, sunrealtype *dp,
                void *user);
  void *user; /* of these callbacks; NULL: that of the problem */
} steif_functional;

typedef struct steif_gradient_cost {
  long steps, recomputed_steps; /* of the run; made again */
  long factors;                 /* made backwards, beside those of the run */
  long solves, transposed_solves;
  size_t bytes; /* most that stages, images and the log took at a time */
} steif_gradient_cost;

typedef struct steif_gradient {
  /* Asked for; 0 takes the default. */
  size_t memory; /* limit in bytes; 1 GiB */
  int
    checkpoints; /* images kept at a time, at least 3, beside the stages of one step, or with sqrt(steps) of them or
                    more, of the steps between two; as many as fit */
  const char *
    folder; /* images go into files of this folder, and memory limits stages only; NULL: none do */
  /* Found; blocks belong to the gradient. */
  int count, parameters; /* J's, P */
  sunindextype n;
  sunrealtype *value; /* J_i */
  sunrealtype *dp;    /* dJ_i/dp_k at i P + k; NULL without parameters */
  sunrealtype *dy0;   /* dJ_i/dy0_j at i n + j: lambda at t0 */
  sunrealtype *
    error_estimate; /* of J_i: sum of lambda . (error estimate) over adaptive steps, else 0. What
                                  quadratures add is not in it. */
  steif_gradient_cost cost;
  void *reserved[8]; /* 0 */
} steif_gradient;

/* A run of the problem from t0 to options.t1 and back. options NULL: defaults; options.active: of which parameters starts
 * are differentiated, dp of others being NaN, as where starts are consistent for some only. Codes of the run;
 * STEIF_BAD_INPUT: no functional, a limit of memory below what one step and 3 images need (the sentence says how much);
 * STEIF_NOT_FINITE: names functional or parameter, and time; STEIF_NO_CONVERGENCE: the
 * equations of a step backwards, GMRES with the transposed preconditioner among them. Where y stands still for a third of the
 * interval, so that its error test says nothing of derivatives, the run is made again with steps a quarter as long, until two
 * gradients agree to 100 rtol; STEIF_NOT_CERTIFIED: seven times were not enough. After failures nothing is there to be freed. */
STEIF_EXPORT int steif_gradient_find(steif_context *ctx, const steif_problem *problem,
                                     const char *method, const steif_options *options,
                                     const steif_functional *functional,
                                     steif_gradient *gradient);
STEIF_EXPORT void steif_gradient_free(steif_context *ctx, steif_gradient *gradient);

#ifdef __cplusplus
}
#endif
#endif
