/* constant_steps.c: what runs with a constant step size keep, where they end, and when they blow up.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "experiment.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/energy.h>

enum { INVARIANTS = 4, POINTS = 4096 };
static const sunrealtype blown = 1e8;

typedef struct run {
  stf_trial *trial;
  const stf_constant_run *line;
  enum stf_picture picture;
  steif_energy energy;
  steif_drift drift[INVARIANTS];
  size_t invariants;
  long steps, blown_at, rejected;
  sunrealtype end[2], time, late, crossing;
} run;

static int draw(run *r, sunrealtype t, const sunrealtype *y)
{
  const long stride = 1 + r->line->steps / POINTS;
  if (!r->line->drawn || r->steps % stride || r->picture == STF_DRIFT) return STEIF_OK;
  return stf_curve_point(r->trial, r->picture == STF_ORBIT ? y[0] : t,
                         y[r->picture == STF_ORBIT]);
}

static int observe(steif_solver *s, sunrealtype t, N_Vector v, void *user)
{
  run *r = user;
  const sunrealtype *y = N_VGetArrayPointer(v), before = r->end[0];
  (void)s;
  r->steps++;
  if (fabs(y[0]) > blown || fabs(y[1]) > blown) {
    r->blown_at = r->steps;
    return 1;
  }
  if (2 * r->steps > r->line->steps) r->late = fmax(r->late, fabs(y[0]));
  if (isnan(r->crossing) && before < 0 && y[0] >= 0)
    r->crossing = r->time + (t - r->time) * before / (before - y[0]);
  r->end[0] = y[0];
  r->end[1] = y[1];
  r->time = t;
  return draw(r, t, y);
}

static int integrate(run *r, const steif_problem *p, const steif_options *o)
{
  steif_context *ctx = r->trial->ctx;
  if (p->invariants > 0) return steif_energy_measure(ctx, p, r->line->method, o, &r->energy);
  steif_solver *s = steif_solver_new(ctx, p, r->line->method, o);
  const int code = s ? steif_solve_to(s, o->t1) : steif_status(ctx);
  steif_solver_free(&s);
  return code;
}

/* A run that blows up or is rejected has told what was asked. */
static int carry_out(run *r)
{
  const stf_constant_run *l = r->line;
  steif_context *ctx = r->trial->ctx;
  steif_problem p;
  STEIF_TRY(steif_problem_find(ctx, l->problem, &p));
  steif_options o = steif_defaults();
  o.h = l->h;
  o.t1 = p.t0 + l->h * (sunrealtype)l->steps;
  o.observe = observe;
  o.observer = r;
  o.newton = 1e-6;
  o.max_steps = 2 * l->steps;
  r->late = 0;
  r->crossing = NAN;
  r->energy.drift = r->drift;
  r->end[0] = p.y0[0];
  r->end[1] = p.y0[1];
  r->time = p.t0;
  r->invariants = (size_t)p.invariants;
  int code = p.invariants <= INVARIANTS ? integrate(r, &p, &o) : STEIF_UNSUPPORTED;
  steif_problem_clear(ctx, &p);
  if (code == STEIF_NOT_FINITE) r->blown_at = r->steps + 1;
  if (code == STEIF_NO_CONVERGENCE) r->rejected = 1;
  if (!r->blown_at && !r->rejected) return code;
  steif_forget(ctx);
  return STEIF_OK;
}

static sunrealtype taken(const run *r, enum stf_what what, const char **name)
{
  const steif_drift *d = r->drift;
  switch (what) {
  case STF_MAX: return *name = "largest drift", d->max;
  case STF_MIN: return *name = "least drift", d->min;
  case STF_FINAL: return *name = "final drift", d->final;
  case STF_MEAN: return *name = "mean drift", d->mean;
  case STF_PER_PERIOD: return *name = "drift per period", d->per_period;
  case STF_SECOND: return *name = "second invariant", fmax(d[1].max, -d[1].min);
  case STF_FIRST_END: return *name = "q at the end", r->end[0];
  case STF_SECOND_END: return *name = "p at the end", r->end[1];
  case STF_LATE: return *name = "largest late |q|", r->late;
  case STF_CROSSING: return *name = "first zero upward", r->crossing;
  case STF_BLOWN: return *name = "blown up at step (0: never)", (sunrealtype)r->blown_at;
  case STF_REJECTED: return *name = "rejected", (sunrealtype)r->rejected;
  default: return *name = "", NAN;
  }
}

static int draw_drift(run *r)
{
  const sunrealtype *row = r->energy.row;
  const size_t columns = 1 + r->invariants;
  for (size_t i = 0; i < r->energy.rows; i++)
    STEIF_TRY(stf_curve_point(r->trial, row[i * columns], row[i * columns + 1]));
  return STEIF_OK;
}

static int line(stf_trial *t, const stf_constant_run *l)
{
  const stf_constant_runs *d = t->data;
  run r = {.trial = t, .line = l, .picture = d->picture, .energy = {.period = d->period}};
  const bool drift = l->drawn && d->picture == STF_DRIFT;
  const char *label = l->label ? l->label : l->method;
  if (drift) {
    r.energy.rows = l->steps < POINTS ? (size_t)l->steps + 1 : POINTS;
    r.energy.row =
      stf_pool_array(t->pool, r.energy.rows * (1 + INVARIANTS), sizeof *r.energy.row);
    if (!r.energy.row) return STEIF_NO_MEMORY;
  }
  if (l->drawn) STEIF_TRY(stf_curve(t, label, 0));
  STEIF_TRY(carry_out(&r));
  for (const stf_known *k = l->known; k < l->known + 6 && k->what; k++) {
    const char *name;
    const sunrealtype all = taken(&r, k->what, &name);
    const bool ended = !r.blown_at && !r.rejected, tells = k->what >= STF_BLOWN;
    const sunrealtype value = ended || tells ? all : NAN;
    STEIF_TRY(stf_find(t, label, l->h, name, value, k->reference, k->tolerance));
  }
  return drift ? draw_drift(&r) : STEIF_OK;
}

int stf_constant_table(stf_trial *t)
{
  const stf_constant_runs *d = t->data;
  for (size_t i = 0; i < d->lines; i++) STEIF_TRY(line(t, d->line + i));
  return STEIF_OK;
}

int stf_blow_up(stf_trial *t, const char *problem, const char *method, sunrealtype step,
                sunrealtype most, sunrealtype t1, sunrealtype *h)
{
  *h = 0;
  for (long k = 1; *h == 0 && (sunrealtype)k * step <= most; k++) {
    const stf_constant_run l = {problem,
                                method,
                                NULL,
                                (sunrealtype)k * step,
                                lround(t1 / ((sunrealtype)k * step)),
                                false,
                                {{STF_NOTHING, 0, 0}}};
    run r = {.trial = t, .line = &l};
    STEIF_TRY(carry_out(&r));
    if (r.blown_at) *h = l.h;
  }
  return STEIF_OK;
}
