/* space.c: vector kernels.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "space.h"
#include "simd.h"
#include <math.h>

void stf_space_open(stf_space *space, N_Vector like)
{
  space->like = like;
  space->n = N_VGetLength(like);
  space->serial = N_VGetVectorID(like) == SUNDIALS_NVEC_SERIAL;
  space->rows = -1;
  if (space->serial ||
      (N_VGetVectorID(like) == SUNDIALS_NVEC_PARALLEL && like->ops->nvdotprodmultiallreduce))
    space->rows = stf_local_length(like);
  space->sums = NULL;
}

sunrealtype *stf_own_rows(N_Vector v, sunindextype *rows)
{
  static sunrealtype
    none; /* the array of a rank without rows: nothing is read or written there */
  *rows = stf_local_length(v);
  if (!v->ops->nvgetarraypointer) return NULL;
  return *rows > 0 ? N_VGetArrayPointer(v) : &none;
}

static inline bool local(const stf_space *space) { return space->rows >= 0; }

/* The components that are here, without a call for a serial vector. */
static inline sunrealtype *own(const stf_space *space, N_Vector v)
{
  return space->serial ? STF_ARRAY(v) : v->ops->nvgetarraypointer(v);
}

void stf_zero(const stf_space *space, N_Vector x)
{
  if (!local(space)) {
    N_VConst(0, x);
    return;
  }
  sunrealtype *a = own(space, x);
  for (sunindextype i = 0; i < space->rows; i++) a[i] = 0;
}

void stf_copy(const stf_space *space, N_Vector x, N_Vector y) { stf_scale(space, 1, x, y); }

void stf_scale(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y)
{
  if (!local(space)) {
    N_VScale(c, x, y);
    return;
  }
  const sunrealtype *a = own(space, x);
  sunrealtype *b = own(space, y);
  for (sunindextype i = 0; i < space->rows; i++) b[i] = c * a[i];
}

void stf_axpy(const stf_space *space, sunrealtype c, N_Vector x, N_Vector y)
{
  if (!local(space)) {
    N_VLinearSum(c, x, 1, y, y);
    return;
  }
  const sunrealtype *a = own(space, x);
  sunrealtype *b = own(space, y);
  for (sunindextype i = 0; i < space->rows; i++) b[i] += c * a[i];
}

void stf_sum(const stf_space *space, sunrealtype a, N_Vector x, sunrealtype b, N_Vector y,
             N_Vector z)
{
  if (!local(space)) {
    N_VLinearSum(a, x, b, y, z);
    return;
  }
  const sunrealtype *u = own(space, x), *v = own(space, y);
  sunrealtype *w = own(space, z);
  for (sunindextype i = 0; i < space->rows; i++) w[i] = a * u[i] + b * v[i];
}

void stf_by_component(const stf_space *space, N_Vector x, N_Vector y, N_Vector z)
{
  if (!local(space)) {
    N_VProd(x, y, z);
    return;
  }
  const sunrealtype *u = own(space, x), *v = own(space, y);
  sunrealtype *w = own(space, z);
  for (sunindextype i = 0; i < space->rows; i++) w[i] = u[i] * v[i];
}

/* Components are taken in blocks that stay in the first cache while the terms pass over them, four at
 * a time; each is the sum of its terms in their order, on every machine. Wider ones where every array is asked for. */
enum { BLOCK = 256, WIDE = 1024, TERMS = 4 };

INLINE void add_terms(int terms, const sunrealtype *f, const sunrealtype *const *a, int size,
                      sunrealtype *restrict sum)
{
  const sunrealtype *restrict a0 = a[0], *restrict a1 = a[1], *restrict a2 = a[2],
                              *restrict a3 = a[3];
  switch (terms) {
  case 1:
    for (int i = 0; i < size; i++) sum[i] += f[0] * a0[i];
    break;
  case 2:
    for (int i = 0; i < size; i++) sum[i] = sum[i] + f[0] * a0[i] + f[1] * a1[i];
    break;
  case 3:
    for (int i = 0; i < size; i++) sum[i] = sum[i] + f[0] * a0[i] + f[1] * a1[i] + f[2] * a2[i];
    break;
  case 4:
    for (int i = 0; i < size; i++)
      sum[i] = sum[i] + f[0] * a0[i] + f[1] * a1[i] + f[2] * a2[i] + f[3] * a3[i];
  }
}

