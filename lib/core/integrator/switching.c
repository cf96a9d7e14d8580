/* switching.c: the two methods of `auto`, and when it switches from one to the other.
 *
 * Every few steps the cost to the end of the method in use is estimated from its last steps, and
 * compared with that of the other one:
 *   in use      N steps like the last ones, but not shorter than the mean since it took over: short ones
 *               pass; where their length grows as exp(r k), h (exp(r N) - 1)/r = t1 - t
 *   explicit    as many steps as stability asks for, h rho = 4 to 5, rho the spectral radius of df/dy now or
 *               in the mean, or what it has cost when it was last in use, if that is more
 *   implicit    as many steps as a smooth solution needs, or what it has cost when it was last in
 *               use; the longer that is ago the less it says. It is tried first when the
 *               explicit one has cost as much, and where its steps follow from stability, h rho > 1
 * Costs are counted (cost_model.c), not timed: the same run takes the same course every time.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "random.h"
#include "switching.h"
#include <math.h>
#include <stdio.h>

/* The region of stability of the explicit method reaches to -5.2 and, but for what a long run does not
 * notice, 3.7 i: h rho where the fastest modes decay, and elsewhere. */
static const double stable_real = 4.8, stable_else = 4;

enum { PERIOD = 8 }; /* steps between the first looks */

/* One of the methods: what stf_step holds of it, and what is known of its cost. */
typedef struct candidate {
  const steif_method *method;
  void *state;
  steif_table *table;
  stf_control control;
  char name[STEIF_SPEC_WORD];
  double rate;      /* cost per unit of time when it was last in use; 0: never was */
  double half_life; /* of that, in cost of the other one */
} candidate;

/* Since the method in use took over. */
typedef struct period {
  sunrealtype t;
  long count;
  double spent;      /* cost of the run before it */
  double rho, looks; /* sum over looks */
} period;

struct stf_switching {
  steif_context *ctx;
  candidate side[2]; /* implicit, explicit: what the one not in use has */
  int at;            /* in use: 0 implicit, 1 explicit */
  stf_cost cost;
  double least;  /* steps of the implicit method through a smooth solution */
  double stable; /* h rho of the explicit method with the spectrum last seen */
  period now;
  long seen_at, look; /* steps at the last look, at the next one */
  sunrealtype t, h;   /* of the last look; mean length of steps before it, 0: first look */
  double spent;       /* cost of the run up to the last look */
  steif_stats seen;   /* at the last look */
  int changes;
  bool constrained; /* a constraint has refused or moved a step since the last look */
  N_Vector work;
};

static void keep(const stf_step *s, candidate *c)
{
  c->method = s->method;
  c->state = s->state;
  c->table = s->table;
  c->control = s->control;
}

static void take(stf_step *s, const candidate *c)
{
  s->method = c->method;
  s->state = c->state;
  s->table = c->table;
  s->control = c->control;
}

/* The spectral radius of the Jacobian at hand, from a vector that has a part of everything. */
static int radius(stf_step *s, stf_switching *r, sunrealtype *rho)
{
  bool real;
  sunrealtype *v = stf_array(s->next), *w = stf_array(s->weights);
  unsigned bits = 1;
  for (sunindextype i = 0; i < s->problem->n; i++) {
    bits =
      1664525 * bits + 1013904223; /* D. E. Knuth, The Art of Computer Programming 2, 3.3.4 */
    v[i] = (bits >> 31 ? 1 : -1) / w[i];
  }
  STEIF_TRY(stf_spectral_radius(s, s->next, s->error, r->work, rho, &real));
  r->stable = real ? stable_real : stable_else;
  return STEIF_OK;
}

/* Steps through `span`, if their length h grows by exp(growth) each. */
static double steps(double span, double h, double growth)
{
  return growth > 0 ? log1p(growth * span / h) / growth : span / h;
}

/* The same, when the last `window` ones had length h, those before `before`. */
static double expected(const stf_step *s, const stf_switching *r, double span, double window,
                       double h, double before)
{
  const double count = (double)(s->count - r->now.count), mean = (s->t - r->now.t) / count,
               recent = log(h / before) / window, whole = 2 * log(h / mean) / count,
               most = steps(span, fmax(h, mean), whole);
  return recent > 0 ? fmin(most, steps(span, h, recent)) : most;
}

