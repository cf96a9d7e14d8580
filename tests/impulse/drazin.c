/* drazin.c: an oracle: x(0+) and impulses of a sparse system of known index k from one real factorisation.
 * M = sigma (sigma E + F)^{-1} E has the eigenvalue 0 on the fast part and sigma / (sigma +
 * lambda) elsewhere. The slow part of w is the u = p(M) M^k w that minimises ||M^k (w - u)|| over a
 * Krylov space (A. Sidi, DGMRES, Linear Algebra Appl. 335, 2001, 189-204); a fast particular
 * solution is x_f = sum_j (-M/sigma)^j (D - sigma)^j (sigma E + F)^{-1} f with D = d/dt; then
 *   x(0+) = x(0-) - d,  d the fast part of x(0-) - x_f,
 *   c_q = (-1)^q h^{q+1} sum_{i=q+1}^{k-1} C(i-1, q) M^i d,  h = 1/sigma,
 * binomial moments of backward Euler, which are exact for every step h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "drazin.h"
#include "circle.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Krylov spaces up to MOST, and no more than PATIENCE dimensions without half the residual: there
 * rounding in the fast part grows. NEAR its smallest value is near enough. */
enum { MOST = 40, PATIENCE = 3, INDEX = 64, WIDE = MOST + INDEX + 1 };
#define NEAR 3.0

/* A slow part left over that needs no other sigma; how often sigma is halved. */
#define ENOUGH 1e-13
enum { SMALLER = 6 };

/* Vectors are in scaled coordinates, x = column x^. */
typedef struct drazin {
  stf_scaled scaled;
  const stf_sources *sources;
  steif_impulse *impulse;
  sunrealtype sigma, residual;
  int index, refinements, steps;
  N_Vector b, x, r, w, basis[WIDE];
  sunrealtype H[WIDE][WIDE];             /* H[m][i]: M v_m = sum_i H[m][i] v_i */
  sunrealtype A[MOST][WIDE];             /* columns of the least squares */
  sunrealtype y[MOST][MOST], left[MOST]; /* solutions and residuals by dimension */
} drazin;

/* x <- (sigma E + F)^{-1} b; b and x differ. */
static void solve(drazin *z, N_Vector b, N_Vector x)
{
  const size_t bytes = (size_t)z->scaled.n * sizeof(sunrealtype);
  memcpy(NV_DATA_S(x), NV_DATA_S(b), bytes);
  stf_scaled_direct(&z->scaled, 0, NV_DATA_S(x));
  for (int sweep = 0; sweep < z->refinements; sweep++) {
    memcpy(NV_DATA_S(z->r), NV_DATA_S(b), bytes);
    if (!stf_scaled_refine(&z->scaled, 0, sweep == 0, NV_DATA_S(x), NV_DATA_S(z->r))) break;
  }
}

/* y <- M x. */
static int apply(drazin *z, N_Vector x, N_Vector y)
{
  STEIF_TRY(steif_pencil_product(z->scaled.pencil, 'E', x, z->b));
  for (sunindextype i = 0; i < z->scaled.n; i++) NV_Ith_S(z->b, i) *= z->sigma;
  solve(z, z->b, y);
  return STEIF_OK;
}

static sunrealtype dot(const drazin *z, N_Vector x, N_Vector y)
{
  const sunrealtype *restrict a = NV_DATA_S(x), *restrict b = NV_DATA_S(y);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < z->scaled.n; i++) sum += a[i] * b[i];
  return sum;
}

static void axpy(const drazin *z, sunrealtype a, N_Vector x, N_Vector y)
{
  const sunrealtype *restrict from = NV_DATA_S(x);
  sunrealtype *restrict to = NV_DATA_S(y);
  for (sunindextype i = 0; i < z->scaled.n; i++) to[i] += a * from[i];
}

/* Vectors of the Krylov space are claimed as they come. */
static int room(drazin *z, int m)
{
  if (!z->basis[m]) z->basis[m] = stf_pool_vector(z->scaled.pool, z->scaled.like);
  return z->basis[m] ? STEIF_OK : STEIF_NO_MEMORY;
}

