/* interleaved.c: factors and iterations of all shifts. The loops over lanes and stages have constant length in each
 * instance, so that a compiler keeps them in vector registers; where the compiler can, the kernels
 * exist once per instruction set and the processor decides when a solver is opened.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "interleaved_sparse.h"
#include "table.h"
#include <float.h>
#include <math.h>

struct stf_interleaved_kernels {
  int (*factor)(stf_shifts *L, const double *J, double h);
  void (*begin)(stf_shifts *L, int count, const double *a, const double *x, const double *y);
  double (*sweep)(stf_shifts *L, const double *y, const double *weight, double h);
  void (*end)(stf_shifts *L);
  void (*keep)(stf_shifts *L, const double *K, double *a);
  void (*filter)(stf_shifts *L, double *x);
  void (*solve_sparse)(stf_shifts *L, double *rhs, double *x);
};

/* Call body(L, n, lanes, ...) with constants for common sizes. */
#define WITH_LANES(body, n, ...)                                                               \
  switch (L->lanes) {                                                                          \
  case 1: body(L, n, 1, __VA_ARGS__); break;                                                   \
  case 2: body(L, n, 2, __VA_ARGS__); break;                                                   \
  case 4: body(L, n, 4, __VA_ARGS__); break;                                                   \
  default: body(L, n, 8, __VA_ARGS__);                                                         \
  }
#define WITH_SIZES(body, ...)                                                                  \
  switch (L->face.n) {                                                                         \
  case 2: WITH_LANES(body, 2, __VA_ARGS__) break;                                              \
  case 3: WITH_LANES(body, 3, __VA_ARGS__) break;                                              \
  default: WITH_LANES(body, L->face.n, __VA_ARGS__)                                            \
  }

/* -- factor ------------------------------------------------------------------------------------ */

/* lambda/h M - J by columns, all lanes. */
INLINE void assemble(stf_shifts *L, const int n, const int lanes, const double *J, double h)
{
  double s[2 * STF_INTERLEAVED_LANES];
  for (int k = 0; k < 2 * lanes; k++) s[k] = L->lambda[k] / h;
  for (int j = 0; j < n; j++)
    for (int i = 0; i < n; i++) {
      const double m = L->M ? L->M[i * n + j] : i == j, a = J[i + n * j];
      double *e = L->lu + (j * n + i) * 2 * lanes;
      for (int k = 0; k < lanes; k++) e[k] = s[k] * m - a, e[lanes + k] = s[lanes + k] * m;
    }
}

/* Bring the row with the largest entry of lane 0 to place k. */
INLINE double pivot(stf_shifts *L, const int n, const int lanes, int k)
{
  double *a = L->lu, big = -1;
  int p = k;
  for (int i = k; i < n; i++) {
    const double *e = a + (k * n + i) * 2 * lanes, size = fabs(e[0]) + fabs(e[lanes]);
    if (size > big) big = size, p = i;
  }
  if (p == k) return big;
  const int row = L->order[k];
  L->order[k] = L->order[p], L->order[p] = row;
  for (int j = 0; j < n; j++) {
    double *x = a + (j * n + k) * 2 * lanes, *y = a + (j * n + p) * 2 * lanes;
    for (int m = 0; m < 2 * lanes; m++) {
      const double t = x[m];
      x[m] = y[m], y[m] = t;
    }
  }
  return big;
}

INLINE void eliminate(stf_shifts *L, const int n, const int lanes, const double *J, double h,
                      int *failed)
{
  assemble(L, n, lanes, J, h);
  for (int i = 0; i < n; i++) L->order[i] = i;
  for (int k = 0; k < n; k++) {
    if (!(pivot(L, n, lanes, k) >= DBL_MIN)) {
      *failed = k + 1;
      return;
    }
    double *column = L->lu + k * n * 2 * lanes, *d = column + k * 2 * lanes;
    reciprocal(lanes, d);
    for (int i = k + 1; i < n; i++) times(lanes, column + i * 2 * lanes, d);
    for (int j = k + 1; j < n; j++) {
      double *other = L->lu + j * n * 2 * lanes;
      subtract(lanes, k + 1, n, column, other + k * 2 * lanes, other);
    }
  }
}

/* -- solve --------------------------------------------------------------------------------------- */

/* x from rhs, which is scratch, by the LU: forward in the order of elimination, then backward, by
 * columns. */