INLINE void add_all(const stf_space *space, int count, const sunrealtype *c, N_Vector const *x,
                    sunindextype from, int size, sunrealtype *restrict sum)
{
  for (int j = 0; j < count;) {
    sunrealtype f[TERMS];
    const sunrealtype *a[TERMS] = {NULL};
    int terms = 0;
    for (; j < count && terms < TERMS; j++)
      if (c[j] != 0) f[terms] = c[j], a[terms++] = own(space, x[j]) + from;
    add_terms(terms, f, a, size, sum);
  }
}

#ifdef STF_SIMD_X86
__attribute__((target("avx2"))) static void add_all_avx2(const stf_space *space, int count,
                                                         const sunrealtype *c,
                                                         N_Vector const *x, sunindextype from,
                                                         int size, sunrealtype *sum)
{
  add_all(space, count, c, x, from, size, sum);
}
#endif

/* sum += the terms in components from .. from + size - 1. */
static void block_sum(const stf_space *space, int count, const sunrealtype *c,
                      N_Vector const *x, sunindextype from, int size, sunrealtype *sum)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() > 2) {
    add_all_avx2(space, count, c, x, from, size, sum);
    return;
  }
#endif
  add_all(space, count, c, x, from, size, sum);
}

/* Few components: four at a time in registers, the last one again where less are left; terms in the same
 * order, so the same bits. */
enum { FEW = 8, TOGETHER = 4 };

static void few_sums(const stf_space *space, int count, const sunrealtype *c, N_Vector const *x,
                     sunrealtype *out)
{
  const sunindextype n = space->rows;
  for (sunindextype i = 0; i < n; i += TOGETHER) {
    sunindextype at[TOGETHER];
    sunrealtype sum[TOGETHER] = {0};
    for (int q = 0; q < TOGETHER; q++) at[q] = i + q < n ? i + q : n - 1;
    for (int j = 0; j < count; j++) {
      const sunrealtype *from = own(space, x[j]);
      if (c[j] == 0) continue;
      for (int q = 0; q < TOGETHER; q++) sum[q] += c[j] * from[at[q]];
    }
    for (int q = 0; q < TOGETHER; q++) out[at[q]] = sum[q];
  }
}

/* Rows of a block one after another, so that its x are read from the first cache. */
static void mix_blocks(const stf_space *space, int rows, int columns, const sunrealtype *M,
                       N_Vector const *x, N_Vector *z, bool add)
{
  sunrealtype sum[WIDE];
  const int most = space->serial ? BLOCK : WIDE;
  for (sunindextype from = 0; from < space->rows; from += most) {
    const int size = space->rows - from < most ? (int)(space->rows - from) : most;
    for (int i = 0; i < rows; i++) {
      sunrealtype *out = own(space, z[i]) + from;
      for (int k = 0; k < size; k++) sum[k] = 0;
      block_sum(space, columns, M + i * columns, x, from, size, sum);
      for (int k = 0; k < size; k++) out[k] = add ? out[k] + sum[k] : sum[k];
    }
  }
}

void stf_combine(const stf_space *space, int count, const sunrealtype *c, N_Vector const *x,
                 N_Vector z)
{
  if (local(space) && space->rows <= FEW)
    few_sums(space, count, c, x, own(space, z));
  else if (local(space))
    mix_blocks(space, 1, count, c, x, &z, false);
  else if (count == 0)
    N_VConst(0, z);
  else
    N_VLinearCombination(count, (sunrealtype *)c, (N_Vector *)x, z);
}

void stf_mix(const stf_space *space, int rows, int columns, const sunrealtype *M,
             N_Vector const *x, N_Vector *z)
{
  if (local(space) && space->rows > FEW) {
    mix_blocks(space, rows, columns, M, x, z, false);
    return;
  }
  for (int i = 0; i < rows; i++) stf_combine(space, columns, M + i * columns, x, z[i]);
}

void stf_mix_add(const stf_space *space, int rows, int columns, const sunrealtype *M,
                 N_Vector const *x, N_Vector *z)
{
  if (local(space)) {
    mix_blocks(space, rows, columns, M, x, z, true);
    return;
  }
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) N_VLinearSum(M[i * columns + j], x[j], 1, z[i], z[i]);
}