static double of_stability(const stf_switching *r, double span, double rho)
{
  const double rejected = 1.15; /* steps made anew */
  return rejected * span * rho / r->stable * r->cost.explicit_step;
}

/* -- in use -------------------------------------------------------------------------------------- */

/* Spent since the last look. Dense output calls f too: these calls do not count. */
static double spent(steif_solver *s)
{
  stf_switching *r = s->switching;
  const stf_cost *p = &r->cost;
  const steif_stats now = *steif_statistics(s), *was = &r->seen;
  const double attempts = (double)(now.steps - was->steps + now.rejected - was->rejected);
  double cost = attempts * p->explicit_step;
  if (r->at == 0)
    cost = (double)(now.nlu - was->nlu) * p->factor +
           (double)(now.nje - was->nje) * p->jacobian +
           (double)(now.nsolve - was->nsolve) * (p->solve + p->f);
  r->seen = now;
  return cost;
}

/* What the other one would cost to the end. */
static int other(steif_solver *s, double span, double *cost)
{
  stf_switching *r = s->switching;
  const candidate *b = &r->side[!r->at];
  *cost = fmax(r->least * r->cost.step, r->spent - r->now.spent);
  if (r->at == 0) {
    sunrealtype rho;
    STEIF_TRY(radius(&s->step, r, &rho));
    r->now.rho += rho, r->now.looks++;
    *cost = of_stability(r, span, fmax(rho, r->now.rho / r->now.looks));
  }
  const double since = r->spent - r->now.spent;
  const double known = b->rate > 0 ? span * b->rate * exp2(-since / b->half_life) : 0;
  *cost = fmax(*cost, known);
  return STEIF_OK;
}

/* Do the explicit method's steps follow from stability? */
static int stiff(steif_solver *s, double h, bool *answer)
{
  stf_step *step = &s->step;
  sunrealtype rho;
  *answer = false;
  const int code = stf_system_linearise(&step->system, step->t, step->y, step->yp);
  if (code) return code < 0 ? code : STEIF_OK;
  STEIF_TRY(radius(step, s->switching, &rho));
  *answer = h * rho > 1;
  return STEIF_OK;
}

static void tell(steif_solver *s, double cost, double other)
{
  const stf_switching *r = s->switching;
  snprintf(s->method, sizeof s->method,
           "%s (since t = %.4g, step %ld, change %d): to the end at %.2g of what %s would cost",
           r->side[r->at].name, s->step.t, s->step.count, r->changes, other / cost,
           r->side[!r->at].name);
}

static void exchange(stf_step *s, stf_switching *r)
{
  keep(s, &r->side[r->at]);
  r->at = !r->at;
  take(s, &r->side[r->at]);
}

/* The next step is the first one of the other method. */
static int change(steif_solver *s)
{
  stf_step *step = &s->step;
  exchange(step, s->switching);
  step->restart = step->newton.jacobian_wanted = true;
  const int code = stf_system_rhs(&step->system, step->t, step->y, step->yp);
  step->yp_known = code == STEIF_OK;
  s->h_next = fmin(s->h_next, stf_first_step(s));
  s->h_old = 0;
  return code < 0 ? code : STEIF_OK;
}

/* From here on the other one, as this one would have cost `here` to the end and that one `there`. */
static int swap(steif_solver *s, double rate, double here, double there)
{
  stf_switching *r = s->switching;
  const stf_step *step = &s->step;
  candidate *a = &r->side[r->at];
  a->rate = rate;
  a->half_life = fmax(2 * a->half_life, 16 * (r->spent - r->now.spent));
  r->now = (period){.t = step->t, .count = step->count, .spent = r->spent};
  r->h = 0, r->look = step->count + PERIOD, r->changes++;
  STEIF_TRY(change(s));
  tell(s, here, there);
  return STEIF_OK;
}

/* The first steps of a method grow: what they are like is seen from the second look on. */
static void first_look(steif_solver *s)
{
  stf_switching *r = s->switching;
  r->now.t = s->step.t, r->now.count = s->step.count;
  r->look = s->step.count + PERIOD;
}

