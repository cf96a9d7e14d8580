/* fuse.c: a product that one sum alone needs is made by the instruction of the sum: a third fewer instructions.
 * Product and sum stay two operations, each rounded.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "assembly.h"

typedef struct uses {
  stf_vector count, maker; /* int32_t of each register; maker: 1 + instruction */
} uses;

static int32_t *count_of(const uses *u, int32_t reg) { return STF_AT(u->count, int32_t, reg); }
static int32_t *maker_of(const uses *u, int32_t reg) { return STF_AT(u->maker, int32_t, reg); }

static void note(const uses *u, const stf_vector *code)
{
  for (size_t i = 0; i < code->count; i++) {
    const stf_step_code *s = STF_AT(*code, stf_step_code, i);
    const int operands = stf_operands(s->kind);
    const int32_t from[3] = {s->a, s->b, s->c};
    for (int k = 0; k < operands; k++) ++*count_of(u, from[k]);
    *maker_of(u, s->to) = (int32_t)i + 1;
  }
}

/* The product behind an operand, if instruction `first` or a later one makes it for this alone. */
static stf_step_code *product(const uses *u, const stf_vector *code, int32_t reg, size_t first)
{
  const int32_t maker = *maker_of(u, reg) - 1;
  if (maker < 0 || (size_t)maker < first || *count_of(u, reg) != 1) return NULL;
  stf_step_code *s = STF_AT(*code, stf_step_code, maker);
  return s->kind == STF_OP_MULTIPLY ? s : NULL;
}

static void fuse(const uses *u, const stf_vector *code, size_t first)
{
  for (size_t i = first; i < code->count; i++) {
    stf_step_code *s = STF_AT(*code, stf_step_code, i);
    if (s->kind != STF_OP_ADD && s->kind != STF_OP_SUBTRACT) continue;
    stf_step_code *left = product(u, code, s->a, first);
    stf_step_code *right = left ? NULL : product(u, code, s->b, first),
                  *p = left ? left : right;
    if (!p) continue;
    const int kind = s->kind == STF_OP_ADD ? STF_OP_TIMES_PLUS
                     : left                ? STF_OP_TIMES_MINUS
                                           : STF_OP_MINUS_TIMES;
    *s = (stf_step_code){kind, s->to, p->a, p->b, left ? s->b : s->a};
    stf_drop(p);
  }
}

static void without_gaps(stf_vector *code)
{
  size_t kept = 0;
  for (size_t i = 0; i < code->count; i++) {
    const stf_step_code s = *STF_AT(*code, stf_step_code, i);
    if (s.kind != STF_OP_NUMBER) *STF_AT(*code, stf_step_code, kept++) = s;
  }
  code->count = kept;
}

static int lanes(stf_assembly *a)
{
  stf_tape *t = a->tape;
  uses u = {{0}, {0}};
  int code = stf_vector_resize(a->ctx, &u.count, (size_t)t->lanes + 1, sizeof(int32_t));
  if (!code) code = stf_vector_resize(a->ctx, &u.maker, (size_t)t->lanes + 1, sizeof(int32_t));
  if (!code) {
    note(&u, &t->wide);
    for (size_t i = 0; i < t->stores.count; i++)
      ++*count_of(&u, STF_AT(t->stores, stf_store, i)->from);
    fuse(&u, &t->wide, 0);
    without_gaps(&t->wide);
  }
  stf_vector_free(a->ctx, &u.count);
  stf_vector_free(a->ctx, &u.maker);
  return code;
}

int stf_tape_fuse(stf_assembly *a)
{
  stf_tape *t = a->tape;
  STEIF_TRY(stf_vector_resize(a->ctx, &a->uses, (size_t)t->registers + 1, sizeof(int32_t)));
  STEIF_TRY(stf_vector_resize(a->ctx, &a->maker, (size_t)t->registers + 1, sizeof(int32_t)));
  const uses u = {a->uses, a->maker};
  note(&u, &a->code);
  for (size_t i = 0; i < t->results.count; i++)
    ++*count_of(&u, STF_AT(t->results, stf_stretch, i)->at);
  for (size_t i = 0; i < t->broadcasts.count; i++)
    ++*count_of(&u, STF_AT(t->broadcasts, stf_step_code, i)->a);
  fuse(&u, &a->code, a->fixed);
  return lanes(a);
}
