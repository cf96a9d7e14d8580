/* run.c: runs of E x' + F x = f through its jumps: at the start and at every declared break x(t+) and
 * the impulses, between them a method on the smooth solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demand.h"
#include "reduce.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/method.h>
#include <steif/table.h>
#include <string.h>

typedef struct run {
  steif_context *ctx;
  const steif_linear *linear;
  const char *method;
  steif_options options;
  const steif_analysis *analysis;
  const steif_linear_output *output;
  steif_structure structure; /* of the pencil, found once */
  sunrealtype *x;            /* x(t-), then x(t+) */
  int *index;                /* of each unknown; NULL: all 1 */
  bool settles;              /* the last value of a segment is put on the constraints */
  sunrealtype end;           /* of the segment */
  stf_reduced reduced;       /* what chosen steps are made on, where there is one */
} run;

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  const run *r = user;
  (void)s;
  return r->settles && t >= r->end ? 0 : r->output->step(t, y, r->output->user);
}

static int jump(run *r, sunrealtype t)
{
  steif_impulse i = {0};
  const steif_linear *l = r->linear;
  int code = steif_impulse_find(r->ctx, l->E, l->F, r->x, t, l->f, l->user, r->analysis,
                                &r->structure, &i);
  if (!code && r->output->jump && r->output->jump(t, r->x, &i, r->output->user))
    code = STEIF_FAIL(r->ctx, STEIF_CALLBACK, "the output stopped the run at t = %.12g", t);
  if (!code) memcpy(r->x, i.x_plus, (size_t)i.n * sizeof *r->x);
  steif_impulse_clear(r->ctx, &i);
  return code;
}

/* f up to the end of a segment: where it breaks there, from the left. */
typedef struct segment {
  const steif_linear *linear;
  sunrealtype end, before; /* before: the last number before end */
} segment;

static int left_of(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const segment *s = user;
  return s->linear->f(t < s->end ? t : s->before, derivative, g, s->linear->user);
}

/* In a first step far below the time scales of the system an unknown of index k would be its
 * rounding errors times h^(1-k). */
static void begin(const run *r, sunrealtype from, sunrealtype to, steif_options *o)
{
  o->t1 = to;
  if (r->output->step) o->observe = observe, o->observer = (void *)r;
  if (!(o->h0 > 0) && r->index)
    o->h0 = fmin(1e-3 * (to - from), r->structure.radius > 0 ? 1e-2 / r->structure.radius : to);
}

static int smooth(run *r, segment *s, sunrealtype from)
{
  steif_problem p;
  const steif_linear *l = r->linear;
  const steif_linear cut = {l->E, l->F, l->f ? left_of : NULL, s};
  const bool low = r->reduced.linear.E;
  r->reduced.from = &cut;
  STEIF_TRY(
    steif_linear_problem(r->ctx, low ? &r->reduced.linear : &cut, r->x, from, s->end, &p));
  p.index = r->index, p.dae_index = low ? 1 : r->structure.index;
  steif_options o = r->options;
  begin(r, from, s->end, &o);
  steif_solver *solver = steif_solver_new(r->ctx, &p, r->method, &o);
  if (!solver) return steif_status(r->ctx);
  const int code = steif_solve_to(solver, s->end);
  if (!code)
    memcpy(r->x, N_VGetArrayPointer(steif_solution(solver)), (size_t)p.n * sizeof *r->x);
  steif_solver_free(&solver);
  return code;
}

/* x(t-) on the constraints that hold at the end of a segment: what the method missed them by would be
 * taken for a jump, and differentiated; and what it makes of unknowns of index k, of which errors
 * of size tol / h^(k-1) are let pass, follows from the others and f. */
static int settle(run *r, segment *s)
{
  steif_impulse i = {0};
  const steif_linear *l = r->linear;
  const int code = steif_impulse_find(r->ctx, l->E, l->F, r->x, s->end, l->f ? left_of : NULL,
                                      s, r->analysis, &r->structure, &i);
  if (!code) memcpy(r->x, i.x_plus, (size_t)i.n * sizeof *r->x);
  steif_impulse_clear(r->ctx, &i);
  return code;
}

