/* gradient.c: gradients by a run forward and back: what is refused, opened and told.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "journey.h"
#include "probe.h"
#include <math.h>
#include <string.h>

static const size_t usual = (size_t)1 << 30; /* bytes */

/* ---- what is refused ------------------------------------------------------------------------ */

static int check_problem(steif_context *ctx, const steif_problem *p, const steif_options *o,
                         bool second)
{
  STEIF_CHECK(!second ||
                !(p->event && (p->handle_event || p->event_list || p->break_count > 0)),
              ctx, STEIF_UNSUPPORTED,
              "second derivatives do not pass events such as those of problem '%s': take "
              "differences of gradients",
              p->name);
  STEIF_CHECK(!second || p->break_count == 0, ctx, STEIF_UNSUPPORTED,
              "second derivatives do not pass breaks such as those of problem '%s': take "
              "differences of gradients",
              p->name);
  STEIF_CHECK(!p->constraint, ctx, STEIF_UNSUPPORTED,
              "gradients are not served beside the constraints of problem '%s', which move the "
              "solution",
              p->name);
  STEIF_CHECK(
    !o->reinitialise && !o->ewt && !o->sensitivities, ctx, STEIF_UNSUPPORTED,
    "gradients do not pass options.reinitialise, .ewt or .sensitivities: leave them 0");
  return STEIF_OK;
}

static int check_parameters(steif_context *ctx, const steif_problem *p)
{
  const steif_parameters *q = p->parameters;
  if (!q) return STEIF_OK;
  STEIF_CHECK(q->count > 0 && q->value, ctx, STEIF_BAD_INPUT,
              "problem '%s' has %d parameters and %s values", p->name, q->count,
              q->value ? "some" : "no");
  STEIF_CHECK(!q->obstacle, ctx, STEIF_UNSUPPORTED,
              "gradients of problem '%s' cannot be had: %s", p->name, q->obstacle);
  for (int k = 0; k < q->count; k++) {
    STEIF_CHECK(!q->name || q->name[k], ctx, STEIF_BAD_INPUT,
                "parameter %d of %d of problem '%s' has no name: give all, or .name = NULL",
                k + 1, q->count, p->name);
    STEIF_CHECK(isfinite(q->value[k]), ctx, STEIF_NOT_FINITE,
                "parameter %d of problem '%s' is %g", k + 1, p->name, q->value[k]);
    STEIF_CHECK(!q->scale || (q->scale[k] > 0 && isfinite(q->scale[k])), ctx, STEIF_BAD_INPUT,
                "scale %g of parameter %d of problem '%s' must be positive", q->scale[k], k + 1,
                p->name);
  }
  return STEIF_OK;
}

static int check_call(steif_context *ctx, const steif_problem *p, const steif_options *o,
                      const steif_functional *J, const steif_gradient *g)
{
  STEIF_CHECK(p && J && g, ctx, STEIF_BAD_INPUT, "a gradient needs a problem and functionals");
  STEIF_CHECK(J->count > 0 && (J->integrand || J->end), ctx, STEIF_BAD_INPUT,
              "%d functionals, with %s: give a count, and .integrand or .end", J->count,
              J->integrand || J->end ? "values" : "no values");
  STEIF_CHECK(g->checkpoints == 0 || g->checkpoints >= STF_FEWEST, ctx, STEIF_BAD_INPUT,
              "%d checkpoints: at least %d are needed, 0 takes as many as fit", g->checkpoints,
              STF_FEWEST);
  STEIF_TRY(check_parameters(ctx, p));
  const int P = p->parameters ? p->parameters->count : 0;
  for (int i = 0; o->active && i < o->active_count; i++)
    STEIF_CHECK(o->active[i] >= 0 && o->active[i] < P, ctx, STEIF_BAD_INPUT,
                "active[%d] = %d is no number of the %d parameters of problem '%s'", i,
                o->active[i], P, p->name);
  return STEIF_OK;
}

