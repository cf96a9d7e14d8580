/* tape_run.c: the machine: scalar instructions, and those on lanes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "simd.h"
#include "tape.h"
#include <math.h>
#include <string.h>

/* A call between them: no compiler takes the product and the sum for one operation. */
INLINE double plus(double a, double b) { return a + b; }

#define NOINLINE static __attribute__((noinline))

/* Sums of products of registers. */
INLINE double sum_of_pairs(const int32_t *factor, int32_t count, const double *r)
{
  double sum = r[factor[0]] * r[factor[1]];
  for (; --count; factor += 2) sum = plus(sum, r[factor[2]] * r[factor[3]]);
  return sum;
}

INLINE double sum_of_triples(const int32_t *factor, int32_t count, const double *r)
{
  double sum = r[factor[0]] * r[factor[1]] * r[factor[2]];
  for (; --count; factor += 3) sum = plus(sum, r[factor[3]] * r[factor[4]] * r[factor[5]]);
  return sum;
}

/* Functions, and what is rare; returns the next instruction. */
static const int32_t *run_other(const int32_t *s, double *r, const stf_lookup *l)
{
  const double a = r[s[2]];
  double *to = r + s[1];
  switch (s[0]) {
  case STF_OP_SELECT: *to = a != 0 ? r[s[3]] : r[s[4]]; return s + 5;
  case STF_OP_LOOKUP: *to = stf_lookup_value(l + s[3], a); return s + 4;
  case STF_OP_TILT: *to = stf_lookup_slope(l + s[3], a); return s + 4;
  default:
    if (stf_operands(s[0]) == 1) {
      *to = stf_operate(s[0], a, 0, 0);
      return s + 3;
    }
    *to = stf_operate(s[0], a, r[s[3]], 0);
    return s + 4;
  }
}

#define A r[s[2]]
#define B r[s[3]]
#define C r[s[4]]
#define PAIR(k) (r[s[2 + 2 * (k)]] * r[s[3 + 2 * (k)]])
#define PAIRS2 plus(PAIR(0), PAIR(1))
#define PAIRS4 plus(plus(PAIRS2, PAIR(2)), PAIR(3))
/* An instruction of so many words. */
#define CASE(kind, value, words)                                                               \
  case STF_OP_##kind:                                                                          \
    *to = value;                                                                               \
    s += words;                                                                                \
    break;
/* s: kind, register of the value, operands. */
static void run_scalar(const int32_t *s, const int32_t *end, double *r, const stf_lookup *l)
{
  do {
    double *to = r + s[1];
    switch (s[0]) {
      CASE(ADD, A + B, 4)
      CASE(SUBTRACT, A - B, 4)
      CASE(MULTIPLY, A * B, 4)
      CASE(DIVIDE, A / B, 4)
      CASE(TIMES_PLUS, plus(A * B, C), 5)
      CASE(TIMES_MINUS, plus(A * B, -C), 5)
      CASE(MINUS_TIMES, plus(C, -(A * B)), 5)
      CASE(NEGATIVE, -A, 3)
      CASE(PAIRS_2, PAIRS2, 6)
      CASE(PAIRS_3, plus(PAIRS2, PAIR(2)), 8)
      CASE(PAIRS_4, PAIRS4, 10)
      CASE(PAIRS_5, plus(PAIRS4, PAIR(4)), 12)
      CASE(PAIRS_6, plus(plus(PAIRS4, PAIR(4)), PAIR(5)), 14)
      CASE(PAIRS, sum_of_pairs(s + 3, s[2], r), 3 + 2 * (ptrdiff_t)s[2])
      CASE(TRIPLES, sum_of_triples(s + 3, s[2], r), 3 + 3 * (ptrdiff_t)s[2])
    default: s = run_other(s, r, l);
    }
  } while (s < end);
}
#undef CASE
#undef A
#undef B
#undef C
#undef PAIR
#undef PAIRS2
#undef PAIRS4

