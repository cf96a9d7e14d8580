/* space.c: vector kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "space.h"
#include <math.h>

void stf_space_open(stf_space *space, N_Vector like)
{
  space->like = like;
  space->n = N_VGetLength(like);
  space->serial = N_VGetVectorID(like) == SUNDIALS_NVEC_SERIAL;
}

void stf_zero(const stf_space *space, N_Vector x)
{
  if (!space->serial) {
    N_VConst(0, x);
    return;
  }
  sunrealtype *a = STF_ARRAY(x);
  for (sunindextype i = 0; i < space->n; i++) a[i] = 0;
}

void stf_copy(const stf_space *space, N_Vector x, N_Vector y) { stf_scale(space, 1, x, y); }

void stf_scale(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y)
{
  if (!space->serial) {
    N_VScale(c, x, y);
    return;
  }
  const sunrealtype *a = STF_ARRAY(x);
  sunrealtype *b = STF_ARRAY(y);
  for (sunindextype i = 0; i < space->n; i++) b[i] = c * a[i];
}

void stf_axpy(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y)
{
  if (!space->serial) {
    N_VLinearSum(c, x, 1, y, y);
    return;
  }
  const sunrealtype *a = STF_ARRAY(x);
  sunrealtype *b = STF_ARRAY(y);
  for (sunindextype i = 0; i < space->n; i++) b[i] += c * a[i];
}

void stf_sum(const stf_space *space, sunrealtype a, N_Vector x, sunrealtype b, N_Vector y,
             N_Vector z)
{
  if (!space->serial) {
    N_VLinearSum(a, x, b, y, z);
    return;
  }
  const sunrealtype *u = STF_ARRAY(x), *v = STF_ARRAY(y);
  sunrealtype *w = STF_ARRAY(z);
  for (sunindextype i = 0; i < space->n; i++) w[i] = a * u[i] + b * v[i];
}

/* Components are taken in blocks that stay in the first cache while the terms pass over them. */
enum { BLOCK = 256 };

static void block_sum(int count, const sunrealtype *c, N_Vector *x, sunindextype from,
                      sunindextype size, sunrealtype *restrict sum)
{
  for (sunindextype i = 0; i < size; i++) sum[i] = 0;
  for (int j = 0; j < count; j++) {
    const sunrealtype *a = STF_ARRAY(x[j]) + from, f = c[j];
    if (f == 0) continue;
    for (sunindextype i = 0; i < size; i++) sum[i] += f * a[i];
  }
}

/* Few components: one after another in a register; terms in the same order, so the same bits. */
enum { FEW = 8 };

static void few_sums(sunindextype n, int count, const sunrealtype *c, N_Vector *x,
                     sunrealtype *out)
{
  for (sunindextype i = 0; i < n; i++) {
    sunrealtype sum = 0;
    for (int j = 0; j < count; j++)
      if (c[j] != 0) sum += c[j] * STF_ARRAY(x[j])[i];
    out[i] = sum;
  }
}

static sunindextype block_size(sunindextype n, sunindextype from)
{
  return n - from < BLOCK ? n - from : BLOCK;
}

void stf_combine(const stf_space *space, int count, const sunrealtype *c, N_Vector *x,
                 N_Vector z)
{
  if (!space->serial) {
    if (count == 0)
      N_VConst(0, z);
    else
      N_VLinearCombination(count, (sunrealtype *)c, x, z);
    return;
  }
  sunrealtype sum[BLOCK], *out = STF_ARRAY(z);
  if (space->n <= FEW) {
    few_sums(space->n, count, c, x, out);
    return;
  }
  for (sunindextype from = 0; from < space->n; from += BLOCK) {
    const sunindextype size = block_size(space->n, from);
    block_sum(count, c, x, from, size, sum);
    for (sunindextype i = 0; i < size; i++) out[from + i] = sum[i];
  }
}

void stf_mix(const stf_space *space, int rows, int columns, const sunrealtype *M, N_Vector *x,
             N_Vector *z)
{
  for (int i = 0; i < rows; i++) stf_combine(space, columns, M + i * columns, x, z[i]);
}

static void combine_add(const stf_space *space, int count, const sunrealtype *c, N_Vector *x,
                        N_Vector z)
{
  if (!space->serial) {
    for (int j = 0; j < count; j++) N_VLinearSum(c[j], x[j], 1, z, z);
    return;
  }
  sunrealtype sum[BLOCK], *out = STF_ARRAY(z);
  for (sunindextype from = 0; from < space->n; from += BLOCK) {
    const sunindextype size = block_size(space->n, from);
    block_sum(count, c, x, from, size, sum);
    for (sunindextype i = 0; i < size; i++) out[from + i] += sum[i];
  }
}

void stf_mix_add(const stf_space *space, int rows, int columns, const sunrealtype *M,
                 N_Vector *x, N_Vector *z)
{
  for (int i = 0; i < rows; i++) combine_add(space, columns, M + i * columns, x, z[i]);
}

sunrealtype stf_norm(const stf_space *space, N_Vector x, N_Vector w)
{
  if (!space->serial) return N_VWrmsNorm(x, w);
  const sunrealtype *a = STF_ARRAY(x), *b = STF_ARRAY(w);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < space->n; i++) {
    const sunrealtype p = a[i] * b[i];
    sum += p * p;
  }
  return sqrt(sum / (sunrealtype)space->n);
}

sunrealtype stf_max(const stf_space *space, N_Vector x)
{
  if (!space->serial) return N_VMaxNorm(x);
  const sunrealtype *a = STF_ARRAY(x);
  sunrealtype most = 0;
  for (sunindextype i = 0; i < space->n; i++) {
    const sunrealtype p = fabs(a[i]);
    if (p > most || isnan(p)) most = p; /* once NaN, no p is larger */
  }
  return most;
}

void stf_weights(const stf_space *space, sunrealtype rtol, sunrealtype atol, N_Vector atols,
                 N_Vector y, N_Vector w)
{
  if (!space->serial) {
    N_VAbs(y, w);
    N_VScale(rtol, w, w);
    if (atols)
      N_VLinearSum(1, atols, 1, w, w);
    else
      N_VAddConst(w, atol, w);
    N_VInv(w, w);
    return;
  }
  const sunrealtype *a = STF_ARRAY(y), *t = atols ? STF_ARRAY(atols) : NULL;
  sunrealtype *b = STF_ARRAY(w);
  for (sunindextype i = 0; i < space->n; i++)
    b[i] = 1 / (rtol * fabs(a[i]) + (t ? t[i] : atol));
}

bool stf_finite(const stf_space *space, N_Vector x)
{
  if (!space->serial) {
    const sunrealtype square = N_VDotProd(x, x);
    return isfinite(square) || (!isnan(square) && isfinite(N_VMaxNorm(x)));
  }
  const sunrealtype *a = STF_ARRAY(x);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < space->n; i++) sum += a[i] * 0;
  return sum == 0;
}

sunrealtype stf_power(sunrealtype x, sunrealtype p) { return powf((float)x, (float)p); }
