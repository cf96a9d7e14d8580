/* c_tape.c: a tape as a function in C. Registers are constants of their scope: r of scalars, w of a pass.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "native.h"
#include <stdio.h>
#include <string.h>

static const char finding_functions[] =
  "static long interval(const struct table *l, double x)\n"
  "{\n"
  "  long low = 0, high = l->count - 1;\n"
  "  while (high - low > 1) {\n"
  "    const long middle = (low + high) / 2;\n"
  "    if (l->x[middle] <= x)\n"
  "      low = middle;\n"
  "    else\n"
  "      high = middle;\n"
  "  }\n"
  "  return low;\n"
  "}\n"
  "static inline int outside(const struct table *l, double x)\n"
  "{\n"
  "  return !(x == x) || (l->error && !(x >= l->x[0] && x <= l->x[l->count - 1]));\n"
  "}\n";
static const char value_function[] =
  "static inline double value(const struct table *l, double x)\n"
  "{\n"
  "  if (outside(l, x)) return NAN;\n"
  "  if (x <= l->x[0]) return l->y[0];\n"
  "  if (x >= l->x[l->count - 1]) return l->y[l->count - 1];\n"
  "  const long i = interval(l, x);\n"
  "  const double h = l->x[i + 1] - l->x[i], s = (x - l->x[i]) / h, rise = l->y[i + 1] - "
  "l->y[i];\n"
  "  if (l->kind == 2) return l->y[i];\n"
  "  if (l->kind == 0) return l->y[i] + s * rise;\n"
  "  if (l->kind == 3) return l->y[i] + l->slope[i] * (x - l->x[i]);\n"
  "  const double a = h * l->slope[i] - rise, b = rise - h * l->slope[i + 1];\n"
  "  return l->y[i] + s * rise + s * (1 - s) * (a * (1 - s) + b * s);\n"
  "}\n";
static const char slope_function[] =
  "static inline double tilt(const struct table *l, double x)\n"
  "{\n"
  "  if (outside(l, x)) return NAN;\n"
  "  if (x < l->x[0] || x >= l->x[l->count - 1] || l->kind == 2) return 0;\n"
  "  const long i = interval(l, x);\n"
  "  const double h = l->x[i + 1] - l->x[i], s = (x - l->x[i]) / h, rise = l->y[i + 1] - "
  "l->y[i];\n"
  "  if (l->kind == 0) return rise / h;\n"
  "  if (l->kind == 3) return l->slope[i];\n"
  "  const double a = h * l->slope[i] - rise, b = rise - h * l->slope[i + 1];\n"
  "  return (rise + (1 - 2 * s) * (a * (1 - s) + b * s) + s * (1 - s) * (b - a)) / h;\n"
  "}\n";

/* ---- operations ------------------------------------------------------------------------------- */

static const char *const infix[STF_OP_KINDS] = {
  [STF_OP_ADD] = "+", [STF_OP_SUBTRACT] = "-", [STF_OP_MULTIPLY] = "*", [STF_OP_DIVIDE] = "/"};

static const char *const value_of[STF_OP_KINDS] = {
#define STF_ONE(name, word, value) [STF_OP_##name] = #value,
  STF_UNARY(STF_ONE) STF_BINARY(STF_ONE)
#undef STF_ONE
};

static void mark_used(const stf_tape *t, bool *used)
{
  const int32_t *s = t->code.data, *end = s + t->code.count, *factors;
  for (stf_step_code step; s < end;) {
    s = stf_tape_decode(s, &step, &factors);
    used[step.kind] = true;
  }
  for (size_t i = 0; i < t->wide.count; i++)
    used[STF_AT(t->wide, stf_step_code, i)->kind] = true;
}

static void array(stf_writer *w, const char *name, size_t which, size_t count, const double *x)
{
  stf_write(w, "static const double %s%zu[] = {", name, which);
  for (size_t i = 0; i < count; i++) {
    stf_write_number(w, x[i]);
    stf_write(w, i % 8 == 7 ? ",\n" : ", ");
  }
  stf_write(w, "};\n");
}

static bool has_slopes(const stf_lookup *l)
{
  return l->kind == STF_CUBIC_TABLE || l->kind == STF_LINES_TABLE;
}