INLINE void solve(stf_shifts *L, const int n, const int lanes, double *restrict rhs,
                  double *restrict x)
{
  if (L->sparse) {
    L->kernels->solve_sparse(L, rhs, x);
    return;
  }
  for (int i = 0; i < n; i++) {
    const double *b = rhs + L->order[i] * 2 * lanes;
    for (int k = 0; k < 2 * lanes; k++) x[i * 2 * lanes + k] = b[k];
  }
  for (int j = 0; j < n - 1; j++)
    subtract(lanes, j + 1, n, L->lu + j * n * 2 * lanes, x + j * 2 * lanes, x);
  for (int j = n - 1; j >= 0; j--) {
    const double *column = L->lu + j * n * 2 * lanes;
    times(lanes, x + j * 2 * lanes, column + j * 2 * lanes);
    subtract(lanes, 0, j, column, x + j * 2 * lanes, x);
  }
}

/* Stage vector of component i: Z = V omega, Y = y + Z. */
INLINE void stages(stf_shifts *L, const int n, const int lanes, const int wide, const double *y)
{
  const int s = L->face.s;
  for (int i = 0; i < n; i++) {
    double z[STF_INTERLEAVED_STAGES] = {0};
    const double *w = L->omega + i * 2 * lanes;
    for (int k = 0; k < 2 * lanes; k++) add(wide / 2, z, L->V[k], w[k]);
    for (int j = 0; j < s; j++) L->face.Y[j * n + i] = y[i] + z[j];
  }
}

#define WITH_WIDE(body, ...)                                                                   \
  if (L->face.wide == 4)                                                                       \
    body(L, n, lanes, 4, __VA_ARGS__);                                                         \
  else if (L->face.wide == 8)                                                                  \
    body(L, n, lanes, 8, __VA_ARGS__);                                                         \
  else                                                                                         \
    body(L, n, lanes, 16, __VA_ARGS__);

/* rhs_k = [V^{-1} F]_k - lambda_k/h (M omega)_k. */
INLINE void right_sides(stf_shifts *L, const int n, const int lanes, double h)
{
  double s[2 * STF_INTERLEAVED_LANES];
  for (int k = 0; k < 2 * lanes; k++) s[k] = L->lambda[k] / h;
  for (int i = 0; i < n; i++) {
    double r[2 * STF_INTERLEAVED_LANES] = {0}, m[2 * STF_INTERLEAVED_LANES] = {0};
    for (int j = 0; j < L->face.s; j++) {
      const double f = L->face.F[j * n + i];
      add(lanes, r, L->Vinv[j], f);
    }
    if (L->M) {
      for (int j = 0; j < n && !L->face.residuals; j++) {
        const double e = L->M[i * n + j];
        if (e == 0) continue;
        for (int k = 0; k < 2 * lanes; k++) m[k] += e * L->omega[j * 2 * lanes + k];
      }
    } else
      for (int k = 0; k < 2 * lanes; k++) m[k] = L->omega[i * 2 * lanes + k];
    minus(lanes, r, s, m);
    for (int k = 0; k < 2 * lanes; k++) L->rhs[i * 2 * lanes + k] = r[k];
  }
}

INLINE void sweep(stf_shifts *L, const int n, const int lanes, const double *y,
                  const double *weight, double h, double *sum)
{
  double total[STF_INTERLEAVED_LANES] = {0};
  right_sides(L, n, lanes, h);
  solve(L, n, lanes, L->rhs, L->work);
  for (int i = 0; i < n; i++) {
    const double *d = L->work + i * 2 * lanes, u = weight[i];
    double *w = L->omega + i * 2 * lanes;
    for (int k = 0; k < lanes; k++) {
      const double re = u * d[k], im = u * d[lanes + k];
      total[k] += re * re + im * im;
    }
    for (int k = 0; k < 2 * lanes; k++) w[k] += d[k];
  }
  WITH_WIDE(stages, y)
  for (int k = 0; k < lanes; k++) *sum += L->gain[k] * total[k];
}

INLINE void predicted(stf_shifts *L, const int n, const int lanes, const int wide, int count,
                      const double *a, const double *x, const double *y)
{
  for (int i = 0; i < n; i++) {
    double w[2 * STF_INTERLEAVED_LANES] = {0}, *z = L->face.Z + i * wide;
    horner(wide / 2, count, a + i * wide, x, z);
    for (int j = 0; j < L->face.s; j++) {
      L->face.Y[j * n + i] = y[i] + z[j];
      add(lanes, w, L->Vinv[j], z[j]);
    }
    for (int k = 0; k < 2 * lanes; k++) L->omega[i * 2 * lanes + k] = w[k];
  }
}

INLINE void begin(stf_shifts *L, const int n, const int lanes, int count, const double *a,
                  const double *x, const double *y){WITH_WIDE(predicted, count, a, x, y)}

