/* sums.c: sums as one instruction: products of registers, added one after the other in
 * the order of the text, so that each operation is rounded as before.
 *
 * A term that is no product has a factor 1. One that is subtracted has the negative of a number or of what
 * parameters determine, else a factor -1: -(a b) = (-a) b, x - y = x + (-y) hold for rounded numbers too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "assembly.h"

enum { MOST_FACTORS = 3 };

typedef struct term {
  int32_t factor[MOST_FACTORS]; /* -1: none */
} term;

typedef struct sums {
  stf_assembly *of;
  stf_vector terms; /* of the sum at hand, the last first */
  stf_vector
    negative; /* int32_t of each register: 1 + that of its negative; -1: fixed, none yet */
  int32_t one, minus_one;
} sums;

static stf_step_code *instruction(const sums *s, int32_t i)
{
  return STF_AT(s->of->code, stf_step_code, i);
}

/* What makes a register in every evaluation; NULL: nothing. */
static stf_step_code *making(const sums *s, int32_t reg)
{
  const int32_t i = *stf_maker_of(s->of, reg) - 1;
  return i >= (int32_t)s->of->fixed ? instruction(s, i) : NULL;
}

/* ... for one other instruction alone. */
static stf_step_code *private(const sums *s, int32_t reg, int kind)
{
  stf_step_code *p = *stf_uses_of(s->of, reg) == 1 ? making(s, reg) : NULL;
  return p && p->kind == kind ? p : NULL;
}

static bool adds(const stf_step_code *p)
{
  return p->kind == STF_OP_ADD || p->kind == STF_OP_SUBTRACT || p->kind == STF_OP_TIMES_PLUS ||
         p->kind == STF_OP_TIMES_MINUS || p->kind == STF_OP_MINUS_TIMES;
}

static stf_step_code *private_sum(const sums *s, int32_t reg)
{
  stf_step_code *p = *stf_uses_of(s->of, reg) == 1 ? making(s, reg) : NULL;
  return p && adds(p) ? p : NULL;
}

/* The operand of a sum that may be a sum itself; -1: none, since that would be subtracted. */
static int32_t inner(const sums *s, const stf_step_code *p)
{
  if (p->kind == STF_OP_TIMES_MINUS) return -1;
  if (p->kind == STF_OP_ADD) return private_sum(s, p->a) ? p->a : p->b;
  return p->kind == STF_OP_SUBTRACT ? p->a : p->c;
}

/* Is there a private product behind an operand that stands alone? */
static bool products(const sums *s, const stf_step_code *p, int32_t next)
{
  const int32_t alone = p->kind == STF_OP_ADD           ? (next == p->a ? p->b : p->a)
                        : p->kind == STF_OP_SUBTRACT    ? p->b
                        : p->kind == STF_OP_TIMES_MINUS ? p->c
                                                        : -1;
  return (alone >= 0 && private(s, alone, STF_OP_MULTIPLY)) ||
         (next >= 0 && private(s, next, STF_OP_MULTIPLY));
}

/* Two operations at least become one. */
static bool worth(const sums *s, const stf_step_code *p)
{
  const int32_t next = inner(s, p);
  return (next >= 0 && private_sum(s, next)) || products(s, p, next);
}

/* ---- registers -------------------------------------------------------------------------------- */

/* A register with its entries in all lists; -1: memory is short. */
static int32_t new_register(sums *s)
{
  const int32_t reg = s->of->tape->registers++;
  const size_t count = (size_t)reg + 1;
  if (stf_vector_resize(s->of->ctx, &s->of->uses, count, sizeof(int32_t)) ||
      stf_vector_resize(s->of->ctx, &s->of->maker, count, sizeof(int32_t)) ||
      stf_vector_resize(s->of->ctx, &s->negative, count, sizeof(int32_t)))
    return -1;
  *STF_AT(s->negative, int32_t, reg) = -1;
  return reg;
}