/* The functions of tables.c that occur. */
static void tables(stf_writer *w, const stf_model *m, const bool *used)
{
  for (int32_t i = 0; i < 4 * m->tables; i++) {
    const stf_lookup *l = m->lookups + i;
    if (!l->count) continue;
    array(w, "table_x", (size_t)i, l->count, l->x);
    array(w, "table_y", (size_t)i, l->count, l->y);
    if (has_slopes(l)) array(w, "table_slope", (size_t)i, l->count, l->slope);
  }
  stf_write(
    w, "static const struct table { int kind, error; long count; const double *x, *y, *slope; "
       "} table[] = {\n");
  for (int32_t i = 0; i < 4 * m->tables; i++) {
    const stf_lookup *l = m->lookups + i;
    if (!l->count) {
      stf_write(w, "  {0, 0, 0, 0, 0, 0},\n");
      continue;
    }
    stf_write(w, "  {%d, %d, %zu, table_x%d, table_y%d, ", l->kind, (int)l->error, l->count,
              (int)i, (int)i);
    stf_write(w, has_slopes(l) ? "table_slope%d},\n" : "0},\n", (int)i);
  }
  stf_write_text(w, "};\n");
  stf_write_text(w, finding_functions);
  if (used[STF_OP_LOOKUP]) stf_write_text(w, value_function);
  if (used[STF_OP_TILT]) stf_write_text(w, slope_function);
}

/* Those that occur, by the same table of values as the machine's. */
void stf_write_functions(stf_writer *w, const stf_model *m, size_t count,
                         const stf_quantity *const *quantities)
{
  bool used[STF_OP_KINDS] = {false};
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < quantities[i]->tapes.count; k++) {
      const stf_tape *t = STF_AT(quantities[i]->tapes, stf_tape, k);
      mark_used(t, used);
    }
  if (used[STF_OP_LOOKUP] || used[STF_OP_TILT]) tables(w, m, used);
  if (used[STF_OP_TIMES_PLUS] || used[STF_OP_TIMES_MINUS] || used[STF_OP_MINUS_TIMES] ||
      used[STF_OP_PAIRS] || used[STF_OP_TRIPLES])
    stf_write(w, "static inline double plus(double a, double b) { return a + b; }\n");
  for (int k = 0; k < STF_OP_KINDS; k++) {
    if (!used[k] || !value_of[k] || infix[k] || k == STF_OP_NEGATIVE) continue;
    stf_write(w, "static inline double op%d(double a%s) { return %s; }\n", k,
              stf_operands(k) > 1 ? ", double b" : "", value_of[k]);
  }
  if (used[STF_OP_SELECT])
    stf_write(
      w, "static inline double op%d(double a, double b, double c) { return a != 0 ? b : c; }\n",
      STF_OP_SELECT);
}

static void operation(stf_writer *w, const stf_step_code *s, const char *a, const char *b,
                      const char *c)
{
  if (infix[s->kind])
    stf_write(w, "%s %s %s;\n", a, infix[s->kind], b);
  else if (s->kind == STF_OP_NEGATIVE)
    stf_write(w, "-%s;\n", a);
  else if (s->kind == STF_OP_LOOKUP || s->kind == STF_OP_TILT)
    stf_write(w, "%s(&table[%d], %s);\n", s->kind == STF_OP_LOOKUP ? "value" : "tilt",
              (int)s->b, a);
  else if (s->kind == STF_OP_TIMES_PLUS)
    stf_write(w, "plus(%s * %s, %s);\n", a, b, c);
  else if (s->kind == STF_OP_TIMES_MINUS)
    stf_write(w, "plus(%s * %s, -%s);\n", a, b, c);
  else if (s->kind == STF_OP_MINUS_TIMES)
    stf_write(w, "plus(%s, -(%s * %s));\n", c, a, b);
  else if (s->kind == STF_OP_SELECT)
    stf_write(w, "op%d(%s, %s, %s);\n", s->kind, a, b, c);
  else if (stf_operands(s->kind) > 1)
    stf_write(w, "op%d(%s, %s);\n", s->kind, a, b);
  else
    stf_write(w, "op%d(%s);\n", s->kind, a);
}

/* ---- the parts of a function ------------------------------------------------------------------ */

static const char *array_of(int kind)
{
  return kind == STF_OP_STATE    ? "y"
         : kind == STF_OP_SLOPE  ? "yp"
         : kind == STF_OP_MEMORY ? "m"
                                 : "p";
}

/* a + stride . counters */
static void place(stf_writer *w, int32_t a, const int32_t *stride, int dims)
{
  stf_write(w, "%d", (int)a);
  for (int d = 0; d < dims; d++)
    if (stride[d] == 1)
      stf_write(w, " + i%d", d);
    else if (stride[d])
      stf_write(w, " + %d * i%d", (int)stride[d], d);
}

