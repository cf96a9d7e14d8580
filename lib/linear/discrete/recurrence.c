/* recurrence.c: the recurrence over the samples, and transfer functions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <math.h>
#include <string.h>

static bool any(size_t count, const double *x)
{
  for (size_t i = 0; i < count; i++)
    if (x[i] != 0) return true;
  return false;
}

/* h += W u(t). */
static int add(steif_context *ctx, const steif_discrete *d, const double *W, steif_input_fn u,
               void *user, double t, double *value, double *h)
{
  const int n = d->form.n, m = d->form.m;
  STEIF_CHECK(u(t, value, user) == 0, ctx, STEIF_CALLBACK,
              "the input failed at t = %.9g; make it return 0 there", t);
  for (int j = 0; j < m; j++) {
    STEIF_CHECK(isfinite(value[j]), ctx, STEIF_NOT_FINITE,
                "input %d is %g at t = %.9g; it must be finite", j, value[j], t);
    for (int i = 0; i < n; i++) h[i] += W[i + n * j] * value[j];
  }
  return STEIF_OK;
}

static int step(steif_context *ctx, const steif_discrete *d, steif_input_fn u, void *user,
                double t0, double k, double *value, const double *h, double *next)
{
  const double *const W[] = {d->B0, d->Bm, d->B1};
  const size_t count = (size_t)d->form.n * (size_t)d->form.m;
  stf_product(d->form.n, 1, d->form.n, 1, d->form.A, h, 0, next);
  for (int i = 0; u && i < 3; i++)
    if (any(count, W[i]))
      STEIF_TRY(add(ctx, d, W[i], u, user, t0 + (k + 0.5 * i) * d->dt, value, next));
  return STEIF_OK;
}

int steif_discrete_run(steif_context *ctx, const steif_discrete *d, steif_input_fn u,
                       void *user, double t0, const double *h0, long steps, double *h)
{
  STEIF_CHECK(d && d->memory, ctx, STEIF_BAD_INPUT,
              "the discrete system is empty; make it with steif_c2d");
  STEIF_CHECK(h && steps >= 0 && isfinite(t0), ctx, STEIF_BAD_INPUT,
              "%ld steps from t0 = %g: a number from 0, a finite time and an array are needed",
              steps, t0);
  const size_t n = (size_t)d->form.n;
  if (h0) STEIF_TRY(stf_check_matrix(ctx, "h0", d->form.n, 1, h0));
  double *value = stf_allocate(ctx, (size_t)d->form.m + 1, sizeof *value);
  if (!value) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < n; i++) h[i] = h0 ? h0[i] : 0;
  int code = STEIF_OK;
  for (long k = 0; k < steps && code == STEIF_OK; k++, h += n)
    code = step(ctx, d, u, user, t0, (double)k, value, h, h + n);
  stf_release(ctx, value);
  return code;
}

/* ---- C (s - A)^{-1} B + D ---- */

static int solve(steif_context *ctx, const steif_state_space *s, double re, double im,
                 double *M, double *X, int *pivot)
{
  const int n = s->n, m = s->m;
  int info = 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const int at = i + n * j;
      M[2 * at] = (i == j ? re : 0) - s->A[at];
      M[2 * at + 1] = i == j ? im : 0;
    }
  for (int j = 0; j < n * m; j++) X[2 * j] = s->B[j], X[2 * j + 1] = 0;
  zgesv_(&n, &m, M, &n, pivot, X, &n, &info);
  STEIF_CHECK(info == 0, ctx, STEIF_SINGULAR,
              "%g %+g i is a pole of the system; ask for another point", re, im);
  return STEIF_OK;
}

static void combine(const steif_state_space *s, const double *X, double *H)
{
  const int n = s->n, o = s->p;
  for (int j = 0; j < s->m; j++)
    for (int i = 0; i < o; i++) {
      double re = s->D ? s->D[i + o * j] : 0, im = 0;
      for (int k = 0; k < n; k++) {
        re += s->C[i + o * k] * X[2 * (k + n * j)];
        im += s->C[i + o * k] * X[2 * (k + n * j) + 1];
      }
      H[2 * (i + o * j)] = re, H[2 * (i + o * j) + 1] = im;
    }
}

int steif_response(steif_context *ctx, const steif_state_space *s, double re, double im,
                   double *H)
{
  STEIF_TRY(stf_state_space_check(ctx, s));
  STEIF_CHECK(isfinite(re) && isfinite(im), ctx, STEIF_NOT_FINITE,
              "s = %g %+g i: a finite point is needed", re, im);
  if (!s->m || !s->p) return STEIF_OK;
  const size_t n = (size_t)s->n, m = (size_t)s->m;
  double *M = stf_allocate(ctx, 2 * n * (n + m), sizeof *M);
  int *pivot = stf_allocate(ctx, n, sizeof *pivot);
  int code = STEIF_NO_MEMORY;
  if (M && pivot) code = solve(ctx, s, re, im, M, M + 2 * n * n, pivot);
  if (code == STEIF_OK) combine(s, M + 2 * n * n, H);
  stf_release(ctx, M), stf_release(ctx, pivot);
  return code;
}