INLINE void last(stf_shifts *L, const int n, const int lanes, const int wide, int unused)
{
  (void)unused;
  for (int i = 0; i < n; i++) {
    double z[STF_INTERLEAVED_STAGES] = {0};
    const double *w = L->omega + i * 2 * lanes;
    for (int k = 0; k < 2 * lanes; k++) add(wide / 2, z, L->V[k], w[k]);
    for (int j = 0; j < wide; j++) L->face.Z[i * wide + j] = z[j];
  }
}

INLINE void end_of(stf_shifts *L, const int n, const int lanes,
                   int unused){WITH_WIDE(last, unused)}

INLINE void polynomial(stf_shifts *L, const int n, const int lanes, const int wide,
                       const double *K, double *a)
{
  (void)lanes;
  for (int i = 0; i < n; i++) {
    double c[STF_INTERLEAVED_STAGES] = {0};
    for (int j = 0; j < L->face.s; j++)
      add(wide / 2, c, K + j * STF_INTERLEAVED_STAGES, L->face.Z[i * wide + j]);
    for (int k = 0; k < wide; k++) a[i * wide + k] = c[k];
  }
}

INLINE void keep(stf_shifts *L, const int n, const int lanes, const double *K,
                 double *a){WITH_WIDE(polynomial, K, a)}

INLINE void filter(stf_shifts *L, const int n, const int lanes, double *x)
{
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 2 * lanes; k++) L->rhs[i * 2 * lanes + k] = k < lanes ? x[i] : 0;
  solve(L, n, lanes, L->rhs, L->work);
  const double im = L->lambda[lanes];
  for (int i = 0; i < n; i++)
    x[i] = im == 0 || L->face.whole ? L->work[i * 2 * lanes]
                                    : -L->lambda[0] / im * L->work[i * 2 * lanes + lanes];
}

/* -- instruction sets ----------------------------------------------------------------------------- */

