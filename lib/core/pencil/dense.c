/* dense.c: dense pencils. Up to n = 16 dense unrolled, real ones up to 64 with many zeros dense bit-set, the
 * others LAPACK; every slot keeps its factors, and E and A stay as they are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lapack.h"
#include "lu.h"
#include "pencil.h"
#include <limits.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

typedef struct factors {
  double *a; /* n^2 entries: split when small and complex, interleaved when large and complex */
  bool wide; /* room for complex entries */
  int *pivot;
  stf_bitset *bitset; /* NULL: not looked at */
  bool skips;         /* the factors in use are those of bitset */
} factors;

typedef struct dense {
  factors slot[STEIF_PENCIL_SLOTS];
} dense;

static int start(steif_pencil *p)
{
  STEIF_CHECK(
    p->n <= INT_MAX, p->ctx, STEIF_UNSUPPORTED,
    "a dense pencil of %lld unknowns is beyond LAPACK's integers: use sparse matrices",
    (long long)p->n);
  return p->n <= STF_UNROLLED ? STEIF_OK : stf_columns_open(p);
}

static int check(steif_pencil *p, const char *name, SUNMatrix M)
{
  for (sunindextype j = 0; j < p->n; j++) {
    const double *c = SM_COLUMN_D(M, j);
    if (stf_all_finite(c, (size_t)p->n)) continue;
    sunindextype i = 0;
    while (stf_all_finite(c + i, 1)) i++;
    return STEIF_FAIL(p->ctx, STEIF_NOT_FINITE,
                      "entry (%lld, %lld) of %s is %g: look at the function that fills it, "
                      "or whose differences do",
                      (long long)i + 1, (long long)j + 1, name, c[i]);
  }
  return STEIF_OK;
}

static int update(steif_pencil *p)
{
  if (p->E) STEIF_TRY(check(p, "E", p->E));
  return check(p, "A", p->A);
}

static int prepare(steif_pencil *p, int slot, steif_shift s)
{
  factors *f = &((dense *)p->state)->slot[slot];
  const size_t n = (size_t)p->n;
  const bool wide = stf_is_complex(s);
  if (!f->pivot && !(f->pivot = stf_allocate(p->ctx, n, sizeof(int)))) return STEIF_NO_MEMORY;
  if (!f->bitset && !wide && p->n > STF_UNROLLED && p->n <= STF_BITSET) {
    if (!(f->bitset = stf_bitset_new(p->ctx, (int)p->n))) return STEIF_NO_MEMORY;
  }
  if (f->a && (f->wide || !wide)) return STEIF_OK;
  stf_release(p->ctx, f->a);
  f->a = stf_allocate(p->ctx, n * n * (wide ? 2 : 1) + STF_UNROLLED_PAD, sizeof(double));
  f->wide = wide;
  return f->a ? STEIF_OK : STEIF_NO_MEMORY;
}

/* One column of re E - A and, `apart` doubles on, of im E; `step` doubles between entries. */
static void real_column(steif_pencil *p, sunindextype j, double s, double *restrict out)
{
  const double *restrict a = SM_COLUMN_D(p->A, j);
  if (p->E) {
    const double *restrict e = SM_COLUMN_D(p->E, j);
    for (sunindextype i = 0; i < p->n; i++) out[i] = s * e[i] - a[i];
  } else {
    for (sunindextype i = 0; i < p->n; i++) out[i] = -a[i];
    out[j] += s;
  }
}

static void imaginary_column(steif_pencil *p, sunindextype j, double s, double *restrict out)
{
  if (p->E) {
    const double *restrict e = SM_COLUMN_D(p->E, j);
    for (sunindextype i = 0; i < p->n; i++) out[i] = s * e[i];
  } else {
    memset(out, 0, (size_t)p->n * sizeof *out);
    out[j] = s;
  }
}

static void interleaved_column(steif_pencil *p, sunindextype j, steif_shift s,
                               double *restrict out)
{
  const double *restrict a = SM_COLUMN_D(p->A, j);
  if (p->E) {
    const double *restrict e = SM_COLUMN_D(p->E, j);
    for (sunindextype i = 0; i < p->n; i++)
      out[2 * i] = s.re * e[i] - a[i], out[2 * i + 1] = s.im * e[i];
  } else {
    for (sunindextype i = 0; i < p->n; i++) out[2 * i] = -a[i], out[2 * i + 1] = 0;
    out[2 * j] += s.re, out[2 * j + 1] = s.im;
  }
}

static void assemble(steif_pencil *p, steif_shift s, double *a)
{
  const sunindextype n = p->n;
  for (sunindextype j = 0; j < n; j++)
    if (!stf_is_complex(s))
      real_column(p, j, s.re, a + n * j);
    else if (n > STF_UNROLLED)
      interleaved_column(p, j, s, a + 2 * n * j);
    else
      real_column(p, j, s.re, a + n * j), imaginary_column(p, j, s.im, a + n * n + n * j);
}

