/* descriptor.c: E x' = A x + g of any index from any x(t-): the jump with its impulses at the
 * start, at breaks and behind events, and chosen steps on the smooth solution between them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "engine.h"
#include "passage.h"
#include "problem.h"
#include <nvector/nvector_serial.h>
#include <string.h>

typedef struct descriptor {
  const steif_problem *problem;
  steif_linear linear;
  steif_analysis analysis;
  stf_passage passage;
  N_Vector work;
  bool anew; /* the next step begins a segment, from run->y */
  int next_break;
  long calls;       /* of g and its derivatives */
  steif_stats past; /* of the segments before */
} descriptor;

static int counted(sunrealtype t, int derivative, N_Vector g, void *user)
{
  descriptor *s = user;
  s->calls++;
  return s->problem->g(t, derivative, g, s->problem->user);
}

static sunrealtype *values(N_Vector v) { return N_VGetArrayPointer(v); }

static size_t bytes(const stf_run *run)
{
  return (size_t)run->problem->n * sizeof(sunrealtype);
}

/* -- opening ----------------------------------------------------------------------------- */

static int check(const stf_run *run)
{
  const steif_options *o = run->options;
  STEIF_CHECK(!(o->h > 0) && !o->mesh, run->ctx, STEIF_UNSUPPORTED,
              "'descriptor' chooses its steps: leave h and mesh out, or take a method such as "
              "radau:s=3, which makes prescribed steps on '%s' as it is",
              run->problem->name);
  STEIF_CHECK(
    !o->ewt && !run->problem->constraint, run->ctx, STEIF_UNSUPPORTED,
    "'descriptor' takes rtol, atol and atols for '%s', no function ewt and no constraints",
    run->problem->name);
  STEIF_CHECK(run->y->ops->nvgetarraypointer && values(run->y), run->ctx, STEIF_UNSUPPORTED,
              "'descriptor' needs vectors with a host array for '%s'", run->problem->name);
  return STEIF_OK;
}

/* -- segments -------------------------------------------------------------------------------
 * */

/* Of the segments before and this one; sparse analyses count as what they factor and solve. */
static void count(stf_run *run, const descriptor *s)
{
  const steif_stats *now = steif_statistics(s->passage.solver), *past = &s->past;
  const steif_pencil_stats *cost = &s->passage.cost;
  run->stats = (steif_stats){.steps = past->steps + now->steps,
                             .rejected = past->rejected + now->rejected,
                             .nfe = s->calls,
                             .nje = past->nje + now->nje,
                             .nlu = past->nlu + now->nlu + cost->factors + cost->refactors,
                             .nsolve = past->nsolve + now->nsolve + cost->solves,
                             .newton = past->newton + now->newton,
                             .newton_fails = past->newton_fails + now->newton_fails,
                             .h_last = now->h_last};
}

/* What the segment has cost, before its solver goes. */
static void close_account(descriptor *s)
{
  if (!s->passage.solver) return;
  const steif_stats *now = steif_statistics(s->passage.solver);
  s->past.steps += now->steps, s->past.rejected += now->rejected, s->past.nje += now->nje;
  s->past.nlu += now->nlu, s->past.nsolve += now->nsolve;
  s->past.newton += now->newton, s->past.newton_fails += now->newton_fails;
}

