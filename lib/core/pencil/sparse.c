/* sparse.c: sparse pencils through KLU (T. A. Davis & E. Palamadai Natarajan, ACM TOMS 37 (3),
 * 2010): one symbolic analysis (AMD ordering, block triangular form) for all shifts, real and
 * complex; new values are refactored with the pivots in use while these stay good. Real shifts of large
 * patterns go through dense blocks (multifrontal) as long as those find good pivots.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fill_order.h"
#include "sparse.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* The backward error of an LU is about STF_EPS over the reciprocal pivot growth. Pivots in use
 * are kept down to this growth, that is 11 digits, or while no more than SLACK worse than those
 * that pivoting itself found. */
#define GROWTH 1e-5
#define SLACK 1e-2

/* Pivots on the diagonal are taken down to this part of the largest of their column where many matrices
 * are to share them (as in other sparse codes; KLU's own 0.001 suits one matrix at a time). */
#define SHARED 0.1

enum { FRONTS = 200, DENSE = 12 }; /* unknowns, and flops per entry, from which on blocks pay */

typedef struct factors {
  klu_l_common common; /* one to a slot: slots are factored side by side */
  klu_l_numeric *numeric;
  bool complex;  /* the arithmetic of numeric */
  bool wide;     /* room for complex values */
  double growth; /* reciprocal, at the last factorisation with pivoting */
  double *value;
  double *block, *stack; /* fronts: factors and scratch; block NULL: not used here */
  int *pivot;
  bool by_fronts,
    rejected; /* the factors in use are those of the fronts; they cannot serve here */
} factors;

typedef struct sparse {
  stf_pattern pattern;
  klu_l_common common;
  klu_l_symbolic *symbolic;
  stf_multifrontal *fronts; /* NULL: none */
  bool fronts_chosen;       /* whether there are any */
  double *work;             /* of their solves */
  factors *slot[STEIF_PENCIL_SLOTS];
} sparse;

static void defaults(klu_l_common *c)
{
  klu_l_defaults(c);
  c->btf = 1;
  c->ordering = 0; /* AMD */
}

static int start(steif_pencil *p)
{
  sparse *s = p->state;
  defaults(&s->common);
  return stf_columns_open(p);
}

static void drop(factors *f)
{
  (f->complex ? klu_zl_free_numeric : klu_l_free_numeric)(&f->numeric, &f->common);
}

/* Forget what depends on the pattern. */
static void forget(steif_pencil *p)
{
  sparse *s = p->state;
  for (int k = 0; k < STEIF_PENCIL_SLOTS; k++) {
    if (!s->slot[k]) continue;
    drop(s->slot[k]);
    stf_release(p->ctx, s->slot[k]->value);
    stf_release(p->ctx, s->slot[k]->block);
    stf_release(p->ctx, s->slot[k]->stack);
    stf_release(p->ctx, s->slot[k]->pivot);
    stf_release(p->ctx, s->slot[k]);
    s->slot[k] = NULL;
  }
  klu_l_free_symbolic(&s->symbolic, &s->common);
  stf_pattern_free(p, &s->pattern);
  stf_multifrontal_free(p->ctx, &s->fronts);
  stf_release(p->ctx, s->work);
  s->work = NULL;
  s->fronts_chosen = false;
}

/* Would the work of factorisations pay for blocks, or for a better order? */
static bool heavy(const klu_l_symbolic *k)
{
  return k->est_flops < 0 || k->est_flops >= DENSE * (k->lnz + k->unz);
}

/* Nested dissection instead of minimum degree, where that is much work and KLU gets it. */
static void dissect(sparse *s)
{
  const stf_pattern *u = &s->pattern;
  klu_l_common with = s->common;
  with.ordering = 3, with.user_order = stf_fill_order_block;
  klu_l_symbolic *better = klu_l_analyze(u->n, u->ptr, u->row, &with);
  if (!better) return;
  klu_l_free_symbolic(&s->symbolic, &s->common);
  s->symbolic = better;
}