static int check_solver(stf_journey *J)
{
  const steif_solver *s = J->back.home;
  STEIF_CHECK(s->step.system.space.serial || s->engine, s->ctx, STEIF_UNSUPPORTED,
              "gradients of problem '%s' need serial vectors", s->problem->name);
  STEIF_CHECK(s->repair.report.moved == 0, s->ctx, STEIF_UNSUPPORTED,
              "the start of problem '%s' was repaired, and its derivative is not known: give a "
              "consistent start",
              s->problem->name);
  STEIF_CHECK(!s->final, s->ctx, STEIF_UNSUPPORTED,
              "constant steps of '%s' do not end at t1 = %.12g: take an h that divides the "
              "interval",
              s->spec, s->t1);
  return STEIF_OK;
}

/* ---- opening ------------------------------------------------------------------------------------- */

static int vectors(stf_backwards *B, int count, N_Vector **v)
{
  *v = stf_pool_vectors(B->pool, count, B->space.like);
  for (int i = 0; *v && i < count; i++) stf_zero(&B->space, (*v)[i]);
  return *v ? STEIF_OK : STEIF_NO_MEMORY;
}

static int claim(stf_backwards *B)
{
  const size_t count = (size_t)B->count, channels = (size_t)B->channels, P = (size_t)B->P;
  const int stages = B->table && B->kind != STF_TRACE_BDF ? B->table->s : 1;
  N_Vector **one[] = {&B->lambda, &B->kappa, &B->gy};
  for (size_t i = 0; i < STF_COUNT(one); i++) STEIF_TRY(vectors(B, B->channels, one[i]));
  for (int j = 1; j < STF_PAST; j++) STEIF_TRY(vectors(B, B->channels, &B->past[j]));
  STEIF_TRY(vectors(B, B->points, &B->Y));
  STEIF_TRY(vectors(B, B->points, &B->Yp));
  STEIF_TRY(vectors(B, (stages + 1) * B->channels, &B->r));
  STEIF_TRY(vectors(B, stages * B->channels, &B->w));
  B->right = stf_pool_array(B->pool, (size_t)stages * channels, sizeof *B->right);
  if (!B->right) return STEIF_NO_MEMORY;
  N_Vector *scratch[] = {&B->before, &B->work, &B->error};
  for (size_t i = 0; i < STF_COUNT(scratch); i++)
    if (!(*scratch[i] = stf_pool_vector(B->pool, B->space.like))) return STEIF_NO_MEMORY;
  const size_t size[] = {count * P, count,        3 * count, STF_PAST * count,
                         count,     channels * P, 2 * count, P};
  sunrealtype **array[] = {&B->gp,    &B->g,  &B->other,    &B->nu,
                           &B->value, &B->mu, &B->estimate, &B->Fp};
  for (size_t i = 0; i < STF_COUNT(array); i++)
    if (!(*array[i] = stf_pool_array(B->pool, size[i] + 1, sizeof(sunrealtype))))
      return STEIF_NO_MEMORY;
  return STEIF_OK;
}

/* Where step lengths are chosen, solves of large sparse stages may leave what is far below errors of the steps; of
 * prescribed steps nothing. Second derivatives are made of factors of each step. */
enum { LARGE = 1000 }; /* unknowns from which prescribed steps share factors too */
static int open_large(stf_journey *J)
{
  stf_backwards *B = &J->back;
  const steif_solver *s = B->home;
  const stf_system *system = &s->step.system;
  const bool krylov = B->adjoint.lanes;
  const bool large = B->adjoint.pencil && system->storage == STEIF_SPARSE && !system->linear;
  const sunrealtype rounding = 1e-14;
  if (krylov)
    return stf_stage_krylov_open(
      &B->adjoint, B->table,
      s->step.adaptive && !J->line ? fmax(1e-3 * s->options.rtol, rounding) : rounding,
      B->channels, B->kind == STF_TRACE_BDF);
  if (!large || J->line || (!s->step.adaptive && B->n < LARGE)) return STEIF_OK;
  return stf_stage_krylov_open(
    &B->adjoint, B->table, s->step.adaptive ? fmax(1e-3 * s->options.rtol, rounding) : rounding,
    B->channels, B->kind == STF_TRACE_BDF);
}