static void factor(steif_pencil *p, int slot, steif_shift s, stf_outcome *out)
{
  factors *f = &((dense *)p->state)->slot[slot];
  const int n = (int)p->n;
  const bool complex = stf_is_complex(s);
  int info;
  assemble(p, s, f->a);
  if (!stf_all_finite(f->a, (size_t)n * (size_t)n * (complex ? 2 : 1))) {
    out->code = STEIF_NOT_FINITE;
    return;
  }
  f->skips = !complex && f->bitset && stf_bitset_look(f->bitset, f->a);
  if (f->skips)
    info = stf_bitset_factor(f->bitset, f->a);
  else if (n <= STF_UNROLLED)
    info = complex ? stf_unrolled_zfactor(n, f->a, f->a + n * n, f->pivot)
                   : stf_unrolled_factor(n, f->a, f->pivot);
  else
    (complex ? zgetrf_ : dgetrf_)(&n, &n, f->a, &n, f->pivot, &info);
  out->factors = 1;
  if (info) out->code = info > 0 ? STEIF_SINGULAR : STEIF_BAD_INPUT, out->column = info - 1;
}

static int columns(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  const factors *f = &((dense *)p->state)->slot[slot];
  const int n = (int)p->n, ldb = (int)ld;
  int info;
  for (int k = 0; k < nrhs && f->skips; k++) stf_bitset_solve(f->bitset, f->a, b + k * ld);
  if (f->skips) return STEIF_OK;
  (stf_is_complex(p->shift[slot]) ? zgetrs_ : dgetrs_)("N", &n, &nrhs, f->a, &n, f->pivot, b,
                                                       &ldb, &info, 1);
  return STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  if (p->n > STF_UNROLLED) return stf_columns(p, slot, nrhs, re, im, columns);
  const factors *f = &((dense *)p->state)->slot[slot];
  const int n = (int)p->n;
  for (int k = 0; k < nrhs; k++)
    if (im)
      stf_unrolled_zsolve(n, f->a, f->a + n * n, f->pivot, stf_array(re[k]), stf_array(im[k]));
    else
      stf_unrolled_solve(n, f->a, f->pivot, stf_array(re[k]));
  return STEIF_OK;
}

static int columns_transposed(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  const factors *f = &((dense *)p->state)->slot[slot];
  const bool complex = stf_is_complex(p->shift[slot]);
  const int n = (int)p->n, ldb = (int)ld;
  int info;
  for (int k = 0; k < nrhs && f->skips; k++)
    stf_bitset_solve_transposed(f->bitset, f->a, b + k * ld);
  if (f->skips) return STEIF_OK;
  (complex ? zgetrs_ : dgetrs_)(complex ? "C" : "T", &n, &nrhs, f->a, &n, f->pivot, b, &ldb,
                                &info, 1);
  return STEIF_OK;
}

static int transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  if (p->n > STF_UNROLLED) return stf_columns(p, slot, nrhs, re, im, columns_transposed);
  const factors *f = &((dense *)p->state)->slot[slot];
  const int n = (int)p->n;
  for (int k = 0; k < nrhs; k++)
    if (im)
      stf_unrolled_zsolve_transposed(n, f->a, f->a + n * n, f->pivot, stf_array(re[k]),
                                     stf_array(im[k]));
    else
      stf_unrolled_solve_transposed(n, f->a, f->pivot, stf_array(re[k]));
  return STEIF_OK;
}

static int product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  SUNMatrix M = which == 'E' ? p->E : p->A;
  const double *restrict from = stf_array(x);
  double *restrict to = stf_array(out);
  memset(to, 0, (size_t)p->n * sizeof *to);
  for (sunindextype j = 0; j < p->n; j++) {
    const double *restrict c = SM_COLUMN_D(M, j), t = from[j];
    for (sunindextype i = 0; i < p->n; i++) to[i] += c[i] * t;
  }
  return STEIF_OK;
}

/* Rows seen so far decide on later orders: they are kept whether the factors are in use or not. */
static void keep(steif_pencil *p, int slot, stf_image *m)
{
  factors *f = &((dense *)p->state)->slot[slot];
  const size_t n = (size_t)p->n, width = stf_is_complex(p->shift[slot]) ? 2 : 1;
  bool sets = f->bitset;
  STF_KEEP(m, sets);
  if (m->reads && sets && !f->bitset && !(f->bitset = stf_bitset_new(p->ctx, (int)p->n)))
    stf_image_stop(m, STEIF_NO_MEMORY);
  if (sets && f->bitset) stf_keep(m, f->bitset, stf_bitset_size());
  STF_KEEP(m, f->skips);
  if (!p->fresh[slot]) return;
  stf_keep(m, f->a, n * n * width * sizeof *f->a);
  stf_keep(m, f->pivot, n * sizeof *f->pivot);
}

/* A run that has gone back to an image may use fewer slots than have memory. */
static void finish(steif_pencil *p)
{
  dense *d = p->state;
  for (int k = 0; k < STEIF_PENCIL_SLOTS; k++) {
    stf_release(p->ctx, d->slot[k].a);
    stf_release(p->ctx, d->slot[k].pivot);
    stf_release(p->ctx, d->slot[k].bitset);
  }
}

const stf_backend stf_backend_dense = {
  .name = "dense",
  .size = sizeof(dense),
  .crowd = 200,
  .matrices = true,
  .open = start,
  .update = update,
  .prepare = prepare,
  .factor = factor,
  .solve = solve,
  .columns = columns,
  .transposed = transposed,
  .product = product,
  .keep = keep,
  .close = finish,
};