/* The value that was held back, settled. */
static int finish(run *r)
{
  if (!r->settles || !r->output->step) return STEIF_OK;
  N_Vector x = N_VMake_Serial(r->structure.n, r->x, steif_sundials(r->ctx));
  STEIF_CHECK(x, r->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  const int stop = r->output->step(r->end, x, r->output->user);
  N_VDestroy(x);
  STEIF_CHECK(!stop, r->ctx, STEIF_CALLBACK, "the output stopped the run at t = %.12g", r->end);
  return STEIF_OK;
}

static int segments(run *r, sunrealtype t0, size_t count, const sunrealtype *breaks)
{
  sunrealtype t = t0;
  for (size_t i = 0; i <= count; i++) {
    const sunrealtype end = i < count ? breaks[i] : r->options.t1;
    STEIF_CHECK(end > t, r->ctx, STEIF_BAD_INPUT,
                "breaks must ascend within (%.17g, %.17g): %.17g comes after %.17g", t0,
                r->options.t1, end, t);
    segment s = {r->linear, end, nextafter(end, t)};
    STEIF_TRY(jump(r, t));
    r->end = end;
    STEIF_TRY(smooth(r, &s, t));
    if (i < count || r->settles) STEIF_TRY(settle(r, &s));
    STEIF_TRY(finish(r));
    t = end;
  }
  return STEIF_OK;
}

/* Does the method carry errors of algebraic unknowns along, |R(inf)| > 0? */
static int keeps(run *r, bool *yes)
{
  steif_method_info info;
  const bool hushed = stf_hush(r->ctx, true);
  const int code = steif_method_find(r->ctx, r->method, &info);
  stf_hush(r->ctx, hushed);
  *yes = !code && (info.claims & STEIF_A_STABLE) &&
         !(info.claims & (STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE));
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

/* Given steps show what the method makes of the system as it is. Chosen ones need errors that mean
 * something: of a system of index 1, or of unknowns judged by their index. */
static int lower(run *r)
{
  bool slope;
  const bool chosen = !(r->options.h > 0) && !r->options.mesh;
  STEIF_TRY(keeps(r, &slope));
  if (chosen) STEIF_TRY(stf_reduced_open(r->ctx, r->linear, &r->structure, slope, &r->reduced));
  if (r->reduced.linear.E) return STEIF_OK;
  r->settles = chosen && r->structure.index > 1;
  return stf_linear_grade(r->ctx, r->linear, r->analysis, &r->structure, &r->index);
}

int steif_linear_run(steif_context *ctx, const steif_linear *given, const sunrealtype *x0,
                     sunrealtype t0, const char *method, const steif_options *options,
                     const steif_analysis *analysis, size_t break_count,
                     const sunrealtype *breaks, const steif_linear_output *output)
{
  static const steif_linear_output silent = {0};
  steif_problem p;
  STEIF_CHECK(options, ctx, STEIF_BAD_INPUT, "options with t1 are needed, got NULL");
  STEIF_TRY(steif_linear_problem(ctx, given, x0, t0, options->t1, &p));
  stf_demand demand = stf_demand_of(ctx, given, analysis);
  const steif_linear linear = stf_demand_linear(&demand);
  run r = {.ctx = ctx,
           .linear = &linear,
           .method = method,
           .options = *options,
           .analysis = analysis,
           .output = output ? output : &silent};
  r.x = stf_allocate(ctx, (size_t)p.n, sizeof *r.x);
  if (!r.x) return STEIF_NO_MEMORY;
  memcpy(r.x, x0, (size_t)p.n * sizeof *r.x);
  int code = steif_structure_find(ctx, given->E, given->F, analysis, &r.structure);
  demand.finite = r.structure.finite;
  if (!code) code = lower(&r);
  if (!code) code = segments(&r, t0, break_count, breaks);
  steif_structure_clear(ctx, &r.structure);
  stf_reduced_close(&r.reduced);
  stf_release(ctx, r.index);
  stf_release(ctx, r.x);
  stf_demand_close(&demand);
  return code;
}