/* sum x_i y_i of `size` components, in four partial sums, which do not wait for each other. */
static sunrealtype dot(sunindextype size, const sunrealtype *x, const sunrealtype *y)
{
  sunrealtype sum[4] = {0};
  sunindextype i = 0;
  for (; i + 4 <= size; i += 4)
    for (int k = 0; k < 4; k++) sum[k] += x[i + k] * y[i + k];
  for (; i < size; i++) sum[i % 4] += x[i] * y[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void stf_dots_here(const stf_space *space, int count, N_Vector x, N_Vector const *v,
                   sunrealtype *sums)
{
  for (int j = 0; j < count; j++) sums[j] = local(space) ? 0 : N_VDotProd(x, v[j]);
  for (sunindextype from = 0; from < space->rows; from += WIDE) {
    const sunindextype size = space->rows - from < WIDE ? space->rows - from : WIDE;
    const sunrealtype *y = own(space, x) + from;
    for (int j = 0; j < count; j++) sums[j] += dot(size, own(space, v[j]) + from, y);
  }
}

void stf_sum_up(const stf_space *space, int count, sunrealtype *sums)
{
  if (local(space) && !space->serial)
    space->like->ops->nvdotprodmultiallreduce(count, space->like, sums);
}

void stf_dots(const stf_space *space, int count, N_Vector x, N_Vector const *v,
              sunrealtype *sums)
{
  stf_count_sum(space);
  stf_dots_here(space, count, x, v, sums);
  stf_sum_up(space, count, sums);
}

/* sum (x_i w_i)^2 of the components that are here. */
static sunrealtype weighed_square(const stf_space *space, N_Vector x, N_Vector w)
{
  const sunrealtype *a = own(space, x), *b = own(space, w);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < space->rows; i++) {
    const sunrealtype p = a[i] * b[i];
    sum += p * p;
  }
  return sum;
}

sunrealtype stf_norm(const stf_space *space, N_Vector x, N_Vector w)
{
  sunrealtype norm;
  stf_norm_each(space, 1, &x, w, &norm);
  return norm;
}

/* One sum over the ranks for all, where the parts of it are known. */
void stf_norm_each(const stf_space *space, int count, N_Vector const *x, N_Vector w,
                   sunrealtype *norms)
{
  const N_Vector_Ops ops = w->ops;
  const bool known = !local(space) && ops->nvwsqrsumlocal && ops->nvdotprodmultiallreduce;
  stf_count_sum(space);
  for (int j = 0; j < count; j++)
    norms[j] = local(space) ? weighed_square(space, x[j], w)
               : known      ? N_VWSqrSumLocal(x[j], w)
                            : N_VWrmsNorm(x[j], w);
  if (known) ops->nvdotprodmultiallreduce(count, w, norms);
  stf_sum_up(space, count, norms);
  if (!known && !local(space)) return;
  for (int j = 0; j < count; j++) norms[j] = sqrt(norms[j] / (sunrealtype)space->n);
}

sunrealtype stf_norms(const stf_space *space, int count, N_Vector const *x, N_Vector w)
{
  enum { AT_ONCE = 32 };
  sunrealtype each[AT_ONCE], sum = 0;
  for (int from = 0; from < count; from += AT_ONCE) {
    const int some = count - from < AT_ONCE ? count - from : AT_ONCE;
    stf_norm_each(space, some, x + from, w, each);
    for (int j = 0; j < some; j++) sum += each[j] * each[j];
  }
  return sqrt(sum / count);
}

sunrealtype stf_max(const stf_space *space, N_Vector x)
{
  stf_count_sum(space);
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
  if (!local(space)) {
    N_VAbs(y, w);
    N_VScale(rtol, w, w);
    if (atols)
      N_VLinearSum(1, atols, 1, w, w);
    else
      N_VAddConst(w, atol, w);
    N_VInv(w, w);
    return;
  }
  const sunrealtype *a = own(space, y), *t = atols ? own(space, atols) : NULL;
  sunrealtype *b = own(space, w);
  for (sunindextype i = 0; i < space->rows; i++)
    b[i] = 1 / (rtol * fabs(a[i]) + (t ? t[i] : atol));
}

bool stf_finite(const stf_space *space, N_Vector x)
{
  stf_count_sum(space);
  if (!local(space)) {
    const sunrealtype square = N_VDotProd(x, x);
    return isfinite(square) || (!isnan(square) && isfinite(N_VMaxNorm(x)));
  }
  const sunrealtype *a = own(space, x);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < space->rows; i++) sum += a[i] * 0;
  stf_sum_up(space, 1, &sum);
  return sum == 0;
}

sunrealtype stf_power(sunrealtype x, sunrealtype p) { return powf((float)x, (float)p); }
