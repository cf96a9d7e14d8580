/* exponent_laws.c: what exact Lyapunov exponents satisfy: Liouville's formula for their sum, the exponent 0
 * of a flow, multipliers of
 * the recurrence.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "period_search.h"
#include "variation.h"
#include "lapack.h"
#include <math.h>
#include <stdlib.h>

enum { ERRORS = 4, WORK = 8 }; /* standard errors allowed for; dgeev's work per row */

typedef struct trial {
  steif_context *ctx;
  const steif_lyapunov_options *options;
  const sunrealtype *exponent;
  const steif_lyapunov_facts *facts;
  int m; /* exponents */
  steif_lyapunov_check *check;
  int *count;
} trial;

static void judge(trial *t, enum steif_lyapunov_law law, int which, sunrealtype value,
                  sunrealtype expected, sunrealtype tolerance)
{
  static const char *const name[] = {"sum", "flow", "recurrence"}; /* enum steif_lyapunov_law */
  const sunrealtype unit = fmin(1, 1 / t->facts->h),
                    bound = fmax(tolerance, STF_EXPONENT_ROUNDING * (unit + fabs(expected)));
  t->check[*t->count] = (steif_lyapunov_check){
    law, name[law], which, value, expected, bound, fabs(value - expected) <= bound};
  ++*t->count;
}

static int sum(trial *t, const steif_problem *p, sunrealtype accuracy)
{
  stf_mean_trace trace;
  sunrealtype most = 0;
  if (t->m < (int)p->n || isnan(t->facts->trace)) return STEIF_OK;
  STEIF_TRY(stf_mean_trace_find(t->ctx, p, t->facts->end - t->facts->time, t->facts->end,
                                t->facts->linear, t->options->stop, &trace));
  if (!trace.known) return STEIF_OK;
  for (int i = 0; i < t->m; i++) most = fmax(most, fabs(t->exponent[i]));
  judge(t, STEIF_SUM_LAW, 0, t->facts->sum, trace.value, accuracy * most + trace.error);
  return STEIF_OK;
}

static void flow(trial *t)
{
  const sunrealtype speed = t->facts->flow;
  int nearest = 0;
  if (!(speed * t->facts->time > log(STF_AT_REST))) return; /* at rest, or no flow */
  for (int i = 1; i < t->m; i++)
    if (fabs(t->exponent[i]) < fabs(t->exponent[nearest])) nearest = i;
  judge(t, STEIF_FLOW_LAW, nearest + 1, t->exponent[nearest], 0,
        fabs(speed) + ERRORS * t->options->error[nearest]);
}

/* ln |multiplier| / period, the largest first; NaN: lost in rounding. */
static int multipliers(steif_context *ctx, int d, sunrealtype *Phi, sunrealtype period,
                       sunrealtype *rate, sunrealtype *work)
{
  const int one = 1, length = WORK * d;
  sunrealtype *im = work, none;
  int info;
  dgeev_("N", "N", &d, Phi, &d, rate, im, &none, &one, &none, &one, work + d, &length, &info, 1,
         1);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "the multipliers of a period were not found (dgeev: %d)", info);
  for (int i = 0; i < d; i++) rate[i] = log(hypot(rate[i], im[i])) / period;
  for (int i = 1; i < d; i++) /* insertion */
    for (int j = i; j > 0 && rate[j] > rate[j - 1]; j--) {
      const sunrealtype kept = rate[j];
      rate[j] = rate[j - 1];
      rate[j - 1] = kept;
    }
  for (int i = d - 1; i > 0; i--)
    if (!(rate[i] > rate[0] + log(STF_MULTIPLIER_ROUNDING) / period)) rate[i] = NAN;
  return STEIF_OK;
}

/* Is it one of A(t)? */
static int tested(stf_pool *pool, trial *t, const steif_problem *p, sunrealtype period)
{
  stf_variation v;
  STEIF_TRY(
    stf_variation_open(pool, t->ctx, p, "be", t->facts->h, p->t0 + t->facts->h, 1, 1, &v));
  return stf_period_tested(&v, t->facts->end, period);
}

static int recurrence(stf_pool *pool, trial *t, const steif_problem *p, const char *method,
                      sunrealtype period)
{
  const size_t d = (size_t)p->n;
  const sunrealtype m = round(period / t->facts->h);
  STEIF_CHECK(t->facts->linear && !p->E && !p->F, t->ctx, STEIF_UNSUPPORTED,
              "'%s' is not x' = A(t) x, whose multipliers are found: leave the period %g out",
              p->name, period);
  STEIF_CHECK(m >= 1 && fabs(period - m * t->facts->h) <= STF_PERIOD_OFF * period, t->ctx,
              STEIF_BAD_INPUT,
              "%.6g steps of h = %.12g make the period %.12g, which must be a whole number: h "
              "= %.17g makes "
              "%.0f",
              period / t->facts->h, t->facts->h, period, period / fmax(m, 1), fmax(m, 1));
  STEIF_TRY(tested(pool, t, p, period));
  sunrealtype *Phi = stf_pool_array(pool, d * d + (2 + WORK) * d, sizeof *Phi);
  if (!Phi) return STEIF_NO_MEMORY;
  sunrealtype *rate = Phi + d * d;
  STEIF_TRY(stf_period_map(pool, t->ctx, p, method, t->facts->h, (long)m, Phi));
  STEIF_TRY(multipliers(t->ctx, (int)d, Phi, period, rate, rate + d));
  for (int i = 0; i < t->m; i++)
    if (isfinite(rate[i]))
      judge(t, STEIF_RECURRENCE_LAW, i + 1, t->exponent[i], rate[i],
            ERRORS * t->options->error[i]);
  return STEIF_OK;
}

int steif_lyapunov_verify(steif_context *ctx, const steif_problem *problem, const char *method,
                          const steif_lyapunov_options *options, sunrealtype accuracy,
                          sunrealtype period, const sunrealtype *exponent,
                          const steif_lyapunov_facts *facts, steif_lyapunov_check *check,
                          int *count)
{
  STF_NAMED(problem);
  STEIF_CHECK(problem && method && options && exponent && facts && check && count, ctx,
              STEIF_BAD_INPUT, "a problem, a method, options, exponents and facts are needed");
  STEIF_CHECK(options->error, ctx, STEIF_BAD_INPUT,
              "tolerances are made of standard errors: give options.error");
  STEIF_CHECK(accuracy >= 0 && period >= 0 && isfinite(period), ctx, STEIF_BAD_INPUT,
              "accuracy = %g and period = %g must not be negative", accuracy, period);
  trial t = {.ctx = ctx, .options = options, .exponent = exponent, .facts = facts};
  t.m = facts->count;
  t.check = check;
  t.count = count;
  *count = 0;
  STEIF_TRY(sum(&t, problem, accuracy > 0 ? accuracy : 0.01));
  flow(&t);
  if (period == 0) return STEIF_OK;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  const int code = recurrence(pool, &t, problem, method, period);
  stf_pool_free(&pool);
  return code > 0 ? steif_status(ctx) : code;
}