static void scalar_load(stf_writer *w, const stf_stretch *l)
{
  for (int k = 0; k < (int)l->count; k++)
    if (l->kind == STF_OP_TIME)
      stf_write(w, "  const double r%d = t;\n", (int)l->at);
    else
      stf_write(w, "  const double r%d = %s[%d];\n", (int)l->at + k, array_of(l->kind),
                (int)l->a + k);
}

/* plus(plus(r1 * r2, r3 * r4), r5 * r6) */
static void products(stf_writer *w, const stf_step_code *s, const int32_t *factor)
{
  const bool triples = s->kind == STF_OP_TRIPLES;
  for (int32_t i = 1; i < s->c; i++) stf_write_text(w, "plus(");
  for (int32_t i = 0; i < s->c; i++, factor += triples ? 3 : 2) {
    stf_write(w, "%sr%d * r%d", i ? ", " : "", (int)factor[0], (int)factor[1]);
    if (triples) stf_write(w, " * r%d", (int)factor[2]);
    if (i) stf_write_text(w, ")");
  }
  stf_write_text(w, ";\n");
}

static void step(stf_writer *w, const stf_step_code *s, const int32_t *factors)
{
  const int32_t from[3] = {s->a, s->b, s->c};
  char name[3][20];
  stf_write(w, "  const double r%d = ", (int)s->to);
  for (int k = 0; k < 3; k++) snprintf(name[k], sizeof *name, "r%d", (int)from[k]);
  if (factors)
    products(w, s, factors);
  else
    operation(w, s, name[0], name[1], name[2]);
}

static void scalars(stf_writer *w, const stf_tape *t, bool fixed)
{
  const stf_stretch *l = t->loads.data;
  const size_t loads[2] = {fixed ? 0 : t->fixed_loads, fixed ? t->fixed_loads : t->loads.count};
  const int32_t *code = t->code.data, *s = code + (fixed ? 0 : t->fixed),
                *end = code + (fixed ? t->fixed : t->code.count), *factors;
  for (size_t i = loads[0]; i < loads[1]; i++) scalar_load(w, l + i);
  for (stf_step_code next; s < end;) {
    s = stf_tape_decode(s, &next, &factors);
    step(w, &next, factors);
  }
}

static void numbers(stf_writer *w, const stf_tape *t)
{
  for (size_t i = 0; i < t->numbers.count; i++) {
    stf_write(w, "  const double r%zu = ", i);
    stf_write_number(w, *STF_AT(t->numbers, double, i));
    stf_write(w, ";\n");
  }
}

/* What parameters determine, from the registers that the library has prepared. */
static void given(stf_writer *w, const stf_tape *t)
{
  const stf_stretch *l = t->loads.data;
  const int32_t *s = t->code.data, *end = s + t->fixed, *factors;
  for (size_t i = 0; i < t->fixed_loads; i++)
    for (int k = l[i].at; k < l[i].at + l[i].count; k++)
      stf_write(w, "  const double r%d = r[%d];\n", k, k);
  for (stf_step_code next; s < end;) {
    s = stf_tape_decode(s, &next, &factors);
    stf_write(w, "  const double r%d = r[%d];\n", (int)next.to, (int)next.to);
  }
}

static const char *sign(const stf_tape *t) { return t->assigns ? "=" : "+="; }

static void results(stf_writer *w, const stf_tape *t)
{
  for (size_t i = 0; i < t->results.count; i++) {
    const stf_stretch *r = STF_AT(t->results, stf_stretch, i);
    for (int k = 0; k < (int)r->count; k++)
      stf_write(w, "  out[%d] %s r%d;\n", (int)r->a + k, sign(t), (int)r->at + k);
  }
}

static void stores(stf_writer *w, const stf_dialect *d, const stf_tape *t, size_t tape)
{
  for (size_t i = 0; i < t->stores.count; i++) {
    const stf_store *s = STF_AT(t->stores, stf_store, i);
    stf_write(w, "  out[");
    if (!s->slot)
      place(w, s->a, s->stride, t->box.dims);
    else if (d->standalone)
      stf_write(w, "slot_%s_%zu_%zu[k]", d->name, tape, i);
    else
      stf_write(w, "s%zu[k]", i);
    stf_write(w, "] %s w%d;\n", sign(t), (int)s->from);
  }
}

/* ---- loops ------------------------------------------------------------------------------------ */

static bool has_slots(const stf_tape *t)
{
  for (size_t i = 0; i < t->stores.count; i++)
    if (STF_AT(t->stores, stf_store, i)->slot) return true;
  return false;
}

