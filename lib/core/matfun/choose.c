/* choose.c: degree and number of squarings from ||A^k||^{1/k} (A. H. Al-Mohy and N. J. Higham,
 * SIAM J. Matrix Anal. Appl. 31, 2009, algorithm 5.1).
 *
 * With d_k = ||A^k||_1^{1/k}, the series of the backward error of the [m/m] approximant is
 * governed by max(d_k, d_{k+1}), which may be far below ||A||. A^2, A^4, A^6 are needed anyway;
 * of higher powers the norm suffices.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include "lapack.h"

enum { DEGREES = 5, EXACT = 32, WORTH = 3 };

/* Bounds of the paper for unit round-off 2^{-53}, and log2 of the coefficient of x^{2m+1} in
 * the backward error, (m!)^2 / ((2m)! (2m+1)!). */
static const int degree[DEGREES] = {3, 5, 7, 9, 13};
static const double theta[DEGREES] = {1.495585217958292e-2, 2.539398330063230e-1,
                                      9.504178996162932e-1, 2.097847961257068, 4.25};
static const double log_coefficient[DEGREES] = {-16.621136113274641, -33.227772656854167,
                                                -51.994974307382167, -72.32471809893495,
                                                -116.447004251763};

double stf_norm1(int n, const double *A)
{
  double most = 0;
  for (int j = 0; j < n; j++, A += n) {
    double sum[4] = {0};
    int i = 0;
    for (; i + 4 <= n; i += 4)
      for (int k = 0; k < 4; k++) sum[k] += fabs(A[i + k]);
    for (; i < n; i++) sum[0] += fabs(A[i]);
    const double total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    if (!(total <= most)) most = total;
  }
  return most;
}

static void scale(size_t count, double c, double *A)
{
  for (size_t i = 0; i < count; i++) A[i] *= c;
}

/* ||F G||_1: by the product in `scratch` for small matrices, else estimated (N. J. Higham, ACM
 * TOMS 14, 1988). */
static double product_norm(stf_core *c, const double *F, const double *G, double *scratch)
{
  const int n = c->n, one = 1;
  const double unit = 1, zero = 0;
  if (n <= EXACT) {
    stf_multiply(n, n, F, G, 0, scratch);
    return stf_norm1(n, scratch);
  }
  double *v = scratch, *x = scratch + n, *y = scratch + 2 * n, estimate = 0;
  int kase = 0, save[3];
  for (;;) {
    dlacn2_(&n, v, x, c->pivot, &estimate, &kase, save);
    if (kase == 0) return estimate;
    const char *trans = kase == 1 ? "N" : "T";
    dgemv_(trans, &n, &n, &unit, kase == 1 ? G : F, &n, x, &one, &zero, y, &one, 1);
    dgemv_(trans, &n, &n, &unit, kase == 1 ? F : G, &n, y, &one, &zero, x, &one, 1);
  }
}

/* y = the row vector x times |A|, divided by its largest entry, which is returned. */
static double times_absolute(const stf_core *c, const double *x, double *y)
{
  enum { LANES = 8 };
  const int n = c->n;
  double most = 0;
  for (int j = 0; j < n; j++) {
    const double *a = c->A + (size_t)j * (size_t)n;
    double sum[LANES] = {0}, total = 0;
    int i = 0;
    for (; i + LANES <= n; i += LANES)
      for (int k = 0; k < LANES; k++) sum[k] += fabs(a[i + k]) * x[i + k];
    for (; i < n; i++) total += fabs(a[i]) * x[i];
    for (int k = 0; k < LANES; k++) total += sum[k];
    y[j] = total;
    if (y[j] > most) most = y[j];
  }
  for (int j = 0; j < n && most > 0; j++) y[j] /= most;
  return most;
}

/* A bound of log2 || |A|^k ||_1, the exact value where the bounds exceed `harmless`:
 * ||B^d||^{k/d} ||B||^{k mod d} for d from 3 on, by products with the row vector of ones. */