/* b <- (D - sigma)^j f by the binomial theorem, in scaled rows. */
static void derive(const drazin *z, int j, sunrealtype *b)
{
  const sunindextype n = z->scaled.n;
  sunrealtype weight = pow(-z->sigma, j);
  for (sunindextype i = 0; i < n; i++) b[i] = 0;
  for (int l = 0; l <= j; l++) {
    const sunrealtype *f = z->sources->f + l * n;
    for (sunindextype i = 0; i < n; i++) b[i] += weight * z->scaled.row[i] * f[i];
    weight *= -(sunrealtype)(j - l) / ((l + 1) * z->sigma);
  }
}

/* w <- x(0-) - x_f, by Horner's rule in -M/sigma = -(sigma E + F)^{-1} E. */
static int difference(drazin *z, const sunrealtype *x0)
{
  sunrealtype *w = NV_DATA_S(z->w), *b = NV_DATA_S(z->b);
  const int terms = z->sources->f ? z->index : 0;
  for (int j = terms - 1; j >= 0; j--) {
    STEIF_TRY(steif_pencil_product(z->scaled.pencil, 'E', z->w, z->x));
    derive(z, j, b);
    axpy(z, -1, z->x, z->b);
    solve(z, z->b, z->w);
  }
  for (sunindextype i = 0; i < z->scaled.n; i++) w[i] = x0[i] / z->scaled.column[i] - w[i];
  return STEIF_OK;
}

/* One more vector by the Arnoldi process, orthogonalised twice; false in *more at an invariant
 * space. */
static int extend(drazin *z, int m, bool *more)
{
  STEIF_TRY(room(z, m + 1));
  STEIF_TRY(apply(z, z->basis[m], z->basis[m + 1]));
  const sunrealtype before = sqrt(dot(z, z->basis[m + 1], z->basis[m + 1]));
  for (int sweep = 0; sweep < 2; sweep++)
    for (int i = 0; i <= m; i++) {
      const sunrealtype h = dot(z, z->basis[i], z->basis[m + 1]);
      z->H[m][i] += h;
      axpy(z, -h, z->basis[i], z->basis[m + 1]);
    }
  const sunrealtype after = sqrt(dot(z, z->basis[m + 1], z->basis[m + 1]));
  *more = after > 4 * STF_EPS * before;
  z->H[m][m + 1] = *more ? after : 0;
  for (sunindextype i = 0; i < z->scaled.n; i++)
    NV_Ith_S(z->basis[m + 1], i) *= *more ? 1 / after : 0;
  return STEIF_OK;
}

/* min ||beta e_1 - A y|| by Householder's reflections, A rows x m by columns, spoilt; y, and the
 * norm of the residual. */
static sunrealtype least_squares(int rows, int m, sunrealtype A[][WIDE], sunrealtype beta,
                                 sunrealtype *y)
{
  sunrealtype rhs[WIDE] = {beta}, left = 0;
  for (int j = 0; j < m; j++) {
    sunrealtype sum = 0;
    for (int i = j; i < rows; i++) sum += A[j][i] * A[j][i];
    const sunrealtype alpha = A[j][j] > 0 ? -sqrt(sum) : sqrt(sum),
                      size = sum - alpha * A[j][j];
    if (!(size > 0)) continue;
    A[j][j] -= alpha;
    for (int k = j + 1; k <= m; k++) {
      sunrealtype *column = k < m ? A[k] : rhs, product = 0;
      for (int i = j; i < rows; i++) product += A[j][i] * column[i];
      for (int i = j; i < rows; i++) column[i] -= product / size * A[j][i];
    }
    A[j][j] = alpha;
  }
  for (int i = m; i < rows; i++) left += rhs[i] * rhs[i];
  for (int j = m - 1; j >= 0; j--) {
    y[j] = rhs[j];
    for (int k = j + 1; k < m; k++) y[j] -= A[k][j] * y[k];
    y[j] = A[j][j] != 0 ? y[j] / A[j][j] : 0;
  }
  return sqrt(left);
}