static int32_t number(sums *s, double value)
{
  const int32_t reg = new_register(s);
  double *to = reg < 0 ? NULL : stf_vector_push(s->of->ctx, &s->of->tape->numbers, sizeof *to);
  int32_t *at = to ? stf_vector_push(s->of->ctx, &s->of->number_at, sizeof *at) : NULL;
  if (!at) return -1;
  *to = value;
  return *at = reg;
}

static int32_t one(sums *s) { return s->one < 0 ? s->one = number(s, 1) : s->one; }
static int32_t minus_one(sums *s)
{
  return s->minus_one < 0 ? s->minus_one = number(s, -1) : s->minus_one;
}

static bool fixed(const sums *s, int32_t reg)
{
  return *STF_AT(s->negative, int32_t, reg) != 0;
}

/* Of what parameters determine. */
static int32_t negative(sums *s, int32_t reg)
{
  const int32_t known = *STF_AT(s->negative, int32_t, reg) - 1;
  if (known >= 0) return known;
  const int32_t to = new_register(s);
  stf_step_code *n = to < 0 ? NULL : stf_vector_push(s->of->ctx, &s->of->negatives, sizeof *n);
  if (!n) return -1;
  *n = (stf_step_code){STF_OP_NEGATIVE, to, reg, 0, 0};
  *STF_AT(s->negative, int32_t, reg) = to + 1;
  return to;
}

static int mark_fixed(sums *s)
{
  stf_tape *t = s->of->tape;
  STEIF_TRY(stf_vector_resize(s->of->ctx, &s->negative, (size_t)t->registers, sizeof(int32_t)));
  for (size_t i = 0; i < s->of->number_at.count; i++)
    *STF_AT(s->negative, int32_t, *STF_AT(s->of->number_at, int32_t, i)) = -1;
  for (size_t i = 0; i < t->fixed_loads; i++)
    *STF_AT(s->negative, int32_t, STF_AT(t->loads, stf_stretch, i)->at) = -1;
  for (size_t i = 0; i < s->of->fixed; i++)
    *STF_AT(s->negative, int32_t, instruction(s, (int32_t)i)->to) = -1;
  return STEIF_OK;
}

/* ---- terms ------------------------------------------------------------------------------------ */

/* a b, or -(a b). A factor that is itself a product of two is taken apart. */
static int product(sums *s, int32_t a, int32_t b, bool minus)
{
  term *to = stf_vector_push(s->of->ctx, &s->terms, sizeof *to);
  if (!to) return STEIF_NO_MEMORY;
  stf_step_code *p = private(s, a, STF_OP_MULTIPLY);
  int32_t other = b;
  if (!p) {
    p = private(s, b, STF_OP_MULTIPLY);
    other = a;
  }
  if (p && minus && !fixed(s, other) && !fixed(s, p->a) && !fixed(s, p->b)) p = NULL;
  *to = p ? (term){{p->a, p->b, other}} : (term){{a, b, -1}};
  if (p) stf_drop(p);
  if (!minus) return STEIF_OK;
  for (int k = 0; k < MOST_FACTORS; k++)
    if (to->factor[k] >= 0 && fixed(s, to->factor[k])) {
      to->factor[k] = negative(s, to->factor[k]);
      return to->factor[k] < 0 ? STEIF_NO_MEMORY : STEIF_OK;
    }
  to->factor[2] = minus_one(s);
  return to->factor[2] < 0 ? STEIF_NO_MEMORY : STEIF_OK;
}

/* An operation is done once more; where it was done is left out when nothing else needs it. */
static void take(sums *s, stf_step_code *p)
{
  const int operands = stf_operands(p->kind);
  const int32_t from[2] = {p->a, p->b};
  if (!--*stf_uses_of(s->of, p->to)) {
    stf_drop(p);
    return;
  }
  for (int k = 0; k < operands; k++) ++*stf_uses_of(s->of, from[k]);
}

