/* series.c: Taylor coefficients in t of nodes. At a kink or
 * jump they are those to the right. SPDX-License-Identifier: BSD-3-Clause */
#include "series.h"
#include <math.h>
#include <string.h>

typedef struct machine {
  int order;
  const stf_feed *feed;
  const stf_curve *curve;
  const int32_t *counter;
  stf_series *scratch; /* 4 */
} machine;

/* The sign of a series just to the right. */
static int sign(const stf_series *a, int n)
{
  for (int k = 0; k <= n; k++)
    if (a->c[k] != 0) return a->c[k] > 0 ? 1 : -1;
  return 0;
}

/* That of a - b. */
static int sign_of_difference(int n, const stf_series *a, const stf_series *b)
{
  for (int k = 0; k <= n; k++)
    if (a->c[k] != b->c[k]) return a->c[k] > b->c[k] ? 1 : -1;
  return 0;
}

static void copy(int n, const stf_series *a, double factor, stf_series *to)
{
  for (int k = 0; k <= n; k++) to->c[k] = factor * a->c[k];
}

/* Unknown `at`, or its derivative. */
static void of_curve(const machine *m, int64_t at, bool slope, stf_series *u)
{
  const int64_t n = m->curve->n;
  for (int k = 0; k <= m->order; k++)
    u->c[k] = slope ? (k + 1) * m->curve->y[(k + 1) * n + at] : m->curve->y[k * n + at];
}

static const char *leaf(const machine *m, const stf_node *n, stf_series *u)
{
  double value = n->number;
  const bool unknown = n->kind == STF_OP_STATE || n->kind == STF_OP_SLOPE;
  if ((unknown || n->kind == STF_OP_MEMORY) && !m->curve) return "unknowns";
  const int64_t at = unknown || n->kind == STF_OP_MEMORY
                       ? n->a + (int64_t)n->b * m->counter[0] +
                           (int64_t)n->stride[0] * m->counter[1] +
                           (int64_t)n->stride[1] * m->counter[2]
                       : 0;
  if (unknown) {
    of_curve(m, at, n->kind == STF_OP_SLOPE, u);
    return NULL;
  }
  if (n->kind == STF_OP_MEMORY) value = m->feed->memory[at];
  if (n->kind == STF_OP_TIME) value = m->feed->t;
  if (n->kind == STF_OP_PARAMETER) value = m->feed->p[n->a];
  if (n->kind == STF_OP_COUNTER) value = m->counter[n->a];
  stf_series_constant(m->order, value, u);
  if (n->kind == STF_OP_TIME && m->order) u->c[1] = 1;
  return NULL;
}

static double floor_to_the_right(int n, const stf_series *a)
{
  stf_series rest = *a;
  rest.c[0] = 0;
  const bool falls = a->c[0] == floor(a->c[0]) && sign(&rest, n) < 0;
  return floor(a->c[0]) - falls;
}

static const char *of_one(const machine *m, const stf_node *n, const stf_series *a,
                          stf_series *u)
{
  const int order = m->order;
  stf_series *w = m->scratch;
  switch (n->kind) {
  case STF_OP_NEGATIVE: copy(order, a, -1, u); return NULL;
  case STF_OP_SIN: stf_series_waves(order, a, -1, u, w); return NULL;
  case STF_OP_COS: stf_series_waves(order, a, -1, w, u); return NULL;
  case STF_OP_SINH: stf_series_waves(order, a, 1, u, w); return NULL;
  case STF_OP_COSH: stf_series_waves(order, a, 1, w, u); return NULL;
  case STF_OP_TAN: return stf_series_tan(order, a, 1, u, w);
  case STF_OP_TANH: return stf_series_tan(order, a, -1, u, w);
  case STF_OP_ATAN: stf_series_atan(order, a, u, w); return NULL;
  case STF_OP_EXP: stf_series_exp(order, a, u); return NULL;
  case STF_OP_EXPM1:
    stf_series_exp(order, a, u);
    u->c[0] = expm1(a->c[0]);
    return NULL;
  case STF_OP_LOG: return stf_series_log(order, a, u);
  case STF_OP_LOG10:
    copy(order, a, 1, w);
    if (!(a->c[0] > 0)) return "the logarithm of a number that is not positive";
    stf_series_log(order, w, w + 1);
    copy(order, w + 1, 1 / log(10), u);
    return NULL;
  case STF_OP_LOG1P:
    copy(order, a, 1, w);
    w->c[0] += 1;
    return stf_series_log(order, w, u);
  case STF_OP_SQRT: return stf_series_power(order, a, 0.5, u);
  case STF_OP_CBRT: return stf_series_power(order, a, 1.0 / 3, u);
  case STF_OP_ABS: copy(order, a, sign(a, order) < 0 ? -1 : 1, u); return NULL;
  case STF_OP_RAMP: copy(order, a, sign(a, order) > 0, u); return NULL;
  case STF_OP_STEP: stf_series_constant(order, sign(a, order) >= 0, u); return NULL;
  case STF_OP_SIGN: stf_series_constant(order, sign(a, order), u); return NULL;
  case STF_OP_NOT: stf_series_constant(order, a->c[0] == 0, u); return NULL;
  case STF_OP_FLOOR: stf_series_constant(order, floor_to_the_right(order, a), u); return NULL;
  case STF_OP_LOOKUP:
    copy(order, a, 1, w);
    w->c[0] = 0;
    return stf_lookup_series(m->feed->lookups + n->b, order, a, sign(w, order), u, w);
  default: return stf_special_series(n->kind, order, a, u, w);
  }
}

