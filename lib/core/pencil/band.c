/* band.c: band pencils. Narrow ones go through band unblocked, wide ones through
 * LAPACK's band LU, in the same storage. The bandwidths are the larger ones of E and A; kl further
 * rows above take the fill of row exchanges.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lapack.h"
#include "lu.h"
#include "pencil.h"
#include <limits.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>

typedef struct factors {
  double *ab;
  bool wide; /* room for complex entries */
  int *pivot;
} factors;

typedef struct band {
  int kl, ku, ld;
  factors slot[STEIF_PENCIL_SLOTS];
} band;

static sunindextype larger(sunindextype x, sunindextype y) { return x > y ? x : y; }
static sunindextype smaller(sunindextype x, sunindextype y) { return x < y ? x : y; }

/* Rows from .. to of column j. */
static void rows(SUNMatrix M, sunindextype j, sunindextype *from, sunindextype *to)
{
  *from = larger(0, j - SM_UBAND_B(M));
  *to = smaller(SM_COLUMNS_B(M) - 1, j + SM_LBAND_B(M));
}

static int start(steif_pencil *p)
{
  band *b = p->state;
  sunindextype kl = SM_LBAND_B(p->A), ku = SM_UBAND_B(p->A);
  if (p->E) kl = larger(kl, SM_LBAND_B(p->E)), ku = larger(ku, SM_UBAND_B(p->E));
  STEIF_CHECK(p->n <= INT_MAX && 2 * kl + ku < INT_MAX, p->ctx, STEIF_UNSUPPORTED,
              "a band pencil of %lld unknowns and bandwidths %lld, %lld is beyond LAPACK's "
              "integers: use sparse matrices",
              (long long)p->n, (long long)kl, (long long)ku);
  b->kl = (int)kl, b->ku = (int)ku, b->ld = (int)(2 * kl + ku + 1);
  return stf_columns_open(p);
}

static int check(steif_pencil *p, const char *name, SUNMatrix M)
{
  for (sunindextype j = 0; j < p->n; j++) {
    sunindextype i, to;
    rows(M, j, &i, &to);
    const double *c = SM_COLUMN_B(M, j) - j;
    if (stf_all_finite(c + i, (size_t)(to - i + 1))) continue;
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
  band *b = p->state;
  factors *f = &b->slot[slot];
  const size_t n = (size_t)p->n;
  const bool wide = stf_is_complex(s);
  if (!f->pivot && !(f->pivot = stf_allocate(p->ctx, n, sizeof(int)))) return STEIF_NO_MEMORY;
  if (f->ab && (f->wide || !wide)) return STEIF_OK;
  stf_release(p->ctx, f->ab);
  f->ab = stf_allocate(p->ctx, n * (wide ? 2 : 1), (size_t)b->ld * sizeof(double));
  f->wide = wide;
  return f->ab ? STEIF_OK : STEIF_NO_MEMORY;
}

/* s E - A in LAPACK's storage: entry (i, j) at kl + ku + i - j of column j. */
static void assemble(steif_pencil *p, steif_shift s, double *ab)
{
  const band *b = p->state;
  const sunindextype w = stf_is_complex(s) ? 2 : 1;
  memset(ab, 0, (size_t)(p->n * w) * (size_t)b->ld * sizeof *ab);
  for (sunindextype j = 0; j < p->n; j++) {
    double *restrict out = ab + w * (j * b->ld + b->kl + b->ku);
    sunindextype i, to;
    rows(p->A, j, &i, &to);
    const double *restrict a = SM_COLUMN_B(p->A, j);
    for (; i <= to; i++) out[w * (i - j)] = -a[i - j];
    i = to = j;
    if (p->E) rows(p->E, j, &i, &to);
    const double one = 1, *restrict e = p->E ? SM_COLUMN_B(p->E, j) : &one;
    for (; i <= to; i++) {
      out[w * (i - j)] += s.re * e[i - j];
      if (w == 2) out[2 * (i - j) + 1] = s.im * e[i - j];
    }
  }
}

static void factor(steif_pencil *p, int slot, steif_shift s, stf_outcome *out)
{
  const band *b = p->state;
  const factors *f = &b->slot[slot];
  const int n = (int)p->n;
  const bool complex = stf_is_complex(s);
  int info;
  assemble(p, s, f->ab);
  if (!stf_all_finite(f->ab, (size_t)n * (size_t)b->ld * (complex ? 2 : 1))) {
    out->code = STEIF_NOT_FINITE;
    return;
  }
  if (b->kl + b->ku <= STF_BAND_UNBLOCKED)
    info = (int)(complex ? stf_band_zfactor : stf_band_factor)(&(stf_band){n, b->kl, b->ku},
                                                               f->ab, f->pivot);
  else
    (complex ? zgbtrf_ : dgbtrf_)(&n, &n, &b->kl, &b->ku, f->ab, &b->ld, f->pivot, &info);
  out->factors = 1;
  if (info) out->code = info > 0 ? STEIF_SINGULAR : STEIF_BAD_INPUT, out->column = info - 1;
}

static int columns(steif_pencil *p, int slot, int nrhs, double *x, sunindextype ld)
{
  const band *b = p->state;
  const factors *f = &b->slot[slot];
  const int n = (int)p->n, ldx = (int)ld;
  const bool complex = stf_is_complex(p->shift[slot]);
  int info;
  if (b->kl + b->ku <= STF_BAND_UNBLOCKED) {
    const stf_band size = {n, b->kl, b->ku};
    for (int k = 0; k < nrhs; k++)
      if (complex)
        stf_band_zsolve(&size, f->ab, f->pivot, x + 2 * k * ld);
      else
        stf_band_solve(&size, f->ab, f->pivot, x + k * ld);
    return STEIF_OK;
  }
  (complex ? zgbtrs_ : dgbtrs_)("N", &n, &b->kl, &b->ku, &nrhs, f->ab, &b->ld, f->pivot, x,
                                &ldx, &info, 1);
  return STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns);
}

