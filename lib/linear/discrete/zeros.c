/* zeros.c: finite zeros of a system with one input and one output.
 *
 * Let r be the least k with g = C A^{k-1} B not 0 (r = 0, g = D, if D is not 0). The feedback
 * u = -C A^r x / g keeps y = 0 on the subspace where C, CA, ..., C A^{r-1} vanish, which is
 * invariant; the zeros are the n - r eigenvalues of A - B C A^r / g restricted to it
 * (A. Isidori, Nonlinear Control Systems, 1995, 4.3).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <math.h>
#include <string.h>

static double length(int n, const double *x)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum = hypot(sum, x[i]);
  return sum;
}

static double dot(int n, const double *x, const double *y)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* Columns 0 .. r-1 of R: C, CA, ... scaled to length 1; *next = the next one, unscaled, *g what
 * belongs to it. */
static int degree(steif_context *ctx, const steif_state_space *s, double *R, double *next,
                  double *g, int *r)
{
  const int n = s->n, one = 1;
  const double zero = 0, unit = 1;
  memcpy(next, s->C, (size_t)n * sizeof *next);
  *g = s->D ? s->D[0] : 0;
  for (*r = 0; *g == 0; ++*r) {
    const double size = length(n, next), input = length(n, s->B);
    STEIF_CHECK(*r < n && size > 0 && input > 0, ctx, STEIF_BAD_INPUT,
                "the transfer function is 0: the input does not reach the output");
    double *row = R + (size_t)*r * (size_t)n;
    for (int i = 0; i < n; i++) row[i] = next[i] / size;
    const double reach = dot(n, row, s->B);
    dgemv_("T", &n, &n, &unit, s->A, &n, row, &one, &zero, next, &one, 1);
    if (fabs(reach) > 1e-13 * input) *g = reach;
  }
  return STEIF_OK;
}

/* F = Q2^T (A - B next^T / g) Q2, Q2 = the last n - r columns of Q; M: n x n scratch. */
static void restrict_to(const steif_state_space *s, int r, const double *Q, const double *next,
                        double g, double *M, double *F)
{
  const int n = s->n, k = n - r;
  const double *Q2 = Q + (size_t)n * (size_t)r;
  const double one = 1, zero = 0;
  stf_product(n, k, n, 1, s->A, Q2, 0, M);
  for (int j = 0; j < k; j++) {
    const double y = dot(n, next, Q2 + (size_t)n * (size_t)j) / g;
    for (int i = 0; i < n; i++) M[i + n * j] -= s->B[i] * y;
  }
  dgemm_("T", "N", &k, &k, &n, &one, Q2, &n, M, &n, &zero, F, &k, 1, 1);
}

/* Orthonormal columns, the first r of which span those of R. */
static int complete(steif_context *ctx, int n, int r, double *R, double *work)
{
  int info = 0;
  const int lwork = n;
  double *tau = work + n;
  dgeqrf_(&n, &r, R, &n, tau, work, &lwork, &info);
  if (info == 0) dorgqr_(&n, &n, &r, R, &n, tau, work, &lwork, &info);
  STEIF_CHECK(info == 0, ctx, STEIF_BAD_INPUT, "no basis for the zeros: argument %d is wrong",
              -info);
  return STEIF_OK;
}

static int find(steif_context *ctx, const steif_state_space *s, double *x, int *count,
                double *re, double *im)
{
  const size_t n = (size_t)s->n;
  double *R = x, *M = R + n * n, *F = M + n * n, *next = F + n * n, g;
  int r;
  STEIF_TRY(degree(ctx, s, R, next, &g, &r));
  *count = s->n - r;
  STEIF_TRY(complete(ctx, s->n, r, R, next + n));
  restrict_to(s, r, R, next, g, M, F);
  return *count ? stf_eigenvalues(ctx, *count, F, re, im) : STEIF_OK;
}

int stf_zeros(steif_context *ctx, const steif_state_space *s, int *count, double *re,
              double *im)
{
  const size_t n = (size_t)s->n;
  double *x = stf_allocate(ctx, 3 * n * n + 3 * n, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  const int code = find(ctx, s, x, count, re, im);
  stf_release(ctx, x);
  return code;
}
