/* steif/decay.h: does a linear equation or the linearisation of y' = f(t, y) decay, do the numbers of a
 * method with a constant step, and for which steps?
 *
 * What is said of the equation does not come from the steps of the method. With a period P of A(t), told or found, it is
 * the monodromy matrix over P by gauss:s=6 (a DAE of index 1: radau:s=5), with more and more steps until
 * its largest multiplier does not change: exponent ln |rho| / P. Without, discrete QR along the same
 * method with steps h0, h0/1.618, h0/2.618, ..., whose ratios leave no common phase of sampling, from the same
 * directions, until two exponents agree. The numbers are measured in the same way with the user's method
 * and step: by the map over q periods where h = q P/m with q <= 4096, which is exact but for rounding;
 * with other h by the maps of two fractions near it, whose difference is the error; without a period
 * by QR, with a standard error from batch means (lyapunov.h).
 *
 *   lambda +- lambda_error   leading exponent of the equation,   mu +- mu_error   of the numbers,
 *   rise, rise_numbers       ln of the largest growth |w(t)|/|w(s)|, s < t <= t1, of a leading direction.
 * A step keeps the decay when lambda < 0, mu < 0, |mu - lambda| <= |lambda|/10 and the numbers rise by no
 * factor above e times that of the equation on the way: aliasing makes decaying solutions grow by 1e9 before
 * they decay. A. Steyer and E. Van Vleck, arXiv 1709.02059.
 *
 * h*: with S the steps that decay, mu + 4 mu_error < 0 and rise_numbers <= rise + 1, h* is the end of the
 * first interval (0, h*) in S. S has holes and islands above h*: a larger step that decays does not tell.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_DECAY_H
#define STEIF_DECAY_H

#include <steif/lyapunov.h>

#ifdef __cplusplus
extern "C" {
#endif

enum steif_decay_verdict {
  STEIF_DECAY_UNDECIDED =
    -1,             /* a sign lies within its error bar, or costs too much: see the sentence */
  STEIF_DECAY_LOST, /* growth, another decay, or growth on the way: the step is too long; or
                                 false damping of an equation that grows */
  STEIF_DECAY_KEPT
};

typedef struct steif_decay {
  enum steif_decay_verdict verdict;
  sunrealtype lambda, lambda_error, mu, mu_error;
  sunrealtype rise, rise_numbers;
  int periodic;       /* lambda comes from multipliers */
  sunrealtype period; /* of A(t); 0: none is known or found */
  int turns,
    parts; /* h (1 +- 1e-3) is `turns` periods / `parts`, parts <= 4: every step samples the
                         same phases; 0: no */
  /* Looked for where the verdict is that the step is too long, or `search` was asked for. */
  sunrealtype h_good,
    h_bad;    /* h* lies between: all steps tried up to h_good are in S, h_bad is not;
                                NaN: not found or not looked for; h_bad infinite: none is bad up to 16 times
                                the first good ones */
  long least; /* period: all steps P/m with m from here to `most` decay, by multipliers */
  long most;  /* 0: not tried */
  int
    tail; /* 1: beyond, the error mu - lambda falls like a power of h on two octaves and is below
                    |lambda|/2: measured, not proven */
  char sentence[600];
  int found; /* 1: the period was neither told nor the problem's: A(t) came back after it */
} steif_decay;

/* options: h, t1, transient as for steif_lyapunov. period: 0: that of the problem, or for x' = A(t) x one that
 * is looked for: from h/64 to a third of the run, and every entry of A comes back, to rounding, at 256 times
 * after any number of periods; without one QR. STEIF_BAD_INPUT where A(t + period) is not A(t). search:
 * 1: look for h* in any case. Problems as for steif_lyapunov, n <= 64 (else STEIF_UNSUPPORTED). */
STEIF_EXPORT int steif_decay_find(steif_context *ctx, const steif_problem *problem,
                                  const char *method, const steif_lyapunov_options *options,
                                  sunrealtype period, int search, steif_decay *decay);

#ifdef __cplusplus
}
#endif
#endif
