/* gear.c: see gear.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gear.h"
#include "suite.h"
#include <stdlib.h>

double gear_random(unsigned *state)
{
  *state = (unsigned)((unsigned long long)*state * 48271u % 2147483647u);
  return 2 * (double)*state / 2147483647.0 - 1;
}

void gear_fill(int n, double scale, unsigned seed, double *A)
{
  for (int k = 0; k < n * n; k++) A[k] = scale * gear_random(&seed);
}

double gear_distance(int n, const double *X, const double *Y)
{
  double error = 0, norm = 0;
  for (int j = 0; j < n; j++) {
    double difference = 0, sum = 0;
    for (int i = 0; i < n; i++) {
      difference += fabs(X[i + n * j] - Y[i + n * j]);
      sum += fabs(Y[i + n * j]);
    }
    if (isnan(difference)) return NAN;
    error = fmax(error, difference), norm = fmax(norm, sum);
  }
  return error / norm;
}

void gear_times(int n, const double *X, const double *Y, double *Z)
{
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      double sum = 0;
      for (int k = 0; k < n; k++) sum += X[i + n * k] * Y[k + n * j];
      Z[i + n * j] = sum;
    }
}

static void *allocate(size_t bytes, void *user)
{
  int *left = user;
  return --*left < 0 ? NULL : malloc(bytes);
}

static void release(void *block, void *user)
{
  (void)user;
  free(block);
}

int gear_hunger(int (*run)(steif_context *ctx))
{
  for (int k = 0; k < 1000; k++) {
    int left = 1000000;
    steif_context *ctx = steif_context_new(
      &(steif_setup){.allocate = allocate, .release = release, .user = &left, .threads = 1});
    left = k;
    const int code = run(ctx);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    left = 1000000;
    steif_context_free(&ctx);
    if (code == STEIF_OK) return k;
  }
  return -1;
}
