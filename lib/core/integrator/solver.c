/* solver.c: the solver object: made from a problem, a spec and options.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include "varying_mass.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* -- opening ----------------------------------------------------------------------------- */

static void destroy_vector(void *v) { N_VDestroy(v); }

static int open_vectors(steif_solver *s, N_Vector *y, N_Vector *yp)
{
  N_Vector like = s->options.like;
  if (!like) {
    like = s->serial = N_VNew_Serial(s->problem->n, steif_sundials(s->ctx));
    STEIF_CHECK(like, s->ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld components",
                (long long)s->problem->n);
    STEIF_TRY(stf_pool_adopt(s->pool, like, destroy_vector));
  }
  *y = stf_pool_vector(s->pool, like);
  *yp = stf_pool_vector(s->pool, like);
  s->dense = stf_pool_vector(s->pool, like);
  if (!*y || !*yp || !s->dense) return STEIF_NO_MEMORY;
  if (!s->options.atols) return STEIF_OK;
  s->atols = stf_pool_vector(s->pool, like);
  if (!s->atols) return STEIF_NO_MEMORY;
  sunindextype rows;
  sunrealtype *a = stf_own_rows(s->atols, &rows);
  STEIF_CHECK(a, s->ctx, STEIF_UNSUPPORTED, "options.atols needs vectors with a host array");
  const size_t n = (size_t)rows;
  memcpy(a, s->options.atols, n * sizeof *a);
  s->floors = stf_pool_array(s->pool, n, sizeof *s->floors);
  if (!s->floors) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < n; j++) s->floors[j] = a[j] / s->options.rtol;
  return STEIF_OK;
}

static int open_engine(steif_solver *s, int form, const steif_spec *spec, N_Vector y,
                       N_Vector yp)
{
  const steif_engine *engine = s->engine;
  STEIF_CHECK(engine->forms & (unsigned)form, s->ctx, STEIF_UNSUPPORTED,
              "'%s' does not accept problems of form %s such as '%s'", spec->name,
              steif_form_name(form), s->problem->name);
  s->engine_state = stf_pool_array(s->pool, 1, engine->size);
  if (!s->engine_state) return STEIF_NO_MEMORY;
  s->run = (stf_run){.ctx = s->ctx,
                     .pool = s->pool,
                     .problem = s->problem,
                     .form = form,
                     .options = &s->options,
                     .user = stf_ewt_user(s),
                     .mass_of_time = s->mass_of_time,
                     .like = y,
                     .deferred = s->agreed ? &s->deferred : NULL,
                     .t = s->problem->t0,
                     .y = y,
                     .yp = yp};
  stf_space space;
  bool known;
  stf_space_open(&space, y);
  STEIF_TRY(stf_agreed_gate(s));
  STEIF_TRY(stf_system_start(s->ctx, s->problem, form, &space, y, yp, &known));
  s->shown = y;
  return engine->open(&s->run, s->engine_state, spec);
}

static int constant_steps(steif_solver *s)
{
  STEIF_TRY(stf_constant_steps(s->ctx, s->options.h, s->problem->t0, s->t1, &s->constant));
  s->step.h_equal = s->constant.h;
  return STEIF_OK;
}

static void destroy_table(void *step)
{
  stf_step *s = step;
  steif_table_free(s->ctx, &s->table);
}

/* How hard Newton works: relative to the error tolerance, or near rounding for given steps. */
static void open_newton(steif_solver *s)
{
  stf_newton *newton = &s->step.newton;
  const steif_options *o = &s->options;
  const bool adaptive = s->step.adaptive;
  newton->tolerance = o->newton > 0 ? o->newton : adaptive ? 1e-2 : 1e-3;
  newton->rounding = adaptive ? 10 * STF_EPS / o->rtol : 100 * newton->tolerance;
  newton->iterations = o->iterations ? o->iterations : adaptive ? 10 : 30;
  newton->stale_rate = adaptive ? 1e-3 : 0.1;
  newton->eta_least = adaptive ? 0 : 1e-2;
  newton->jacobian_new = true;
}

static int claim_state(steif_solver *s)
{
  s->step.state = stf_pool_array(s->pool, 1, s->step.method->size);
  return s->step.state ? STEIF_OK : STEIF_NO_MEMORY;
}

