/* adjoint.c: an oracle: the stage quadrature of a Runge-Kutta method on a homogeneous block, computed by the
 * adjoint method: multiply the stage equations by the adjoint stages and sum by parts. The weak
 * order at index k is therefore the pointwise order of the adjoint method at index k - 1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "adjoint.h"
#include "weak_inside.h"
#include <math.h>
#include <string.h>

typedef struct dual {
  int s, k;
  sunrealtype h;
  const sunrealtype *b, *c, *w;
  long double *H;      /* h times the adjoint matrix, factored in place, s x s */
  int *pivot;          /* s */
  long double *slope;  /* stages of one component, s */
  long double *lambda; /* k */
} dual;

/* LU with partial pivoting; false if a pivot vanishes. */
static bool factor(dual *d)
{
  const int s = d->s;
  for (int j = 0; j < s; j++) {
    int p = j;
    for (int i = j + 1; i < s; i++)
      if (fabsl(d->H[i * s + j]) > fabsl(d->H[p * s + j])) p = i;
    d->pivot[j] = p;
    if (fabsl(d->H[p * s + j]) < STF_EPS * d->h) return false;
    for (int q = 0; q < s; q++) {
      const long double held = d->H[j * s + q];
      d->H[j * s + q] = d->H[p * s + q];
      d->H[p * s + q] = held;
    }
    for (int i = j + 1; i < s; i++) {
      const long double l = d->H[i * s + j] /= d->H[j * s + j];
      for (int q = j + 1; q < s; q++) d->H[i * s + q] -= l * d->H[j * s + q];
    }
  }
  return true;
}

static void solve(const dual *d, long double *x)
{
  const int s = d->s;
  for (int j = 0; j < s; j++) {
    const long double held = x[d->pivot[j]];
    x[d->pivot[j]] = x[j];
    x[j] = held;
  }
  for (int i = 0; i < s; i++)
    for (int j = 0; j < i; j++) x[i] -= d->H[i * s + j] * x[j];
  for (int i = s; i-- > 0;) {
    for (int j = i + 1; j < s; j++) x[i] -= d->H[i * s + j] * x[j];
    x[i] /= d->H[i * s + i];
  }
}

/* One backward step to t: with slopes K_i = -lambda', N^T K_i + lambda + h sum_j a^_ij K_j =
 * w g(t + c_i h). N^T shifts down, so component m needs the slopes of component m - 1 only. */
static void step(dual *d, sunrealtype t)
{
  for (int i = 0; i < d->s; i++) d->slope[i] = 0;
  for (int m = 0; m < d->k; m++) {
    for (int i = 0; i < d->s; i++)
      d->slope[i] = (long double)d->w[m] * steif_test_function(t + d->c[i] * d->h, 0) -
                    d->lambda[m] - d->slope[i];
    solve(d, d->slope);
    for (int i = 0; i < d->s; i++) d->lambda[m] += (long double)d->h * d->b[i] * d->slope[i];
  }
}

static int assemble(steif_context *ctx, dual *d, const steif_table *table)
{
  const int s = d->s;
  for (int i = 0; i < s; i++) {
    STEIF_CHECK(table->b[i] != 0, ctx, STEIF_UNSUPPORTED,
                "weight b_%d of %s is zero: the method has no adjoint in this sense", i + 1,
                table->name);
    for (int j = 0; j < s; j++)
      d->H[i * s + j] = (long double)d->h * table->b[j] * table->A[j * s + i] / table->b[i];
  }
  STEIF_CHECK(factor(d), ctx, STEIF_SINGULAR,
              "the matrix A of %s is singular: stages of a block need a regular one",
              table->name);
  return STEIF_OK;
}

int adjoint_value(steif_context *ctx, const steif_table *table, int k, sunrealtype h, size_t n,
                  const sunrealtype *w, const sunrealtype *x0, sunrealtype *value)
{
  const int s = table->s;
  const size_t room = (size_t)(s * s + s + k);
  long double *work = stf_allocate(ctx, room, sizeof *work);
  int pivot[STEIF_STAGES];
  if (!work) return STEIF_NO_MEMORY;
  dual d = {.s = s, .k = k, .h = h, .b = table->b, .c = table->c, .w = w, .pivot = pivot};
  d.H = work, d.slope = d.H + s * s, d.lambda = d.slope + s;
  const int code = assemble(ctx, &d, table);
  if (code == STEIF_OK) {
    for (size_t i = n; i-- > 0;) step(&d, (sunrealtype)i * h);
    long double sum = 0;
    for (int m = 0; m + 1 < k; m++) sum += d.lambda[m] * x0[m + 1];
    *value = (sunrealtype)sum;
  }
  stf_release(ctx, work);
  return code;
}
