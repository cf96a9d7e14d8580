/* The kernels of small collocation: elimination that skips zeros against that of all entries, and
 * both against the matrix.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interleaved.h"
#include "table.h"
#include "suite.h"
#include <stdlib.h>
#include <string.h>

enum { MOST = 64 };

static double uniform(unsigned *seed)
{
  *seed = (unsigned)((unsigned long long)*seed * 48271 % 2147483647);
  return *seed / 1073741823.5 - 1;
}

/* About `per` entries a column besides the diagonal, which is empty in every fifth column. */
static void scatter(int n, int per, unsigned seed, double *J)
{
  memset(J, 0, sizeof *J * (size_t)(n * n));
  for (int j = 0; j < n; j++) {
    J[j + n * j] = j % 5 ? -3 + uniform(&seed) : 0;
    for (int k = 0; k < per; k++) {
      const int i = (int)((uniform(&seed) + 1) / 2 * n);
      J[i % n + n * j] = 2 * uniform(&seed);
    }
  }
  for (int j = 0; j < n; j += 5) {
    const int next = (j + 1) % n;
    J[next + n * j] = 4.7, J[j + n * next] = -5.1;
  }
}

typedef struct bench {
  steif_context *ctx;
  stf_pool *pool;
  steif_table *table;
  stf_transform transform;
  int n;
  double J[MOST * MOST], M[MOST * MOST];
  stf_interleaved *L;
  stf_shifts *inside; /* of L */
} bench;

static void begin(bench *b, const char *spec, int n, bool mass)
{
  unsigned seed = 99;
  b->n = n;
  b->ctx = steif_context_new(NULL), b->pool = stf_pool_new(b->ctx);
  b->table = steif_table_new(b->ctx, spec);
  CU_ASSERT_FATAL(!stf_transform_build(b->pool, b->ctx, b->table, &b->transform));
  for (int i = 0; i < n * n; i++)
    b->M[i] = i % (n + 1) == 0 && (i / n) % 4 ? 1 + uniform(&seed) / 3 : 0;
  b->L = stf_interleaved_new(b->pool, &b->transform, n, mass ? b->M : NULL);
  CU_ASSERT_FATAL(b->L != NULL);
  b->inside = (stf_shifts *)b->L;
}

static void end(bench *b)
{
  steif_table_free(b->ctx, &b->table);
  stf_pool_free(&b->pool);
  steif_context_free(&b->ctx);
}

/* One sweep from the stage values F, omega = 0: d omega of all lanes. */
static void sweep(bench *b, double h, double *omega)
{
  double y[MOST] = {0}, weight[MOST];
  const size_t count = (size_t)(2 * b->inside->lanes * b->n);
  unsigned seed = 7;
  for (int i = 0; i < b->n; i++) weight[i] = 1;
  static const double none[STF_INTERLEAVED_STAGES];
  stf_interleaved_begin(b->L, 0, none, none, y);
  for (int i = 0; i < b->n * b->L->s; i++) b->L->F[i] = uniform(&seed);
  stf_interleaved_sweep(b->L, y, weight, h);
  memcpy(omega, b->inside->omega, count * sizeof *omega);
}

static void skipping_zeros_changes_nothing(void)
{
  static const char *const specs[] = {"radau:s=1", "radau:s=3", "gauss:s=4", "radau:s=7",
                                      "gauss:s=9"};
  static const int sizes[] = {8, 20, 33, 64};
  for (int k = 0; k < 5; k++)
    for (int c = 0; c < 8; c++) {
      const int n = sizes[c / 2];
      double thin[16 * MOST], all[16 * MOST];
      bench *b = malloc(sizeof *b);
      begin(b, specs[k], n, c % 2);
      scatter(n, 1, 31u + (unsigned)c, b->J);
      CHECK(stf_interleaved_factor(b->L, b->J, 0.13) == 0 && b->inside->sparse);
      sweep(b, 0.13, thin);
      b->inside->sparse = false, b->inside->full = true;
      CHECK(stf_interleaved_factor(b->L, b->J, 0.13) == 0 && !b->inside->sparse);
      sweep(b, 0.13, all);

      for (int i = 0; i < 2 * b->inside->lanes * n; i++) CLOSE_FLOOR(thin[i], all[i], 1e-10, 1);
      end(b);
      free(b);
    }
}

/* max |(lambda/h M - J) x - r| / max |x| */
static double residual(const bench *b, double h, const double *x, const double *r)
{
  double most = 0, size = 0;
  for (int i = 0; i < b->n; i++) {
    double sum = -r[i];
    for (int j = 0; j < b->n; j++) {
      const double m = b->inside->M ? b->M[i * b->n + j] : i == j;
      sum += (b->transform.re[0] / h * m - b->J[i + b->n * j]) * x[j];
    }
    most = fmax(most, fabs(sum)), size = fmax(size, fabs(x[i]));
  }
  return most / size;
}

/* The pattern may grow from one Jacobian to the next, until nothing is left to skip. */
static void patterns_grow(void)
{
  bench *b = malloc(sizeof *b);
  begin(b, "radau:s=5", 20, true);
  for (int per = 1; per <= 40; per *= 3) {
    double x[MOST], r[MOST];
    unsigned seed = 5;
    scatter(20, per, 11u + (unsigned)per, b->J);
    CHECK(stf_interleaved_factor(b->L, b->J, 0.21) == 0);
    CHECK(per == 3 || b->inside->sparse == (per == 1));
    for (int i = 0; i < 20; i++) x[i] = r[i] = uniform(&seed);
    stf_interleaved_filter(b->L, x);
    CHECK(residual(b, 0.21, x, r) < 1e-12);
  }
  end(b);
  free(b);
}

/* An empty column is named: 1 + its number. */
static void singular_columns_are_named(void)
{
  bench *b = malloc(sizeof *b);
  begin(b, "radau:s=3", 20, true);
  scatter(20, 1, 3, b->J);
  for (int i = 0; i < 20; i++) b->J[i + 20 * 8] = 0; /* M is empty there, too */
  CHECK(b->M[8 * 21] == 0);
  CHECK(stf_interleaved_factor(b->L, b->J, 0.1) == 9 && b->inside->sparse);
  end(b);
  free(b);
}

CU_TestInfo tests_of_interleaved[] = {
  {"skipping zeros changes nothing", skipping_zeros_changes_nothing},
  {"patterns grow", patterns_grow},
  {"singular columns are named", singular_columns_are_named},
  CU_TEST_INFO_NULL,
};
