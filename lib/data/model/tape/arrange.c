/* arrange.c: scalar registers in the order in which they are filled: numbers, what parameters determine, loads
 * as they lie in memory, values, results as they lie in memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "assembly.h"
#include <stdlib.h>

typedef struct order {
  stf_vector of; /* int32_t: 1 + new register of each old one */
  int32_t next;
} order;

static int32_t *place(const order *o, int32_t reg) { return STF_AT(o->of, int32_t, reg); }

static void give(order *o, int32_t reg)
{
  if (!*place(o, reg)) *place(o, reg) = ++o->next;
}

static int by_place(const void *x, const void *y)
{
  const stf_stretch *a = x, *b = y;
  if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
  if (a->a != b->a) return a->a < b->a ? -1 : 1;
  return a->at < b->at ? -1 : a->at > b->at;
}

static void sort(const stf_vector *v, size_t from, size_t to)
{
  stf_stretch *s = v->data;
  if (to > from) qsort(s + from, to - from, sizeof *s, by_place);
}

/* Neighbours in registers and in memory as one; returns where the next one goes. */
static size_t merge(const stf_vector *v, size_t from, size_t to, size_t kept)
{
  stf_stretch *s = v->data;
  for (size_t i = from; i < to; i++) {
    stf_stretch *last = i > from ? s + kept - 1 : NULL;
    if (last && last->kind == s[i].kind && s[i].a == last->a + last->count &&
        s[i].at == last->at + last->count)
      last->count++;
    else
      s[kept++] = s[i];
  }
  return kept;
}

/* ---- instructions ----------------------------------------------------------------------------- */

/* Those that are left: of parameters only, their negatives, the others. */
static int collect(stf_assembly *a)
{
  stf_vector code = {0};
  const size_t most = a->code.count + a->negatives.count;
  STEIF_TRY(stf_vector_resize(a->ctx, &code, most, sizeof(stf_step_code)));
  stf_step_code *to = code.data;
  const stf_step_code *from = a->code.data, *negatives = a->negatives.data;
  size_t kept = 0;
  for (size_t i = 0; i < a->fixed; i++) to[kept++] = from[i];
  for (size_t i = 0; i < a->negatives.count; i++) to[kept++] = negatives[i];
  const size_t fixed = kept;
  for (size_t i = a->fixed; i < a->code.count; i++)
    if (from[i].kind != STF_OP_NUMBER) to[kept++] = from[i];
  code.count = kept;
  stf_vector_free(a->ctx, &a->code);
  a->code = code;
  a->fixed = fixed;
  return STEIF_OK;
}

static void rename_operands(const order *o, stf_step_code *s)
{
  int32_t *from[3] = {&s->a, &s->b, &s->c};
  const int operands = s->kind >= STF_OP_PAIRS ? 0 : stf_operands(s->kind);
  for (int k = 0; k < operands; k++) *from[k] = *place(o, *from[k]) - 1;
  s->to = *place(o, s->to) - 1;
}

static void rename_all(const order *o, const stf_assembly *a)
{
  const stf_tape *t = a->tape;
  for (size_t i = 0; i < a->code.count; i++)
    rename_operands(o, STF_AT(a->code, stf_step_code, i));
  for (size_t i = 0; i < a->factors.count; i++)
    *STF_AT(a->factors, int32_t, i) = *place(o, *STF_AT(a->factors, int32_t, i)) - 1;
  for (size_t i = 0; i < t->loads.count; i++)
    STF_AT(t->loads, stf_stretch, i)->at = *place(o, STF_AT(t->loads, stf_stretch, i)->at) - 1;
  for (size_t i = 0; i < t->broadcasts.count; i++)
    STF_AT(t->broadcasts, stf_step_code, i)->a =
      *place(o, STF_AT(t->broadcasts, stf_step_code, i)->a) - 1;
  for (size_t i = 0; i < t->results.count; i++)
    STF_AT(t->results, stf_stretch, i)->at =
      *place(o, STF_AT(t->results, stf_stretch, i)->at) - 1;
}

/* ---- order ------------------------------------------------------------------------------------ */

static void give_loads(order *o, const stf_tape *t, size_t from, size_t to)
{
  for (size_t i = from; i < to; i++) give(o, STF_AT(t->loads, stf_stretch, i)->at);
}

/* `count` registers of results, the last ones. */
static void give_results(const order *o, const stf_tape *t, const uint8_t *is_result,
                         int32_t count)
{
  int32_t next = t->registers - count;
  for (size_t i = 0; i < t->results.count; i++) {
    const int32_t reg = STF_AT(t->results, stf_stretch, i)->at;
    if (is_result[reg] && !*place(o, reg)) *place(o, reg) = ++next;
  }
}

/* Values that are no results first; t->registers becomes as many as are used. */
static void give_values(order *o, const stf_assembly *a, uint8_t *is_result)
{
  stf_tape *t = a->tape;
  const stf_step_code *s = a->code.data;
  int32_t results = 0;
  for (size_t i = 0; i < t->results.count; i++)
    is_result[STF_AT(t->results, stf_stretch, i)->at] = 1;
  for (size_t i = a->fixed; i < a->code.count; i++)
    if (is_result[s[i].to])
      results++;
    else
      give(o, s[i].to);
  t->registers = o->next + results;
  give_results(o, t, is_result, results);
}

int stf_tape_arrange(stf_assembly *a)
{
  stf_tape *t = a->tape;
  order o = {{0}, 0};
  uint8_t *is_result = stf_allocate(a->ctx, (size_t)t->registers + 1, 1);
  int code = is_result
               ? stf_vector_resize(a->ctx, &o.of, (size_t)t->registers + 1, sizeof(int32_t))
               : STEIF_NO_MEMORY;
  if (!code) code = collect(a);
  if (!code) {
    sort(&t->loads, 0, t->fixed_loads);
    sort(&t->loads, t->fixed_loads, t->loads.count);
    sort(&t->results, 0, t->results.count);
    for (size_t i = 0; i < a->number_at.count; i++) give(&o, *STF_AT(a->number_at, int32_t, i));
    give_loads(&o, t, 0, t->fixed_loads);
    for (size_t i = 0; i < a->fixed; i++) give(&o, STF_AT(a->code, stf_step_code, i)->to);
    give_loads(&o, t, t->fixed_loads, t->loads.count);
    give_values(&o, a, is_result);
    rename_all(&o, a);
    const size_t fixed = merge(&t->loads, 0, t->fixed_loads, 0);
    t->loads.count = merge(&t->loads, t->fixed_loads, t->loads.count, fixed);
    t->fixed_loads = fixed;
    t->results.count = merge(&t->results, 0, t->results.count, 0);
  }
  stf_vector_free(a->ctx, &o.of);
  if (is_result) stf_release(a->ctx, is_result);
  return code;
}
