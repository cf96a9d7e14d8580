/* taylor.c: e^B u by truncated Taylor series (A. H. Al-Mohy and N. J. Higham, SIAM J. Sci.
 * Comput. 33, 2011): s steps of degree m with the smallest m s for which the backward error is
 * below the unit round-off, ended early where the terms have died out.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include <limits.h>

/* theta_m: the largest norm whose backward error in log(e^{-x} T_m(x)) is 2^{-53}; recomputed
 * from the series with 60 digits, in agreement with table 3.1 of the paper. */
static const double theta[] = {
  0,         2.22045e-16, 2.58096e-8, 1.38635e-5, 0.000339717, 0.00240088, 0.00906566,
  0.0238446, 0.0499123,   0.0895776,  0.144183,   0.214236,    0.299616,   0.399778,
  0.513915,  0.641084,    0.780287,   0.930533,   1.09086,     1.26038,    1.43825,
  1.62372,   1.81608,     2.01471,    2.21905,    2.42858,     2.64285,    2.86145,
  3.084,     3.31017,     3.53967,    3.77221,    4.00756,     4.2455,     4.48582,
  4.72835,   4.97292,     5.21938,    5.46759,    5.71744,     5.9688,     6.22158,
  6.47568,   6.73102,     6.9875,     7.24507,    7.50365,     7.76317,    8.02359,
  8.28485,   8.5469,      8.80969,    9.07319,    9.33734,     9.60212,    9.8675};
enum { MOST = sizeof theta / sizeof *theta - 1, ROOTS = 8 };

typedef struct plan {
  int m;
  double s; /* a whole number */
} plan;

static void offer(plan *best, int m, double alpha)
{
  const double s = fmax(1, ceil(alpha / theta[m]));
  if (best->m == 0 || m * s < best->m * best->s) *best = (plan){m, s};
}

/* For small norms the estimates of powers would cost more than they save (their condition
 * (3.13) with one column). */
static plan choose(steif_action *a, bool shift)
{
  const double t = fabs(a->t), norm = t * (shift ? a->facts.shifted : a->facts.norm);
  const double least = a->aux ? 1 : 0; /* the shift matrix J */
  plan best = {0, 0};
  if (norm <= 63) {
    for (int m = 1; m <= MOST; m++) offer(&best, m, fmax(norm, least));
    return best;
  }
  for (int p = 2; p <= ROOTS; p++) {
    const double alpha = t * fmax(stf_facts_root(a, shift, p), stf_facts_root(a, shift, p + 1));
    for (int m = p * (p - 1) - 1; m <= MOST; m++) offer(&best, m, fmax(alpha, least));
  }
  return best;
}

/* basis[0] becomes e^{(B - mu)/s} of itself; basis[1] and [2] are lost. *error is the size of
 * what was left out. */
static int step(steif_action *a, plan how, double tolerance, double *error)
{
  stf_state *sum = a->basis, *term = a->basis + 1, *next = a->basis + 2;
  double before = stf_state_norm(a, sum), now = before;
  stf_copy(&a->space, sum->v, term->v);
  for (int j = 0; j < a->aux; j++) term->z[j] = sum->z[j];
  for (int k = 1; k <= how.m; k++) {
    STEIF_TRY(stf_state_product(a, term, next));
    stf_state_scale(a, 1 / (how.s * k), next);
    stf_state_add(a, 1, next, sum);
    const stf_state t = *term;
    *term = *next, *next = t;
    before = now, now = stf_state_norm(a, term);
    if (before + now <= tolerance * stf_state_norm(a, sum)) break;
  }
  *error = before + now;
  return STEIF_OK;
}

static int steps(steif_action *a, plan how, double tolerance)
{
  const double factor = exp(a->mu / how.s);
  double error = 0, last = stf_state_norm(a, a->basis), left_out;
  for (double done = 0; done < how.s; done++) {
    STEIF_TRY(step(a, how, tolerance, &left_out));
    stf_state_scale(a, factor, a->basis);
    const double now = stf_state_norm(a, a->basis);
    error = error * fmax(1, last > 0 ? now / last : 1) + factor * left_out + 2 * STF_EPS * now;
    last = now;
    a->report.steps++;
    a->report.error = error;
    if (!isfinite(now) || a->report.products > a->o.products) a->report.error = INFINITY;
    if (!isfinite(a->report.error)) return STEIF_OK;
  }
  return STEIF_OK;
}

int stf_action_taylor(steif_action *a, N_Vector w)
{
  STEIF_CHECK(a->A && a->space.n <= INT_MAX, a->ctx, STEIF_UNSUPPORTED,
              "the Taylor method needs a sparse matrix: give A, or take another method");
  a->dimension = 1;
  a->aux = a->p;
  STEIF_TRY(stf_state_grow(a, 3));
  const bool shift = a->p == 0 && a->facts.shifted < a->facts.norm;
  const plan how = choose(a, shift);
  a->mu = shift ? a->t * a->facts.mu : 0;
  double tolerance = 0.05 * stf_action_allowed(a, a->scale) / (a->scale * how.s);
  for (int pass = 0; pass < 2; pass++) {
    stf_state_start(a, a->basis);
    STEIF_TRY(steps(a, how, fmax(STF_EPS / 2, tolerance)));
    a->report.norm = stf_vector_norm(&a->space, a->basis->v);
    const double allowed = stf_action_allowed(a, a->report.norm);
    if (!isfinite(a->report.error) || a->report.error <= allowed) break;
    tolerance *= 0.3 * allowed / a->report.error;
  }
  stf_copy(&a->space, a->basis->v, w);
  return STEIF_OK;
}
