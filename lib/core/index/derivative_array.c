/* derivative_array.c: test D: the derivative array F_0 = ... = F_K = 0 in the Taylor coefficients z_0
 * .. z_{K+1} of y, its Jacobian dF_k/dz_j = [F_y]_{k-j} + (j/tau) [F_y']_{k-j+1}.
 *
 * With M the columns of z_1 .. z_{K+1} and N those of z_0: y' is determined by K
 * differentiations when every null vector of M vanishes in z_1, and Z^T N with Z the left
 * null space of M holds all constraints on y. S. L. Campbell and C. W. Gear, Numer. Math.
 * 72 (1995) 173-196; P. Kunkel and V. Mehrmann, Differential-Algebraic Equations, EMS
 * (2006).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "index_thresholds.h"
#include "singular_values.h"
#include <math.h>
#include <string.h>

typedef struct array_work {
  stf_point *point;
  size_t n;
  sunrealtype tau;
  const sunrealtype *E, *B;
  sunrealtype *left;                 /* n: scales of equations */
  sunrealtype *D, *M, *U, *VT, *s;   /* for the deepest array */
  sunrealtype *part, *U2, *VT2, *s2; /* Z^T N and its decomposition */
  size_t hidden, kernel;             /* rank of Z^T N, columns of Z */
} array_work;

int stf_derivative_array_open(stf_point *point, stf_derivative_array *a)
{
  const size_t n = point->n;
  *a = (stf_derivative_array){.index = -1, .freedom = -1};
  if (!(a->determined = stf_pool_array(point->pool, 3 * n, sizeof *a->determined)))
    return STEIF_NO_MEMORY;
  a->derivatives = a->determined + n;
  a->prescribe = a->determined + 2 * n;
  return STEIF_OK;
}

void stf_derivative_array_fill(size_t n, int K, sunrealtype tau, const sunrealtype *E,
                               const sunrealtype *B, sunrealtype *D)
{
  const size_t rows = (size_t)(K + 1) * n, square = n * n;
  memset(D, 0, rows * (size_t)(K + 2) * n * sizeof *D);
  for (int j = 0; j <= K + 1; j++)
    for (int k = 0; k <= K; k++) {
      const sunrealtype *b = k >= j ? B + (size_t)(k - j) * square : NULL;
      const sunrealtype *e = j > 0 && k - j + 1 >= 0 ? E + (size_t)(k - j + 1) * square : NULL;
      sunrealtype *block = D + (size_t)j * n * rows + (size_t)k * n;
      for (size_t q = 0; q < square && (b || e); q++)
        block[q / n * rows + q % n] = (b ? b[q] : 0) + (e ? j / tau * e[q] : 0);
    }
}

/* Columns by size, rows by the largest entry of [F_y]_0 and [F_y']_0/tau. */
static void scale(array_work *w, int K)
{
  const size_t n = w->n, rows = (size_t)(K + 1) * n;
  const sunrealtype *size = w->point->size;
  memset(w->left, 0, n * sizeof *w->left);
  for (size_t q = 0; q < n * n; q++)
    w->left[q % n] =
      fmax(w->left[q % n], (fabs(w->B[q]) + fabs(w->E[q]) / w->tau) * size[q / n]);
  for (size_t i = 0; i < n; i++)
    w->left[i] = w->left[i] > 0 ? exp2(-round(log2(w->left[i]))) : 1;
  for (size_t j = 0; j < (size_t)(K + 2) * n; j++)
    for (size_t i = 0; i < rows; i++) w->D[j * rows + i] *= w->left[i % n] * size[j % n];
}

static sunrealtype norm(const sunrealtype *x, size_t count)
{
  sunrealtype sum = 0;
  for (size_t k = 0; k < count; k++) sum += x[k] * x[k];
  return sqrt(sum);
}

/* Null vectors of M in z_1: which y_j' are determined; true if all are. */
static bool full(const array_work *w, size_t rows, size_t rank, int K, stf_derivative_array *a,
                 sunrealtype *gap)
{
  sunrealtype small = 1e-15, large = 1;
  bool all = true;
  for (size_t j = 0; j < w->n; j++) {
    const sunrealtype part = norm(w->VT + j * rows + rank, rows - rank);
    const bool zero = part < STF_VANISHING;
    if (zero && a->determined[j] < 0) a->determined[j] = K;
    if (!zero) a->determined[j] = -1;
    all = all && zero;
    if (zero)
      small = fmax(small, part);
    else
      large = fmin(large, part);
  }
  *gap = large / small;
  return all;
}