static int open_back(stf_journey *J)
{
  stf_backwards *B = &J->back;
  stf_system *system = &B->home->step.system;
  stf_system *matrices;
  B->pool = stf_pool_new(B->ctx);
  if (!B->pool) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_record_open(B));
  STEIF_TRY(check_solver(J));
  B->space = system->space;
  B->channels = J->line ? 2 * B->count : B->count;
  if (J->line) B->width += 2 * (size_t)B->n * (size_t)B->points;
  STEIF_TRY(claim(B));
  const int m = B->kind == STF_TRACE_COLLOCATION ? B->table->s : 1;
  STEIF_TRY(stf_matrices_for(B, J->line != NULL, &matrices));
  STEIF_TRY(stf_adjoint_open(B->pool, matrices, m, B->table, B->count, &B->adjoint));
  STEIF_TRY(open_large(J));
  if (m == 1 && B->kind == STF_TRACE_COLLOCATION)
    STEIF_TRY(stf_transform_build(B->pool, B->ctx, B->table, &B->adjoint.transform));
  if (B->kind == STF_TRACE_COLLOCATION)
    STEIF_TRY(stf_stage_polynomial_open(B->pool, B->table, B->adjoint.transform.B, &B->u));
  if (J->line) STEIF_TRY(stf_push_open(B, J->line));
  const int form = steif_problem_form(B->ctx, B->problem); /* the system's may be lowered */
  if (B->P)
    STEIF_TRY(stf_slopes_open(B->pool, B->ctx, B->problem, form, B->space.like, &B->slopes));
  const steif_options *o = &J->options;
  STEIF_TRY(stf_probe_open(B->pool, matrices, B->slopes, o->active,
                           o->active ? o->active_count : B->P, &B->probe));
  return stf_probe_look(B->probe, B->home);
}

static int bend_end(stf_backwards *B, const stf_step *last)
{
  const stf_pushed *D = B->tangent;
  const size_t size = (size_t)(B->count * B->P);
  STEIF_TRY(stf_bend_functional(B, 1, last->t, last->y, D->y));
  for (int i = 0; i < B->count; i++) stf_copy(&B->space, D->gy[i], B->lambda[B->count + i]);
  if (size) memcpy(B->mu + size, D->gp, size * sizeof *B->mu);
  return STEIF_OK;
}

int stf_journey_end(stf_journey *J)
{
  stf_backwards *B = &J->back;
  J->ended = true;
  for (int i = 0; i < B->count; i++) B->nu[i] = 1;
  STEIF_TRY(stf_check_inside_unknowns(B, J->runner));
  STEIF_TRY(stf_probe_look(B->probe, J->runner));
  for (int at_end = 0; at_end < 2; at_end++)
    STEIF_TRY(stf_probe_functional(B, at_end, J->runner->end, stf_last(J->runner)));
  if (!B->functional->end) return STEIF_OK;
  if (B->tangent) STEIF_TRY(bend_end(B, &J->runner->step));
  STEIF_TRY(stf_functional_at(B, 1, J->runner->end, stf_last(J->runner)));
  STEIF_TRY(stf_check_end_unknowns(B, J->runner));
  for (int i = 0; i < B->count; i++) {
    J->end[i] = B->value[i] = B->g[i];
    stf_copy(&B->space, B->gy[i], B->lambda[i]);
  }
  memcpy(B->mu, B->gp, (size_t)(B->count * B->P) * sizeof *B->mu);
  return STEIF_OK;
}

/* ---- results --------------------------------------------------------------------------------------- */