static int columns_transposed(steif_pencil *p, int slot, int nrhs, double *x, sunindextype ld)
{
  const band *b = p->state;
  const factors *f = &b->slot[slot];
  const int n = (int)p->n, ldx = (int)ld;
  const bool complex = stf_is_complex(p->shift[slot]);
  int info;
  if (b->kl + b->ku <= STF_BAND_UNBLOCKED) {
    const stf_band size = {n, b->kl, b->ku};
    for (int k = 0; k < nrhs; k++)
      if (complex)
        stf_band_zsolve_transposed(&size, f->ab, f->pivot, x + 2 * k * ld);
      else
        stf_band_solve_transposed(&size, f->ab, f->pivot, x + k * ld);
    return STEIF_OK;
  }
  (complex ? zgbtrs_ : dgbtrs_)(complex ? "C" : "T", &n, &b->kl, &b->ku, &nrhs, f->ab, &b->ld,
                                f->pivot, x, &ldx, &info, 1);
  return STEIF_OK;
}

static int transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns_transposed);
}

static int product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  SUNMatrix M = which == 'E' ? p->E : p->A;
  const double *restrict v = stf_array(x);
  double *restrict to = stf_array(out);
  memset(to, 0, (size_t)p->n * sizeof *to);
  const sunindextype width = SM_LDIM_B(M), upper = SM_UBAND_B(M), lower = SM_LBAND_B(M);
  for (sunindextype d = -upper; d <= lower; d++) { /* diagonals: entries (j + d, j) */
    const double *restrict c = SM_DATA_B(M) + SM_SUBAND_B(M) + d;
    const sunindextype last = smaller(p->n, p->n - d);
    for (sunindextype j = larger(0, -d); j < last; j++) to[j + d] += c[j * width] * v[j];
  }
  return STEIF_OK;
}

static void keep(steif_pencil *p, int slot, stf_image *m)
{
  const band *b = p->state;
  const factors *f = &b->slot[slot];
  const size_t n = (size_t)p->n, width = stf_is_complex(p->shift[slot]) ? 2 : 1;
  if (!p->fresh[slot]) return;
  stf_keep(m, f->ab, n * width * (size_t)b->ld * sizeof *f->ab);
  stf_keep(m, f->pivot, n * sizeof *f->pivot);
}

static void finish(steif_pencil *p)
{
  band *b = p->state;
  for (int k = 0; k < STEIF_PENCIL_SLOTS; k++) {
    stf_release(p->ctx, b->slot[k].ab);
    stf_release(p->ctx, b->slot[k].pivot);
  }
}

const stf_backend stf_backend_band = {
  .name = "band",
  .size = sizeof(band),
  .crowd = 2000,
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
