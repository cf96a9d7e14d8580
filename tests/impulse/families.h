/* families.h: random dense pencils of known structure, rand(n_f, {k_b}, rho,
 * kind, kappa): E = U diag(I, N_1, N_2, ...) V,  F = U diag(J, I) V, U and V
 * with logarithmically spaced singular values of condition kappa, N_b Jordan
 * blocks of sizes k_b, J of conjugate pairs 0.05 w +- i w ("osc") or real
 * ("stiff"), w logarithmic in [0.1, rho]. In block coordinates every answer is
 * a finite sum, evaluated here from the blocks. SPDX-License-Identifier:
 * BSD-3-Clause */
#ifndef FAMILIES_H
#define FAMILIES_H

#include "linear_system.h"
#include "suite.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { BLOCKS = 72, DEPTH = 6 };

typedef struct family {
  const char *name;
  int finite;
  int sizes[BLOCKS]; /* ends with 0 */
  double rho;
  bool stiff;
  double kappa;
} family;

typedef struct sample {
  int n, k;
  uint64_t state;
  double *E, *F, *U, *V, *inverse; /* row i, column j at [j n + i] */
  double *x0, *f;                  /* f: k x n */
  double *plus, *c;                /* exact: n, and (k - 1) x n */
} sample;

static inline double uniform(sample *s)
{
  s->state ^= s->state << 13, s->state ^= s->state >> 7, s->state ^= s->state << 17;
  return ((double)(s->state >> 11) + 0.5) * 0x1p-53;
}
static inline double normal(sample *s)
{
  const double r = sqrt(-2 * log(uniform(s)));
  return r * cos(6.283185307179586 * uniform(s));
}

/* C = A B and C = A B^T. */
static inline void multiply(int n, const double *A, const double *B, bool transposed, double *C)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) C[j * n + i] = 0;
  for (int j = 0; j < n; j++)
    for (int k = 0; k < n; k++) {
      const double b = transposed ? B[k * n + j] : B[j * n + k];
      for (int i = 0; b != 0 && i < n; i++) C[j * n + i] += A[k * n + i] * b;
    }
}
static inline void apply(int n, const double *A, const double *x, double *y)
{
  for (int i = 0; i < n; i++) y[i] = 0;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) y[i] += A[j * n + i] * x[j];
}

/* Orthonormal columns by Gram and Schmidt, twice. */
static inline void orthogonal(sample *s, double *Q)
{
  const int n = s->n;
  for (int j = 0; j < n; j++) {
    double *q = Q + j * n, norm = 0;
    for (int i = 0; i < n; i++) q[i] = normal(s);
    for (int p = 0; p < 2 * j; p++) {
      double dot = 0;
      for (int i = 0; i < n; i++) dot += Q[p % j * n + i] * q[i];
      for (int i = 0; i < n; i++) q[i] -= dot * Q[p % j * n + i];
    }
    for (int i = 0; i < n; i++) norm += q[i] * q[i];
    for (int i = 0; i < n; i++) q[i] /= sqrt(norm);
  }
}

/* A = Q_1 Sigma Q_2^T and its inverse Q_2 Sigma^{-1} Q_1^T. */
static inline void conditioned(sample *s, double kappa, double *A, double *inverse)
{
  const int n = s->n;
  const size_t count = (size_t)n * (size_t)n;
  double *one = malloc(count * sizeof *one), *two = malloc(count * sizeof *two);
  double *scaled = malloc(count * sizeof *scaled);
  orthogonal(s, one), orthogonal(s, two);
  for (int sign = -1; sign <= 1; sign += 2) {
    for (int j = 0; j < n; j++) {
      const double sigma = pow(kappa, sign * (n > 1 ? j / (n - 1.0) : 0));
      for (int i = 0; i < n; i++) scaled[j * n + i] = (sign < 0 ? one : two)[j * n + i] * sigma;
    }
    double *out = sign < 0 ? A : inverse;
    if (out) multiply(n, scaled, sign < 0 ? two : one, true, out);
  }
  free(one), free(two), free(scaled);
}

/* diag(J, I) and diag(I, N_1, ...). */
static inline void blocks(const family *p, int n, double *E, double *F)
{
  const int f = p->finite, rates = p->stiff ? f : f / 2;
  for (int i = 0; i < n; i++) F[i * n + i] = 1;
  for (int i = 0; i < f; i++) E[i * n + i] = 1;
  for (int i = 0; i < rates; i++) {
    const double w = 0.1 * pow(p->rho / 0.1, rates > 1 ? i / (rates - 1.0) : 1);
    const int a = p->stiff ? i : 2 * i, b = a + 1;
    F[a * n + a] = p->stiff ? w : 0.05 * w;
    if (!p->stiff) F[b * n + b] = 0.05 * w, F[b * n + a] = w, F[a * n + b] = -w;
  }
  for (int b = 0, at = f; p->sizes[b]; at += p->sizes[b++])
    for (int i = 0; i + 1 < p->sizes[b]; i++) E[(at + i + 1) * n + at + i] = 1;
}

