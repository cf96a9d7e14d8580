/* encode.c: scalar instructions as words, each as long as it needs, and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "assembly.h"
#include <string.h>

static bool sums(int kind) { return kind >= STF_OP_PAIRS; }
static int width(int kind) { return kind == STF_OP_TRIPLES ? 3 : 2; }
static int operands(int kind)
{
  return kind == STF_OP_LOOKUP || kind == STF_OP_TILT ? 2 : stf_operands(kind);
}

/* Sums of two to six products have a kind each, others their number in front of their factors. */
static int kind_of(const stf_step_code *s)
{
  return s->kind == STF_OP_PAIRS && s->c <= 6 ? STF_OP_PAIRS_2 + s->c - 2 : s->kind;
}

static size_t words_of(const stf_step_code *s)
{
  if (!sums(s->kind)) return 2 + (size_t)operands(s->kind);
  return (kind_of(s) == s->kind ? 3u : 2u) + (size_t)s->c * (size_t)width(s->kind);
}

static void write(const stf_step_code *s, const int32_t *factors, int32_t *to)
{
  const int32_t from[3] = {s->a, s->b, s->c};
  *to++ = kind_of(s);
  *to++ = s->to;
  if (sums(s->kind)) {
    if (kind_of(s) == s->kind) *to++ = s->c;
    memcpy(to, factors + s->b, (size_t)s->c * (size_t)width(s->kind) * sizeof *to);
  } else {
    memcpy(to, from, (size_t)operands(s->kind) * sizeof *to);
  }
}

int stf_tape_encode(stf_assembly *a)
{
  stf_tape *t = a->tape;
  size_t words = 0;
  for (size_t i = 0; i < a->code.count; i++)
    words += words_of(STF_AT(a->code, stf_step_code, i));
  STEIF_TRY(stf_vector_resize(a->ctx, &t->code, words, sizeof(int32_t)));
  words = 0;
  for (size_t i = 0; i < a->code.count; i++) {
    const stf_step_code *s = STF_AT(a->code, stf_step_code, i);
    if (i == a->fixed) t->fixed = words;
    write(s, a->factors.data, STF_AT(t->code, int32_t, words));
    words += words_of(s);
  }
  if (a->fixed == a->code.count) t->fixed = words;
  return STEIF_OK;
}

const int32_t *stf_tape_decode(const int32_t *word, stf_step_code *s, const int32_t **factors)
{
  int32_t from[3] = {0, 0, 0};
  *factors = NULL;
  if (sums(word[0])) {
    const bool few = word[0] >= STF_OP_PAIRS_2;
    const int kind = few ? STF_OP_PAIRS : word[0];
    const int32_t count = few ? word[0] - STF_OP_PAIRS_2 + 2 : word[2];
    *s = (stf_step_code){kind, word[1], 0, 0, count};
    *factors = word + 3 - few;
    return *factors + (ptrdiff_t)count * width(kind);
  }
  memcpy(from, word + 2, (size_t)operands(word[0]) * sizeof *from);
  *s = (stf_step_code){word[0], word[1], from[0], from[1], from[2]};
  return word + 2 + operands(word[0]);
}