static double log_absolute_power(stf_core *c, int k, double harmless)
{
  double *x = c->sums, *y = c->sums + c->n, log_norm = 0;
  for (int i = 0; i < c->n; i++) x[i] = 1;
  for (int done = 1; done <= k; done++) {
    const double most = times_absolute(c, x, y);
    if (most == 0) return -INFINITY;
    log_norm += log2(most);
    double *const t = x;
    x = y, y = t;
    const double bound = log_norm * (k / done) + (k % done) * log2(c->norm);
    if (done > 2 && bound <= harmless) return bound;
  }
  return log_norm;
}

/* Squarings beyond s that the rounding-safe bound of degree m asks for: those that bring
 * |c_{2m+1}| || |A|^{2m+1} || / ||A|| below the unit round-off. */
static int extra(stf_core *c, int which, int s)
{
  const int m = degree[which];
  const double fixed = log_coefficient[which] - log2(c->norm) - 2.0 * m * s + 53;
  if (fixed + (2 * m + 1) * log2(c->norm) <= 0) return 0;
  const double alpha = fixed + log_absolute_power(c, 2 * m + 1, -fixed);
  return alpha > 0 ? (int)ceil(alpha / (2 * m)) : 0;
}

static bool take(stf_core *c, int which, double eta)
{
  if (!(eta <= theta[which]) || extra(c, which, 0)) return false;
  c->m = degree[which];
  return true;
}

static int halvings(double size)
{
  const double s = ceil(log2(size / theta[DEGREES - 1]));
  return s > 0 ? (int)s : 0;
}

/* ||A^8|| and ||A^10|| are bounded by ||A^4|| and ||A^6||; for larger matrices their estimates
 * cost as much as a squaring and are made where several may be saved. */
static void large(stf_core *c)
{
  const int n = c->n;
  const double d4 = pow(stf_norm1(n, c->A4), 0.25), d6 = pow(stf_norm1(n, c->A6), 1.0 / 6);
  const double bound = fmax(d4, d6);
  for (int which = 0; which < DEGREES - 1; which++)
    if (take(c, which, bound)) return;
  double eta = bound;
  if (n <= EXACT || halvings(bound) > WORTH) {
    const double d8 = pow(product_norm(c, c->A4, c->A4, c->U), 0.125);
    const double low = fmax(d6, d8);
    if (take(c, 2, low) || take(c, 3, low)) return;
    eta = fmin(low, fmax(d8, pow(product_norm(c, c->A4, c->A6, c->U), 0.1)));
  }
  c->m = 13;
  int s = halvings(eta);
  s += extra(c, DEGREES - 1, s);
  c->s = s < halvings(c->norm) ? s : halvings(c->norm);
}

/* Powers of A by need, m and s. */
static void search(stf_core *c)
{
  const int n = c->n;
  c->s = 0;
  stf_multiply(n, n, c->A, c->A, 0, c->A2);
  if (take(c, 0, c->norm)) return;
  stf_multiply(n, n, c->A2, c->A2, 0, c->A4);
  if (take(c, 1, c->norm)) return;
  stf_multiply(n, n, c->A2, c->A4, 0, c->A6);
  if (take(c, 2, c->norm) || take(c, 3, c->norm)) return;
  if (c->norm <= theta[DEGREES - 1])
    c->m = 13;
  else
    large(c);
}

/* Powers up to the tenth must not overflow. */
enum { LARGEST = 64 };

static void shrink(stf_core *c, int halvings_)
{
  scale((size_t)c->n * (size_t)c->n, ldexp(1, -halvings_), c->A);
  c->norm = stf_norm1(c->n, c->A);
  c->before += halvings_;
}

void stf_core_choose(stf_core *c)
{
  const size_t count = (size_t)c->n * (size_t)c->n;
  int exponent = 0;
  c->before = 0;
  if (isinf(c->norm)) shrink(c, LARGEST);
  frexp(c->norm, &exponent);
  if (exponent > LARGEST) shrink(c, exponent - LARGEST);
  search(c);
  if (c->s > 0) {
    scale(count, ldexp(1, -c->s), c->A);
    scale(count, ldexp(1, -2 * c->s), c->A2);
    scale(count, ldexp(1, -4 * c->s), c->A4);
    scale(count, ldexp(1, -6 * c->s), c->A6);
  }
  if (c->m == 9) stf_multiply(c->n, c->n, c->A4, c->A4, 0, c->A8);
  c->s += c->before;
}
