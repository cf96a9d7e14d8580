/* solver_image.c: what a solver remembers between two steps.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"

static void keep_progress(steif_solver *s, stf_image *m)
{
  STF_KEEP(m, s->t1);
  STF_KEEP(m, s->options.t1);
  STF_KEEP(m, s->t1_opened);
  STF_KEEP(m, s->t_shown);
  STF_KEEP(m, s->end);
  STF_KEEP(m, s->finished);
  STF_KEEP(m, s->constant);
  STF_KEEP(m, s->rejected);
  STF_KEEP(m, s->mesh_at);
  STF_KEEP(m, s->next_break);
  STF_KEEP(m, s->constraint_moves);
  STF_KEEP(m, s->rounded);
  sunrealtype cpu_s = stf_cpu_seconds(s);
  STF_KEEP(m, cpu_s);
  if (m->reads) s->cpu_s = cpu_s;
  STF_KEEP(m, s->method);
}

static void keep_control(steif_solver *s, stf_image *m)
{
  STF_KEEP(m, s->h_next);
  STF_KEEP(m, s->h_old);
  STF_KEEP(m, s->h_tried);
  STF_KEEP(m, s->error_old);
  STF_KEEP(m, s->after_reject);
}

static void keep_events(steif_solver *s, stf_image *m)
{
  stf_detector *w = s->events;
  const size_t count = (size_t)w->count;
  stf_keep_vector(m, w->after);
  if (w->slope) stf_keep_vector(m, w->slope);
  stf_keep(m, w->low, count * sizeof *w->low);
  stf_keep(m, w->noise, count * sizeof *w->noise);
  stf_keep(m, w->sign, count * sizeof *w->sign);
  stf_keep(m, w->coarse, count * sizeof *w->coarse);
  stf_keep(m, w->fired, count * sizeof *w->fired);
  STF_KEEP(m, w->t);
  STF_KEEP(m, w->started);
  STF_KEEP(m, w->cut);
  STF_KEEP(m, w->settled);
  STF_KEEP(m, w->moved);
  STF_KEEP(m, w->silent);
  STF_KEEP(m, w->last);
  STF_KEEP(m, w->gathered);
  STF_KEEP(m, w->name);
}

/* Bytes of the callbacks themselves. */
static void keep_callbacks(steif_solver *s, stf_image *m)
{
  const steif_problem *p = s->problem;
  size_t count = 0;
  if (m->code || !p->save) return;
  const long bytes = p->save(NULL, p->user);
  void *block = bytes >= 0 ? stf_allocate(s->ctx, (size_t)bytes + 1, 1) : NULL;
  if (bytes < 0)
    stf_image_stop(m, STEIF_FAIL(s->ctx, STEIF_CALLBACK, "save of problem '%s' returned %ld",
                                 p->name, bytes));
  else if (!block)
    stf_image_stop(m, STEIF_NO_MEMORY);
  if (m->code) return;
  if (!m->reads) p->save(block, p->user);
  count = (size_t)bytes;
  stf_keep(m, block, count);
  const int returned = m->reads && !m->code ? p->restore(block, count, p->user) : 0;
  stf_release(s->ctx, block);
  if (returned)
    stf_image_stop(m, STEIF_FAIL(s->ctx, STEIF_CALLBACK, "restore of problem '%s' returned %d",
                                 p->name, returned));
}

/* The solution shown is that of the end, or lies before it. */
static void keep_shown(steif_solver *s, stf_image *m)
{
  bool between = s->shown == s->dense;
  STF_KEEP(m, between);
  if (m->code) return;
  if (between) stf_keep_vector(m, s->dense);
  if (m->reads) s->shown = between ? s->dense : stf_last(s);
}

/* Another end may have brought or taken the place for a last step beyond it. */
static void keep_final(steif_solver *s, stf_image *m)
{
  bool there = s->final;
  STF_KEEP(m, there);
  if (m->code) return;
  if (!there) s->final = NULL;
  if (there && !s->final && !(s->final = stf_pool_vector(s->pool, s->step.y)))
    stf_image_stop(m, STEIF_NO_MEMORY);
  if (s->final) stf_keep_vector(m, s->final);
}

/* The steps of an engine once more, seen by nobody. */
static int repeat(steif_solver *s, long steps)
{
  const steif_options with = s->options;
  int code = STEIF_OK;
  s->options.observe = NULL, s->options.on_event = NULL;
  while (!code && s->run.stats.steps < steps) code = steif_solve_step(s);
  s->options.observe = with.observe, s->options.on_event = with.on_event;
  return code;
}

/* Has it come to y, which is in s->dense, at t? */
static int check_repeated(steif_solver *s, long steps, sunrealtype t)
{
  N_VLinearSum(1, s->run.y, -1, s->dense, s->dense);
  const bool same = s->run.t == t && s->run.stats.steps == steps && N_VMaxNorm(s->dense) == 0;
  STEIF_CHECK(
    same, s->ctx, STEIF_UNSUPPORTED,
    "'%s' keeps its history to itself, and its %ld steps to t = %.12g, repeated, did not "
    "come to the same bits: repeat the run as a whole",
    s->spec, steps, t);
  return STEIF_OK;
}

/* Of engines, which keep their history to themselves, there is the point that they had come to. */
static void keep_engine(steif_solver *s, stf_image *m)
{
  long steps = s->run.stats.steps;
  sunrealtype t = s->run.t, t1 = s->t1, shown = s->t_shown;
  STF_KEEP(m, steps);
  STF_KEEP(m, t);
  STF_KEEP(m, t1);
  STF_KEEP(m, shown);
  stf_keep_vector(m, m->reads ? s->dense : s->run.y);
  if (!m->reads || m->code) return;
  int code = repeat(s, steps);
  if (!code) code = check_repeated(s, steps, t);
  s->t1 = s->options.t1 = t1;
  if (!code && shown < s->end) code = steif_dense(s, shown, s->dense);
  if (!code && shown < s->end) s->shown = s->dense;
  s->t_shown = shown;
  if (code) stf_image_stop(m, code);
}

/* A method of ours. */
static void keep_run(steif_solver *s, stf_image *m)
{
  const int count = s->invariants ? s->problem->invariants : 0;
  keep_progress(s, m);
  keep_control(s, m);
  stf_keep_presence(m, s->switching, "a second method of auto");
  if (s->switching && !m->code) stf_switching_keep(s, m);
  stf_step_keep(&s->step, m);
  stf_method_keep(&s->step, m);
  stf_rounding_keep(s, m);
  stf_mode_keep(s, m);
  keep_final(s, m);
  stf_keep(m, s->invariants, (size_t)count * sizeof *s->invariants);
  stf_keep_presence(m, s->events, "event detection");
  if (s->events && !m->code) keep_events(s, m);
  keep_callbacks(s, m);
  keep_shown(s, m);
}

void stf_solver_keep(steif_solver *s, stf_image *m)
{
  (s->engine ? keep_engine : keep_run)(s, m);
}