/* w_i(0+) = sum_j (-1)^j g_{i+j}^(j), c_q = (-1)^q N^{q+1} (w(0-) - w(0+)) in
 * one block. */
static inline void solution(sample *s, int at, int size, const double *y, const double *g,
                            double *plus, double *c)
{
  const int n = s->n;
  for (int i = 0; i < size; i++) {
    plus[at + i] = 0;
    for (int j = 0; i + j < size; j++) plus[at + i] += (j % 2 ? -1 : 1) * g[j * n + at + i + j];
  }
  for (int q = 0; q + 1 < s->k; q++)
    for (int i = 0; i + q + 1 < size; i++)
      c[q * n + at + i] = (q % 2 ? -1 : 1) * (y[at + i + q + 1] - plus[at + i + q + 1]);
}

static inline void answer(sample *s, const family *p)
{
  const int n = s->n, k = s->k;
  const size_t size = (size_t)s->n, all = size * (size_t)s->k;
  double *y = calloc(size, sizeof *y), *g = calloc(all, sizeof *g);
  double *plus = calloc(size, sizeof *plus), *c = calloc(all, sizeof *c);
  for (int i = 0; i < n; i++) plus[i] = y[i] = normal(s);
  for (int i = 0; i < k * n; i++) g[i] = normal(s);
  for (int b = 0, at = p->finite; p->sizes[b]; at += p->sizes[b++])
    solution(s, at, p->sizes[b], y, g, plus, c);
  apply(n, s->inverse, y, s->x0);
  apply(n, s->inverse, plus, s->plus);
  for (int j = 0; j < k; j++) apply(n, s->U, g + j * n, s->f + j * n);
  for (int j = 0; j + 1 < k; j++) apply(n, s->inverse, c + j * n, s->c + j * n);
  free(y), free(g), free(plus), free(c);
}

static inline void sample_open(sample *s, const family *p, unsigned seed)
{
  *s = (sample){.n = p->finite, .state = 88172645463325252u + 977 * (uint64_t)seed};
  for (int b = 0; p->sizes[b]; b++) {
    s->n += p->sizes[b];
    if (s->k < p->sizes[b]) s->k = p->sizes[b];
  }
  const size_t n = (size_t)s->n, k = (size_t)s->k + 1;
  double **square[] = {&s->E, &s->F, &s->U, &s->V, &s->inverse};
  for (int i = 0; i < 5; i++) *square[i] = calloc(n * n, sizeof(double));
  s->x0 = calloc(n, sizeof(double)), s->plus = calloc(n, sizeof(double));
  s->f = calloc(k * n, sizeof(double)), s->c = calloc(k * n, sizeof(double));
  double *D = calloc(n * n, sizeof *D), *B = calloc(n * n, sizeof *B);
  double *T = calloc(n * n, sizeof *T);
  for (int i = 0; i < 20; i++) uniform(s);
  conditioned(s, p->kappa, s->U, NULL), conditioned(s, p->kappa, s->V, s->inverse);
  blocks(p, s->n, D, B);
  multiply(s->n, s->U, D, false, T), multiply(s->n, T, s->V, false, s->E);
  multiply(s->n, s->U, B, false, T), multiply(s->n, T, s->V, false, s->F);
  free(D), free(B), free(T);
  answer(s, p);
}

static inline void sample_close(sample *s)
{
  free(s->E), free(s->F), free(s->U), free(s->V), free(s->inverse);
  free(s->x0), free(s->f), free(s->plus), free(s->c);
}

static inline double off(int n, const double *a, const double *b)
{
  double difference = 0, size = 0;
  for (int i = 0; i < n; i++) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return sqrt(difference / size);
}

/* The families of the tables; errors are of x(0+), c_0, c_1, ... by staircase
 * and by Schur form. */
typedef struct measured {
  family family;
  double staircase[DEPTH], schur[DEPTH];
} measured;

/* Source: table of relative errors in double precision, staircase with
 * propagated tolerances and reordered QZ, measured once in a prototype with
 * other random numbers. */