/* The segment from run->t to the next break or the end; run->y becomes x(t+). */
static int begin(stf_run *run, descriptor *s)
{
  const steif_problem *p = run->problem;
  while (s->next_break < p->break_count && p->breaks[s->next_break] <= run->t) s->next_break++;
  const bool breaks =
    s->next_break < p->break_count && p->breaks[s->next_break] < run->options->t1;
  memcpy(s->passage.x, values(run->y), bytes(run));
  close_account(s);
  s->anew = false;
  STEIF_TRY(stf_passage_begin(&s->passage, run->t,
                              breaks ? p->breaks[s->next_break] : run->options->t1));
  memcpy(values(run->y), s->passage.x, bytes(run));
  return STEIF_OK;
}

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  descriptor *s = state;
  STEIF_TRY(stf_spec_only(run->ctx, spec, (const char *const[]){NULL}));
  STEIF_TRY(check(run));
  STEIF_TRY(steif_linear_of(run->ctx, run->problem, &s->linear));
  s->problem = run->problem, s->analysis.names = run->problem->names;
  if (s->linear.f) s->linear.f = counted, s->linear.user = s;
  s->work = N_VNew_Serial(run->problem->n, steif_sundials(run->ctx));
  STEIF_CHECK(s->work, run->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  steif_options o = *run->options; /* what the run as a whole watches stays with it */
  o.observe = NULL, o.on_event = NULL, o.reinitialise = NULL, o.jump = NULL, o.stop = NULL,
  o.like = NULL;
  o.max_seconds = 0, o.force_storage = 0;
  s->passage = (stf_passage){.ctx = run->ctx,
                             .given = &s->linear,
                             .name = run->problem->name,
                             .analysis = &s->analysis,
                             .method = "auto",
                             .options = o,
                             .jump = run->options->jump,
                             .user = run->options->observer};
  STEIF_TRY(stf_passage_open(&s->passage, values(run->y)));
  return begin(run, s);
}

static void close(stf_run *run, void *state)
{
  descriptor *s = state;
  (void)run;
  stf_passage_close(&s->passage);
  if (s->work) N_VDestroy(s->work);
  if (s->linear.E) SUNMatDestroy(s->linear.E);
  if (s->linear.F) SUNMatDestroy(s->linear.F);
}

/* -- steps ------------------------------------------------------------------------------- */

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  descriptor *s = state;
  stf_passage *p = &s->passage;
  (void)t_stop; /* the end of the run */
  STEIF_CHECK(
    run->stats.steps < run->options->max_steps, run->ctx, STEIF_STEP_LIMIT,
    "%ld steps made at t = %.12g of problem '%s', the limit: raise max_steps or loosen "
    "the tolerance",
    run->stats.steps, run->t, run->problem->name);
  if (s->anew) STEIF_TRY(begin(run, s));
  STEIF_TRY(stf_step_untimed(p->solver));
  run->t = steif_time(p->solver);
  memcpy(values(run->y), values(steif_solution(p->solver)), bytes(run));
  count(run, s);
  s->anew = run->t >= p->end;
  const bool inner = run->t < run->options->t1;
  return p->settles || (s->anew && inner) ? stf_passage_settle(p, run->t, values(run->y))
                                          : STEIF_OK;
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  descriptor *s = state;
  stf_passage *p = &s->passage;
  STEIF_CHECK(p->solver, run->ctx, STEIF_BAD_INPUT,
              "no step has been made since the last jump");
  STEIF_TRY(steif_dense(p->solver, t, s->work));
  if (p->settles) STEIF_TRY(stf_passage_settle(p, t, values(s->work)));
  memcpy(values(y), values(s->work), bytes(run));
  return STEIF_OK;
}

static int renew(stf_run *run, void *state)
{
  (void)run;
  ((descriptor *)state)->anew = true;
  return STEIF_OK;
}

static int jump(steif_context *ctx, const steif_problem *problem, sunrealtype t, sunrealtype *x,
                bool *certified)
{
  steif_linear l;
  steif_impulse i = {0};
  STEIF_TRY(steif_linear_of(ctx, problem, &l));
  int code = steif_impulse_find(ctx, l.E, l.F, x, t, l.f, l.user, NULL, NULL, &i);
  *certified = !code && i.certified;
  if (!code) memcpy(x, i.x_plus, (size_t)i.n * sizeof *x);
  steif_impulse_clear(ctx, &i);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  return code;
}

const steif_engine steif_engine_descriptor = {
  .family = "descriptor",
  .about =
    "E x' = A x + g of any index from any x(t-): impulses from the pencil, adaptive steps on a "
    "system of index 1 with the same smooth solutions (S. L. Campbell, Singular Systems of "
    "Differential Equations, Pitman 1980)",
  .forms = STEIF_DESCRIPTOR,
  .size = sizeof(descriptor),
  .open = open,
  .step = step,
  .dense = dense,
  .renew = renew,
  .jump = jump,
  .close = close,
};