/* A product of two costs as much as its value would: it is computed wherever it is needed. */
static int single(sums *s, int32_t reg, bool minus)
{
  stf_step_code *p = making(s, reg);
  if (p && p->kind == STF_OP_NEGATIVE) {
    take(s, p);
    reg = p->a;
    minus = !minus;
  }
  p = making(s, reg);
  if (p && p->kind == STF_OP_MULTIPLY && minus && *stf_uses_of(s->of, reg) > 1 &&
      !fixed(s, p->a) && !fixed(s, p->b))
    p = NULL;
  if (!p || p->kind != STF_OP_MULTIPLY) {
    const int32_t factor = minus ? minus_one(s) : one(s);
    return factor < 0 ? STEIF_NO_MEMORY : product(s, reg, factor, false);
  }
  take(s, p);
  return product(s, p->a, p->b, minus);
}

/* The terms of the outermost operations of a sum but its inner one. */
static int outer(sums *s, const stf_step_code *p, int32_t next)
{
  switch (p->kind) {
  case STF_OP_TIMES_PLUS: return product(s, p->a, p->b, false);
  case STF_OP_MINUS_TIMES: return product(s, p->a, p->b, true);
  case STF_OP_ADD: return single(s, next == p->a ? p->b : p->a, false);
  case STF_OP_SUBTRACT: return single(s, p->b, true);
  default: STEIF_TRY(single(s, p->c, true)); return product(s, p->a, p->b, false);
  }
}

static int gather(sums *s, const stf_step_code *root)
{
  stf_step_code sum = *root;
  s->terms.count = 0;
  for (;;) {
    const int32_t next = inner(s, &sum);
    STEIF_TRY(outer(s, &sum, next));
    if (next < 0) return STEIF_OK;
    stf_step_code *p = private_sum(s, next);
    if (!p) return single(s, next, false);
    sum = *p;
    stf_drop(p);
  }
}

/* The terms as factors, the first first. */
static int join(sums *s, stf_step_code *root)
{
  stf_vector *to = &s->of->factors;
  const size_t from = to->count, count = s->terms.count;
  size_t width = 2;
  for (size_t i = 0; i < count; i++)
    if (STF_AT(s->terms, term, i)->factor[2] >= 0) width = 3;
  STEIF_TRY(stf_vector_resize(s->of->ctx, to, from + count * width, sizeof(int32_t)));
  for (size_t i = 0; i < count; i++) {
    const term *x = STF_AT(s->terms, term, count - 1 - i);
    for (size_t k = 0; k < width; k++) {
      const int32_t reg = x->factor[k] >= 0 ? x->factor[k] : one(s);
      if (reg < 0) return STEIF_NO_MEMORY;
      *STF_AT(*to, int32_t, from + i * width + k) = reg;
    }
  }
  *root = (stf_step_code){width == 2 ? STF_OP_PAIRS : STF_OP_TRIPLES, root->to, 0,
                          (int32_t)from, (int32_t)count};
  return STEIF_OK;
}

/* From the last instruction to the first: a sum before its own terms. */
static int all(sums *s)
{
  const int32_t count = (int32_t)s->of->code.count;
  for (int32_t i = count; i-- > (int32_t)s->of->fixed;) {
    stf_step_code *p = instruction(s, i);
    if (!adds(p) || !worth(s, p)) continue;
    STEIF_TRY(gather(s, p));
    STEIF_TRY(join(s, p));
  }
  return STEIF_OK;
}

int stf_tape_sum(stf_assembly *a)
{
  sums s = {.of = a, .one = -1, .minus_one = -1};
  int code = mark_fixed(&s);
  if (!code) code = all(&s);
  stf_vector_free(a->ctx, &s.terms);
  stf_vector_free(a->ctx, &s.negative);
  stf_vector_free(a->ctx, &a->uses);
  stf_vector_free(a->ctx, &a->maker);
  return code;
}
