/* verdict_case.c: one random question, its answer, and the truth.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "verdict_case.h"
#include <steif/forcing.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define APART 0.3      /* orders that are different */
#define NONE 1e-13     /* of the largest, impulses that are none */
#define OUTSIDE 2      /* of an error bar */
#define ROUNDING 1e-15 /* of an expression */

static const char *const functions[] = {NULL, "(1-t)^12", "exp(-t)*(1+sin(3*t))*(1-t)^9",
                                        "exp(-1/(1-t^2))", "cos(5*t)*(1-t)^10"};
enum { FUNCTIONS = sizeof functions / sizeof *functions, BUMP = 3 };

const char *verdict_outcome_name(enum verdict_outcome outcome)
{
  static const char *const name[] = {"right",       "undecided", "false",
                                     "other_order", "error_bar", "failed"};
  return name[outcome];
}

static int taylor(long double t, int order, long double *c, void *user)
{
  return steif_function_taylor(t, order, c, user);
}

static int method_count(void)
{
  int count = 0;
  while (asked_method_at(count)) count++;
  return count;
}

static void draw(verdict_case *c, stf_random *r)
{
  const planted_system *s = &c->system;
  c->method = (int)stf_random_below(r, method_count());
  c->component = stf_random_below(r, 2) ? STEIF_ALL : (int)stf_random_below(r, s->n);
  c->g = functions[stf_random_below(r, FUNCTIONS)];
  c->h = ldexp(1, -3 - (int)stf_random_below(r, 5));
  if (stf_random_below(r, 3) == 0) c->h *= stf_random_in(r, 0.6, 1.4);
}

/* ---- the truth ------------------------------------------------------------------------------- */

/* The largest impulse of order q of the components asked for. */
static long double size_of(const verdict_case *c, const long double *impulse, int q)
{
  const int n = c->system.n, first = c->component == STEIF_ALL ? 0 : c->component;
  const int count = c->component == STEIF_ALL ? n : 1;
  long double most = 0;
  for (int m = first; m < first + count; m++) most = fmaxl(most, fabsl(impulse[q * n + m]));
  return most;
}

/* One more order; one that is not known leaves open what is above it. */
static void lower(double *least, bool *unknown, double order)
{
  *unknown = *unknown || isnan(order);
  if (order < *least) *least = order;
}

/* The lowest of the orders on impulses that are there, and without any. */
static int find_truth(steif_context *ctx, verdict_case *c, const long double *impulse,
                      method_orders *known)
{
  long double most = 0;
  double order;
  bool unknown = false;
  const int count = c->system.index - 1;
  c->truth = INFINITY;
  for (int q = 0; q < count; q++) most = fmaxl(most, size_of(c, impulse, q));
  for (int q = 0; q < count; q++) {
    if (size_of(c, impulse, q) <= NONE * most) continue;
    STEIF_TRY(method_order_on_impulse(ctx, c->method, q, known, &order));
    lower(&c->truth, &unknown, order);
  }
  if (c->system.forcing != SYSTEM_FREE || c->system.finite) {
    STEIF_TRY(method_order_without(ctx, c->method, &c->system, c->component, &order));
    lower(&c->truth, &unknown, order);
  }
  if (unknown && c->truth > APART) c->truth = NAN;
  return STEIF_OK;
}

/* The error of row i as the canonical run has it, over the level of the row. */
static int compare(steif_context *ctx, verdict_case *c, const stf_weight *g,
                   const long double *exact, int i)
{
  planted_system *s = &c->system;
  const steif_weak_row *row = c->row + i;
  long double made[SYSTEM_MOST], sum = 0;
  const size_t steps = (size_t)ceil(1 / row->h * (1 - 1e-9));
  STEIF_TRY(canonical_run(ctx, c->method, &s->plain, s->z0, s->index, g, row->h, steps, made));
  for (int m = 0; m < s->n; m++) made[m] -= exact[m];
  for (int m = 0; m < s->n; m++) {
    const long double e = planted_system_component(s, m, made);
    if (c->component == STEIF_ALL)
      sum = hypotl(sum, e);
    else if (m == c->component)
      sum = e;
  }
  c->off = fmax(c->off, fabs((double)(row->error - sum)) / row->rounding);
  return STEIF_OK;
}

static enum verdict_outcome judge(const verdict_case *c)
{
  const int converges = c->result.converges;
  if (converges >= 0 && !isnan(c->truth) && converges != (c->truth > APART))
    return VERDICT_FALSE;
  if (c->off > OUTSIDE) return VERDICT_ERROR_BAR;
  if (converges < 0) return VERDICT_OPEN;
  if (converges == 1 && fabs(c->result.order - c->truth) > APART && isfinite(c->truth) &&
      c->g != functions[BUMP])
    return VERDICT_ORDER;
  return VERDICT_RIGHT;
}

static int check(steif_context *ctx, verdict_case *c, const steif_weight *given,
                 method_orders *known)
{
  const stf_weight g = stf_weight_of(ctx, given);
  long double exact[SYSTEM_MOST], impulse[SYSTEM_MOST * SYSTEM_MOST];
  int last = -1, first = -1;
  STEIF_TRY(planted_system_exact(&c->system, &g, exact, impulse));
  STEIF_TRY(find_truth(ctx, c, impulse, known));
  for (int i = 0; i < VERDICT_ROWS; i++)
    if (c->row[i].usable) last = i, first = first < 0 ? i : first;
  if (first >= 0) STEIF_TRY(compare(ctx, c, &g, exact, first));
  if (last > first) STEIF_TRY(compare(ctx, c, &g, exact, last));
  c->outcome = judge(c);
  return STEIF_OK;
}

/* ---- a case ---------------------------------------------------------------------------------- */

static bool is_failure(int code) { return code != STEIF_OK && code != STEIF_NO_MEMORY; }

int verdict_case_run(steif_context *ctx, long seed, method_orders *known, verdict_case *c)
{
  steif_function *f = NULL;
  c->seed = seed, c->off = 0, c->truth = NAN, c->outcome = VERDICT_FAILED;
  STEIF_TRY(planted_system_new(ctx, seed, &c->system));
  draw(c, &c->system.random);
  const asked_method *a = asked_method_at(c->method);
  if (c->g && !(f = steif_function_parse(ctx, c->g, 1, NULL))) return steif_status(ctx);
  const steif_weight g = {taylor, f, 1, ROUNDING};
  const steif_weak_query query = {.method = a->method,
                                  .start = a->start,
                                  .convention = a->convention,
                                  .linear = &c->system.linear,
                                  .x0 = c->system.x0,
                                  .component = c->component,
                                  .g = f ? &g : NULL,
                                  .h = c->h,
                                  .rows = VERDICT_ROWS};
  int code = steif_weak_measure(ctx, &query, c->row, &c->result);
  const bool failed = is_failure(code);
  if (!code) code = check(ctx, c, query.g, known);
  steif_function_free(&f);
  return failed ? STEIF_OK : code;
}

void verdict_case_free(verdict_case *c) { planted_system_free(&c->system); }