static const measured table[] = {
  {{"osc 10 [2]", 8, {2}, 10, false, 1}, {9.6e-16, 5.9e-16}, {4.2e-15, 5.3e-15}},
  {{"osc 10 [3,2,1]", 10, {3, 2, 1}, 10, false, 1},
   {7.0e-15, 2.3e-15, 1.9e-15},
   {6.7e-14, 2.8e-14, 4.2e-15}},
  {{"osc 10 [4,3,1,1]", 20, {4, 3, 1, 1}, 10, false, 1},
   {9.6e-14, 6.3e-15, 7.6e-15, 1.5e-15},
   {1.3e-13, 1.1e-14, 7.1e-15, 3.3e-15}},
  {{"osc 10 [5,2]", 20, {5, 2}, 10, false, 1},
   {2.6e-12, 2.3e-13, 3.7e-14, 1.4e-14, 2.5e-15},
   {1.3e-12, 1.7e-13, 1.7e-13, 1.7e-13, 4.4e-15}},
  {{"stiff 1e3 [2,2,1]", 20, {2, 2, 1}, 1e3, true, 1}, {2.3e-11, 1.4e-13}, {5.6e-11, 2.7e-13}},
  {{"stiff 1e3 [3,2,1]", 20, {3, 2, 1}, 1e3, true, 1},
   {5.3e-8, 2.0e-10, 3.0e-13},
   {1.8e-9, 2.0e-11, 1.4e-13}},
  {{"stiff 1e6 [2,1]", 20, {2, 1}, 1e6, true, 1}, {6.2e-6, 1.2e-11}, {8.3e-6, 7.7e-11}},
  {{"osc 10 [3,2] kappa 1e3", 20, {3, 2}, 10, false, 1e3},
   {4.3e-10, 2.6e-10, 6.7e-11},
   {1.8e-11, 1.2e-11, 8.4e-12}},
  {{"osc 10 [3,2] kappa 1e5", 20, {3, 2}, 10, false, 1e5},
   {6.2e-6, 1.1e-6, 3.6e-8},
   {3.5e-7, 1.4e-7, 9.2e-8}},
  {{"osc 10 [3,2] ten times",
    150,
    {3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2, 3, 2},
    10,
    false,
    1},
   {4.2e-14, 1.4e-14, 7.4e-15},
   {5.9e-14, 1.5e-14, 9.9e-15}},
  {{"one mode 1e6, [2]", 6, {2}, 1e6, true, 1}, {2.1e-5, 1.5e-10}, {5.8e-5, 1.5e-10}},
};
enum { ROWS = sizeof table / sizeof *table };

/* Beyond double precision: the chain of 3 and the rate 1e6 cannot be told
 * apart. */
static const family hopeless = {"stiff 1e6 [3,1]", 20, {3, 1}, 1e6, true, 1};

static inline SUNMatrix dense(steif_context *ctx, int n, const double *columns)
{
  SUNMatrix M = SUNDenseMatrix(n, n, steif_sundials(ctx));
  memcpy(SM_DATA_D(M), columns, (size_t)n * (size_t)n * sizeof *columns);
  return M;
}

/* The forcing of a sample, and its impulse. */
static inline int recorded(sunrealtype t, int q, N_Vector out, void *user)
{
  const sample *p = user;
  (void)t;
  if (q >= p->k) return 1;
  memcpy(N_VGetArrayPointer(out), p->f + q * p->n, (size_t)p->n * sizeof(double));
  return 0;
}

static inline steif_impulse solve(steif_context *ctx, sample *p, enum steif_algorithm algorithm)
{
  SUNMatrix E = dense(ctx, p->n, p->E), F = dense(ctx, p->n, p->F);
  steif_impulse impulse;
  const int code =
    steif_impulse_find(ctx, E, F, p->x0, 0, recorded, p,
                       &(steif_analysis){.algorithm = algorithm}, NULL, &impulse);
  CHECK(code == STEIF_OK);
  if (code) printf("\n  %s", steif_message(ctx));
  SUNMatDestroy(E), SUNMatDestroy(F);
  return impulse;
}

/* Structure of the pencil with E and F by columns. */
static inline steif_structure look(steif_context *ctx, int n, const double *E, const double *F,
                                   enum steif_algorithm algorithm)
{
  const steif_analysis analysis = {.algorithm = algorithm};
  SUNMatrix e = dense(ctx, n, E), f = dense(ctx, n, F);
  steif_structure s;
  const int code = steif_structure_find(ctx, e, f, &analysis, &s);
  CHECK(code == STEIF_OK);
  if (code) printf("\n  %s", steif_message(ctx));
  SUNMatDestroy(e), SUNMatDestroy(f);
  return s;
}

/* E and F of the 5 x 5 pencil of index 3 with eigenvalues -1/2 +- 3i, by rows.
 */
static const double ut5_E[5][5] = {
  {1, 0, 1, 0, 0}, {1, 1, 2, 0, 1}, {0, 1, 1, 1, 1}, {0, 0, 0, 1, 1}, {1, 0, 1, 0, 1}};
static const double ut5_F[5][5] = {{.5, 3, 3.5, 0, 3},
                                   {-2.5, 3.5, 1, 0, 3.5},
                                   {-3, .5, -1.5, 1, .5},
                                   {0, 0, 1, 2, 0},
                                   {.5, 3, 3.5, 1, 4}};

static inline SUNMatrix dense5(steif_context *ctx, const double (*rows)[5])
{
  SUNMatrix M = SUNDenseMatrix(5, 5, steif_sundials(ctx));
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++) SM_ELEMENT_D(M, i, j) = rows[i][j];
  return M;
}

/* An allocator with so many meals left. */
static inline void *starving(size_t bytes, void *user)
{
  long *left = user;
  return (*left)-- > 0 ? malloc(bytes) : NULL;
}
static inline void feeding(void *block, void *user)
{
  (void)user;
  free(block);
}

#endif
