/* modes.c: the equations that hold from an event or a break on, the next mode of a DAE: its index, and the state
 * put where they hold. As at a start (repair.h): index 1 keeps unknowns with a derivative, and the others follow;
 * hidden constraints of higher index that appear or change make impulses, by which velocities and charges jump.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "integrator.h"
#include <math.h>
#include <string.h>

/* Unknowns with a derivative that move by no more tolerances than this have errors, and no jump. */
static const sunrealtype most = 10;

/* Is the start of such runs put in order, so that those of later modes are? */
static bool follows(const steif_solver *s)
{
  const stf_repair *r = &s->repair;
  return !s->engine && s->step.adaptive && r->algebraic && r->policy == STEIF_REPAIR &&
         s->step.system.space.serial;
}

/* The index of the mode, where it was found, and of its unknowns, decide on weights from now on. */
static int take_index(steif_solver *s, const stf_repair *found)
{
  stf_repair *r = &s->repair;
  const size_t n = (size_t)s->problem->n;
  memcpy(r->algebraic, found->algebraic, n * sizeof *r->algebraic);
  r->count = found->count;
  if (!found->report.number && found->problem.dae_index != 1) return STEIF_OK;
  r->problem.dae_index = found->problem.dae_index;
  STEIF_TRY(stf_check_mode_index(&s->step));
  r->problem.index = NULL;
  if (!found->problem.index) return STEIF_OK;
  if (!r->mode && !(r->mode = stf_pool_array(s->pool, n, sizeof *r->mode)))
    return STEIF_NO_MEMORY;
  r->problem.index = memcpy(r->mode, found->problem.index, n * sizeof *r->mode);
  return STEIF_OK;
}

/* The largest movement of an unknown with a derivative, in tolerances. */
static sunrealtype jump_of(const steif_solver *s, const stf_repair *found, const sunrealtype *y)
{
  sunrealtype largest = 0;
  for (size_t j = 0; j < (size_t)s->problem->n; j++)
    if (!found->algebraic[j])
      largest = fmax(largest, fabs(found->report.y[j] - y[j]) / found->weight[j]);
  return largest;
}

static const char *of_start(const char *text)
{
  static const char begins[] = "start: ";
  return text + (strncmp(text, begins, sizeof begins - 1) ? 0 : sizeof begins - 1);
}

/* y takes its place in the mode. */
static int take_place(steif_solver *s, const stf_repair *found, sunrealtype t, sunrealtype *y)
{
  steif_repair *told = &s->repair.report;
  const bool jumps = jump_of(s, found, y) > most;
  if (jumps && s->saltation) STEIF_TRY(stf_saltation_place(s, y));
  if (jumps)
    STEIF_TRY(stf_quadrature_impulses(s, t, s->step.y, found->algebraic, found->problem.index));
  if (jumps && !told->jumps++)
    stf_point_say(told->jumped, "t = %.12g: %s", t, of_start(found->report.message));
  memcpy(y, found->report.y, (size_t)s->problem->n * sizeof *y);
  return STEIF_OK;
}

/* What has gone wrong is told of index 2 and 3, whose first step would jump somewhere; of index 1 the step finds its
 * own way or tells of itself. */
static int refused(steif_solver *s, const stf_repair *found, sunrealtype t, int code)
{
  char why[STF_MESSAGE];
  if (code == STEIF_NO_MEMORY) return code;
  stf_message_copy(s->ctx, why);
  steif_forget(s->ctx);
  if (found->problem.dae_index < 2) return STEIF_OK;
  return STEIF_FAIL(s->ctx, code,
                    "no consistent values at t = %.12g, from which on other equations hold: %s",
                    t, why);
}