static const char *power(const machine *m, const stf_series *a, const stf_series *b,
                         stf_series *u)
{
  const int order = m->order;
  const double p = b->c[0];
  bool constant = true;
  for (int k = 1; k <= order; k++) constant = constant && b->c[k] == 0;
  if (constant && p == floor(p) && fabs(p) <= 1 << 30)
    return stf_series_whole(order, a, (long)p, u, m->scratch);
  if (constant) return stf_series_power(order, a, p, u);
  if (!(a->c[0] > 0))
    return "a power of a number that is not positive, the exponent not constant";
  stf_series_log(order, a, m->scratch);
  stf_series_times(order, m->scratch, b, m->scratch + 1);
  stf_series_exp(order, m->scratch + 1, u);
  return NULL;
}

static const char *length(int n, const stf_series *a, const stf_series *b, stf_series *u,
                          stf_series *w)
{
  stf_series_times(n, a, a, w);
  stf_series_times(n, b, b, w + 1);
  for (int k = 0; k <= n; k++) w->c[k] += w[1].c[k];
  return stf_series_power(n, w, 0.5, u);
}

/* a - b floor(a/b) */
static const char *remainder_of(int n, const stf_series *a, const stf_series *b, stf_series *u,
                                stf_series *w)
{
  const char *wrong = stf_series_over(n, a, b, w);
  if (wrong) return wrong;
  const double whole = floor_to_the_right(n, w);
  for (int k = 0; k <= n; k++) u->c[k] = a->c[k] - whole * b->c[k];
  return NULL;
}

static const char *of_two(const machine *m, const stf_node *n, const stf_series *a,
                          const stf_series *b, stf_series *u)
{
  const int order = m->order;
  switch (n->kind) {
  case STF_OP_ADD:
    for (int k = 0; k <= order; k++) u->c[k] = a->c[k] + b->c[k];
    return NULL;
  case STF_OP_SUBTRACT:
    for (int k = 0; k <= order; k++) u->c[k] = a->c[k] - b->c[k];
    return NULL;
  case STF_OP_MULTIPLY: stf_series_times(order, a, b, u); return NULL;
  case STF_OP_DIVIDE: return stf_series_over(order, a, b, u);
  case STF_OP_POWER: return power(m, a, b, u);
  case STF_OP_MIN: copy(order, sign_of_difference(order, a, b) < 0 ? a : b, 1, u); return NULL;
  case STF_OP_MAX: copy(order, sign_of_difference(order, a, b) > 0 ? a : b, 1, u); return NULL;
  case STF_OP_LESS:
    stf_series_constant(order, sign_of_difference(order, a, b) < 0, u);
    return NULL;
  case STF_OP_LESS_EQUAL:
    stf_series_constant(order, sign_of_difference(order, a, b) <= 0, u);
    return NULL;
  case STF_OP_ATAN2: return stf_angle_series(order, a, b, u, m->scratch);
  case STF_OP_HYPOT: return length(order, a, b, u, m->scratch);
  case STF_OP_MOD: return remainder_of(order, a, b, u, m->scratch);
  default:
    stf_series_constant(order, stf_operate(n->kind, a->c[0], b->c[0], 0), u);
    return NULL;
  }
}

const char *stf_series_run(const stf_formulas *g, const int32_t *list, size_t count,
                           const stf_feed *feed, const stf_curve *curve, const int32_t *counter,
                           int order, int32_t *place, stf_series *all, int32_t *wrong)
{
  const machine m = {order, feed, curve, counter, all + count};
  const char *first = NULL;
  int32_t child[3];
  for (size_t i = 0; i < count; i++) {
    const stf_node *n = stf_node_at(g, list[i]);
    const int operands = stf_children(n, child);
    const stf_series *x[3] = {NULL, NULL, NULL};
    const char *why = NULL;
    for (int k = 0; k < operands; k++) x[k] = all + place[child[k]];
    place[list[i]] = (int32_t)i;
    if (operands == 0) why = leaf(&m, n, all + i);
    if (operands == 1) why = of_one(&m, n, x[0], all + i);
    if (operands == 2) why = of_two(&m, n, x[0], x[1], all + i);
    if (operands == 3) copy(order, x[0]->c[0] != 0 ? x[1] : x[2], 1, all + i);
    for (int k = 0; why && k <= order; k++) all[i].c[k] = NAN;
    if (why && !first) first = why, *wrong = list[i];
  }
  return first;
}

int stf_taylor(const stf_formulas *g, int32_t root, const stf_feed *feed,
               const stf_curve *curve, const int32_t *counter, int order, stf_sweep *sweep,
               double *value, const char **why)
{
  int32_t wrong;
  STEIF_TRY(stf_reach(g, root, &sweep->mark, &sweep->list));
  STEIF_TRY(stf_vector_resize(g->ctx, &sweep->adjoint, g->nodes.count, sizeof(int32_t)));
  const size_t count = sweep->list.count;
  stf_series *all = stf_allocate(g->ctx, count + 4, sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  const char *first = stf_series_run(g, sweep->list.data, count, feed, curve, counter, order,
                                     sweep->adjoint.data, all, &wrong);
  if (first && why && !*why) *why = first;
  bool finite = true;
  for (int k = 0; k <= order; k++) {
    value[k] = all[count - 1].c[k];
    finite = finite && isfinite(value[k]);
  }
  for (size_t i = 0; i < count; i++)
    *STF_AT(sweep->adjoint, int32_t, *STF_AT(sweep->list, int32_t, i)) = 0;
  stf_release(g->ctx, all);
  return finite ? STEIF_OK : STEIF_RETRY;
}