static int analyse(steif_pencil *p)
{
  sparse *s = p->state;
  stf_pattern *u = &s->pattern;
  forget(p);
  STEIF_TRY(stf_pattern_build(p, u));
  s->symbolic = klu_l_analyze(u->n, u->ptr, u->row, &s->common);
  const long long n = u->n, nnz = u->nnz;
  STEIF_CHECK(s->symbolic || s->common.status == KLU_INVALID, p->ctx, STEIF_NO_MEMORY,
              "no memory to analyse a pattern of %lld unknowns and %lld entries; make the "
              "problem smaller",
              n, nnz);
  STEIF_CHECK(
    s->symbolic, p->ctx, STEIF_BAD_INPUT,
    "KLU rejected the pattern of %lld unknowns and %lld entries: check the index arrays", n,
    nnz);
  if (p->many_shifts && heavy(s->symbolic)) dissect(s);
  p->stats.analyses++;
  return STEIF_OK;
}

static int update(steif_pencil *p)
{
  sparse *s = p->state;
  return stf_pattern_update(p, &s->pattern, s->symbolic, analyse, forget);
}

/* Fronts take over real shifts of large patterns, where an entry of the factors meets enough work to
 * pay for the blocks, unless the block triangular form that KLU finds or its unsymmetric pattern is
 * much sparser. */
static int choose_fronts(steif_pencil *p)
{
  sparse *s = p->state;
  const klu_l_symbolic *k = s->symbolic;
  if (p->n < FRONTS || p->n > INT_MAX / 2 || k->structural_rank < k->n) return STEIF_OK;
  if (!heavy(k)) return STEIF_OK;
  STEIF_TRY(stf_multifrontal_open(p->ctx, &s->pattern, &s->fronts));
  const stf_fronts_size size = stf_multifrontal_size(s->fronts);
  if (k->lnz >= 0 && (double)size.factors > 2 * (k->lnz + k->unz)) {
    stf_multifrontal_free(p->ctx, &s->fronts);
    return STEIF_OK;
  }
  s->work = stf_allocate(p->ctx, size.work, sizeof *s->work);
  return s->work ? STEIF_OK : STEIF_NO_MEMORY;
}

/* With the first real shift: circles of complex ones do without. */
static int open_fronts(steif_pencil *p)
{
  sparse *s = p->state;
  const int code = choose_fronts(p);
  s->fronts_chosen = code == STEIF_OK;
  if (code) stf_multifrontal_free(p->ctx, &s->fronts);
  return code;
}

static int prepare_fronts(steif_pencil *p, factors *f)
{
  const stf_fronts_size size = stf_multifrontal_size(((sparse *)p->state)->fronts);
  f->block = stf_allocate(p->ctx, size.factors, sizeof *f->block);
  f->stack = stf_allocate(p->ctx, size.stack, sizeof *f->stack);
  f->pivot = stf_allocate(p->ctx, size.pivots, sizeof *f->pivot);
  return f->block && f->stack && f->pivot ? STEIF_OK : STEIF_NO_MEMORY;
}

static int prepare(steif_pencil *p, int slot, steif_shift shift)
{
  sparse *s = p->state;
  factors *f = s->slot[slot];
  const size_t nnz = (size_t)s->pattern.nnz;
  const bool wide = stf_is_complex(shift);
  if (!f) {
    if (!(f = s->slot[slot] = stf_allocate(p->ctx, 1, sizeof *f))) return STEIF_NO_MEMORY;
    defaults(&f->common);
    if (p->many_shifts) f->common.tol = SHARED;
  }
  if (!wide && !s->fronts_chosen) STEIF_TRY(open_fronts(p));
  if (s->fronts && !wide && !f->block && !f->rejected) STEIF_TRY(prepare_fronts(p, f));
  if (f->value && (f->wide || !wide)) return STEIF_OK;
  stf_release(p->ctx, f->value);
  f->value = stf_allocate(p->ctx, nnz, (wide ? 2 : 1) * sizeof(double));
  f->wide = wide;
  return f->value ? STEIF_OK : STEIF_NO_MEMORY;
}

static double growth(sparse *s, factors *f)
{
  stf_pattern *u = &s->pattern;
  const SuiteSparse_long good = (f->complex ? klu_zl_rgrowth : klu_l_rgrowth)(
    u->ptr, u->row, f->value, s->symbolic, f->numeric, &f->common);
  return good ? f->common.rgrowth : 0;
}

