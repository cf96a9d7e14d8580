/* incomplete.c: sparse pencils factored without fill, ILU(0) (J. A. Meijerink & H. A. van der Vorst,
 * Math. Comp. 31, 1977): L U agrees with s E - A on the pattern of the matrix and its diagonal, and
 * has no entries beside it. Solves are approximate: preconditioners.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sparse.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>

typedef struct place {
  int row, from; /* from: entry of the union, -1: a diagonal that is not in it */
} place;

typedef struct incomplete {
  stf_pattern pattern;
  int *ptr, *diagonal;              /* columns, rows ascending, and where their diagonals are */
  int *row, *from;                  /* of entries */
  int *at;                          /* scratch: where row i is in the column at hand, plus 1 */
  double *value;                    /* scratch: s E - A on the union */
  double *slot[STEIF_PENCIL_SLOTS]; /* L without its unit diagonal, U with its own inverted */
} incomplete;

static int start(steif_pencil *p) { return stf_columns_open(p); }

static void forget(steif_pencil *p)
{
  incomplete *s = p->state;
  for (int k = 0; k < STEIF_PENCIL_SLOTS; k++) stf_release(p->ctx, s->slot[k]);
  stf_release(p->ctx, s->ptr);
  stf_release(p->ctx, s->diagonal);
  stf_release(p->ctx, s->row);
  stf_release(p->ctx, s->from);
  stf_release(p->ctx, s->at);
  stf_release(p->ctx, s->value);
  stf_pattern_free(p, &s->pattern);
  *s = (incomplete){.ptr = NULL};
}

static int by_row(const void *a, const void *b)
{
  const int i = ((const place *)a)->row, j = ((const place *)b)->row;
  return (i > j) - (i < j);
}

/* Column j of the union in order, with its diagonal; returns where the next one begins. */
static int sort(incomplete *s, int j, int at, place *entry)
{
  const stf_pattern *u = &s->pattern;
  int count = 0;
  bool there = false;
  for (SuiteSparse_long k = u->ptr[j]; k < u->ptr[j + 1]; k++) {
    entry[count++] = (place){(int)u->row[k], (int)k};
    there |= u->row[k] == j;
  }
  if (!there) entry[count++] = (place){j, -1};
  qsort(entry, (size_t)count, sizeof *entry, by_row);
  for (int k = 0; k < count; k++) {
    s->row[at + k] = entry[k].row, s->from[at + k] = entry[k].from;
    if (entry[k].row == j) s->diagonal[j] = at + k;
  }
  return at + count;
}

static int allocate(steif_pencil *p, size_t n, size_t count)
{
  incomplete *s = p->state;
  s->ptr = stf_allocate(p->ctx, n + 1, sizeof *s->ptr);
  s->diagonal = stf_allocate(p->ctx, n, sizeof *s->diagonal);
  s->row = stf_allocate(p->ctx, count, sizeof *s->row);
  s->from = stf_allocate(p->ctx, count, sizeof *s->from);
  s->at = stf_allocate(p->ctx, n, sizeof *s->at);
  s->value = stf_allocate(p->ctx, count, sizeof *s->value);
  return s->ptr && s->diagonal && s->row && s->from && s->at && s->value ? STEIF_OK
                                                                         : STEIF_NO_MEMORY;
}

static int analyse(steif_pencil *p)
{
  incomplete *s = p->state;
  forget(p);
  STEIF_TRY(stf_pattern_build(p, &s->pattern));
  const long long n = p->n, most = s->pattern.nnz + n; /* each diagonal may be missing */
  STEIF_CHECK(most < INT_MAX, p->ctx, STEIF_UNSUPPORTED,
              "incomplete factors of %lld entries: up to %d are possible", most, INT_MAX);
  STEIF_TRY(allocate(p, (size_t)n, (size_t)most));
  place *entry = stf_allocate(p->ctx, (size_t)n + 1, sizeof *entry);
  if (!entry) return STEIF_NO_MEMORY;
  for (int j = 0; j < n; j++) s->ptr[j + 1] = sort(s, j, s->ptr[j], entry);
  stf_release(p->ctx, entry);
  p->stats.analyses++;
  return STEIF_OK;
}

static int update(steif_pencil *p)
{
  incomplete *s = p->state;
  return stf_pattern_update(p, &s->pattern, s->ptr, analyse, forget);
}

