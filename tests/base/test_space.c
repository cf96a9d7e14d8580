/* test_space.c: the kernels on a serial vector against plain sums in long double, and the same on a
 * ManyVector, which runs through the operations of SUNDIALS. n = 2 x 367 spans three cache blocks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "space.h"
#include "suite.h"
#include <nvector/nvector_manyvector.h>

enum { HALF = 367, N = 2 * HALF, VECTORS = 5 };

typedef struct bench {
  steif_context *ctx;
  stf_space space;
  N_Vector part[VECTORS][2], v[VECTORS];
} bench;

/* Component i of the k-th vector: no two alike, both signs, sizes from 1e-3 to 1e3. */
static double entry(int k, int i)
{
  const double x = sin(12.9898 * (i + 1) + 78.233 * (k + 1));
  return x * pow(10, 3 * cos(0.7 * i + k));
}

static double *at(bench *b, int k, int i)
{
  if (b->space.serial) return NV_DATA_S(b->v[k]) + i;
  return NV_DATA_S(b->part[k][i / HALF]) + i % HALF;
}

static bench open_bench(int serial)
{
  bench b = {.ctx = steif_context_new(NULL)};
  SUNContext sun = steif_sundials(b.ctx);
  for (int k = 0; k < VECTORS; k++) {
    for (int j = 0; !serial && j < 2; j++) b.part[k][j] = N_VNew_Serial(HALF, sun);
    b.v[k] = serial ? N_VNew_Serial(N, sun) : N_VNew_ManyVector(2, b.part[k], sun);
  }
  stf_space_open(&b.space, b.v[0]);
  for (int k = 0; k < VECTORS; k++)
    for (int i = 0; i < N; i++) *at(&b, k, i) = entry(k, i);
  return b;
}

static void close_bench(bench *b)
{
  for (int k = 0; k < VECTORS; k++) {
    N_VDestroy(b->v[k]);
    for (int j = 0; j < 2; j++)
      if (b->part[k][j]) N_VDestroy(b->part[k][j]);
  }
  steif_context_free(&b->ctx);
}

/* Largest difference between vector k and c_0 e_0 + ... + c_4 e_4, relative to sum |c_j e_j|. */
static double off(bench *b, int k, const double *c)
{
  double worst = 0;
  for (int i = 0; i < N; i++) {
    long double sum = 0, size = 0;
    for (int j = 0; j < VECTORS; j++) {
      sum += (long double)c[j] * entry(j, i);
      size += fabsl((long double)c[j] * entry(j, i));
    }
    const double d = (double)(fabsl(*at(b, k, i) - sum) / (size > 0 ? size : 1));
    if (!(d <= worst)) worst = d;
  }
  return worst;
}

/* Five terms: at most five roundings of products and four of sums. */
static const double rounding = 10 * STF_EPS;

static void sums(int serial)
{
  bench b = open_bench(serial);
  const stf_space *s = &b.space;
  CHECK(s->serial == serial && s->n == N);
  stf_zero(s, b.v[4]);
  CHECK(off(&b, 4, (double[]){0, 0, 0, 0, 0}) == 0);
  stf_copy(s, b.v[1], b.v[4]);
  CHECK(off(&b, 4, (double[]){0, 1, 0, 0, 0}) == 0);
  stf_scale(s, -2.5, b.v[2], b.v[4]);
  CHECK(off(&b, 4, (double[]){0, 0, -2.5, 0, 0}) <= rounding);
  stf_axpy(s, 0.3, b.v[0], b.v[4]);
  CHECK(off(&b, 4, (double[]){0.3, 0, -2.5, 0, 0}) <= rounding);
  stf_sum(s, 1.7, b.v[1], -0.9, b.v[3], b.v[4]);
  CHECK(off(&b, 4, (double[]){0, 1.7, 0, -0.9, 0}) <= rounding);
  stf_combine(s, 4, (double[]){0.2, -3.1, 0, 5.7}, b.v, b.v[4]);
  CHECK(off(&b, 4, (double[]){0.2, -3.1, 0, 5.7, 0}) <= rounding);
  stf_combine(s, 3, (double[]){1.9, 0.6, -7.3}, b.v, b.v[0]);
  CHECK(off(&b, 0, (double[]){1.9, 0.6, -7.3, 0, 0}) <= rounding);
  close_bench(&b);
}