void stf_switching_constrained(steif_solver *s)
{
  if (s->switching) s->switching->constrained = true;
}

/* Steps that constraints have made short tell neither of stiffness nor of accuracy: looks begin anew. */
static bool unsettled(steif_solver *s)
{
  stf_switching *r = s->switching;
  if (!r->constrained) return false;
  r->constrained = false, r->h = 0;
  first_look(s);
  return true;
}

int stf_switching_look(steif_solver *s)
{
  stf_switching *r = s->switching;
  stf_step *step = &s->step;
  if (step->count < r->look) return STEIF_OK;
  const double window = (double)(step->count - r->seen_at), before = r->h, settle = 0.2;
  const double span = s->t1 - step->t, h = (step->t - r->t) / window, cost = spent(s) / window;
  r->look = step->count + (3 * (step->count - r->seen_at) + 1) / 2;
  r->seen_at = step->count, r->t = step->t, r->h = h, r->spent += window * cost;
  if (unsettled(s)) return STEIF_OK;
  if (!(before > 0)) return first_look(s), STEIF_OK;
  const double here = expected(step, r, span, window, h, before) * cost;
  double there;
  STEIF_TRY(other(s, span, &there));
  if (!((1 + settle) * there + PERIOD * cost < here)) return STEIF_OK;
  bool worth = true;
  if (r->at == 1 && !(r->side[0].rate > 0)) STEIF_TRY(stiff(s, h, &worth));
  return worth ? swap(s, cost / h, here, there) : STEIF_OK;
}

void stf_switching_stay(steif_solver *s)
{
  stf_switching *r = s->switching;
  if (r->changes > 0 && r->now.count == s->step.count) exchange(&s->step, r);
}

void stf_switching_keep(steif_solver *s, stf_image *m)
{
  stf_switching *r = s->switching;
  int at = r->at;
  STF_KEEP(m, at);
  if (m->code) return;
  if (r->at != at) exchange(&s->step, r);
  exchange(&s->step, r);
  stf_method_keep(&s->step, m);
  STF_KEEP(m, s->step.control);
  exchange(&s->step, r);
  for (int i = 0; i < 2; i++) {
    STF_KEEP(m, r->side[i].rate);
    STF_KEEP(m, r->side[i].half_life);
  }
  STF_KEEP(m, r->now);
  STF_KEEP(m, r->seen_at);
  STF_KEEP(m, r->look);
  STF_KEEP(m, r->t);
  STF_KEEP(m, r->h);
  STF_KEEP(m, r->spent);
  STF_KEEP(m, r->seen);
  STF_KEEP(m, r->changes);
  STF_KEEP(m, r->constrained);
}

void stf_switching_leave(steif_solver *s)
{
  if (s->switching->at == 1) exchange(&s->step, s->switching);
}

/* -- opening ------------------------------------------------------------------------------------------ */

static void destroy_table(void *owner)
{
  stf_switching *r = owner;
  steif_table_free(r->ctx, &r->side[!r->at].table);
}

/* The explicit method, in the place of the implicit one, which is kept. */
static int open_explicit(steif_solver *s)
{
  stf_step *step = &s->step;
  stf_switching *r = s->switching;
  steif_spec spec;
  keep(step, &r->side[0]);
  STEIF_TRY(steif_spec_parse(s->ctx, stf_auto_methods[STF_AUTO_EXPLICIT], &spec));
  step->table = NULL;
  r->at = 1;
  STEIF_TRY(stf_pool_adopt(step->pool, r, destroy_table));
  STEIF_TRY(stf_method_find(s->ctx, &spec, &step->method, &step->table));
  step->state = stf_pool_array(step->pool, 1, step->method->size);
  if (!step->state) return STEIF_NO_MEMORY;
  step->control = stf_control_usual;
  return step->method->open(step, &spec, step->table);
}