/* Z^T N: rank and null space; left in VT2. */
static int constraints(array_work *w, size_t rows, size_t rank, sunrealtype *gap)
{
  const size_t n = w->n, kernel = rows - rank;
  sunrealtype top = 0;
  w->kernel = kernel;
  for (size_t j = 0; j < n; j++) {
    top = fmax(top, norm(w->D + j * rows, rows));
    for (size_t k = 0; k < kernel; k++) {
      sunrealtype sum = 0;
      for (size_t i = 0; i < rows; i++) sum += w->U[(rank + k) * rows + i] * w->D[j * rows + i];
      w->part[j * kernel + k] = sum;
    }
  }
  STEIF_TRY(stf_point_svd(w->point->ctx, kernel, n, w->part, w->s2, w->U2, w->VT2));
  w->hidden = stf_point_rank(w->s2, kernel < n ? kernel : n, top > 0 ? top : 1, gap);
  if (kernel == 0) *gap = INFINITY;
  return STEIF_OK;
}

/* How often each equation is differentiated in the constraints. */
static void derivatives(const array_work *w, size_t rows, size_t rank, stf_derivative_array *a)
{
  for (size_t i = 0; i < rows; i++) {
    sunrealtype most = 0;
    for (size_t k = rank; k < rows; k++) most = fmax(most, fabs(w->U[k * rows + i]));
    if (most > STF_VANISHING) a->derivatives[i % w->n] = (int)(i / w->n);
  }
}

/* Lengths that differ by rounding are equal: the first is taken, on every machine. */
#define SAME_LENGTH 1e-6

/* Start values that can be prescribed: rows of the null space of the constraints, the largest
 * remaining one each time (Gram-Schmidt with pivoting). */
static void prescribe(array_work *w, stf_derivative_array *a)
{
  const size_t n = w->n, dim = n - w->hidden;
  sunrealtype *T = w->part; /* n x dim, by unknowns */
  for (size_t j = 0; j < n; j++) {
    memcpy(T + j * dim, w->VT2 + j * n + w->hidden, dim * sizeof *T);
    a->prescribe[j] = norm(T + j * dim, dim) < 1e-8 ? -1 : 0;
  }
  for (size_t k = 0; k < dim; k++) {
    size_t at = 0;
    for (size_t j = 1; j < n; j++)
      if (norm(T + j * dim, dim) > (1 + SAME_LENGTH) * norm(T + at * dim, dim)) at = j;
    const sunrealtype length = norm(T + at * dim, dim);
    if (!(length > 1e-10)) return;
    a->prescribe[at] = 1;
    for (size_t q = 0; q < dim; q++) w->s2[q] = T[at * dim + q] / length;
    for (size_t j = 0; j < n; j++) {
      sunrealtype dot = 0;
      for (size_t q = 0; q < dim; q++) dot += T[j * dim + q] * w->s2[q];
      for (size_t q = 0; q < dim; q++) T[j * dim + q] -= dot * w->s2[q];
    }
  }
}

static int level(array_work *w, int K, stf_derivative_array *a)
{
  const size_t n = w->n, rows = (size_t)(K + 1) * n, before = w->hidden;
  sunrealtype gap[3];
  stf_derivative_array_fill(n, K, w->tau, w->E, w->B, w->D);
  scale(w, K);
  memcpy(w->M, w->D + n * rows, rows * rows * sizeof *w->M);
  STEIF_TRY(stf_point_svd(w->point->ctx, rows, rows, w->M, w->s, w->U, w->VT));
  const size_t rank = stf_point_rank(w->s, rows, w->s[0], &gap[0]);
  a->closed = full(w, rows, rank, K, a, &gap[1]);
  a->gap = fmin(a->gap, fmin(gap[0], gap[1]));
  if (a->closed) {
    a->index = K;
    a->freedom = (sunindextype)(n - before);
    if (K == 0)
      for (size_t j = 0; j < n; j++) a->prescribe[j] = 1;
    return STEIF_OK;
  }
  STEIF_TRY(constraints(w, rows, rank, &gap[2]));
  a->gap = fmin(a->gap, gap[2]);
  a->stalls = K > 0 && w->hidden == before;
  memset(a->derivatives, 0, n * sizeof *a->derivatives);
  derivatives(w, rows, rank, a);
  prescribe(w, a);
  return STEIF_OK;
}

