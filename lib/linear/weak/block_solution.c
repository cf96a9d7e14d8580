/* block_solution.c: the distributional solution of N x' + x = f, paired with a test function, and
 * the closed first-order constants of backward Euler. S. L. Campbell, Singular Systems of
 * Differential Equations (1980); signs from the Laplace transform N (s X - x(0-)) + X = F.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak_inside.h"
#include <math.h>
#include <nvector/nvector_serial.h>

enum { PANELS = 16, PANELS_MOST = 4096 };
static const long double agreed = 1e-15L;

static sunrealtype sign(int i) { return i % 2 ? -1 : 1; }

int stf_block_series(stf_block *block, sunrealtype t, int j, bool weighted, sunrealtype *x)
{
  for (int m = 0; m < block->k; m++) x[m] = 0;
  for (int n = 0; block->forcing && n < block->k; n++) {
    const int code = block->forcing(t, n + j, block->g, block->user);
    STEIF_CHECK(code <= 0, block->ctx, STEIF_UNSUPPORTED,
                "derivative %d of the forcing is not known at t = %g; the exact solution of an "
                "index-%d block needs it: let the forcing answer derivatives up to %d",
                n + j, t, block->k, block->k + 1);
    STEIF_CHECK(code == 0, block->ctx, STEIF_CALLBACK,
                "the forcing returned %d for derivative %d at t = %g", code, n + j, t);
    const sunrealtype *f = N_VGetArrayPointer(block->g), w = sign(n) * (weighted ? n + 1 : 1);
    for (int m = 0; m + n < block->k; m++) x[m] += w * f[m + n];
  }
  return STEIF_OK;
}

/* c_i = (-1)^i N^{i+1} (x0 - x_s(0)). */
static int impulses(stf_block *block)
{
  const int k = block->k;
  STEIF_TRY(stf_block_series(block, 0, 0, false, block->x));
  for (int i = 0; i + 1 < k; i++)
    for (int m = 0; m < k; m++) {
      const int from = m + i + 1;
      block->c[i * k + m] = from < k ? sign(i) * (block->x0[from] - block->x[from]) : 0;
    }
  return STEIF_OK;
}

static int claim(stf_block *block)
{
  const size_t k = (size_t)block->k;
  block->c = stf_allocate(block->ctx, k * k, sizeof *block->c);
  block->x = stf_allocate(block->ctx, k, sizeof *block->x);
  if (!block->c || !block->x) return STEIF_NO_MEMORY;
  block->g = N_VNew_Serial(block->k, steif_sundials(block->ctx));
  STEIF_CHECK(block->g, block->ctx, STEIF_NO_MEMORY, "no memory for a vector of %d values",
              block->k);
  return impulses(block);
}

int stf_block_open(stf_block *block, steif_context *ctx, int k, steif_forcing forcing,
                   void *user, const sunrealtype *x0)
{
  *block = (stf_block){.ctx = ctx,
                       .k = k,
                       .forcing = forcing,
                       .user = user,
                       .x0 = x0,
                       .weight = stf_weight_of(ctx, NULL)};
  STEIF_CHECK(k >= 1, ctx, STEIF_BAD_INPUT, "index k = %d of the block must be at least 1", k);
  STEIF_CHECK(x0, ctx, STEIF_BAD_INPUT, "x(0-) is missing: give the %d start values", k);
  const int code = claim(block);
  if (code != STEIF_OK) stf_block_close(block);
  return code;
}

void stf_block_close(stf_block *block)
{
  if (!block->ctx) return;
  if (block->g) N_VDestroy(block->g);
  stf_release(block->ctx, block->c);
  stf_release(block->ctx, block->x);
  *block = (stf_block){0};
}

int steif_jordan_exact(steif_context *ctx, int k, steif_forcing forcing, void *user,
                       const sunrealtype *x0, sunrealtype t, sunrealtype *x, sunrealtype *c)
{
  stf_block block;
  STEIF_TRY(stf_block_open(&block, ctx, k, forcing, user, x0));
  const int code = x ? stf_block_series(&block, t, 0, false, x) : STEIF_OK;
  for (int i = 0; c && i < (k - 1) * k; i++) c[i] = block.c[i];
  stf_block_close(&block);
  return code;
}

