/* probe_starts.c: dy0/dp as it is given, against differences of problem.start.
 *
 * Central differences over d, about 6e-6 of p, and over L = 1e-3 of p, and the one over [0, d], agree to their errors
 * where the start is smooth in p. An entry is called wrong where it is off by ten times what they are apart, with the
 * rounding of y0 over d, and by 1e-3 of itself; where the start cannot be evaluated, or is not smooth, nothing
 * is said. Of DAEs of index 1 what is compared is E dy0/dp, which the algebraic unknowns have no part in: those may be
 * given as they follow from the others. Starts of higher index have hidden constraints to fulfil, which
 * start_derivatives.c looks at.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "probe.h"
#include "saltation.h"
#include <math.h>
#include <nvector/nvector_serial.h>

static const sunrealtype units = 8, longer = 1e-3;

typedef struct probe {
  steif_context *ctx;
  const steif_problem *problem;
  stf_carry *T; /* for products with E; NULL: the identity */
  sunrealtype d;
  N_Vector y, near, wide, half, work, given;
} probe;

/* out = y0 at p_k = value; work: y'. */
static int start_at(const probe *q, int k, sunrealtype value, N_Vector out)
{
  const steif_problem *p = q->problem;
  STEIF_TRY(steif_parameter_set(q->ctx, p, k, value));
  N_VConst(0, out);
  return p->start(p->t0, out, q->work, p->user) ? STEIF_RETRY : STEIF_OK;
}

/* out = (y0(p + high) - y0(p + low)) / (high - low); y has the second one. */
static int between(probe *q, int k, sunrealtype low, sunrealtype high, N_Vector out)
{
  const sunrealtype p = q->problem->parameters->value[k];
  const volatile sunrealtype up = p + high, down = p + low;
  int code = start_at(q, k, up, out);
  if (!code) code = start_at(q, k, down, q->y);
  const int back = steif_parameter_set(q->ctx, q->problem, k, p);
  if (!code) N_VLinearSum(1 / (up - down), out, -1 / (up - down), q->y, out);
  return code ? code : back;
}

static int times_E(probe *q, N_Vector x)
{
  STEIF_TRY(stf_matrices_at_product(&q->T->at, 0, 'E', x, q->work));
  N_VScale(1, q->work, x);
  return STEIF_OK;
}

/* Differences, and y0; of them and of what is given the products with E. */
static int differences(probe *q, int k, N_Vector given)
{
  const steif_parameters *all = q->problem->parameters;
  const sunrealtype d = q->d = stf_slopes_increment(all, k), L = longer * d / cbrt(STF_EPS);
  STEIF_TRY(between(q, k, -L, L, q->wide));
  STEIF_TRY(between(q, k, -d, d, q->near));
  STEIF_TRY(between(q, k, 0, d, q->half));
  N_VScale(1, given, q->given);
  N_Vector seen[] = {q->y, q->near, q->wide, q->half, q->given};
  for (size_t i = 0; q->T && i < STF_COUNT(seen); i++) STEIF_TRY(times_E(q, seen[i]));
  return STEIF_OK;
}

static int say(const probe *q, int k, sunindextype i, sunrealtype bar)
{
  const steif_problem *p = q->problem;
  const steif_parameters *all = p->parameters;
  char room[STEIF_SPEC_WORD];
  return STEIF_FAIL(
    q->ctx, STEIF_BAD_INPUT,
    "%sdy0/dp of parameter %d%s%.40s%s of problem '%s' is wrong: parameters.start gives %.6g "
    "in %s, where differences of problem.start are %.6g, to about %.1g: correct "
    "parameters.start, "
    "or leave it NULL",
    q->T ? "E " : "", k + 1, all->name ? " (" : "", all->name ? all->name[k] : "",
    all->name ? ")" : "", p->name, stf_array(q->given)[i],
    q->T ? stf_equation(p, i, room) : stf_unknown(p, i, room), stf_array(q->near)[i], bar);
}

/* The entry that is off the most, in what it may be off by. */
static int compare(const probe *q, int k)
{
  const sunrealtype *g = stf_array(q->given), *c = stf_array(q->near), *w = stf_array(q->wide),
                    *h = stf_array(q->half), *y = stf_array(q->y);
  const sunrealtype size = q->T ? N_VMaxNorm(q->y) : 0;
  sunindextype worst = -1;
  sunrealtype most = 1, bar = 0, error;
  for (sunindextype i = 0; i < q->problem->n; i++) {
    const sunrealtype rounding = units * STF_EPS * fmax(size, fabs(y[i])) / q->d;
    const sunrealtype excess = stf_probe_excess(g[i], c[i], w[i], h[i], rounding, &error);
    if (excess > most && isfinite(excess)) worst = i, most = excess, bar = error;
  }
  return worst < 0 ? STEIF_OK : say(q, k, worst, bar);
}

static int look(probe *q, int k, N_Vector given)
{
  stf_pool *pool = stf_pool_new(q->ctx);
  N_Vector *v = pool ? stf_pool_vectors(pool, 6, given) : NULL;
  int code = v ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) {
    q->y = v[0], q->near = v[1], q->wide = v[2], q->half = v[3], q->work = v[4],
    q->given = v[5];
    const bool before = stf_silence(q->ctx, true);
    const bool seen = !differences(q, k, given);
    stf_silence(q->ctx, before);
    if (seen) code = compare(q, k);
  }
  stf_pool_free(&pool);
  return code;
}

int stf_probe_start(steif_context *ctx, const steif_problem *p, int k, N_Vector given)
{
  probe q = {.ctx = ctx, .problem = p};
  if (!p->start || !p->parameters->start || steif_problem_form(ctx, p) != STEIF_ODE ||
      N_VGetVectorID(given) != SUNDIALS_NVEC_SERIAL)
    return STEIF_OK;
  return look(&q, k, given);
}

int stf_probe_starts(steif_solver *s, stf_carry *T)
{
  const stf_step *step = &s->step;
  const steif_problem *p = s->problem;
  probe q = {.ctx = s->ctx, .problem = p, .T = step->system.form == STEIF_ODE ? NULL : T};
  if (!p->start || !p->parameters->start || s->repair.report.moved > 0 ||
      (q.T && (p->dae_index < 0 || p->dae_index > 1)))
    return STEIF_OK;
  if (q.T) STEIF_TRY(stf_carry_point(T, 0, step->t, step->y, step->yp));
  for (int k = 0; k < T->count; k++) STEIF_TRY(look(&q, T->parameter[k], T->S[k]));
  return STEIF_OK;
}