static int find(array_work *w, const stf_curve *curve, stf_pool *pool, int deepest,
                stf_derivative_array *a)
{
  const size_t n = w->n, square = n * n, rows = (size_t)(deepest + 1) * n;
  stf_chebyshev rule;
  sunrealtype delta;
  stf_chebyshev_open(&rule, deepest + 4, deepest + 1);
  const size_t orders = (size_t)deepest + 2;
  sunrealtype *nodes = stf_pool_array(pool, 2 * (size_t)rule.m * square, sizeof *nodes);
  sunrealtype *E = stf_pool_array(pool, 2 * orders * square, sizeof *E);
  w->D = stf_pool_array(pool, rows * (rows + n), sizeof *w->D);
  w->M = stf_pool_array(pool, rows * rows, sizeof *w->M);
  w->U = stf_pool_array(pool, rows * rows, sizeof *w->U);
  w->VT = stf_pool_array(pool, rows * rows, sizeof *w->VT);
  w->s = stf_pool_array(pool, rows + 2 * n + n, sizeof *w->s);
  w->part = stf_pool_array(pool, rows * n + square, sizeof *w->part);
  w->U2 = stf_pool_array(pool, rows * rows, sizeof *w->U2);
  w->VT2 = stf_pool_array(pool, square, sizeof *w->VT2);
  if (!nodes || !E || !w->D || !w->M || !w->U || !w->VT || !w->s || !w->part || !w->U2 ||
      !w->VT2)
    return STEIF_NO_MEMORY;
  w->s2 = w->s + rows;
  w->left = w->s + rows + 2 * n;
  w->E = E;
  w->B = E + orders * square;
  STEIF_TRY(stf_curve_matrices(w->point, curve, &rule, nodes, E, E + orders * square, &delta));
  for (int K = 0; K <= deepest && !a->closed; K++) STEIF_TRY(level(w, K, a));
  return STEIF_OK;
}

static int find_at(stf_point *point, const stf_curve *curve, int deepest,
                   stf_derivative_array *a)
{
  array_work w = {.point = point, .n = point->n, .tau = curve->tau};
  a->closed = a->stalls = false;
  a->index = -1;
  a->freedom = -1;
  a->gap = INFINITY;
  a->tau = curve->tau;
  for (size_t j = 0; j < point->n; j++) {
    a->determined[j] = -1;
    a->derivatives[j] = a->prescribe[j] = 0;
  }
  stf_pool *pool = stf_pool_new(point->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = find(&w, curve, pool, deepest, a);
  stf_pool_free(&pool);
  return code;
}

/* -- over tau ---------------------------------------------------------------------------- */

static void copy(size_t n, const stf_derivative_array *from, stf_derivative_array *to)
{
  int *const lists = to->determined;
  memcpy(lists, from->determined, 3 * n * sizeof *lists);
  *to = *from;
  to->determined = lists;
  to->derivatives = lists + n;
  to->prescribe = lists + 2 * n;
}

/* A verdict that closes is worth more than one that does not. */
static bool better(const stf_derivative_array *x, const stf_derivative_array *y)
{
  const bool sound_x = x->gap >= STF_LEAST_GAP, sound_y = y->gap >= STF_LEAST_GAP;
  if (sound_x != sound_y) return sound_x;
  return x->gap > y->gap;
}

/* Two lengths in a row of which each is certain: the others would not say anything else. */
static bool settled(const stf_derivative_array *last, const stf_derivative_array *now)
{
  return last->closed && now->closed && last->index == now->index &&
         fmin(last->gap, now->gap) >= STF_CERTAIN_GAP;
}

int stf_derivative_array_scan(stf_point *point, const stf_view *view, sunrealtype t,
                              const sunrealtype *y, const sunrealtype *yp,
                              const sunrealtype *ypp, stf_derivative_array *a)
{
  const size_t n = point->n;
  const int deepest = n > 100 ? 2 : STF_DEEPEST, most = n > 100 ? 2 : n > 30 ? 4 : 8;
  sunrealtype slow, fast;
  stf_derivative_array trial, last = {.closed = false};
  stf_view_rates(point, view, &slow, &fast);
  const int steps = (int)fmin(most, 2 + ceil(log10(fast / slow)));
  sunrealtype *z = stf_allocate(point->ctx, 3 * n, sizeof *z);
  if (!z) return STEIF_NO_MEMORY;
  int code = stf_derivative_array_open(point, &trial);
  a->gap = 0;
  a->closed = a->stalls = false;
  a->index = -1;
  a->freedom = -1;
  for (int k = 0; k <= steps && code >= 0; k++) {
    const sunrealtype tau = 0.1 / fast * pow(100 * fast / slow, (sunrealtype)k / steps);
    for (size_t j = 0; j < n; j++) {
      z[j] = y[j];
      z[n + j] = tau * yp[j];
      z[2 * n + j] = ypp ? tau * tau / 2 * ypp[j] : 0;
    }
    const stf_curve curve = {.t = t, .tau = tau, .count = 3, .z = z};
    code = find_at(point, &curve, deepest, &trial);
    if (!code && better(&trial, a)) copy(n, &trial, a);
    if (!code && point->brief && settled(&last, &trial)) break;
    last = trial;
  }
  stf_release(point->ctx, z);
  return code > 0 ? STEIF_OK : code;
}
