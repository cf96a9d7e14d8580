/* decay.c: does the equation decay, do the numbers: measured apart, then compared.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "decay.h"
#include "period_search.h"
#include <math.h>

/* Of A(t): the one that the user tells, tested; the problem's own; or one that is found. */
static int periods(stf_pool *pool, stf_variation *v, const steif_lyapunov_options *o,
                   sunrealtype told, stf_question *q)
{
  const steif_problem *p = q->problem;
  q->period = told > 0 ? told : p->period;
  if (told > 0 && v->linear) return stf_period_tested(v, q->t1, told);
  if (q->period > 0 || !v->linear || p->linear) return STEIF_OK;
  STEIF_TRY(stf_period_search(pool, v, o->h, q->t1, o->stop, &q->period, &q->off));
  q->found = q->period > 0;
  return STEIF_OK;
}

static int ask(steif_context *ctx, const steif_problem *p, const char *method,
               const steif_lyapunov_options *o, sunrealtype period, stf_question *q,
               sunrealtype *known)
{
  STEIF_CHECK(p && method && o, ctx, STEIF_BAD_INPUT,
              "a problem, a method and options are needed");
  STEIF_CHECK(period >= 0 && isfinite(period), ctx, STEIF_BAD_INPUT,
              "the period %g must be finite and not negative", period);
  STEIF_CHECK(p->n <= STF_DECAY_UNKNOWNS, ctx, STEIF_UNSUPPORTED,
              "'%s' with n = %lld: the verdict on a step is found up to n = %d", p->name,
              (long long)p->n, STF_DECAY_UNKNOWNS);
  stf_constant steps;
  STEIF_TRY(stf_constant_steps(ctx, o->h, p->t0, o->t1 != 0 ? o->t1 : p->t1, &steps));
  const bool dae = p->E || p->F;
  *q = (stf_question){.ctx = ctx,
                      .problem = p,
                      .method = method,
                      .exact = dae ? "radau:s=5" : "gauss:s=6",
                      .t1 = steps.end,
                      .transient = o->transient,
                      .stop = o->stop};
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  stf_variation v;
  int code = stf_variation_open(pool, ctx, p, "be", o->h, p->t0 + o->h, 1, o->linear, &v);
  q->linear = !code && v.linear;
  if (!code) code = periods(pool, &v, o, period, q);
  stf_pool_free(&pool);
  if (code) return code > 0 ? steif_status(ctx) : code;
  *known = q->period;
  if (!q->linear || dae) q->period = 0;
  return STEIF_OK;
}

static int measure(const stf_question *q, sunrealtype h, steif_decay *d)
{
  stf_rate equation, numbers;
  STEIF_TRY(stf_rate_of_step(q, h, &numbers));
  STEIF_TRY(stf_rate_of_equation(q, h, &equation));
  d->lambda = equation.value, d->lambda_error = equation.error, d->rise = equation.rise;
  d->mu = numbers.value, d->mu_error = numbers.error, d->rise_numbers = numbers.rise;
  return STEIF_OK;
}

int steif_decay_find(steif_context *ctx, const steif_problem *problem, const char *method,
                     const steif_lyapunov_options *options, sunrealtype period, int search,
                     steif_decay *decay)
{
  STF_NAMED(problem);
  stf_question q;
  STEIF_CHECK(decay, ctx, STEIF_BAD_INPUT, "room for the verdict is needed");
  *decay = (steif_decay){.h_good = NAN, .h_bad = NAN};
  STEIF_TRY(ask(ctx, problem, method, options, period, &q, &decay->period));
  decay->periodic = q.period > 0;
  decay->found = q.found;
  STEIF_TRY(measure(&q, options->h, decay));
  stf_decay_judge(options->h, decay);
  const bool wanted = decay->verdict == STEIF_DECAY_LOST || search;
  if (wanted && decay->lambda < -decay->lambda_error)
    STEIF_TRY(stf_step_search(&q, options->h, decay));
  stf_decay_tell(&q, decay);
  return STEIF_OK;
}
