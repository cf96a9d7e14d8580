/* steif/lyapunov.h: Lyapunov exponents of numerical solutions, and whether steps are short
 * enough.
 *
 * A Runge-Kutta, multistep or general linear method of constant step size turns W' = J(t, y(t)) W
 * along its own solution of y' = f(t, y) into a linear recurrence. Discrete QR after every
 * step,
 *   W_n = Q_n R_n,  W <- W R_n^{-1},  exponent_i = mean of ln (R_n)_ii / h,
 * gives the exponents of that recurrence: those of the problem as h -> 0, and the verdict on
 * the step itself where the problem decays and the numbers grow (Steyer and Van Vleck, arXiv
 * 1709.02059; Dieci and Van Vleck, SIAM J. Numer. Anal. 40, 2002). W_n is the combination
 * ell X_n of the history X_n that the parasitic modes leave alone, ell V = ell (glm.h).
 *
 *   steif_lyapunov_options o = {.h = 0.01, .t1 = 500, .transient = 20};
 *   sunrealtype exponent[3];
 *   steif_lyapunov(ctx, &lorenz, "rk4", &o, exponent, NULL, NULL);
 *
 * The problem is an ode with .f and .jac on serial vectors, or a DAE in the mass form, as a
 * descriptor system E y' = A y + g with matrices, or as F(t, y, y') = 0 with .idajac and a constant
 * dF/dy'. A DAE has as many exponents as degrees of freedom: at index 1 the rank of dF/dy', at index 2 and 3 the start values that can be prescribed
 * (steif_diagnose; a wrong number of them is STEIF_BAD_INPUT). Steps carry directions into the tangent
 * space of all constraints, hidden ones too, after `index` steps, with which averages begin; the method
 * has to forget algebraic errors: M(inf) = 0. The part of a linear DAE that it drives to 0 is nilpotent,
 * so the exponents are ln |R(h s)| / h exactly, s a finite eigenvalue. Forms of lower index have more
 * exponents: the modes of their drift, which are not those of the problem. Tables
 * (gauss:s=2, dirk:alexander2, rk4, ...), be, bdf:p=2 .. 6 and glm:TABLE have such a recurrence;
 * others give STEIF_UNSUPPORTED.
 *
 * Band and sparse Jacobians are used as they are: a step with k exponents takes O(k n + nonzeros)
 * numbers and the factors of its stages, so a few leading exponents (options.count, 1000 at most) of
 * 1e5 unknowns are in reach. Dense Jacobians and DAEs end at n = 1000. The directions begin at random
 * and are the same ones in every run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_LYAPUNOV_H
#define STEIF_LYAPUNOV_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Exponents i and i + 1 are integrally separated where the mean of ln R_ii - ln R_jj, j = i + 1, over every
 * window of some length is above a positive number (arXiv 1709.02059, definition 2.2). Then an error of
 * O(h^p) in the steps changes them by O(h^p), else by more. Windows of 1/64, 1/32, .. 1/4 of the run are
 * looked at: here is the first that separates them, else the longest. That no window does proves nothing:
 * a gap below what the shortest of them blurs is not seen. NaN: too few steps. */
typedef struct steif_separation {
  sunrealtype window, low, high; /* length; smallest and largest mean over one of that length */
  sunrealtype spread; /* standard deviation of the smallest ones in 16 parts of the run */
  int separated;      /* 1: low - 2 spread > 0 */
} steif_separation;