static int claim_results(stf_backwards *B, steif_gradient *g)
{
  const size_t count = (size_t)B->count, P = (size_t)B->P, n = (size_t)B->n;
  g->count = B->count, g->parameters = B->P, g->n = B->n;
  g->value = stf_allocate(B->ctx, count, sizeof *g->value);
  g->dp = P ? stf_allocate(B->ctx, count * P, sizeof *g->dp) : NULL;
  g->dy0 = stf_allocate(B->ctx, count * n, sizeof *g->dy0);
  g->error_estimate = stf_allocate(B->ctx, count, sizeof *g->error_estimate);
  return g->value && (g->dp || !P) && g->dy0 && g->error_estimate ? STEIF_OK : STEIF_NO_MEMORY;
}

static int as_status(steif_context *ctx, int code)
{
  return code > 0 ? steif_status(ctx) : code;
}

static bool asked_for(const stf_journey *J, int k)
{
  const steif_options *o = &J->options;
  bool found = o->active == NULL;
  for (int i = 0; !found && i < o->active_count; i++) found = o->active[i] == k;
  return found;
}

static void not_asked(stf_journey *J, int k)
{
  const stf_backwards *B = &J->back;
  for (int i = 0; i < B->count; i++) {
    J->out->dp[i * B->P + k] = NAN;
    if (J->line) J->Hp[i * B->P + k] = NAN;
  }
}

/* dJ/dp_k = mu_k + (dy0/dp_k) . lambda, and its derivative along the line. */
static int by_parameter(stf_journey *J, int k)
{
  stf_backwards *B = &J->back;
  STEIF_TRY(as_status(B->ctx, steif_parameter_start(B->ctx, B->problem, k, B->work)));
  STEIF_CHECK(stf_finite(&B->space, B->work), B->ctx, STEIF_NOT_FINITE,
              "dy0/dp of parameter %d of problem '%s' is not finite", k + 1, B->problem->name);
  STEIF_TRY(stf_probe_start(B->ctx, B->problem, k, B->work));
  for (int i = 0; i < B->count; i++)
    J->out->dp[i * B->P + k] = B->mu[i * B->P + k] + N_VDotProd(B->work, B->lambda[i]);
  if (!J->line) return STEIF_OK;
  STEIF_TRY(as_status(B->ctx, stf_bend_start(B, k, B->error)));
  for (int i = 0; i < B->count; i++)
    J->Hp[i * B->P + k] = B->mu[(B->count + i) * B->P + k] +
                          N_VDotProd(B->work, B->lambda[B->count + i]) +
                          N_VDotProd(B->error, B->lambda[i]);
  return STEIF_OK;
}

static int results(stf_journey *J)
{
  stf_backwards *B = &J->back;
  steif_gradient *g = J->out;
  const size_t size = (size_t)B->n * sizeof *g->dy0;
  STEIF_TRY(claim_results(B, g));
  for (int i = 0; i < B->count; i++) {
    g->value[i] = B->value[i], g->error_estimate[i] = B->estimate[i];
    memcpy(g->dy0 + i * B->n, STF_ARRAY(B->lambda[i]), size);
    if (J->Hy0) memcpy(J->Hy0 + i * B->n, STF_ARRAY(B->lambda[B->count + i]), size);
  }
  for (int k = 0; k < B->P; k++)
    if (asked_for(J, k))
      STEIF_TRY(by_parameter(J, k));
    else
      not_asked(J, k);
  g->cost.steps = J->steps, g->cost.bytes = J->bytes;
  g->cost.factors = B->adjoint.factors;
  g->cost.solves += B->adjoint.forward_solves;
  g->cost.transposed_solves = B->adjoint.solves;
  return STEIF_OK;
}

/* ---- all --------------------------------------------------------------------------------------------- */

/* One method throughout, of those that carry derivatives. */
static int open_run(stf_journey *J)
{
  stf_backwards *B = &J->back;
  B->home = J->runner = steif_solver_new(B->ctx, B->problem, J->method, &J->options);
  if (!B->home) return steif_status(B->ctx);
  if (!B->home->chosen) return STEIF_OK;
  J->method = stf_carrying(B->home->chosen);
  steif_solver_free(&B->home);
  B->home = J->runner = steif_solver_new(B->ctx, B->problem, J->method, &J->options);
  return B->home ? STEIF_OK : steif_status(B->ctx);
}