static double least(const factors *f) { return fmin(GROWTH, SLACK * f->growth); }

/* New values with the old pivots; false when these have become bad. */
static bool refactor(const steif_pencil *p, sparse *s, factors *f)
{
  stf_pattern *u = &s->pattern;
  const SuiteSparse_long good = (f->complex ? klu_zl_refactor : klu_l_refactor)(
    u->ptr, u->row, f->value, s->symbolic, f->numeric, &f->common);
  if (!good || f->common.status != KLU_OK) return false;
  return p->keeps_pivots || growth(s, f) >= least(f);
}

static void judge(const sparse *s, const factors *f, stf_outcome *out)
{
  switch (f->common.status) {
  case KLU_OUT_OF_MEMORY:
  case KLU_TOO_LARGE: out->code = STEIF_NO_MEMORY; break;
  case KLU_SINGULAR: out->code = STEIF_SINGULAR; break;
  default: out->code = STEIF_BAD_INPUT;
  }
  out->column = (sunindextype)f->common.singular_col;
  if (s->symbolic->structural_rank < s->symbolic->n)
    out->rank = (sunindextype)s->symbolic->structural_rank;
}

static void full(const steif_pencil *p, sparse *s, factors *f, stf_outcome *out)
{
  stf_pattern *u = &s->pattern;
  f->numeric = (f->complex ? klu_zl_factor : klu_l_factor)(u->ptr, u->row, f->value,
                                                           s->symbolic, &f->common);
  out->factors = 1;
  if (!f->numeric || f->common.status != KLU_OK) {
    judge(s, f, out);
    drop(f);
  } else
    f->growth = p->keeps_pivots ? 1 : growth(s, f);
}

static void factor(steif_pencil *p, int slot, steif_shift shift, stf_outcome *out)
{
  sparse *s = p->state;
  factors *f = s->slot[slot];
  const bool complex = stf_is_complex(shift);
  stf_pattern_assemble(p, &s->pattern, shift, f->value);
  if (!stf_pattern_moderate(&s->pattern, shift) &&
      !stf_all_finite(f->value, (size_t)s->pattern.nnz * (complex ? 2 : 1))) {
    out->code = STEIF_NOT_FINITE;
    return;
  }
  const bool before = f->by_fronts;
  if (!complex && f->block && !f->rejected) {
    f->by_fronts = stf_multifrontal_factor(s->fronts, f->value, f->block, f->pivot, f->stack);
    f->rejected = !f->by_fronts;
    out->factors = !before, out->refactors = before,
    out->fill = (long)stf_multifrontal_size(s->fronts).factors;
    if (f->by_fronts) return;
    out->factors = out->refactors = 0;
  }
  f->by_fronts = false;
  if (f->numeric && f->complex != complex) drop(f);
  f->complex = complex;
  if (f->numeric && refactor(p, s, f))
    out->refactors = 1;
  else {
    out->fallbacks = f->numeric != NULL;
    drop(f);
    full(p, s, f, out);
  }
  if (f->numeric)
    out->fill = f->numeric->lnz + f->numeric->unz - s->pattern.n + f->numeric->nzoff;
}

static int columns(steif_pencil *p, int slot, int nrhs, double *b, sunindextype ld)
{
  sparse *s = p->state;
  factors *f = s->slot[slot];
  if (f->by_fronts) {
    stf_multifrontal_solve(s->fronts, f->block, f->pivot, nrhs, b, ld, s->work);
    return STEIF_OK;
  }
  (f->complex ? klu_zl_solve : klu_l_solve)(s->symbolic, f->numeric, ld, nrhs, b, &f->common);
  return STEIF_OK;
}

static int solve(steif_pencil *p, int slot, int nrhs, N_Vector *re, N_Vector *im)
{
  return stf_columns(p, slot, nrhs, re, im, columns);
}

void stf_sparse_direct(steif_pencil *p, int slot, double *b) { columns(p, slot, 1, b, p->n); }

const stf_pattern *stf_sparse_pattern(const steif_pencil *p)
{
  return &((const sparse *)p->state)->pattern;
}

