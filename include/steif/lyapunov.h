/* steif/lyapunov.h: Lyapunov exponents of numerical solutions, and whether steps are short enough.
 *
 * A Runge-Kutta method or a BDF with equal steps turns W' = J(t, y(t)) W along its own solution
 * of y' = f(t, y) into a linear recurrence. Discrete QR after every step,
 *   W_n = Q_n R_n,  W <- W R_n^{-1},  exponent_i = mean of ln (R_n)_ii / h,
 * gives the exponents of that recurrence: those of the problem as h -> 0, and the verdict on the
 * step itself where the problem decays and the numbers grow (Steyer and Van Vleck, arXiv
 * 1709.02059; Dieci and Van Vleck, SIAM J. Numer. Anal. 40, 2002). For a BDF, W_n is the
 * combination ell X_n of the history X_n that its parasitic roots leave alone, ell V = ell.
 *
 *   steif_lyapunov_options o = {.h = 0.01, .t1 = 500, .transient = 20};
 *   sunrealtype exponent[3];
 *   steif_lyapunov(ctx, &lorenz, "rk4", &o, exponent, NULL, NULL);
 *
 * The problem is an ode with .f and .jac on serial vectors. Tables (gauss:s=2, dirk:alexander2,
 * rk4, ...) and be, bdf:p=2 .. 6 have such a recurrence here; others give STEIF_UNSUPPORTED.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_LYAPUNOV_H
#define STEIF_LYAPUNOV_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_lyapunov_options {
  sunrealtype h;         /* the step; lowered so that a whole number fills [t0, t1] */
  sunrealtype t1;        /* end; 0: the problem's */
  sunrealtype transient; /* time before the averages begin */
  sunrealtype window;    /* length of the windows of the intervals; 0: a tenth of what is averaged */
  int count;             /* exponents wanted, the largest first; 0: all n */
  int linear;            /* 1: J does not depend on y, and no trajectory is run; -1: it does;
                            0: as J at three random y tells */
} steif_lyapunov_options;

typedef struct steif_lyapunov_facts {
  long steps;            /* averaged */
  int linear;            /* was J taken as free of y? */
  sunrealtype h, time;   /* step in use, time averaged over */
  sunrealtype sum;       /* of the exponents; with all n it equals, to the order of the method, ... */
  sunrealtype trace;     /* ... the mean of trace J */
  sunrealtype mu;        /* largest running average of the first exponent in the second half */
} steif_lyapunov_facts;

/* exponent: count values in the order of QR, which descends as the run grows. interval (may be
 * NULL): count pairs, the smallest and largest average over a window, estimates of the Sacker-Sell
 * spectrum. Every step costs the same. With a long h the parasitic roots of a BDF may lead before
 * the exponents of small solutions. STEIF_NOT_FINITE: blow-up, or a direction is lost. */
STEIF_EXPORT int steif_lyapunov(steif_context *ctx, const steif_problem *problem,
                                const char *method, const steif_lyapunov_options *options,
                                sunrealtype *exponent, sunrealtype *interval,
                                steif_lyapunov_facts *facts);

/* One solution x_n of the recurrence, from y0, of a linear problem x' = A(t) x (a forcing is left
 * out): how it grows and how far every step is from the exact flow. History of a BDF: from rk4.
 * N steps, w_n = ell X_n, t_n the oldest time in X_n. */
typedef struct steif_growth_facts {
  long steps;
  sunrealtype mu;        /* max over n >= N/2 of ln(|w_n| / |x_0|) / (t_n - t_0) */
  sunrealtype mu_last;   /* the last of them */
  sunrealtype mu_window; /* growth of w per time over the second half */
  sunrealtype lte_mean, lte_max; /* |x_{n+1} - X(t_{n+1}, t_n) x_n|, X the exact flow (Gauss, order
                                    12, with substeps) */
  sunrealtype residual_mean, residual_max; /* of the BDF formula on the exact solution; else NaN */
  sunrealtype tau_max;   /* largest ratio of consecutive lte; the first 50 are left out when there
                            are 100 */
  sunrealtype norm_max, norm_end; /* of x_n */
} steif_growth_facts;

/* options: h, t1, linear. STEIF_UNSUPPORTED when J depends on y. */
STEIF_EXPORT int steif_growth_measure(steif_context *ctx, const steif_problem *problem,
                                      const char *method,
                                      const steif_lyapunov_options *options,
                                      steif_growth_facts *facts);

#ifdef __cplusplus
}
#endif
#endif
