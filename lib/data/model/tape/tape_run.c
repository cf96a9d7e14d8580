/* tape_run.c: the machine: scalar instructions, and those on lanes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "simd.h"
#include "tape.h"
#include <math.h>
#include <string.h>

/* A call between them: no compiler takes the product and the sum for one operation. */
INLINE double plus(double a, double b) { return a + b; }

static void run_scalar(const stf_step_code *s, const stf_step_code *end, double *r,
                       const stf_lookup *l)
{
  for (; s < end; s++) {
    const double a = r[s->a];
    switch (s->kind) {
    case STF_OP_ADD: r[s->to] = a + r[s->b]; break;
    case STF_OP_SUBTRACT: r[s->to] = a - r[s->b]; break;
    case STF_OP_MULTIPLY: r[s->to] = a * r[s->b]; break;
    case STF_OP_DIVIDE: r[s->to] = a / r[s->b]; break;
    case STF_OP_TIMES_PLUS: r[s->to] = plus(a * r[s->b], r[s->c]); break;
    case STF_OP_TIMES_MINUS: r[s->to] = plus(a * r[s->b], -r[s->c]); break;
    case STF_OP_MINUS_TIMES: r[s->to] = plus(r[s->c], -(a * r[s->b])); break;
    case STF_OP_NEGATIVE: r[s->to] = -a; break;
    case STF_OP_SELECT: r[s->to] = a != 0 ? r[s->b] : r[s->c]; break;
    case STF_OP_LOOKUP: r[s->to] = stf_lookup_value(l + s->b, a); break;
    case STF_OP_TILT: r[s->to] = stf_lookup_slope(l + s->b, a); break;
    default: r[s->to] = stf_operate(s->kind, a, stf_operands(s->kind) > 1 ? r[s->b] : 0, 0);
    }
  }
}

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
  if (kind >= STF_OP_ALONG && kind <= STF_OP_WEIGHT) return f->along[kind - STF_OP_ALONG];
  return kind == STF_OP_STATE    ? f->y
         : kind == STF_OP_SLOPE  ? f->yp
         : kind == STF_OP_MEMORY ? f->memory
                                 : f->p;
}

static double loaded(const stf_feed *f, const stf_load *l)
{
  return l->kind == STF_OP_TIME ? f->t : array_of(f, l->kind)[l->a];
}

void stf_tape_prepare(const stf_tape *t, const stf_feed *feed, double *space)
{
  const stf_load *l = t->numbers.data;
  for (size_t i = 0; i < t->numbers.count; i++)
    space[l[i].to] = *STF_AT(t->values, double, l[i].a);
  l = t->loads.data;
  for (size_t i = 0; i < t->fixed_loads; i++) space[l[i].to] = feed->p[l[i].a];
  const stf_step_code *s = t->code.data;
  if (s) run_scalar(s, s + t->fixed, space, feed->lookups);
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

void stf_tape_run(const stf_tape *t, const stf_feed *feed, double *space, double *out)
{
  double *lanes = space + t->registers;
  const double **at = t->at.data;
  for (int32_t i = 0; i < t->lanes; i++) at[i] = lanes + (size_t)i * STF_PASSES;
  const stf_load *l = t->loads.data;
  const double *y = feed->y;
  for (size_t i = t->fixed_loads; i < t->state_loads; i++) space[l[i].to] = y[l[i].a];
  for (size_t i = t->state_loads; i < t->loads.count; i++) space[l[i].to] = loaded(feed, l + i);
  const stf_step_code *s = t->code.data;
  if (s) run_scalar(s + t->fixed, s + t->code.count, space, feed->lookups);
  if (t->box.dims) {
    const stf_step_code *b = t->broadcasts.data;
    for (size_t i = 0; i < t->broadcasts.count; i++)
      for (int k = 0; k < STF_PASSES; k++)
        lanes[(size_t)b[i].to * STF_PASSES + (size_t)k] = space[b[i].a];
    run_passes(t, feed, lanes, out);
    return;
  }
  const stf_store *o = t->stores.data;
  if (t->assigns)
    for (size_t i = 0; i < t->stores.count; i++) out[o[i].a] = space[o[i].from];
  else
    for (size_t i = 0; i < t->stores.count; i++) out[o[i].a] += space[o[i].from];
}
