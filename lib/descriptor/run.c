/* run.c: runs of E x' + F x = f through its jumps: at the start and at every declared break x(t+) and
 * the impulses, between them a method on the smooth solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "structure.h"
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
} run;

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  const run *r = user;
  (void)s;
  return r->output->step(t, y, r->output->user);
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

static int smooth(run *r, sunrealtype from, sunrealtype to)
{
  steif_problem p;
  STEIF_TRY(steif_linear_problem(r->ctx, r->linear, r->x, from, to, &p));
  steif_options o = r->options;
  o.t1 = to;
  if (r->output->step) o.observe = observe, o.observer = r;
  steif_solver *s = steif_solver_new(r->ctx, &p, r->method, &o);
  if (!s) return steif_status(r->ctx);
  const int code = steif_solve_to(s, to);
  if (!code) memcpy(r->x, N_VGetArrayPointer(steif_solution(s)), (size_t)p.n * sizeof *r->x);
  steif_solver_free(&s);
  return code;
}

static int segments(run *r, sunrealtype t0, size_t count, const sunrealtype *breaks)
{
  sunrealtype t = t0;
  for (size_t i = 0; i <= count; i++) {
    const sunrealtype end = i < count ? breaks[i] : r->options.t1;
    STEIF_CHECK(end > t, r->ctx, STEIF_BAD_INPUT,
                "breaks must ascend within (%.17g, %.17g): %.17g comes after %.17g", t0,
                r->options.t1, end, t);
    STEIF_TRY(jump(r, t));
    STEIF_TRY(smooth(r, t, end));
    t = end;
  }
  return STEIF_OK;
}

int steif_linear_run(steif_context *ctx, const steif_linear *linear, const sunrealtype *x0,
                     sunrealtype t0, const char *method, const steif_options *options,
                     const steif_analysis *analysis, size_t break_count,
                     const sunrealtype *breaks, const steif_linear_output *output)
{
  static const steif_linear_output silent = {0};
  steif_problem p;
  STEIF_CHECK(options, ctx, STEIF_BAD_INPUT, "options with t1 are needed, got NULL");
  STEIF_TRY(steif_linear_problem(ctx, linear, x0, t0, options->t1, &p));
  run r = {.ctx = ctx,
           .linear = linear,
           .method = method,
           .options = *options,
           .analysis = analysis,
           .output = output ? output : &silent};
  r.x = stf_allocate(ctx, (size_t)p.n, sizeof *r.x);
  if (!r.x) return STEIF_NO_MEMORY;
  memcpy(r.x, x0, (size_t)p.n * sizeof *r.x);
  int code = steif_structure_find(ctx, linear->E, linear->F, analysis, &r.structure);
  if (!code) code = segments(&r, t0, break_count, breaks);
  steif_structure_clear(ctx, &r.structure);
  stf_release(ctx, r.x);
  return code;
}