/* min ||M^k w - M^k V_m y||, where M^k V_m is V_{m+k} times k Hessenberg matrices. */
static void project(drazin *z, int m, sunrealtype beta)
{
  for (int j = 0; j < m; j++) {
    for (int i = 0; i < WIDE; i++) z->A[j][i] = i == j;
    for (int power = 0; power < z->index; power++) {
      sunrealtype next[WIDE] = {0};
      for (int c = 0; c < m + power; c++)
        for (int i = 0; i <= c + 1; i++) next[i] += z->H[c][i] * z->A[j][c];
      memcpy(z->A[j], next, sizeof next);
    }
  }
  z->left[m - 1] = least_squares(m + z->index, m, z->A, beta, z->y[m - 1]);
}

/* Dimensions 1, 2, ... until the residual is at rounding level or falls no more; the best one. */
static int sweep(drazin *z, sunrealtype beta, int *best)
{
  bool more = true;
  int known = 0;
  *best = 1;
  for (int m = 1; m <= MOST && more; m++) {
    for (; known < m + z->index && more; known++) STEIF_TRY(extend(z, known, &more));
    project(z, m, beta);
    if (z->left[m - 1] < z->left[*best - 1] / 2) *best = m;
    if (z->left[m - 1] <= STF_EPS * beta || m - *best >= PATIENCE) break;
  }
  return STEIF_OK;
}

/* w <- the fast part of w: w - u. */
static int purify(drazin *z)
{
  const size_t bytes = (size_t)z->scaled.n * sizeof(sunrealtype);
  STEIF_TRY(room(z, 0));
  memcpy(NV_DATA_S(z->x), NV_DATA_S(z->w), bytes);
  for (int power = 0; power < z->index; power++) {
    STEIF_TRY(apply(z, z->x, z->basis[0]));
    memcpy(NV_DATA_S(z->x), NV_DATA_S(z->basis[0]), bytes);
  }
  const sunrealtype beta = sqrt(dot(z, z->x, z->x)), size = sqrt(dot(z, z->w, z->w));
  z->residual = beta;
  if (!(beta > STF_EPS * size)) return STEIF_OK;
  memset(NV_DATA_S(z->basis[0]), 0, bytes);
  axpy(z, 1 / beta, z->x, z->basis[0]);
  int best, m = 0;
  STEIF_TRY(sweep(z, beta, &best));
  while (z->left[m] > NEAR * z->left[best - 1]) m++;
  for (int j = 0; j <= m; j++) axpy(z, -z->y[m][j], z->basis[j], z->w);
  z->residual = z->left[m];
  z->steps = m + 1;
  return STEIF_OK;
}

/* x(0+) and the moments of d = w. */
static int evaluate(drazin *z, const sunrealtype *x0)
{
  steif_impulse *out = z->impulse;
  const sunindextype n = z->scaled.n;
  const sunrealtype *w = NV_DATA_S(z->w), *column = z->scaled.column;
  sunrealtype size = 0;
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype x = x0[i] / column[i] - w[i];
    out->x_plus[i] = x * column[i];
    size += x * x;
  }
  out->estimate = size > 0 ? z->residual / sqrt(size) : 0;
  for (int i = 1; i < z->index; i++) {
    STEIF_TRY(apply(z, z->w, z->x));
    memcpy(NV_DATA_S(z->w), NV_DATA_S(z->x), (size_t)n * sizeof *w);
    sunrealtype binomial = 1; /* C(i-1, q) */
    for (int q = 0; q < i; q++) {
      const sunrealtype weight = binomial * (q % 2 ? -1 : 1) * pow(z->sigma, -q - 1);
      for (sunindextype j = 0; j < n; j++) out->c[q * n + j] += weight * column[j] * w[j];
      binomial *= (sunrealtype)(i - 1 - q) / (q + 1);
    }
  }
  return STEIF_OK;
}