static void body(stf_writer *w, const stf_tape *t)
{
  const stf_load *l = t->wide_loads.data;
  const stf_step_code *s = t->wide.data;
  char name[3][20];
  for (size_t i = 0; i < t->wide_loads.count; i++) {
    stf_write(w, "  const double w%d = ", (int)l[i].to);
    if (l[i].kind == STF_OP_COUNTER)
      stf_write(w, "(double)i%d;\n", (int)l[i].a);
    else {
      stf_write(w, "%s[", array_of(l[i].kind));
      place(w, l[i].a, l[i].stride, t->box.dims);
      stf_write(w, "];\n");
    }
  }
  for (size_t i = 0; i < t->wide.count; i++) {
    const int32_t from[3] = {s[i].a, s[i].b, s[i].c};
    for (int k = 0; k < 3; k++) snprintf(name[k], sizeof *name, "w%d", (int)from[k]);
    stf_write(w, "  const double w%d = ", (int)s[i].to);
    operation(w, s + i, name[0], name[1], name[2]);
  }
}

static void loops(stf_writer *w, const stf_dialect *d, const stf_tape *t, size_t tape)
{
  const stf_step_code *b = t->broadcasts.data;
  const int dims = t->box.dims;
  const bool slots = has_slots(t);
  for (size_t i = 0; i < t->broadcasts.count; i++)
    stf_write(w, "  const double w%d = r%d;\n", (int)b[i].to, (int)b[i].a);
  for (size_t i = 0; slots && !d->standalone && i < t->stores.count; i++)
    if (STF_AT(t->stores, stf_store, i)->slot)
      stf_write(w, "  const int *const s%zu = slot[%zu];\n", i, i);
  for (int k = 0; k < dims; k++) {
    const int low = t->box.low[k];
    stf_write(w, "  for (long i%d = %d; i%d < %lld; i%d++) {\n", k, low, k,
              (long long)low + t->box.count[k], k);
  }
  if (slots) {
    stf_write(w, "  const long k = ");
    for (int k = 1; k < dims; k++) stf_write(w, "(");
    stf_write(w, "(i0 - %d)", (int)t->box.low[0]);
    for (int k = 1; k < dims; k++)
      stf_write(w, " * %d + (i%d - %d))", (int)t->box.count[k], k, (int)t->box.low[k]);
    stf_write(w, ";\n");
  }
  body(w, t);
  stores(w, d, t, tape);
  for (int k = 0; k < dims; k++) stf_write(w, "  }\n");
}

/* ---- functions -------------------------------------------------------------------------------- */

static void slot_arrays(stf_writer *w, const stf_dialect *d, const stf_tape *t, size_t tape)
{
  const int64_t passes = stf_passes(&t->box);
  for (size_t i = 0; t->box.dims && i < t->stores.count; i++) {
    const stf_store *s = STF_AT(t->stores, stf_store, i);
    if (!s->slot) continue;
    stf_write(w, "static const int slot_%s_%zu_%zu[] = {", d->name, tape, i);
    for (int64_t k = 0; k < passes; k++)
      stf_write(w, "%d,%s", (int)s->slot[k], k % 16 == 15 ? "\n" : " ");
    stf_write(w, "};\n");
  }
}

static void one(stf_writer *w, const stf_dialect *d, const stf_tape *t, size_t tape)
{
  if (d->standalone) slot_arrays(w, d, t, tape);
  stf_write(w,
            "%svoid %s_%zu(double t, const double *restrict y, const double *restrict yp,\n"
            "  const double *restrict p, const double *restrict m%s,\n"
            "  double *restrict out)\n{\n",
            d->store, d->name, tape,
            d->standalone ? "" : ", const double *restrict r, const int *const *slot");
  stf_write(w, "  (void)t, (void)y, (void)yp, (void)p, (void)m%s;\n",
            d->standalone ? "" : ", (void)r, (void)slot");
  numbers(w, t);
  if (d->standalone)
    scalars(w, t, true);
  else
    given(w, t);
  scalars(w, t, false);
  if (t->box.dims)
    loops(w, d, t, tape);
  else
    results(w, t);
  stf_write(w, "}\n\n");
}

size_t stf_write_quantity(stf_writer *w, const stf_dialect *d, const stf_quantity *q)
{
  size_t count = 0;
  for (size_t i = 0; i < q->tapes.count; i++) {
    const stf_tape *t = STF_AT(q->tapes, stf_tape, i);
    const size_t statements = t->code.count / 4 + t->wide.count + t->stores.count;
    if (d->most && statements > (size_t)d->most) continue;
    one(w, d, t, i);
    count++;
  }
  return count;
}