static int claim_step(steif_solver *s)
{
  stf_step *step = &s->step;
  step->next = stf_pool_vector(s->pool, step->y);
  step->error = stf_pool_vector(s->pool, step->y);
  step->weights = stf_pool_vector(s->pool, step->y);
  return step->next && step->error && step->weights ? claim_state(s) : STEIF_NO_MEMORY;
}

/* A family may have another one for a system like this. */
static int specialise(steif_solver *s)
{
  stf_step *step = &s->step;
  const steif_method *variant = step->method->variant ? step->method->variant(step) : NULL;
  if (!variant) return STEIF_OK;
  step->method = variant;
  return claim_state(s);
}

/* What methods for y' = L y + N(t, y) see: L, or df/dy at the start, in the place of the matrix. */
static const steif_problem *semilinear(steif_solver *s)
{
  const steif_problem *p = s->problem;
  s->semilinear = *p;
  s->semilinear.linear = 1;
  if (p->L || p->Lv) s->semilinear.A = p->L, s->semilinear.Av = p->Lv, s->semilinear.jac = NULL;
  return &s->semilinear;
}

/* The one by which the start was looked at. */
static int take_system(steif_solver *s, N_Vector y, N_Vector yp)
{
  stf_system *system = &s->step.system;
  *system = s->repair.point.system;
  system->floors = s->floors;
  system->problem = s->problem;
  if (s->problem->index) STEIF_TRY(stf_index_check(system));
  if (s->repair.point.views <= 1) return STEIF_OK;
  system->filled = system->filled && system->linear;
  const int code = stf_system_linearise(system, s->problem->t0, y, yp);
  return code > 0 ? STEIF_CALLBACK : code;
}

static int open_system(steif_solver *s, int form, N_Vector y, N_Vector yp)
{
  stf_step *step = &s->step;
  const steif_options *o = &s->options;
  const sunrealtype scale = o->atol / o->rtol;
  const unsigned other = STF_EXPLICIT | STF_SEMILINEAR;
  const bool plain = step->method->traits & STF_EXPLICIT && !o->sensitivities;
  if (s->repair.point.pool && !o->force_storage && !(step->method->traits & other))
    return take_system(s, y, yp);
  if (!plain)
    return stf_system_open(s->pool, s->ctx,
                           step->method->traits & STF_SEMILINEAR ? semilinear(s) : s->problem,
                           form, o->force_storage ? o->storage : s->problem->storage, scale,
                           s->floors, y, yp, &step->system);
  step->system.ctx = s->ctx, step->system.problem = s->problem, step->system.form = form;
  step->system.scale = scale, step->system.floors = s->floors, step->system.weight = 1;
  return STEIF_OK;
}

/* Where the look at the start has called the callbacks there, and moved nothing, that was their first call. */
static int start_values(steif_solver *s, int form, N_Vector y, N_Vector yp)
{
  const steif_problem *p = s->problem;
  stf_step *step = &s->step;
  if (!s->repair.point.pool || s->repair.report.y)
    return stf_system_start(s->ctx, p, form, &step->system.space, y, yp, &step->yp_known);
  step->yp_known = p->yp0;
  return stf_start_values(s->ctx, p, y, yp);
}

