/* square.c: phi functions of the five-point Laplacian on a square, against its sine basis.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "phi_cost.h"
#include "timing.h"
#include "lapack.h"
#include <math.h>
#include <steif/phi.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { GRIDS = 2, TIMES = 3, MOST_P = STEIF_BENCH_SQUARE / TIMES - 1 };
static const int sides[GRIDS] = {32, 1000};
static const sunrealtype times[TIMES] = {0.01, 0.0135, 0.018};
static const sunrealtype pi = 3.14159265358979323846;

/* With N = side inner points each way and h = 1/(N + 1), A = (5-point differences)/h^2 = S D S on
 * both axes: S the symmetric, orthogonal sine matrix, D the sums of mu_i = -4/h^2 sin^2(i pi h/2). */
typedef struct square {
  steif_context *ctx;
  int side;
  sunrealtype *S, *mu, *work; /* N x N, N, N x N */
  SUNMatrix A;
  N_Vector b, w, exact;
  steif_action *action;
} square;

static void five_points(const square *q)
{
  const int N = q->side;
  const sunrealtype scale = (sunrealtype)(N + 1) * (N + 1);
  sunindextype *start = SUNSparseMatrix_IndexPointers(q->A), at = 0;
  sunindextype *row = SUNSparseMatrix_IndexValues(q->A);
  sunrealtype *value = SUNSparseMatrix_Data(q->A);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      const int near[5][2] = {{i, j - 1}, {i - 1, j}, {i, j}, {i + 1, j}, {i, j + 1}};
      start[i + N * j] = at;
      for (int k = 0; k < 5; k++) {
        const int x = near[k][0], y = near[k][1];
        if (x < 0 || y < 0 || x >= N || y >= N) continue;
        row[at] = x + N * y;
        value[at++] = k == 2 ? -4 * scale : scale;
      }
    }
  start[N * N] = at;
}

static void sines(const square *q)
{
  const int N = q->side;
  const sunrealtype h = 1. / (N + 1);
  for (int j = 0; j < N; j++) {
    const sunrealtype s = sin((j + 1) * pi * h / 2);
    q->mu[j] = -4 * s * s / (h * h);
    /* (i+1)(j+1) modulo the period 2(N+1) keeps the argument of the sine small. */
    for (int i = 0; i < N; i++)
      q->S[i + N * j] = sqrt(2 * h) * sin((i + 1) * (j + 1) % (2 * (N + 1)) * pi * h);
  }
}

/* In (0, 1): S. K. Park and K. W. Miller, Comm. ACM 31 (1988). */
static void random_vector(const square *q)
{
  unsigned seed = 2024;
  sunrealtype *b = N_VGetArrayPointer(q->b);
  for (int i = 0; i < q->side * q->side; i++) {
    seed = (unsigned)((unsigned long long)seed * 48271u % 2147483647u);
    b[i] = (sunrealtype)seed / 2147483647.0;
  }
}

static int prepare(stf_pool *pool, square *q)
{
  const int N = q->side;
  const size_t n = (size_t)N * (size_t)N;
  SUNContext sun = steif_sundials(q->ctx);
  q->A = SUNSparseMatrix(N * N, N * N, 5 * N * N, CSC_MAT, sun);
  q->b = N_VNew_Serial(N * N, sun);
  STEIF_CHECK(q->A && q->b, q->ctx, STEIF_NO_MEMORY, "no memory for a grid of %d x %d", N, N);
  q->w = stf_pool_vector(pool, q->b);
  q->exact = stf_pool_vector(pool, q->b);
  q->S = stf_pool_array(pool, n, sizeof *q->S);
  q->work = stf_pool_array(pool, n, sizeof *q->work);
  q->mu = stf_pool_array(pool, (size_t)N, sizeof *q->mu);
  if (!q->w || !q->exact || !q->S || !q->work || !q->mu) return STEIF_NO_MEMORY;
  five_points(q);
  sines(q);
  random_vector(q);
  q->action = steif_action_new(q->ctx, q->A, NULL, q->w, NULL);
  return q->action ? STEIF_OK : steif_status(q->ctx);
}

static void clear(square *q)
{
  steif_action_free(&q->action);
  if (q->b) N_VDestroy(q->b);
  if (q->A) SUNMatDestroy(q->A);
}

/* exact = phi_p(tA) b through the sine basis. */
static int reference(const square *q, sunrealtype t, int p)
{
  const int N = q->side;
  sunrealtype *x = N_VGetArrayPointer(q->exact), phi[MOST_P + 1], imaginary[MOST_P + 1];
  stf_multiply(N, N, q->S, N_VGetArrayPointer(q->b), 0, q->work);
  stf_multiply(N, N, q->work, q->S, 0, x);
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      STEIF_TRY(steif_phi_scalar(p, t * (q->mu[i] + q->mu[j]), 0, phi, imaginary));
      x[i + N * j] *= phi[p];
    }
  stf_multiply(N, N, q->S, x, 0, q->work);
  stf_multiply(N, N, q->work, q->S, 0, x);
  return STEIF_OK;
}

static int measure(const square *q, int p, steif_bench_square *row)
{
  N_Vector b[MOST_P + 1] = {NULL};
  steif_action_report told;
  b[p] = q->b;
  const sunrealtype start = stf_now();
  STEIF_TRY(steif_action_apply(q->action, row->t, p, b, q->w, &told));
  row->cpu_s = stf_now() - start;
  row->p = p;
  row->factors = told.factors;
  row->solves = told.solves;
  STEIF_TRY(reference(q, row->t, p));
  N_VLinearSum(1, q->w, -1, q->exact, q->w);
  row->error = sqrt(N_VDotProd(q->w, q->w) / N_VDotProd(q->exact, q->exact));
  return STEIF_OK;
}

int steif_bench_squares(steif_context *ctx, size_t i,
                        steif_bench_square row[STEIF_BENCH_SQUARE])
{
  if (i >= GRIDS) return STEIF_BAD_INPUT;
  square q = {.ctx = ctx, .side = sides[i]};
  stf_pool *pool = stf_pool_new(ctx);
  int code = pool ? prepare(pool, &q) : STEIF_NO_MEMORY;
  for (int k = 0; k < STEIF_BENCH_SQUARE && !code; k++) {
    row[k] = (steif_bench_square){.n = (sunindextype)q.side * q.side, .t = times[k % TIMES]};
    code = measure(&q, k / TIMES, row + k);
  }
  clear(&q);
  stf_pool_free(&pool);
  return code;
}