typedef struct steif_lyapunov_options {
  sunrealtype h;         /* the constant step, used as it is: the run ends at t0 + N h, the last
                            whole step that is not after t1 */
  sunrealtype t1;        /* end; 0: the problem's */
  sunrealtype transient; /* time before the averages begin */
  sunrealtype
    window;       /* length of the windows of the intervals; 0: a tenth of what is averaged */
  int count;      /* exponents wanted, the largest first; 0: all, which needs room for n */
  int linear;     /* 1: J does not depend on y, and no trajectory is run; -1: it does;
                            0: as J at three random y tells */
  int weak_start; /* 1: the history of a BDF by rk4 without its last stage, weights
                            (1, 2, 2, 0)/6 (steif_growth_measure): an error of order h at the start */
  sunrealtype *error; /* room for count standard errors of the exponents, from the means over 16
                            parts of the run: the exponent of the recurrence lies within 1 of them
                            in 2/3 of all runs, within 2.131 in 19/20 (Student's t), or more often;
                            NaN below 32 steps. NULL: not wanted */
  steif_separation
    *separation; /* room for count - 1 (count 0: n - 1) pairs; NULL: not wanted */
  /* steif_growth_measure, after every step: |x_n|, and how far it is from the exact flow of the step. */
  int (*tell)(sunrealtype t, sunrealtype norm, sunrealtype lte, void *user);
  void *user; /* of both callbacks; nonzero from one ends the run with STEIF_CALLBACK */
  const volatile int
    *stop; /* nonzero: STEIF_STOPPED after the step at hand, with the averages (or
                            the growth) of the steps made; without any where facts.steps is 0 */
  /* steif_lyapunov, some 1000 times in a run: the averages of the exponents from the transient to t. */
  int (*average)(sunrealtype t, int count, const sunrealtype *mean, void *user);
} steif_lyapunov_options;

typedef struct steif_lyapunov_facts {
  int count;           /* exponents found */
  long steps;          /* averaged */
  int linear;          /* was J taken as free of y? */
  sunrealtype h, time; /* step, time averaged over */
  sunrealtype end;     /* of the last step: t1, or less where h does not divide the run */
  sunrealtype sum; /* of the exponents; with all n it equals, to the order of the method, ... */
  sunrealtype
    trace; /* ... the mean of trace J, here at the stages of the method: as blind as these;
                        NaN for a DAE. steif_lyapunov_verify has its own */
  sunrealtype rise; /* largest ln(|w(t)| / |w(s)|), s < t, of the first direction w */
  sunrealtype mu;   /* largest running average of the first exponent in the second half */
  sunrealtype flow; /* ln(|y'| in the last step / in the first) / time: y' of an autonomous
                        problem solves W' = J W. NaN for others, and where J is free of y */
  sunrealtype
    dimension; /* Kaplan and Yorke's j + (sum of the j largest) / |the next|, j the last
                            with a sum >= 0; n where all sums are; NaN: more exponents decide it */
} steif_lyapunov_facts;

/* exponent: count values in the order of QR, which descends as the run grows. interval (may be
 * NULL): count pairs, the smallest and largest average over a window, estimates of the
 * Sacker-Sell spectrum. Every step costs the same. With a long h the parasitic roots of a BDF
 * may lead before the exponents of small solutions. STEIF_NOT_FINITE: blow-up, or a direction
 * is lost. */
STEIF_EXPORT int steif_lyapunov(steif_context *ctx, const steif_problem *problem,
                                const char *method, const steif_lyapunov_options *options,
                                sunrealtype *exponent, sunrealtype *interval,
                                steif_lyapunov_facts *facts);

/* What holds for exact exponents, and whether it does for those found. */
enum steif_lyapunov_law {
  STEIF_SUM_LAW, /* the sum of all n is the mean of trace J: needs an ode and count = n. The trace does
                      not come from the steps of the method: adaptive quadrature of tr A(t), or along
                      a run of its own with rtol 1e-8 */
  STEIF_FLOW_LAW, /* one is 0 along a solution of an autonomous problem that does not come to rest,
                       |y'| staying above 1e-6 of what it was; the nearest to 0 is taken */
  STEIF_RECURRENCE_LAW /* x' = A(t) x of a given period P = m h': each is ln |multiplier| / P of m
                            steps of the method itself: this checks the exponents of the recurrence
                            and says nothing of the step. Multipliers below 1e-9 of the largest are
                            lost in rounding */
};
typedef struct steif_lyapunov_check {
  enum steif_lyapunov_law law;
  const char *name; /* "sum", "flow", "recurrence" */
  int which;        /* exponent, from 1; 0: all of them */
  /* tolerance: accuracy max |exponent| for the sum; else four standard errors, and for the flow
     |facts.flow| besides, since a run is finite: 1e-9 (min(1, 1/h) + |expected|) at least. */
  sunrealtype value, expected, tolerance;
  int holds;
} steif_lyapunov_check;