static int open_step(steif_solver *s, int form, const steif_spec *spec, N_Vector y, N_Vector yp)
{
  stf_step *step = &s->step;
  const steif_problem *p = s->problem;
  steif_options *o = &s->options;
  *step = (stf_step){.ctx = s->ctx,
                     .pool = s->pool,
                     .problem = p,
                     .options = o,
                     .t0 = p->t0,
                     .t = p->t0,
                     .y = y,
                     .yp = yp};
  STEIF_TRY(stf_method_find(s->ctx, spec, &step->method, &step->table));
  STEIF_TRY(stf_pool_adopt(s->pool, step, destroy_table));
  steif_method_info info = {0};
  STEIF_TRY(step->method->describe(s->ctx, spec, step->table, &info));
  const bool lowered = s->lowered && (step->method->traits & STF_VARYING_MASS);
  STEIF_CHECK(lowered || (step->method->forms & (unsigned)form), s->ctx, STEIF_UNSUPPORTED,
              "'%s' does not accept problems of form %s such as '%s'", s->method,
              steif_form_name(form), p->name);
  step->adaptive = !o->mesh && !(o->h > 0);
  STEIF_CHECK(!step->adaptive || info.adaptive, s->ctx, STEIF_UNSUPPORTED,
              "'%s' has no error estimate to choose steps by: give steps with h", s->method);
  step->absolute = form == STEIF_DESCRIPTOR && !step->adaptive;
  if (!step->adaptive && !o->mesh) STEIF_TRY(constant_steps(s));
  stf_space_open(&step->system.space, y);
  STEIF_TRY(stf_agreed_gate(s));
  STEIF_TRY(start_values(s, form, y, yp));
  STEIF_TRY(claim_step(s));
  STEIF_TRY(open_system(s, form, y, yp));
  STEIF_TRY(stf_look_at_pencil(s, form));
  if (s->agreed) stf_operator_defer(&step->system, &s->deferred);
  s->family = step->method, s->family_state = step->state;
  s->own[0] = step->y, s->own[1] = step->next;
  s->opened = stf_pool_here(s->pool);
  return STEIF_OK;
}

/* What belongs to one start and goes with it. */
static int begin_step(steif_solver *s)
{
  stf_step *step = &s->step;
  open_newton(s);
  step->control = stf_control_usual;
  STEIF_TRY(specialise(s));
  STEIF_TRY(step->method->open(step, &s->parsed, step->table));
  s->shown = step->y;
  if (step->h_equal > 0) STEIF_TRY(stf_rest_open(s, &s->constant, s->t1));
  if (!step->adaptive) return STEIF_OK;
  STEIF_TRY(stf_look_at_orders(s));
  s->h_next = stf_first_step(s);
  return stf_rounding_open(s);
}

/* Weights of the caller at the start: baselines do not look at their signs. */
static int check_ewt(steif_solver *s, N_Vector y)
{
  if (!s->options.ewt) return STEIF_OK;
  const int returned = s->options.ewt(y, s->dense, stf_ewt_user(s));
  STEIF_CHECK(returned == 0 && N_VMin(s->dense) > 0, s->ctx, STEIF_CALLBACK,
              "ewt of problem '%s' returned %d with the smallest weight %g at the start: it "
              "returns 0 with 1 / (error allowed in y_i) > 0",
              s->problem->name, returned, N_VMin(s->dense));
  return STEIF_OK;
}

/* A number by which a checkpoint knows the problem again. */
static void take_fingerprint(steif_solver *s)
{
  stf_image m = {.ctx = s->ctx};
  stf_keep_vector(&m, s->engine ? s->run.y : s->step.y);
  stf_keep_vector(&m, s->engine ? s->run.yp : s->step.yp);
  if (!s->engine) stf_matrices_keep(&s->step.system, &m);
  s->fingerprint = m.code ? 0 : m.sum;
  if (m.code) steif_forget(s->ctx);
}

static int begin(const steif_solver *s)
{
  const steif_problem *p = s->problem;
  const int returned = p->begin ? p->begin(p->t0, p->user) : 0;
  STEIF_CHECK(returned == 0, s->ctx, STEIF_CALLBACK, "begin of problem '%s' returned %d",
              p->name, returned);
  return STEIF_OK;
}

static const char *copied(stf_pool *pool, const char *text)
{
  const size_t bytes = strlen(text) + 1;
  char *copy = stf_pool_array(pool, bytes, 1);
  return copy ? memcpy(copy, text, bytes) : NULL;
}