/* One instruction on `count` passes. */
INLINE void run_lane(const stf_step_code *s, const double *const *at, double *lanes, int count,
                     const stf_lookup *l)
{
  double *restrict to = lanes + (size_t)s->to * STF_PASSES;
  const bool table = s->kind == STF_OP_LOOKUP || s->kind == STF_OP_TILT;
  const double *x = at[s->a], *y = table ? x : at[s->b], *z = at[s->c];
  switch (s->kind) {
#define STF_ONE(name, word, value)                                                             \
  case STF_OP_##name:                                                                          \
    for (int i = 0; i < count; i++) {                                                          \
      const double a = x[i];                                                                   \
      to[i] = value;                                                                           \
    }                                                                                          \
    break;
    STF_UNARY(STF_ONE)
#undef STF_ONE
#define STF_ONE(name, word, value)                                                             \
  case STF_OP_##name:                                                                          \
    for (int i = 0; i < count; i++) {                                                          \
      const double a = x[i], b = y[i];                                                         \
      to[i] = value;                                                                           \
    }                                                                                          \
    break;
    STF_BINARY(STF_ONE)
#undef STF_ONE
  case STF_OP_TIMES_PLUS:
    for (int i = 0; i < count; i++) to[i] = plus(x[i] * y[i], z[i]);
    break;
  case STF_OP_TIMES_MINUS:
    for (int i = 0; i < count; i++) to[i] = plus(x[i] * y[i], -z[i]);
    break;
  case STF_OP_MINUS_TIMES:
    for (int i = 0; i < count; i++) to[i] = plus(z[i], -(x[i] * y[i]));
    break;
  case STF_OP_SELECT:
    for (int i = 0; i < count; i++) to[i] = x[i] != 0 ? y[i] : z[i];
    break;
  case STF_OP_LOOKUP:
    for (int i = 0; i < count; i++) to[i] = stf_lookup_value(l + s->b, x[i]);
    break;
  default:
    for (int i = 0; i < count; i++) to[i] = stf_lookup_slope(l + s->b, x[i]);
    break;
  }
}

static const double *array_of(const stf_feed *f, int kind)
{
  if (kind == STF_OP_STATE) return f->y;
  if (kind >= STF_OP_ALONG && kind <= STF_OP_WEIGHT) return f->along[kind - STF_OP_ALONG];
  return kind == STF_OP_SLOPE    ? f->yp
         : kind == STF_OP_MEMORY ? f->memory
         : kind == STF_OP_TIME   ? &f->t
                                 : f->p;
}

/* Most stretches are one number, which needs no call. */
INLINE void copy_stretch(double *restrict to, const double *restrict from, int32_t count)
{
  if (count == 1)
    *to = *from;
  else
    memcpy(to, from, (size_t)count * sizeof *to);
}

INLINE void load(const stf_tape *t, size_t from, size_t to, const stf_feed *feed, double *space)
{
  const stf_stretch *l = t->loads.data;
  for (size_t i = from; i < to; i++) {
    const double *x = array_of(feed, l[i].kind) + l[i].a;
    copy_stretch(space + l[i].at, x, l[i].count);
  }
}

static void run_code(const stf_tape *t, size_t from, size_t to, const stf_feed *feed,
                     double *space)
{
  const int32_t *code = t->code.data;
  if (to > from) run_scalar(code + from, code + to, space, feed->lookups);
}

void stf_tape_prepare(const stf_tape *t, const stf_feed *feed, double *space)
{
  if (t->numbers.count) memcpy(space, t->numbers.data, t->numbers.count * sizeof *space);
  load(t, 0, t->fixed_loads, feed, space);
  run_code(t, 0, t->fixed, feed, space);
}

/* ---- passes
 * ----------------------------------------------------------------------------------
 */

static int64_t offset(int32_t a, const int32_t *stride, const int32_t *counter)
{
  return a + (int64_t)stride[0] * counter[0] + (int64_t)stride[1] * counter[1] +
         (int64_t)stride[2] * counter[2];
}

INLINE void fill(const stf_tape *t, const stf_feed *feed, const int32_t *counter, int count,
                 double *lanes)
{
  const int inner = t->box.dims - 1;
  const double **at = t->at.data;
  const stf_load *l = t->wide_loads.data;
  for (size_t i = 0; i < t->wide_loads.count; i++, l++) {
    double *to = lanes + (size_t)l->to * STF_PASSES;
    if (l->kind == STF_OP_COUNTER) {
      for (int k = 0; k < count; k++) to[k] = counter[l->a] + (l->a == inner ? k : 0);
      continue;
    }
    const double *from = array_of(feed, l->kind) + offset(l->a, l->stride, counter);
    const int64_t step = l->stride[inner];
    if (step == 1)
      at[l->to] = from;
    else
      for (int k = 0; k < count; k++) to[k] = from[k * step];
  }
}