/* Is J symmetric? Then v^T J (J v) = |J v|^2 for any v, here with a part of everything. */
static int symmetric(stf_step *s, N_Vector work, bool *answer)
{
  static const double noise = 1e-6; /* of Jacobians by differences */
  sunrealtype *v = stf_array(s->next), *Jv = stf_array(s->error), *JJv = stf_array(work);
  double product = 0, square = 0, sum = 0;
  stf_random random = {.state = 1};
  for (sunindextype i = 0; i < s->problem->n; i++) v[i] = stf_random_in(&random, -0.5, 0.5);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', s->next, s->error));
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', s->error, work));
  for (sunindextype i = 0; i < s->problem->n; i++) {
    product += v[i] * JJv[i];
    square += Jv[i] * Jv[i];
    sum += fabs(v[i] * JJv[i]);
  }
  *answer = fabs(product - square) <= noise * (sum + square);
  return STEIF_OK;
}

/* Of a smooth solution: the estimate is O(h^(q + 1)). Linear systems get smoother as they go, which
 * collocation, of order 2 q - 1, sees; so do those on grids whose Jacobian is symmetric, as of diffusion: 10 to 24
 * steps at rtol 1e-3, 7 to 20 at 1e-5, 10 to 33 at 1e-8. Two substances that react took 11 to 71, 10
 * to 54 and 20 to 90. */
static int least_steps(stf_step *s, N_Vector work, double *least)
{
  const int q = s->table ? s->table->s : s->control.order > 0 ? s->control.order : 4;
  const sunrealtype more = pow(s->options->rtol, -1.0 / (q + 1));
  bool smooth = false;
  *least = s->table && s->system.linear ? 20 : 20 + 1.5 * more;
  if (!s->table || s->system.linear || s->system.storage != STEIF_SPARSE) return STEIF_OK;
  STEIF_TRY(symmetric(s, work, &smooth));
  *least = smooth ? 8 + 0.8 * more : 10 + 1.2 * more;
  return STEIF_OK;
}

/* Is an explicit step cheaper than an implicit one by more than the steps that a lower order needs, errors
 * of order 8 against 13? */
static bool cheaper(const stf_step *s, const stf_cost *p)
{
  return 1.3 * pow(s->options->rtol, 1.0 / 14 - 1.0 / 9) * p->explicit_step < p->step;
}

/* Neither matrices without a host array nor tolerances that an explicit method does not keep; nor
 * where stability asks for so many steps that the explicit one never pays. */
int stf_switching_open(steif_solver *s, const char *name)
{
  const double hopeless = 100, least_rtol = 1e-12;
  stf_step *step = &s->step;
  if (!step->adaptive || step->system.form != STEIF_ODE || !step->system.A ||
      !step->system.space.serial || s->options.rtol < least_rtol)
    return STEIF_OK;
  stf_cost cost;
  stf_cost_of(step, 13, &cost);
  if (!cheaper(step, &cost)) return STEIF_OK;
  stf_switching *r = stf_pool_array(s->pool, 1, sizeof *r);
  if (!r || !(r->work = stf_pool_vector(s->pool, step->y))) return STEIF_NO_MEMORY;
  r->ctx = s->ctx, r->cost = cost;
  sunrealtype rho;
  STEIF_TRY(least_steps(step, r->work, &r->least));
  STEIF_TRY(stf_weigh(s));
  STEIF_TRY(radius(step, r, &rho));
  const double span = s->t1 - step->t, implicit = r->least * r->cost.step,
               explicit_ = of_stability(r, span, rho);
  if (!(explicit_ < hopeless * implicit)) return STEIF_OK;
  s->switching = r;
  snprintf(r->side[0].name, sizeof r->side[0].name, "%s", name);
  snprintf(r->side[1].name, sizeof r->side[1].name, "%s", stf_auto_methods[STF_AUTO_EXPLICIT]);
  STEIF_TRY(open_explicit(s));
  r->look = PERIOD, r->t = r->now.t = step->t;
  r->seen = *steif_statistics(s);
  if (explicit_ < implicit)
    snprintf(s->method, sizeof s->method, "%s (n = %lld, rtol %.1e): not stiff so far, else %s",
             stf_auto_methods[STF_AUTO_EXPLICIT], (long long)step->problem->n, s->options.rtol,
             name);
  else
    exchange(step, r);
  return STEIF_OK;
}