static int open(steif_solver *s, const char *method)
{
  steif_spec *spec = &s->parsed;
  N_Vector y = NULL, yp = NULL;
  int form = 0;
  STEIF_TRY(stf_agreed_open(s, method, &form));
  STEIF_TRY(begin(s));
  s->t1 = s->t1_opened = s->options.t1;
  s->t_shown = s->end = s->problem->t0;
  s->drift = s->corrected = NAN;
  if (!(s->spec = copied(s->pool, method))) return STEIF_NO_MEMORY;
  STEIF_TRY(open_vectors(s, &y, &yp));
  snprintf(s->method, sizeof s->method, "%s", method);
  const bool automatic = !strcmp(method, "auto");
  STEIF_TRY(steif_spec_parse(s->ctx, method, spec));
  s->engine = stf_engine_find(spec->name);
  STEIF_TRY(stf_look_at_index(s));
  STEIF_TRY(stf_look_at_mass(s, &form, y, yp));
  const bool later =
    automatic && form == STEIF_DESCRIPTOR; /* `descriptor` makes the jump itself */
  if (!later && (automatic || !s->engine)) STEIF_TRY(stf_look_at_start(s, form));
  if (automatic)
    s->chosen = method = stf_choose(s->problem, &s->options, form, s->method, sizeof s->method);
  stf_tell_pattern(s);
  STEIF_TRY(steif_spec_parse(s->ctx, method, spec));
  s->engine = stf_engine_find(spec->name);
  if (later && !s->engine) STEIF_TRY(stf_look_at_start(s, form));
  STEIF_TRY(stf_look_at_breaks(s));
  STEIF_TRY(s->engine ? open_engine(s, form, spec, y, yp) : open_step(s, form, spec, y, yp));
  if (form == STEIF_DESCRIPTOR)
    STEIF_TRY(stf_constant_matrices(s->ctx, s->problem, form, s->t1, y, s->spec));
  STEIF_TRY(stf_agreed_gate(s));
  if (s->engine) STEIF_TRY(check_ewt(s, y));
  if (s->engine && s->options.h > 0 && !s->options.mesh) STEIF_TRY(constant_steps(s));
  STEIF_TRY(stf_run_begin(s));
  take_fingerprint(s);
  return STEIF_OK;
}

int stf_run_begin(steif_solver *s)
{
  if (!s->engine) STEIF_TRY(begin_step(s));
  if (s->chosen && !s->options.sensitivities) STEIF_TRY(stf_switching_open(s, s->chosen));
  STEIF_TRY(stf_sensitivity_open(s));
  STEIF_TRY(stf_quadrature_open(s));
  STEIF_TRY(stf_constraint_open(s));
  STEIF_TRY(stf_drift_open(s));
  STEIF_TRY(stf_event_open(s));
  s->observed = stf_observed(s);
  s->watched = s->events || s->options.observe || s->quadratures;
  s->stretch = 16;
  return STEIF_OK;
}

steif_solver *steif_solver_new_sized(size_t problem_bytes, size_t options_bytes,
                                     steif_context *ctx, const steif_problem *problem,
                                     const char *method, const steif_options *options)
{
  if (!ctx) return NULL;
  steif_forget(ctx);
  N_Vector like = stf_given_like(problem, problem_bytes, options, options_bytes);
  steif_solver *s = stf_allocate(ctx, 1, sizeof *s);
  stf_deferred none = {0};
  if (s) s->ctx = ctx, s->pool = stf_pool_new(ctx);
  int code = s && s->pool ? stf_take_given(s, problem, problem_bytes, options, options_bytes)
                          : STEIF_NO_MEMORY;
  if (!code && !method) code = STEIF_FAIL(ctx, STEIF_BAD_INPUT, "a method is needed, got NULL");
  if (code) stf_agree(ctx, like, code); /* the first that ranks do which have come further */
  stf_deferred *const before = stf_context_open(ctx, s ? &s->deferred : NULL);
  if (!code) code = open(s, method);
  stf_context_open(ctx, before);
  code = stf_deferred_leave(ctx, like, s ? &s->deferred : &none, code);
  if (s) stf_agreed_tell(s, code);
  if (code) steif_solver_free(&s);
  return s;
}

steif_solver *(steif_solver_new)(steif_context *ctx, const steif_problem *problem,
                                 const char *method, const steif_options *options)
{
  return steif_solver_new_sized(0, 0, ctx, problem, method, options);
}

void steif_solver_free(steif_solver **s)
{
  if (!s || !*s) return;
  steif_context *ctx = (*s)->ctx;
  if ((*s)->engine_state) (*s)->engine->close(&(*s)->run, (*s)->engine_state);
  stf_pool_free(&(*s)->pool);
  stf_release(ctx, *s);
  *s = NULL;
}
