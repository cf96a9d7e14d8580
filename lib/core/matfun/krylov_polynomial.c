/* krylov_polynomial.c: e^B u by Krylov spaces of B with sub-steps (R. B. Sidje, Expokit, ACM TOMS 24,
 * 1998).
 *
 * With B V_m = V_m H + h v_{m+1} e_m^T, the exponential of tau [H 0 0; h e_m^T 0 0; 0 1 0]
 * holds beside e^{tau H} e_1 the coefficient of v_{m+1}, a correction, and that of B v_{m+1},
 * its error.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include "lapack.h"
#include <string.h>

/* A dense exponential after so many products. */
enum { EVERY = 5 };

typedef struct krylov {
  int m;         /* dimension */
  bool exact;    /* the space is invariant */
  double beta;   /* ||u|| */
  double beyond; /* ||B v_{m+1}|| */
  double error;  /* of a trial */
  int order;     /* in tau, of that error */
} krylov;

static double clamp(double x, double low, double high)
{
  return x > high ? high : x > low ? x : low;
}

static double norm_of_H(const steif_action *a, int m)
{
  const size_t ld = (size_t)stf_order(a->dimension);
  double most = 0;
  for (int j = 0; j < m; j++) {
    double sum = 0;
    for (int i = 0; i <= j + 1; i++) sum += fabs(a->H[(size_t)i + ld * (size_t)j]);
    most = fmax(most, sum);
  }
  return most;
}

/* a->column = coefficients of e^{tau B} u, k->error. */
static void attempt(steif_action *a, krylov *k, double tau)
{
  const int m = k->m, order = k->exact ? m : m + 2;
  const size_t ld = (size_t)stf_order(a->dimension), n = (size_t)order;
  memset(a->M, 0, n * n * sizeof *a->M);
  for (int j = 0; j < m; j++)
    for (int i = 0; i <= j + 1 && i < order; i++)
      a->M[(size_t)i + n * (size_t)j] = tau * a->H[(size_t)i + ld * (size_t)j];
  if (!k->exact) a->M[(size_t)m + 1 + n * (size_t)m] = tau;
  k->order = m > 1 ? m : 1;
  k->error = INFINITY;
  if (!stf_action_expm(a, order)) return;
  for (int i = 0; i < order; i++) a->column[i] = k->beta * a->X[i];
  k->error = 0;
  if (k->exact) return;
  const double e1 = fabs(a->column[m]), e2 = fabs(a->column[m + 1]) * k->beyond;
  k->error = e1 > 10 * e2 ? e2 : e1 > e2 ? e1 * e2 / (e1 - e2) : e1;
  if (e1 <= e2 && m > 2) k->order = m - 1;
}

/* The basis from its first state, which is divided by its norm, until it serves for tau. Behind
 * the last vector stands its product, of which the norm is needed and the next step begins. */
static int build(steif_action *a, krylov *k, double tau, double allowed)
{
  const int ld = stf_order(a->dimension);
  stf_state_scale(a, 1 / k->beta, a->basis);
  STEIF_TRY(stf_state_grow(a, 2));
  STEIF_TRY(stf_state_product(a, a->basis, a->basis + 1));
  for (k->m = 0, k->exact = false; k->m < a->dimension;) {
    double *h = a->H + (size_t)k->m * (size_t)ld;
    stf_state_orthogonalise(a, ++k->m, h);
    k->exact = h[k->m] == 0;
    if (k->m > a->report.dimension) a->report.dimension = k->m;
    if (k->exact) return STEIF_OK;
    STEIF_TRY(stf_state_grow(a, k->m + 2));
    STEIF_TRY(stf_state_product(a, a->basis + k->m, a->basis + k->m + 1));
    k->beyond = stf_state_norm(a, a->basis + k->m + 1);
    if (k->m % EVERY == 0) attempt(a, k, tau);
    if (k->m % EVERY == 0 && k->error <= allowed * tau) return STEIF_OK;
  }
  return STEIF_OK;
}

/* Shorten tau until the error per unit of time is allowed. */
static double step(steif_action *a, krylov *k, double tau, double allowed)
{
  for (;;) {
    attempt(a, k, tau);
    if (k->error <= allowed * tau || tau < 1e-13) return tau;
    tau *= clamp(0.85 * pow(allowed * tau / k->error, 1.0 / k->order), 0.1, 0.9);
  }
}

/* The state at time `done` becomes basis[0]; the polynomials in z are known exactly. */
static void advance(steif_action *a, const krylov *k, double done)
{
  stf_state *next = a->basis + k->m + 1;
  stf_state_combine(a, k->exact ? k->m : k->m + 1, a->column, next);
  double power = 1 / a->eta;
  for (int j = a->aux - 1, i = 1; j >= 0; j--, i++) {
    next->z[j] = power;
    power *= done / i;
  }
  const stf_state t = *a->basis;
  *a->basis = *next, *next = t;
}

/* One pass over [0, 1] with an absolute error of `allowed`; errors grow with the solution. */
static int sweep(steif_action *a, double allowed, double *error)
{
  krylov k;
  double done = 0, tau = 0;
  *error = 0;
  stf_state_start(a, a->basis);
  while (done < 1) {
    k.beta = stf_state_norm(a, a->basis);
    if (k.beta == 0) return STEIF_OK;
    const double left = 1 - done, aim = tau == 0 || tau > left ? left : tau;
    STEIF_TRY(build(a, &k, aim, allowed));
    if (tau == 0 && k.m == a->dimension) tau = k.m / (3 * norm_of_H(a, k.m) + 1e-300);
    tau = step(a, &k, tau > 0 && tau < left ? tau : left, allowed);
    done = tau >= 1 - done ? 1 : done + tau;
    a->report.steps++;
    advance(a, &k, done);
    *error *= fmax(1, stf_state_norm(a, a->basis) / k.beta);
    *error += k.error + 2 * STF_EPS * k.beta;
    if (!isfinite(*error) || (done < 1 && a->report.products > a->o.products)) {
      *error = INFINITY;
      return STEIF_OK;
    }
    tau *= clamp(0.9 * pow(allowed * tau / k.error, 1.0 / k.order), 0.3, 3);
  }
  return STEIF_OK;
}

/* The tolerance is one of ||w||, which is known after the first pass. */
int stf_action_polynomial(steif_action *a, N_Vector w)
{
  double allowed = 0.5 * stf_action_allowed(a, a->scale);
  a->dimension = a->o.dimension ? a->o.dimension : STF_POLYNOMIAL;
  a->aux = a->p, a->mu = 0;
  STEIF_TRY(stf_state_grow(a, 3));
  for (int pass = 0; pass < 2; pass++) {
    STEIF_TRY(sweep(a, allowed, &a->report.error));
    a->report.norm = stf_vector_norm(&a->space, a->basis->v);
    if (!(a->report.error > stf_action_allowed(a, a->report.norm))) break;
    if (!isfinite(a->report.error)) break;
    allowed = 0.25 * stf_action_allowed(a, a->report.norm);
  }
  stf_copy(&a->space, a->basis->v, w);
  return STEIF_OK;
}