const double *stf_sparse_values(const steif_pencil *p, int slot)
{
  return ((const sparse *)p->state)->slot[slot]->value;
}

klu_l_symbolic *stf_sparse_symbolic(const steif_pencil *p)
{
  return ((const sparse *)p->state)->symbolic;
}

klu_l_numeric *stf_sparse_factors(const steif_pencil *p, int slot)
{
  return ((const sparse *)p->state)->slot[slot]->numeric;
}

void stf_sparse_drop(steif_pencil *p, int slot)
{
  drop(((sparse *)p->state)->slot[slot]);
  p->fresh[slot] = false;
}

double stf_sparse_growth(const steif_pencil *p, int slot)
{
  return least(((const sparse *)p->state)->slot[slot]);
}

stf_sparse_blocks stf_sparse_fronts(const steif_pencil *p, int slot)
{
  const sparse *s = p->state;
  const factors *f = s->slot[slot];
  return (stf_sparse_blocks){f->by_fronts ? s->fronts : NULL, f->block, f->pivot, s->work};
}

int stf_sparse_product(steif_pencil *p, char which, N_Vector x, N_Vector out)
{
  SUNMatrix M = which == 'E' ? p->E : p->A;
  const sunindextype *restrict ptr = SM_INDEXPTRS_S(M), *restrict row = SM_INDEXVALS_S(M);
  const double *restrict value = SM_DATA_S(M), *restrict from = stf_array(x);
  double *restrict to = stf_array(out);
  memset(to, 0, (size_t)p->n * sizeof *to);
  for (sunindextype j = 0; j < p->n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) to[row[k]] += value[k] * from[j];
  return STEIF_OK;
}

/* What prepare has made in the run that was saved: blocks of a slot that has been real, too. */
static void keep_shape(steif_pencil *p, factors *f, stf_image *m)
{
  sparse *s = p->state;
  bool chosen = s->fronts_chosen, blocks = f->block;
  STF_KEEP(m, chosen);
  STF_KEEP(m, blocks);
  if (!m->reads || m->code) return;
  if (chosen && !s->fronts_chosen) stf_image_stop(m, open_fronts(p));
  if (!m->code && blocks && !s->fronts)
    stf_image_stop(m, STEIF_FAIL(p->ctx, STEIF_BAD_INPUT,
                                 "the checkpoint has factors by fronts where there are none"));
  if (!m->code && blocks && !f->block) stf_image_stop(m, prepare_fronts(p, f));
}

static void keep_values(steif_pencil *p, int slot, stf_image *m)
{
  const sparse *s = p->state;
  const factors *f = s->slot[slot];
  const size_t width = stf_is_complex(p->shift[slot]) ? 2 : 1;
  stf_keep(m, f->value, (size_t)s->pattern.nnz * width * sizeof *f->value);
  if (!f->by_fronts) return;
  const stf_fronts_size size = stf_multifrontal_size(s->fronts);
  stf_keep(m, f->block, size.factors * sizeof *f->block);
  stf_keep(m, f->pivot, size.pivots * sizeof *f->pivot);
}

static void keep(steif_pencil *p, int slot, stf_image *m)
{
  sparse *s = p->state;
  factors *f = s->slot[slot];
  if (m->reads) drop(f); /* a run in use may go back to an image */
  keep_shape(p, f, m);
  STF_KEEP(m, f->growth);
  STF_KEEP(m, f->complex);
  STF_KEEP(m, f->by_fronts);
  STF_KEEP(m, f->rejected);
  stf_klu_keep(s->symbolic, f->complex, &f->numeric, &f->common, m);
  if (p->fresh[slot] && !m->code) keep_values(p, slot, m);
}

static void finish(steif_pencil *p) { forget(p); }

const stf_backend stf_backend_sparse = {
  .name = "KLU",
  .size = sizeof(sparse),
  .crowd = 2000,
  .matrices = true,
  .open = start,
  .update = update,
  .prepare = prepare,
  .factor = factor,
  .solve = solve,
  .columns = columns,
  .transposed = stf_sparse_transposed,
  .product = stf_sparse_product,
  .keep = keep,
  .close = finish,
};
