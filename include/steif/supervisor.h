/* steif/supervisor.h: step sizes that keep a decaying solution decaying.
 *
 * Control by local errors looks one step ahead. On x' = A(t) x with a non-normal A the numbers may
 * grow for ever while every local error is small against |x| and the problem decays: the errors tilt
 * x, and the growth that follows is the problem's own. The supervisor follows a solution w of
 *   w' = J(t, y) w,  J = df/dy along the computed y;  M w' = J w;  F_y w + F_y' w' = 0
 * of which the caller asserts that it decays, |w(t)| <= K exp(-rate (t - s)) |w(s)|, and intervenes by
 * one of two rules where it does not:
 *
 *   windows   of length H. Where mu = (ln |w(T + H)| - ln |w(T)|) / H > -rate, the window is undone and
 *             made again with steps of at most shrink * min(cap, mean step). If that lowers mu by less
 *             than real |mu + rate|, the growth is the problem's and stays; of its shrinks one is kept.
 *   sum       G := max(0, G + ln (|w_n| / |w_{n-1}|) + rate h_n) is at most ln K for the problem. Where
 *             G > swing, steps are capped by shrink times their mean and G := 0. Nothing is undone:
 *             cheap, but numbers may grow between the interventions.
 *
 * E. Steyer and E. Van Vleck, arXiv 1709.02059, pose the problem. Where f (F) is linear and
 * homogeneous w is y itself, its local error is measured against |y| in the Euclidean norm, and atol
 * is not used. Else y and w are integrated side by side, w with the tolerance rtol |w|; .jac (.idajac)
 * is needed then, and the coupling dJ/dy w is left out of Newton's matrix (Rosenbrock and exponential methods, which
 * need it, and auto, which may choose them, give STEIF_UNSUPPORTED).
 *
 *   steif_supervision how = {.rate = 0.035, .window = 12.566};
 *   steif_supervise(ctx, &problem, "bdf:p=2", &options, &how, y, &facts);
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_SUPERVISOR_H
#define STEIF_SUPERVISOR_H

#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The rules above; STEIF_SUPERVISE_NONE: the growth is measured, the steps are left alone. */
enum steif_supervision_rule {
  STEIF_SUPERVISE_WINDOWS,
  STEIF_SUPERVISE_SUM,
  STEIF_SUPERVISE_NONE
};

typedef struct steif_supervised_window {
  sunrealtype t, mu; /* its end, growth of w per time */
  sunrealtype log;   /* ln (|w(t)| / |w(t0)|) at its end */
  sunrealtype h;     /* mean step */
  int redone;        /* how often it was made again */
  int real;          /* 1: the growth does not depend on h */
} steif_supervised_window;

typedef struct steif_supervision {
  enum steif_supervision_rule rule;
  sunrealtype rate;   /* > 0, per time; a quarter of the expected decay is a good choice */
  sunrealtype window; /* > 0: H; whole periods of the coefficients, two or more. A window that
                               the end cuts off is not judged */
  sunrealtype swing;  /* ln K of the sum; 0: 7 */
  sunrealtype shrink; /* 0: 0.7 */
  sunrealtype real;   /* 0: 0.35 */
  int redo; /* how often a window is made again at most, and how many windows in a row may grow
                       whatever the step (then STEIF_NOT_CERTIFIED: the problem does not decay by that
                       rate); 0: 12 */
  /* Called after every window; nonzero stops with STEIF_CALLBACK. */
  int (*tell)(const steif_supervised_window *window, void *user);
  void *user;
} steif_supervision;

typedef struct steif_supervised {
  long windows, triggers; /* made; growing ones (windows), interventions (sum) */
  long redone, real;      /* windows made again in all; of real growth */
  long unresolved;        /* still growing, and faster for longer steps, after the last redo */
  sunrealtype mu;         /* growth of w per time over the second half */
  sunrealtype peak;       /* largest ln (|w| / |w_0|) */
  sunrealtype cap;        /* on the step at the end; infinite: none */
  int direct;             /* 1: w is y */
  sunrealtype
    end; /* t1; less after STEIF_STOPPED (options.stop), when all this is of [t0, end] */
  steif_stats cost; /* all of it, what was undone included */
} steif_supervised;

/* Integrates from t0 to t1 with an adaptive step size; options as for a solver, but not
 * h, mesh, atols, ewt or observe. y: n values at t1 (may be NULL), as facts. The problem is an ode,
 * or of mass or implicit form and index 0 or 1, on serial vectors. w starts as y0, or as ones where
 * that is 0, made consistent. Solver failures are passed on; DIRK methods with an explicit first stage
 * need y', which a DAE does not give after the start: STEIF_UNSUPPORTED. */
STEIF_EXPORT int steif_supervise(steif_context *ctx, const steif_problem *problem,
                                 const char *method, const steif_options *options,
                                 const steif_supervision *how, sunrealtype *y,
                                 steif_supervised *facts);

#ifdef __cplusplus
}
#endif
#endif