/* The laws that apply. exponent, facts: of a run with these options, `error` among them. accuracy: 0:
 * 0.01. period: 0: none is known; STEIF_BAD_INPUT where no whole number of steps makes it. check: room
 * for n + 2. */
STEIF_EXPORT int steif_lyapunov_verify(steif_context *ctx, const steif_problem *problem,
                                       const char *method,
                                       const steif_lyapunov_options *options,
                                       sunrealtype accuracy, sunrealtype period,
                                       const sunrealtype *exponent,
                                       const steif_lyapunov_facts *facts,
                                       steif_lyapunov_check *check, int *count);

/* One solution x_n of the recurrence, from y0, of a linear problem x' = A(t) x (a forcing is
 * left out): how it grows and how far every step is from the exact flow. History of a BDF: from
 * rk4; of other methods: fitted to exact values in the first step. N steps, w_n = ell X_n, t_n
 * the oldest time in X_n. */
typedef struct steif_growth_facts {
  long steps;
  /* Growth of w per time; n from m = N/2 on. */
  sunrealtype mu;         /* max of ln(|w_n| / |x_0|) / (t_n - t_0) */
  sunrealtype mu_last;    /* the last of them */
  sunrealtype mu_window;  /* ln(|w_n| / |w_m|) / (t_n - t_m) for the last n */
  sunrealtype mu_running; /* the largest of them over n > m */
  sunrealtype mu_partial; /* max of ln(|w_n| / |w_{m-1}|) / (t_n - t_0), the formula (37) as
                             printed: a part of the growth over all of the time, near 0 */
  sunrealtype lte_mean,
    lte_max; /* |x_{n+1} - X(t_{n+1}, t_n) x_n|, X the exact flow (Gauss, order
                                    12, with substeps) */
  sunrealtype residual_mean,
    residual_max;                    /* of the BDF formula on the exact solution; else NaN */
  sunrealtype local_mean, local_max; /* the same on the exact solution through x_n */
  sunrealtype tau_max; /* largest ratio of consecutive lte; the first 50 are left out when there
                            are 100 */
  sunrealtype tau_all; /* none left out */
  sunrealtype norm_max, norm_end; /* of x_n */
} steif_growth_facts;

/* options: h, t1, linear. STEIF_UNSUPPORTED when J depends on y. */
STEIF_EXPORT int steif_growth_measure(steif_context *ctx, const steif_problem *problem,
                                      const char *method, const steif_lyapunov_options *options,
                                      steif_growth_facts *facts);

/* The one-step map of a linear problem that the recurrence converges to: after burn_in steps of
 * any n columns, W_n = ell X_n and Z_n, the solution itself at t_n, have maps
 *   Phi_w = W_{n+1} W_n^{-1},   Phi_f = Z_{n+1} Z_n^{-1}
 * that depend on the columns no more. Phi_f is off the exact X(t_{n+1}, t_n) by O(h^{p+1});
 * Phi_w by O(h^2) as a rule, whatever p is, since W_n = Z_n + O(h) (the change of coordinates
 * is bounded, so the exponents are the same). */
typedef struct steif_underlying {
  long burn_in;                       /* in; 0: twice as many as take the parasitic modes
                                          of h = 0 below 1e-15, 64 at least; out */
  sunrealtype *Phi_w, *Phi_f, *exact; /* room for n x n each, by rows */
} steif_underlying;

/* start: k blocks n x n by rows at t0; NULL: u_j I. */
STEIF_EXPORT int steif_underlying_find(steif_context *ctx, const steif_problem *problem,
                                       const char *method, sunrealtype h,
                                       const sunrealtype *start, steif_underlying *out);

#ifdef __cplusplus
}
#endif
#endif