/* y at t, the first time of a mode. Shown: the mode begins later; to all digits: for differences. */
enum { BEGINS, SHOWN, EXACT };
static int begin(steif_solver *s, sunrealtype t, int what, N_Vector y)
{
  const steif_options *o = &s->options;
  const bool ahead = what != BEGINS;
  const sunrealtype finest = 1e-13, scale = what == EXACT ? finest / o->rtol : 1;
  steif_problem at = *s->repair.given;
  stf_pool *pool = stf_pool_new(s->ctx);
  at.t0 = t, at.y0 = stf_array(y), at.yp0 = NULL, at.start = NULL;
  at.index = NULL, at.dae_index = 0;
  stf_repair found = {.ctx = s->ctx,
                      .pool = pool,
                      .given = &at,
                      .policy = STEIF_REPAIR,
                      .rtol = scale * o->rtol,
                      .atol = scale * o->atol,
                      .atols = what == EXACT ? NULL : o->atols};
  const bool before = stf_silence(s->ctx, true);
  int code = pool ? stf_start_repaired(&found) : STEIF_NO_MEMORY;
  stf_silence(s->ctx, before);
  if (code)
    code = refused(s, &found, t, code);
  else if (ahead && found.report.y)
    memcpy(stf_array(y), found.report.y, (size_t)at.n * sizeof *found.report.y);
  else if (!ahead && found.algebraic)
    code = take_index(s, &found);
  if (!code && !ahead && found.report.y) code = take_place(s, &found, t, stf_array(y));
  stf_pool_free(&pool);
  return code;
}

int stf_mode_place(steif_solver *s, sunrealtype t, N_Vector y)
{
  return follows(s) ? begin(s, t, BEGINS, y) : STEIF_OK;
}

int stf_mode_show(steif_solver *s, sunrealtype t, N_Vector y)
{
  return follows(s) ? begin(s, t, SHOWN, y) : STEIF_OK;
}

int stf_mode_exactly(steif_solver *s, sunrealtype t, N_Vector y)
{
  return follows(s) ? begin(s, t, EXACT, y) : STEIF_OK;
}

/* y was `before` where S was found. */
static int recompute(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, bool *known)
{
  if (!s->saltation) return stf_recompute_mode(s, t, y, yp, known);
  const size_t bytes = (size_t)s->problem->n * sizeof(sunrealtype);
  sunrealtype *before = stf_allocate(s->ctx, bytes / sizeof *before, sizeof *before);
  if (!before) return STEIF_NO_MEMORY;
  memcpy(before, stf_array(y), bytes);
  int code = stf_recompute_mode(s, t, y, yp, known);
  if (!code && *known) code = stf_saltation_recompute(s, before);
  stf_release(s->ctx, before);
  return code;
}

int stf_mode_begin(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, bool *known)
{
  *known = false;
  if (!follows(s)) return STEIF_OK;
  if (!s->saltation) STEIF_TRY(stf_recompute_mode(s, t, y, yp, known)); /* the mode goes on */
  if (*known) return STEIF_OK;
  STEIF_TRY(begin(s, t, BEGINS, y));
  return recompute(s, t, y, yp, known);
}

void stf_mode_keep(steif_solver *s, stf_image *m)
{
  stf_repair *r = &s->repair;
  const size_t n = (size_t)s->problem->n;
  bool own = r->mode && r->problem.index == r->mode;
  if (!r->algebraic || m->code) return;
  STF_KEEP(m, r->problem.dae_index);
  STF_KEEP(m, r->count);
  STF_KEEP(m, r->report.jumps);
  STF_KEEP(m, r->report.jumped);
  stf_keep(m, r->algebraic, n * sizeof *r->algebraic);
  STF_KEEP(m, own);
  if (m->code) return;
  if (own && !r->mode && !(r->mode = stf_pool_array(s->pool, n, sizeof *r->mode)))
    stf_image_stop(m, STEIF_NO_MEMORY);
  else if (own)
    stf_keep(m, r->mode, n * sizeof *r->mode);
  if (own && !m->code) r->problem.index = r->mode;
}