/* The kernels once more for an instruction set. */
#define KERNELS(isa, attribute)                                                                \
  attribute static int factor_##isa(stf_shifts *L, const double *J, double h)                  \
  {                                                                                            \
    int failed = 0;                                                                            \
    if (L->sparse)                                                                             \
      WITH_LANES(eliminate_sparse, L->face.n, J, h, &failed)                                   \
    else                                                                                       \
      WITH_SIZES(eliminate, J, h, &failed)                                                     \
    return failed;                                                                             \
  }                                                                                            \
  attribute static void begin_##isa(stf_shifts *L, int count, const double *a,                 \
                                    const double *x, const double *y){                         \
    WITH_SIZES(begin, count, a, x,                                                             \
               y)} attribute static double sweep_##isa(stf_shifts *L, const double *y,         \
                                                       const double *weight, double h)         \
  {                                                                                            \
    double sum = 0;                                                                            \
    WITH_SIZES(sweep, y, weight, h, &sum)                                                      \
    return sum;                                                                                \
  }                                                                                            \
  attribute static void end_##isa(stf_shifts *L){WITH_SIZES(                                   \
    end_of, 0)} attribute static void keep_##isa(stf_shifts *L, const double *K, double *a)    \
  {                                                                                            \
    const int n = L->face.n;                                                                   \
    keep(L, n, 1, K, a);                                                                       \
  }                                                                                            \
  attribute static void filter_##isa(stf_shifts *L, double *x){WITH_SIZES(                     \
    filter, x)} attribute static void sparse_##isa(stf_shifts *L, double *rhs, double *x)      \
  {                                                                                            \
    WITH_LANES(solve_sparse, L->face.n, rhs, x)                                                \
  }                                                                                            \
  static const struct stf_interleaved_kernels isa = {factor_##isa, begin_##isa, sweep_##isa,   \
                                                     end_##isa,    keep_##isa,  filter_##isa,  \
                                                     sparse_##isa};

KERNELS(plain, )
#ifdef STF_SIMD_X86
KERNELS(avx2, STF_AVX2)
KERNELS(avx512, STF_AVX512)

static const struct stf_interleaved_kernels *best(void)
{
  return stf_simd_width() == 8 ? &avx512 : stf_simd_width() == 4 ? &avx2 : &plain;
}
#else
static const struct stf_interleaved_kernels *best(void) { return &plain; }
#endif

/* -- order ----------------------------------------------------------------------------------- */

/* Is it worth to skip the zeros of J, and in which order? */
enum { LEAST = 8 }; /* unknowns: below, loops over all entries are faster */

static void look(stf_shifts *L, const double *J)
{
  const int n = L->face.n;
  bool same = true;
  if (n < LEAST || L->full) return;
  for (int j = 0; j < n; j++) {
    uint64_t column = (uint64_t)1 << j;
    for (int i = 0; i < n; i++)
      column |= (uint64_t)(J[i + n * j] != 0 || (L->M && L->M[i * n + j] != 0)) << i;
    if (column & ~L->pattern[j]) same = false;
    L->pattern[j] |= column;
  }
  if (same) return;
  L->sparse = stf_bitset_order(n, L->pattern, L->column) <= STF_BITSET_FULL * n * n;
  L->full = !L->sparse;
}

/* -- what others call ------------------------------------------------------------------------------ */

static stf_shifts *inside(stf_interleaved *L) { return (stf_shifts *)L; }

int stf_interleaved_factor(stf_interleaved *L, const double *J, double h)
{
  look(inside(L), J);
  return inside(L)->kernels->factor(inside(L), J, h);
}

void stf_interleaved_begin(stf_interleaved *L, int count, const double *a, const double *x,
                           const double *y)
{
  inside(L)->kernels->begin(inside(L), count, a, x, y);
}

double stf_interleaved_sweep(stf_interleaved *L, const double *y, const double *weight,
                             double h)
{
  return inside(L)->kernels->sweep(inside(L), y, weight, h);
}

void stf_interleaved_end(stf_interleaved *L) { inside(L)->kernels->end(inside(L)); }

void stf_interleaved_keep(stf_interleaved *L, double (*K)[STF_INTERLEAVED_STAGES], double *a)
{
  inside(L)->kernels->keep(inside(L), K[0], a);
}

void stf_interleaved_filter(stf_interleaved *L, double *x)
{
  inside(L)->kernels->filter(inside(L), x);
}

/* -- open ------------------------------------------------------------------------------------------ */

static int padded(int count, int most)
{
  int size = 1;
  while (size < count && size < most) size *= 2;
  return size;
}

/* V^{-1} and V by lanes from the real T, Tinv of the split: omega_re and omega_im are rows of it. */
static void fill(const stf_transform *transform, stf_shifts *L)
{
  const int s = transform->s, lanes = L->lanes;
  for (int k = 0; k < lanes; k++) {
    const int lane = k < transform->shifts ? k : 0, row = transform->row[lane];
    const bool pair = transform->im[lane] != 0;
    L->lambda[k] = transform->re[lane], L->lambda[lanes + k] = transform->im[lane];
    L->gain[k] = k >= transform->shifts ? 0 : pair ? 4 : 1;
    for (int j = 0; j < s; j++) {
      L->Vinv[j][k] = transform->Tinv[row * s + j];
      L->Vinv[j][lanes + k] = pair ? transform->Tinv[(row + 1) * s + j] : 0;
      L->V[k][j] = k < transform->shifts ? transform->T[j * s + row] : 0;
      L->V[lanes + k][j] = k < transform->shifts && pair ? transform->T[j * s + row + 1] : 0;
    }
  }
}

static int allocate(stf_pool *pool, stf_shifts *L)
{
  const size_t n = (size_t)L->face.n, row = (size_t)(2 * L->lanes), s = (size_t)L->face.s;
  L->lu = stf_pool_array(pool, n * n * row, sizeof *L->lu);
  L->omega = stf_pool_array(pool, 3 * n * row, sizeof *L->omega);
  L->face.Z = stf_pool_array(pool, n * (size_t)L->face.wide, sizeof *L->face.Z);
  L->face.F = stf_pool_array(pool, 2 * n * s, sizeof *L->face.F);
  L->order = stf_pool_array(pool, n, sizeof *L->order);
  L->row = stf_pool_array(pool, n * n, sizeof *L->row);
  if (!L->lu || !L->omega || !L->face.Z || !L->face.F || !L->order || !L->row)
    return STEIF_NO_MEMORY;
  L->rhs = L->omega + n * row;
  L->work = L->rhs + n * row;
  L->face.Y = L->face.F + n * s;
  return STEIF_OK;
}

stf_interleaved *stf_interleaved_new(stf_pool *pool, const stf_transform *transform, int n,
                                     const double *M)
{
  stf_shifts *L = stf_pool_array(pool, 1, sizeof *L);
  if (!L) return NULL;
  L->face.n = n;
  L->face.s = transform->s;
  L->face.wide = transform->s <= 4 ? 4 : transform->s <= 8 ? 8 : 16;
  L->lanes = padded(transform->shifts, STF_INTERLEAVED_LANES);
  L->M = M;
  L->kernels = best();
  fill(transform, L);
  return allocate(pool, L) ? NULL : &L->face;
}
