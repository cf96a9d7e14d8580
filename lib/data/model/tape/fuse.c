/* fuse.c: a product that one sum alone needs is made by the instruction of the sum: a third fewer instructions.
 * Product and sum stay two operations, each rounded.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tape.h"

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

static void fuse(const uses *u, const stf_vector *code, size_t first, size_t end)
{
  for (size_t i = first; i < end; i++) {
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
    p->kind = STF_OP_NUMBER; /* none */
  }
}

static size_t without_gaps(stf_vector *code, size_t fixed)
{
  size_t kept = 0, kept_fixed = 0;
  for (size_t i = 0; i < code->count; i++) {
    const stf_step_code s = *STF_AT(*code, stf_step_code, i);
    if (s.kind == STF_OP_NUMBER) continue;
    *STF_AT(*code, stf_step_code, kept++) = s;
    kept_fixed += i < fixed;
  }
  code->count = kept;
  return kept_fixed;
}

int stf_tape_fuse(steif_context *ctx, stf_tape *t)
{
  const bool loops = t->box.dims > 0;
  uses scalar = {{0}, {0}}, lane = {{0}, {0}};
  int code = stf_vector_resize(ctx, &scalar.count, (size_t)t->registers + 1, sizeof(int32_t));
  if (!code)
    code = stf_vector_resize(ctx, &scalar.maker, (size_t)t->registers + 1, sizeof(int32_t));
  if (!code) code = stf_vector_resize(ctx, &lane.count, (size_t)t->lanes + 1, sizeof(int32_t));
  if (!code) code = stf_vector_resize(ctx, &lane.maker, (size_t)t->lanes + 1, sizeof(int32_t));
  if (!code) {
    note(&scalar, &t->code);
    note(&lane, &t->wide);
    for (size_t i = 0; i < t->stores.count; i++)
      ++*count_of(loops ? &lane : &scalar, STF_AT(t->stores, stf_store, i)->from);
    for (size_t i = 0; i < t->broadcasts.count; i++)
      ++*count_of(&scalar, STF_AT(t->broadcasts, stf_step_code, i)->a);
    fuse(&scalar, &t->code, t->fixed, t->code.count);
    fuse(&lane, &t->wide, 0, t->wide.count);
    t->fixed = without_gaps(&t->code, t->fixed);
    without_gaps(&t->wide, 0);
  }
  stf_vector_free(ctx, &scalar.count);
  stf_vector_free(ctx, &scalar.maker);
  stf_vector_free(ctx, &lane.count);
  stf_vector_free(ctx, &lane.maker);
  return code;
}