static int prepare(steif_pencil *p, int slot, steif_shift shift)
{
  incomplete *s = p->state;
  STEIF_CHECK(!stf_is_complex(shift), p->ctx, STEIF_UNSUPPORTED,
              "incomplete factors are for real shifts, not for %g%+gi", shift.re, shift.im);
  if (s->slot[slot]) return STEIF_OK;
  s->slot[slot] = stf_allocate(p->ctx, (size_t)s->ptr[p->n], sizeof *s->slot[slot]);
  return s->slot[slot] ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Column j of L and U from the columns before it; false without a pivot. */
static bool eliminate(incomplete *s, double *restrict v, int j)
{
  const int *restrict row = s->row;
  const int begin = s->ptr[j], diagonal = s->diagonal[j], end = s->ptr[j + 1];
  double most = 0;
  for (int k = begin; k < end; k++) {
    v[k] = s->from[k] < 0 ? 0 : s->value[s->from[k]];
    most = fmax(most, fabs(v[k]));
    s->at[row[k]] = k + 1;
  }
  for (int k = begin; k < diagonal; k++) {
    const int before = row[k];
    for (int l = s->diagonal[before] + 1; l < s->ptr[before + 1]; l++) {
      const int at = s->at[row[l]];
      if (at) v[at - 1] -= v[l] * v[k];
    }
  }
  for (int k = begin; k < end; k++) s->at[row[k]] = 0;
  if (!(fabs(v[diagonal]) > STF_EPS * most) || !isfinite(v[diagonal])) return false;
  v[diagonal] = 1 / v[diagonal];
  for (int k = diagonal + 1; k < end; k++) v[k] *= v[diagonal];
  return true;
}

static void factor(steif_pencil *p, int slot, steif_shift shift, stf_outcome *out)
{
  incomplete *s = p->state;
  stf_pattern_assemble(p, &s->pattern, shift, s->value);
  if (!stf_all_finite(s->value, (size_t)s->pattern.nnz)) {
    out->code = STEIF_NOT_FINITE;
    return;
  }
  out->factors = 1, out->fill = s->ptr[p->n];
  for (int j = 0; j < p->n; j++)
    if (!eliminate(s, s->slot[slot], j)) {
      out->code = STEIF_SINGULAR, out->column = j;
      return;
    }
}

static void substitute(const incomplete *s, const double *restrict v, int n, double *restrict b)
{
  const int *restrict row = s->row;
  for (int j = 0; j < n; j++)
    for (int k = s->diagonal[j] + 1; k < s->ptr[j + 1]; k++) b[row[k]] -= v[k] * b[j];
  for (int j = n; j-- > 0;) {
    b[j] *= v[s->diagonal[j]];
    for (int k = s->ptr[j]; k < s->diagonal[j]; k++) b[row[k]] -= v[k] * b[j];
  }
}

static int columns(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  const incomplete *s = p->state;
  for (int i = 0; i < nrhs; i++) substitute(s, s->slot[slot], (int)p->n, b + i * ld);
  return STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns);
}

/* U^T from the first column on, L^T from the last. */
static void substitute_transposed(const incomplete *s, const double *restrict v, int n,
                                  double *restrict b)
{
  for (int j = 0; j < n; j++) {
    for (int k = s->ptr[j]; k < s->diagonal[j]; k++) b[j] -= v[k] * b[s->row[k]];
    b[j] *= v[s->diagonal[j]];
  }
  for (int j = n; j-- > 0;)
    for (int k = s->diagonal[j] + 1; k < s->ptr[j + 1]; k++) b[j] -= v[k] * b[s->row[k]];
}

static int columns_transposed(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  const incomplete *s = p->state;
  for (int i = 0; i < nrhs; i++) substitute_transposed(s, s->slot[slot], (int)p->n, b + i * ld);
  return STEIF_OK;
}

static int transposed(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns_transposed);
}

static void keep(steif_pencil *p, int slot, stf_image *m)
{
  const incomplete *s = p->state;
  if (p->fresh[slot]) stf_keep(m, s->slot[slot], (size_t)s->ptr[p->n] * sizeof **s->slot);
}

static void finish(steif_pencil *p) { forget(p); }

const stf_backend stf_backend_incomplete = {
  .name = "incomplete",
  .size = sizeof(incomplete),
  .matrices = true,
  .open = start,
  .update = update,
  .prepare = prepare,
  .factor = factor,
  .solve = solve,
  .transposed = transposed,
  .product = stf_sparse_product,
  .keep = keep,
  .close = finish,
};