static int travel(stf_journey *J)
{
  stf_backwards *B = &J->back;
  STEIF_TRY(open_run(J));
  STEIF_TRY(open_back(J));
  STEIF_TRY(stf_along_open(J));
  STEIF_TRY(stf_passages_open(J));
  N_Vector start[] = {stf_pool_vector(B->pool, B->space.like),
                      stf_pool_vector(B->pool, B->space.like)};
  if (!start[0] || !start[1]) return STEIF_NO_MEMORY;
  const stf_step *first = &B->home->step;
  const sunrealtype t0 = first->t;
  stf_copy(&B->space, first->y, start[0]), stf_copy(&B->space, first->yp, start[1]);
  STEIF_TRY(stf_probe_functional(B, 0, t0, start[0]));
  STEIF_TRY(stf_probe_pull(B, t0, start[0], start[1]));
  if (J->line) STEIF_TRY(stf_push_start(B, t0, start[0], start[1]));
  STEIF_TRY(stf_journey_forward(J));
  J->out->cost.solves = steif_statistics(J->runner)->nsolve;
  STEIF_TRY(stf_journey_back(J));
  STEIF_TRY(stf_along_check(J));
  STEIF_TRY(stf_passages_first(J));
  if (J->line) STEIF_TRY(stf_push_start(B, t0, start[0], start[1]));
  STEIF_TRY(stf_pull_start(B, t0, start[0], start[1]));
  return results(J);
}

static void clear(steif_context *ctx, steif_gradient *g)
{
  sunrealtype *block[] = {g->value, g->dp, g->dy0, g->error_estimate};
  for (size_t i = 0; i < STF_COUNT(block); i++) stf_release(ctx, block[i]);
  g->value = g->dp = g->dy0 = g->error_estimate = NULL;
}

int stf_journey_once(stf_journey *J, const steif_problem *problem,
                     const steif_functional *functional, steif_gradient *g)
{
  steif_context *ctx = J->back.ctx;
  J->out = g, J->limit = g->memory ? g->memory : usual;
  J->back =
    (stf_backwards){.ctx = ctx, .problem = problem, .functional = functional, .n = problem->n};
  J->back.count = functional->count;
  J->back.P = problem->parameters ? problem->parameters->count : 0;
  g->value = g->dp = g->dy0 = g->error_estimate = NULL;
  g->cost = (steif_gradient_cost){0};
  const int code = travel(J);
  J->again = !code && stf_quiet(J);
  stf_journey_close(J);
  if (code) clear(ctx, g);
  return code;
}

int stf_journey_make(stf_journey *J, const steif_problem *problem,
                     const steif_functional *functional, steif_gradient *g)
{
  steif_context *ctx = J->back.ctx;
  STEIF_TRY(check_call(ctx, problem, &J->options, functional, g));
  STEIF_TRY(check_problem(ctx, problem, &J->options, J->line != NULL));
  J->options.observe = NULL, J->options.on_event = NULL;
  const stf_journey call = *J;
  int code = stf_journey_once(J, problem, functional, g);
  if (!code && J->again) {
    code = stf_quiet_again(&call, problem, functional, J->longest, g);
    if (code) clear(ctx, g);
  }
  return as_status(ctx, code);
}

int steif_gradient_find(steif_context *ctx, const steif_problem *problem, const char *method,
                        const steif_options *options, const steif_functional *functional,
                        steif_gradient *g)
{
  STF_NAMED(problem);
  if (!ctx) return STEIF_BAD_INPUT;
  steif_forget(ctx);
  stf_journey J = {.method = method, .back = {.ctx = ctx}};
  J.options = options ? *options : steif_defaults();
  return stf_journey_make(&J, problem, functional, g);
}

void steif_gradient_free(steif_context *ctx, steif_gradient *g)
{
  if (ctx && g) clear(ctx, g);
}
