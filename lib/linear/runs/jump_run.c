/* jump_run.c: runs of E x' + F x = f through its jumps: at the start and at every declared break
 * x(t+) and the impulses, between them a method on the smooth solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "passage.h"
#include <nvector/nvector_serial.h>
#include <string.h>

typedef struct run {
  stf_passage passage;
  const steif_linear_output *output;
  N_Vector shown; /* the solution of a step, settled */
} run;

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  run *r = user;
  (void)s;
  if (r->passage.settles) {
    N_VScale(1, y, r->shown);
    STEIF_TRY(stf_passage_settle(&r->passage, t, N_VGetArrayPointer(r->shown)));
    y = r->shown;
  }
  return r->output->step(t, y, r->output->user);
}

static int open(run *r, const sunrealtype *x0)
{
  stf_passage *p = &r->passage;
  STEIF_TRY(stf_passage_open(p, x0));
  if (!p->settles) return STEIF_OK;
  r->shown = N_VNew_Serial(p->n, steif_sundials(p->ctx));
  STEIF_CHECK(r->shown, p->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  return STEIF_OK;
}

static int segments(run *r, sunrealtype t0, sunrealtype t1, size_t count,
                    const sunrealtype *breaks)
{
  stf_passage *p = &r->passage;
  sunrealtype t = t0;
  for (size_t i = 0; i <= count; i++) {
    const sunrealtype end = i < count ? breaks[i] : t1;
    STEIF_CHECK(end > t, p->ctx, STEIF_BAD_INPUT,
                "breaks must ascend within (%.17g, %.17g): %.17g comes after %.17g", t0, t1,
                end, t);
    STEIF_TRY(stf_passage_begin(p, t, end));
    STEIF_TRY(steif_solve_to(p->solver, end));
    memcpy(p->x, N_VGetArrayPointer(steif_solution(p->solver)), (size_t)p->n * sizeof *p->x);
    if (i < count) STEIF_TRY(stf_passage_settle(p, end, p->x));
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
  run r = {.output = output ? output : &silent};
  r.passage = (stf_passage){.ctx = ctx,
                            .given = linear,
                            .method = method,
                            .options = *options,
                            .analysis = analysis,
                            .jump = r.output->jump,
                            .user = r.output->user};
  if (r.output->step) r.passage.options.observe = observe, r.passage.options.observer = &r;
  int code = open(&r, x0);
  if (!code) code = segments(&r, t0, options->t1, break_count, breaks);
  if (r.shown) N_VDestroy(r.shown);
  stf_passage_close(&r.passage);
  return code;
}