INLINE void store(const stf_tape *t, const int32_t *counter, int64_t pass, int count,
                  const double *const *at, double *out)
{
  const int inner = t->box.dims - 1;
  const stf_store *s = t->stores.data;
  for (size_t i = 0; i < t->stores.count; i++, s++) {
    const double *from = at[s->from];
    if (s->slot) {
      const int32_t *slot = s->slot + pass;
      if (t->assigns)
        for (int k = 0; k < count; k++) out[slot[k]] = from[k];
      else
        for (int k = 0; k < count; k++) out[slot[k]] += from[k];
    } else {
      double *to = out + offset(s->a, s->stride, counter);
      const int64_t step = s->stride[inner];
      if (t->assigns && step == 1)
        memcpy(to, from, (size_t)count * sizeof *to);
      else if (t->assigns)
        for (int k = 0; k < count; k++) to[k * step] = from[k];
      else
        for (int k = 0; k < count; k++) to[k * step] += from[k];
    }
  }
}

INLINE void every_pass(const stf_tape *t, const stf_feed *feed, double *lanes, double *out)
{
  const stf_box *b = &t->box;
  const int inner = b->dims - 1;
  int32_t counter[STF_LOOPS];
  int64_t pass = 0;
  memcpy(counter, b->low, sizeof counter);
  for (int d = 0; d < b->dims; d++)
    if (b->count[d] < 1) return;
  for (;;) {
    for (int32_t k = 0; k < b->count[inner]; k += STF_PASSES) {
      const int count = b->count[inner] - k < STF_PASSES ? b->count[inner] - k : STF_PASSES;
      counter[inner] = b->low[inner] + k;
      fill(t, feed, counter, count, lanes);
      const stf_step_code *s = t->wide.data;
      for (size_t i = 0; i < t->wide.count; i++)
        run_lane(s + i, t->at.data, lanes, count, feed->lookups);
      store(t, counter, pass + k, count, t->at.data, out);
    }
    pass += b->count[inner];
    int d = inner - 1;
    while (d >= 0 && ++counter[d] == b->low[d] + b->count[d]) {
      counter[d] = b->low[d];
      d--;
    }
    if (d < 0) return;
  }
}

/* The same with vectors of four where the processor has them; a multiplication and an addition stay two
 * operations, so that the numbers are the same. */
#ifdef STF_SIMD_X86
__attribute__((target("avx2"))) static void
four_at_once(const stf_tape *t, const stf_feed *feed, double *lanes, double *out)
{
  every_pass(t, feed, lanes, out);
}
#endif

static void run_passes(const stf_tape *t, const stf_feed *feed, double *lanes, double *out)
{
#ifdef STF_SIMD_X86
  if (stf_simd_width() >= 4) {
    four_at_once(t, feed, lanes, out);
    return;
  }
#endif
  every_pass(t, feed, lanes, out);
}

/* Not inlined, as what adds: a small tape is run in less time than their registers are saved. */
NOINLINE void run_loops(const stf_tape *t, const stf_feed *feed, double *space, double *out)
{
  double *lanes = space + t->registers;
  const double **at = t->at.data;
  for (int32_t i = 0; i < t->lanes; i++) at[i] = lanes + (size_t)i * STF_PASSES;
  const stf_step_code *b = t->broadcasts.data;
  for (size_t i = 0; i < t->broadcasts.count; i++)
    for (int k = 0; k < STF_PASSES; k++)
      lanes[(size_t)b[i].to * STF_PASSES + (size_t)k] = space[b[i].a];
  run_passes(t, feed, lanes, out);
}

NOINLINE void add_results(const stf_tape *t, const double *space, double *out)
{
  const stf_stretch *o = t->results.data, *end = o + t->results.count;
  for (; o < end; o++)
    for (int32_t k = 0; k < o->count; k++) out[o->a + k] += space[o->at + k];
}

void stf_tape_run(const stf_tape *t, const stf_feed *feed, double *space, double *out)
{
  load(t, t->fixed_loads, t->loads.count, feed, space);
  run_code(t, t->fixed, t->code.count, feed, space);
  if (t->box.dims) {
    run_loops(t, feed, space, out);
  } else if (!t->assigns) {
    add_results(t, space, out);
  } else {
    const stf_stretch *o = t->results.data, *end = o + t->results.count;
    for (; o < end; o++) copy_stretch(out + o->a, space + o->at, o->count);
  }
}
