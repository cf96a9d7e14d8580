/* rosenbrock_unrolled.c: factors and stages of Rosenbrock methods, once per number of unknowns and instruction set, so that
 * loops over unknowns unroll and the solution of a triangular system stays in registers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include <float.h>
#include <math.h>

struct stf_rosenbrock_kernels {
  int (*factor)(stf_rosenbrock *R, const double *J, double shift);
  void (*stage)(const stf_rosenbrock *R, const stf_rosenbrock_stage *g);
};

/* -- factor ------------------------------------------------------------------------------------ */

INLINE void assemble(stf_rosenbrock *R, const int n, const double *J, double shift)
{
  for (int i = 0; i < n * n; i++) R->lu[i] = (R->M ? shift * R->M[i] : 0) - J[i];
  for (int i = 0; !R->M && i < n; i++) R->lu[i + n * i] += shift;
}

/* The largest entry of column k to place k; its size. */
INLINE double pivot(stf_rosenbrock *R, const int n, const int k)
{
  double *a = R->lu, big = fabs(a[k + n * k]);
  int p = k;
  for (int i = k + 1; i < n; i++)
    if (fabs(a[i + n * k]) > big) big = fabs(a[i + n * k]), p = i;
  if (p == k) return big;
  const int row = R->order[k];
  R->order[k] = R->order[p], R->order[p] = row;
  for (int j = 0; j < n; j++) {
    const double t = a[k + n * j];
    a[k + n * j] = a[p + n * j], a[p + n * j] = t;
  }
  return big;
}

INLINE void eliminate(stf_rosenbrock *R, const int n, const double *J, double shift,
                      int *failed)
{
  double *a = R->lu;
  assemble(R, n, J, shift);
  for (int i = 0; i < n; i++) R->order[i] = i;
  for (int k = 0; k < n; k++) {
    if (!(pivot(R, n, k) >= DBL_MIN)) {
      *failed = k + 1;
      return;
    }
    const double d = R->pivot[k] = 1 / a[k + n * k];
    for (int i = k + 1; i < n; i++) a[i + n * k] *= d;
    for (int j = k + 1; j < n; j++) {
      const double x = a[k + n * j];
      for (int i = k + 1; i < n; i++) a[i + n * j] -= a[i + n * k] * x;
      a[k + n * j] = x * d;
    }
  }
}

/* -- stage --------------------------------------------------------------------------------------- */

/* x_i -= a_ik x_k for i in from .. to - 1. */
INLINE void subtract(const int n, const int k, const int from, const int to, const double *a,
                     double *x)
{
  for (int i = from; i < to; i++) x[i] -= a[i + n * k] * x[k];
}

/* Without a loop over k: with n constant every step is straight code, x stays in registers. */
INLINE void solve(const stf_rosenbrock *R, const int n, const double *b, double *x)
{
  const double *a = R->lu;
  for (int i = 0; i < n; i++) x[i] = b[R->order[i]];
  subtract(n, 0, 1, n, a, x);
  if (n > 2) subtract(n, 1, 2, n, a, x);
  if (n > 3) subtract(n, 2, 3, n, a, x);
  if (n > 4) subtract(n, 3, 4, n, a, x);
  if (n > 5) subtract(n, 4, 5, n, a, x);
  if (n > 6) subtract(n, 5, 6, n, a, x);
  if (n > 7) subtract(n, 6, 7, n, a, x);
  for (int i = 0; i < n; i++) x[i] *= R->pivot[i];
  if (n > 7) subtract(n, 7, 0, 7, a, x);
  if (n > 6) subtract(n, 6, 0, 6, a, x);
  if (n > 5) subtract(n, 5, 0, 5, a, x);
  if (n > 4) subtract(n, 4, 0, 4, a, x);
  if (n > 3) subtract(n, 3, 0, 3, a, x);
  if (n > 2) subtract(n, 2, 0, 2, a, x);
  if (n > 1) subtract(n, 1, 0, 1, a, x);
}

INLINE void combine(const int n, int count, const double *c, double *const *u, double *sum)
{
  for (int k = 0; k < n; k++) sum[k] = 0;
  for (int j = 0; j < count; j++)
    for (int k = 0; k < n; k++) sum[k] += c[j] * u[j][k];
}

INLINE void stage(const stf_rosenbrock *R, const int n, const stf_rosenbrock_stage *g)
{
  double b[STF_ROSENBROCK], x[STF_ROSENBROCK], sum[STF_ROSENBROCK];
  const double per = 1 / g->h;
  combine(n, g->i, g->c, g->u, sum);
  for (int k = 0; k < n; k++) b[k] = g->f[k];
  for (int k = 0; g->slope != 0 && k < n; k++) b[k] += g->slope * g->ft[k];
  if (!R->M)
    for (int k = 0; k < n; k++) b[k] += per * sum[k];
  for (int j = 0; R->M && j < n; j++)
    for (int k = 0; k < n; k++) b[k] += R->M[k + n * j] * (per * sum[j]);
  solve(R, n, b, x);
  for (int k = 0; k < n; k++) g->u[g->i][k] = x[k];
  if (!g->a) {
    for (int k = 0; k < n; k++) g->Y[k] += x[k];
    return;
  }
  combine(n, g->i + 1, g->a, g->u, sum);
  for (int k = 0; k < n; k++) g->Y[k] = g->y[k] + sum[k];
}

/* -- instances ----------------------------------------------------------------------------------- */

#define WITH_SIZES(body, ...)                                                                  \
  switch (R->n) {                                                                              \
  case 1: body(R, 1, __VA_ARGS__); break;                                                      \
  case 2: body(R, 2, __VA_ARGS__); break;                                                      \
  case 3: body(R, 3, __VA_ARGS__); break;                                                      \
  case 4: body(R, 4, __VA_ARGS__); break;                                                      \
  case 5: body(R, 5, __VA_ARGS__); break;                                                      \
  case 6: body(R, 6, __VA_ARGS__); break;                                                      \
  case 7: body(R, 7, __VA_ARGS__); break;                                                      \
  default: body(R, 8, __VA_ARGS__);                                                            \
  }

#define KERNELS(isa, attribute)                                                                \
  attribute static int factor_##isa(stf_rosenbrock *R, const double *J, double shift)          \
  {                                                                                            \
    int failed = 0;                                                                            \
    WITH_SIZES(eliminate, J, shift, &failed)                                                   \
    return failed;                                                                             \
  }                                                                                            \
  attribute static void stage_##isa(const stf_rosenbrock *R, const stf_rosenbrock_stage *g)    \
  {                                                                                            \
    WITH_SIZES(stage, g)                                                                       \
  }                                                                                            \
  static const struct stf_rosenbrock_kernels isa = {factor_##isa, stage_##isa};

KERNELS(plain, )
#ifdef STF_SIMD_X86
KERNELS(avx2, STF_AVX2)

static const struct stf_rosenbrock_kernels *best(void)
{
  return stf_simd_width() >= 4 ? &avx2 : &plain;
}
#else
static const struct stf_rosenbrock_kernels *best(void) { return &plain; }
#endif

void stf_rosenbrock_open(stf_rosenbrock *R, int n, const double *M)
{
  *R = (stf_rosenbrock){.kernels = best(), .n = n, .M = M};
}

int stf_rosenbrock_factor(stf_rosenbrock *R, const double *J, double shift)
{
  return R->kernels->factor(R, J, shift);
}

void stf_rosenbrock_solve(const stf_rosenbrock *R, const stf_rosenbrock_stage *g)
{
  R->kernels->stage(R, g);
}
