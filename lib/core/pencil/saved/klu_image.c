/* klu_image.c: the factors that KLU has made, array by array (klu_l_numeric of klu.h): a refactorisation
 * goes on with their pivots.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sparse.h"
#include <stdint.h>

typedef SuiteSparse_long whole;

/* An array of KLU's, made where it is read. */
static void array(stf_image *m, klu_l_common *c, void *place, size_t count, size_t size)
{
  void **block = place;
  if (m->code) return;
  if (m->reads) *block = klu_l_malloc(count, size, c);
  if (m->reads && c->status != KLU_OK) {
    stf_image_stop(m,
                   STEIF_FAIL(m->ctx, STEIF_NO_MEMORY,
                              "no memory for the factors of a checkpoint, %zu entries", count));
    return;
  }
  stf_keep(m, *block, count * size);
}

static void scalars(stf_image *m, klu_l_numeric *f)
{
  whole *const number[] = {
    &f->n, &f->nblocks, &f->lnz, &f->unz, &f->max_lnz_block, &f->max_unz_block, &f->nzoff};
  for (size_t i = 0; i < sizeof number / sizeof *number; i++)
    stf_keep(m, number[i], sizeof(whole));
  STF_KEEP(m, f->worksize);
}

/* Of the matrix that was analysed, and no sizes that are not. */
static void check(stf_image *m, const klu_l_symbolic *s, const klu_l_numeric *f)
{
  const size_t most = SIZE_MAX / 64;
  if (m->code ||
      (f->n == s->n && f->nblocks == s->nblocks && f->nzoff == s->nzoff && f->worksize <= most))
    return;
  stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_BAD_INPUT,
                               "the checkpoint has factors of another matrix: %lld unknowns in "
                               "%lld blocks, here %lld in %lld",
                               (long long)f->n, (long long)f->nblocks, (long long)s->n,
                               (long long)s->nblocks));
}

/* L and U of each block, in units of an entry. Blocks of one unknown have neither, nor a size. */
static void block(stf_image *m, klu_l_common *c, klu_l_numeric *f, size_t b, size_t entry)
{
  size_t size = f->LUbx[b] ? f->LUsize[b] : 0;
  stf_keep_count(m, &size, SIZE_MAX / entry);
  if (m->code) return;
  f->LUsize[b] = size;
  if (size) array(m, c, &f->LUbx[b], size, entry);
}

static void blocks(stf_image *m, klu_l_common *c, klu_l_numeric *f, size_t entry)
{
  const size_t count = (size_t)f->nblocks;
  if (m->code) return;
  if (m->reads) f->LUsize = klu_l_malloc(count, sizeof *f->LUsize, c);
  if (m->reads) f->LUbx = klu_l_malloc(count, sizeof *f->LUbx, c);
  for (size_t b = 0; m->reads && f->LUbx && b < count; b++) f->LUbx[b] = NULL;
  if (!f->LUbx || !f->LUsize) {
    stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_NO_MEMORY, "no memory for %zu blocks", count));
    return;
  }
  for (size_t b = 0; b < count; b++) block(m, c, f, b, entry);
}

static void arrays(stf_image *m, klu_l_common *c, klu_l_numeric *f, size_t entry)
{
  const size_t n = (size_t)f->n, size = sizeof(whole), off = (size_t)f->nzoff;
  whole **const index[] = {&f->Pnum, &f->Pinv, &f->Lip, &f->Uip, &f->Llen, &f->Ulen};
  bool scaled = f->Rs;
  for (size_t i = 0; i < sizeof index / sizeof *index; i++) array(m, c, index[i], n, size);
  blocks(m, c, f, entry);
  array(m, c, &f->Udiag, n, entry);
  STF_KEEP(m, scaled);
  if (scaled) array(m, c, &f->Rs, n, sizeof *f->Rs);
  array(m, c, &f->Offp, n + 1, size);
  array(m, c, &f->Offi, off + 1, size);
  array(m, c, &f->Offx, off + 1, entry);
}

/* The work space, of which two members are parts: entries first. */
static void work(stf_image *m, klu_l_common *c, klu_l_numeric *f, size_t entry)
{
  if (!m->reads || m->code) return;
  f->Work = klu_l_malloc(f->worksize, 1, c);
  if (!f->Work) {
    stf_image_stop(
      m, STEIF_FAIL(m->ctx, STEIF_NO_MEMORY, "no memory for %zu bytes of work", f->worksize));
    return;
  }
  f->Xwork = f->Work;
  f->Iwork = (whole *)(void *)((char *)f->Xwork + (size_t)f->n * entry);
}

static klu_l_numeric *make(stf_image *m, klu_l_common *c)
{
  klu_l_numeric *f = klu_l_malloc(1, sizeof *f, c);
  if (f)
    *f = (klu_l_numeric){0};
  else
    stf_image_stop(m, STEIF_FAIL(m->ctx, STEIF_NO_MEMORY, "no memory for sparse factors"));
  return f;
}

void stf_klu_keep(const klu_l_symbolic *symbolic, bool wide, klu_l_numeric **numeric,
                  klu_l_common *common, stf_image *m)
{
  const size_t entry = (wide ? 2 : 1) * sizeof(double);
  bool there = *numeric;
  STF_KEEP(m, there);
  if (m->code || !there) return;
  if (m->reads && !(*numeric = make(m, common))) return;
  klu_l_numeric *f = *numeric;
  scalars(m, f);
  if (m->reads) check(m, symbolic, f);
  if (m->code && m->reads) {
    common->status = KLU_OK;
    klu_l_free(f, 1, sizeof *f, common);
    *numeric = NULL;
  }
  if (m->code) return;
  arrays(m, common, f, entry);
  work(m, common, f, entry);
}