static void mixes(int serial)
{
  bench b = open_bench(serial);
  const double M[] = {0.4, -1.3, 2.2, 3.7, 0.8, -0.6};
  stf_mix(&b.space, 2, 3, M, b.v, b.v + 3);
  CHECK(off(&b, 3, (double[]){0.4, -1.3, 2.2, 0, 0}) <= rounding);
  CHECK(off(&b, 4, (double[]){3.7, 0.8, -0.6, 0, 0}) <= rounding);
  stf_mix_add(&b.space, 2, 3, M, b.v, b.v + 3);
  CHECK(off(&b, 3, (double[]){0.8, -2.6, 4.4, 0, 0}) <= rounding);
  CHECK(off(&b, 4, (double[]){7.4, 1.6, -1.2, 0, 0}) <= rounding);
  close_bench(&b);
}

static void norms(int serial)
{
  bench b = open_bench(serial);
  const stf_space *s = &b.space;
  const double rtol = 3e-4, atol = 7e-6;
  long double plain = 0, own = 0;
  double most = 0;
  for (int i = 0; i < N; i++) {
    const long double size = rtol * fabsl((long double)entry(1, i)), x = entry(0, i);
    const long double p = x / (size + atol), q = x / (size + fabs(entry(2, i)));
    plain += p * p, own += q * q;
    *at(&b, 2, i) = fabs(entry(2, i));
    most = fmax(most, fabs(entry(0, i)));
  }
  stf_weights(s, rtol, atol, NULL, b.v[1], b.v[3]);
  CLOSE(stf_norm(s, b.v[0], b.v[3]), (double)sqrtl(plain / N), N * STF_EPS);
  stf_weights(s, rtol, atol, b.v[2], b.v[1], b.v[3]);
  CLOSE(stf_norm(s, b.v[0], b.v[3]), (double)sqrtl(own / N), N * STF_EPS);
  CHECK(stf_max(s, b.v[0]) == most);
  close_bench(&b);
}

static void finite(int serial)
{
  bench b = open_bench(serial);
  CHECK(stf_finite(&b.space, b.v[0]));
  static const double bad[] = {NAN, INFINITY, -INFINITY};
  static const int place[] = {0, HALF, N - 1};
  for (int k = 0; k < 9; k++) {
    *at(&b, 0, place[k % 3]) = bad[k / 3];
    CHECK(!stf_finite(&b.space, b.v[0]));
    *at(&b, 0, place[k % 3]) = 3e200; /* its square is not */
    CHECK(stf_finite(&b.space, b.v[0]));
  }
  close_bench(&b);
}

static void serial_sums(void) { sums(1), mixes(1); }
static void other_sums(void) { sums(0), mixes(0); }
static void serial_norms(void) { norms(1), finite(1); }
static void other_norms(void) { norms(0), finite(0); }

static void a_maximum_does_not_lose_a_nan(void)
{
  bench b = open_bench(1);
  *at(&b, 0, HALF) = NAN;
  CHECK(isnan(stf_max(&b.space, b.v[0])));
  close_bench(&b);
}

CU_TestInfo tests_of_space[] = {
  {"sums of serial vectors", serial_sums},
  {"sums of other vectors", other_sums},
  {"norms and finiteness of serial vectors", serial_norms},
  {"norms and finiteness of other vectors", other_norms},
  {"a maximum does not lose a NaN", a_maximum_does_not_lose_a_nan},
  CU_TEST_INFO_NULL,
};