/* The integral below by Gauss's rule on so many panels, and that of its absolute value. */
static int panels(stf_block *block, int m, int series, bool half, int j, int count,
                  long double *value, long double *size)
{
  const stf_weight *g = &block->weight;
  long double derivative[STF_DERIVATIVES];
  *value = *size = 0;
  for (int panel = 0; panel < count; panel++)
    for (int i = 0; i < STF_BOX; i++) {
      const long double t = g->t1 * ((long double)panel + g->node[i]) / count;
      STEIF_TRY(stf_weight_at(g, t, j, derivative));
      STEIF_TRY(stf_block_series(block, (sunrealtype)t, series, false, block->x));
      sunrealtype a = block->x[m];
      if (half) {
        STEIF_TRY(stf_block_series(block, (sunrealtype)t, series, true, block->x));
        a -= block->x[m] / 2;
      }
      const long double term = g->weight[i] * a * derivative[j] * g->t1 / count;
      *value += term;
      *size += fabsl(term);
    }
  return STEIF_OK;
}

/* int_0^t1 (component m of the series a, less half the weighted series if `half`) g^(j) dt. */
static int integral(stf_block *block, int m, int series, bool half, int j, long double *value)
{
  long double finer, size;
  *value = 0;
  if (!block->forcing) return STEIF_OK;
  STEIF_TRY(panels(block, m, series, half, j, PANELS, value, &size));
  for (int count = 2 * PANELS; count <= PANELS_MOST; count *= 2) {
    STEIF_TRY(panels(block, m, series, half, j, count, &finer, &size));
    const bool same = fabsl(finer - *value) <= agreed * size;
    *value = finer;
    if (same) break;
  }
  return STEIF_OK;
}

/* g^(0) .. g^(order) at 0. */
static int at_zero(const stf_block *block, int order, long double *g)
{
  STEIF_CHECK(order < STF_DERIVATIVES, block->ctx, STEIF_UNSUPPORTED,
              "a block of index %d takes too many derivatives of the test function", block->k);
  return stf_weight_at(&block->weight, 0, order, g);
}

int stf_block_pair(stf_block *block, int m, int j, sunrealtype *value)
{
  long double sum, g[STF_DERIVATIVES];
  STEIF_TRY(at_zero(block, block->k > 1 ? block->k - 2 + j : j, g));
  STEIF_TRY(integral(block, m, 0, false, j, &sum));
  for (int i = 0; i + 1 < block->k; i++)
    sum += (long double)sign(i) * block->c[i * block->k + m] * g[i + j];
  *value = (sunrealtype)sum;
  return STEIF_OK;
}

/* With d = x0 - x_s(0):
 *   E_1(R) = sum_q (q+1)/2 N^{q+1} d g^(q+1)(0) + int (x_s' - v/2) g
 *            - 1/2 sum_q N^{q+2} v'(0) g^(q)(0),
 *   E_1(P) = E_1(R) + <x, g'> + x0 g(0),
 * from expanding the symbol (sigma/s) (I + sigma N)^{-1}, sigma = (1 - e^{-sh})/h. */
int stf_block_first(stf_block *block, int m, enum steif_convention convention,
                    sunrealtype *value)
{
  const int k = block->k;
  long double sum, g[STF_DERIVATIVES];
  STEIF_TRY(at_zero(block, k, g));
  STEIF_TRY(integral(block, m, 1, true, 0, &sum));
  for (int q = 0; q + 1 < k; q++) /* c_q = (-1)^q N^{q+1} d */
    sum += (long double)sign(q) * (q + 1) / 2 * block->c[q * k + m] * g[q + 1];
  STEIF_TRY(stf_block_series(block, 0, 2, true, block->x));
  for (int q = 0; m + q + 2 < k; q++) sum -= (long double)block->x[m + q + 2] / 2 * g[q];
  if (convention == STEIF_P) {
    sunrealtype shifted;
    STEIF_TRY(stf_block_pair(block, m, 1, &shifted));
    sum += (long double)shifted + block->x0[m] * g[0];
  }
  *value = (sunrealtype)sum;
  return STEIF_OK;
}