static int analyse(drazin *z, const sunrealtype *x0)
{
  stf_scaled *s = &z->scaled;
  N_Vector *const work[] = {&z->b, &z->x, &z->r, &z->w};
  for (size_t k = 0; k < sizeof work / sizeof *work; k++)
    if (!(*work[k] = stf_pool_vector(s->pool, s->like))) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_scaled_set(s, z->sigma));
  STEIF_TRY(steif_pencil_factor(s->pencil, 1, &(steif_shift){z->sigma, 0}));
  STEIF_TRY(difference(z, x0));
  STEIF_TRY(purify(z));
  STEIF_TRY(evaluate(z, x0));
  snprintf(
    z->impulse->message, sizeof z->impulse->message,
    "not certified: one factorisation at sigma = %.3g and %d Krylov vectors leave a slow "
    "part of %.1e; compare with STEIF_CONTOUR",
    z->sigma, z->steps, z->impulse->estimate);
  return STEIF_OK;
}

/* One factorisation at sigma; *impulse is new. */
static int attempt(steif_context *ctx, SUNMatrix E, SUNMatrix F, int refinements, int index,
                   sunrealtype sigma, const sunrealtype *x0, const stf_sources *sources,
                   steif_impulse *impulse)
{
  STEIF_TRY(stf_impulse_allocate(ctx, sources->n, index, impulse));
  impulse->method = "drazin";
  drazin *z = stf_allocate(ctx, 1, sizeof *z);
  if (!z) return STEIF_NO_MEMORY;
  *z = (drazin){.sources = sources, .impulse = impulse, .index = index};
  z->refinements = refinements, z->sigma = sigma;
  int code = stf_scaled_open(ctx, E, F, &z->scaled);
  if (!code) code = analyse(z, x0);
  stf_scaled_close(&z->scaled);
  stf_release(ctx, z);
  return code;
}

/* Rounding that spares no zeros makes an error of size eps (sigma nu)^(2k-1), nu the size of the fast
 * part, and the slow part that is left over shows it: a smaller sigma is tried where it is large. */
static int lower(steif_context *ctx, SUNMatrix E, SUNMatrix F, int refinements, int index,
                 sunrealtype sigma, const sunrealtype *x0, const stf_sources *sources,
                 steif_impulse *impulse)
{
  for (int k = 0; k < SMALLER && impulse->estimate > ENOUGH; k++) {
    steif_impulse next = {0};
    sigma /= 2;
    const int code = attempt(ctx, E, F, refinements, index, sigma, x0, sources, &next);
    const bool better = !code && next.estimate < impulse->estimate;
    steif_impulse_clear(ctx, better ? impulse : &next);
    if (better) *impulse = next;
    if (code == STEIF_SINGULAR) steif_forget(ctx);
    if (!better) return code == STEIF_SINGULAR ? STEIF_OK : code;
  }
  return STEIF_OK;
}

int drazin_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F, const steif_analysis *analysis,
                   const sunrealtype *x0, const stf_sources *sources,
                   steif_structure *structure, steif_impulse *impulse)
{
  const steif_analysis a = stf_analysis_filled(analysis);
  const int index = structure->index < 0 ? structure->index_least : structure->index;
  STEIF_CHECK(index <= INDEX, ctx, STEIF_UNSUPPORTED,
              "index %d: Drazin inverses are formed up to index %d", index, (int)INDEX);
  STEIF_CHECK(!sources->f || index <= sources->derivatives + 1, ctx, STEIF_BAD_INPUT,
              "index %d asks for derivatives of the forcing up to order %d, %d is known: give "
              "them in the forcing function",
              index, index - 1, sources->derivatives);
  const sunrealtype sigma = stf_radius(E, F, analysis, structure);
  STEIF_TRY(attempt(ctx, E, F, a.refinements, index, sigma, x0, sources, impulse));
  if (a.radius > 0) return STEIF_OK;
  return lower(ctx, E, F, a.refinements, index, sigma, x0, sources, impulse);
}
