/* exponential_step.c: one step of an exponential method (exponential_data.h).
 *
 * For a Rosenbrock method of an equation that depends on t, with v = df/dt(t_n, y_n), stages get
 * (c_i h)^2 phi_2(c_i hL) v besides and N(t, y) = f(t, y) - L y - t v.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential_step.h"
#include <math.h>

/* Errors of the phi functions: with chosen steps in the norm of the tolerance, for each of a
 * few applications, else relative to the increment. */
static const sunrealtype share = 0.02, sharp = 1e-12;

static int highest(const stf_exponential_step *e, const steif_problem *p)
{
  int k = e->renews && !p->autonomous ? 2 : 1;
  for (int i = 0; i < e->x->count; i++)
    if (e->x->term[i].k > k) k = e->x->term[i].k;
  return k;
}

static int claim(stf_step *s)
{
  stf_exponential_step *e = s->state;
  N_Vector *const all[] = {&e->f0,      &e->slope_t, &e->before, &e->slope, &e->drift, &e->end,
                           &e->flow[0], &e->flow[1], &e->Y,      &e->dY,    &e->work};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (!(*all[i] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  for (int i = 1; i < e->x->s; i++)
    if (!(e->D[i] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  for (int k = 1; k <= e->phis.p; k++)
    if (!(e->b[k] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  return STEIF_OK;
}

int stf_exponential_step_open(stf_step *s, const stf_exponential *x, bool renews)
{
  stf_exponential_step *e = s->state;
  e->x = x, e->renews = renews, e->fresh = true;
  STEIF_TRY(stf_phis_open(s->pool, &s->system, highest(e, s->problem), x->nodes, x->node,
                          !renews && s->h_equal > 0, &e->phis));
  s->control.order = x->embedded;
  s->control.tolerance = !e->renews ? 1 : x->embedded > 2 ? 0.1 : 0.05;
  return claim(s);
}

/* f and df/dt at the accepted point, and L there. */
static int start(stf_step *s, sunrealtype h)
{
  stf_exponential_step *e = s->state;
  if (!e->known) {
    STEIF_TRY(stf_system_rhs(&s->system, s->t, s->y, e->f0));
    if (e->renews) STEIF_TRY(stf_slope_in_time(s, h, e->f0, e->slope_t, e->work));
  }
  e->known = true;
  if (!e->renews || e->fresh) return STEIF_OK;
  STEIF_TRY(stf_system_linearise(&s->system, s->t, s->y, e->f0));
  STEIF_TRY(stf_phis_renew(&e->phis));
  e->fresh = true, e->held = false;
  return STEIF_OK;
}

static void aim(stf_step *s)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  if (s->adaptive)
    stf_phis_aim(&e->phis, 0, share * sqrt((sunrealtype)space->n) / stf_max(space, s->weights));
  else
    stf_phis_aim(&e->phis, sharp, 0);
}

/* w = sum_k phi_k(node h L) b_k of those b_k that are used; a step too long for the action is
 * one to make smaller. */
static int apply(stf_step *s, sunrealtype h, int node, unsigned used, N_Vector w)
{
  stf_exponential_step *e = s->state;
  N_Vector b[STF_EXP_ORDER + 1] = {NULL};
  for (int k = 1; k <= e->phis.p; k++) {
    if (!(used >> k & 1)) continue;
    b[k] = stf_max(&s->system.space, e->b[k]) == 0 ? NULL : e->b[k];
    if (b[k] && !stf_finite(&s->system.space, b[k])) {
      e->known = false;
      return STEIF_RECOVER(s->ctx, STEIF_NOT_FINITE,
                           "f of problem '%s' is not finite in the step from t = %.12g with "
                           "h = %.6g",
                           s->problem->name, s->t, h);
    }
  }
  const int code = stf_phis_apply(&e->phis, h, node, b, w);
  return code == STEIF_NOT_CERTIFIED && s->adaptive ? STEIF_RETRY : code;
}

/* c_i h phi_1(c_i hL) F + (c_i h)^2 phi_2(c_i hL) v at a node, once in an attempt. */
static int flow(stf_step *s, sunrealtype h, int node, N_Vector *out)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype c = e->x->node[node] * h;
  const bool drifts = e->renews && !s->problem->autonomous;
  *out = e->flow[node];
  if (e->flowed[node]) return STEIF_OK;
  stf_scale(space, c, e->f0, e->b[1]);
  if (drifts) stf_scale(space, c * c, e->slope_t, e->b[2]);
  STEIF_TRY(apply(s, h, node, drifts ? 6 : 2, *out));
  e->flowed[node] = true;
  return STEIF_OK;
}

/* out = the terms of a stage at all nodes; *any tells whether there are some. */
static int terms(stf_step *s, sunrealtype h, int stage, N_Vector out, bool *any)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  *any = false;
  for (int node = 0; node < e->x->nodes; node++) {
    unsigned used = 0;
    for (const stf_exp_term *m = e->x->term; m < e->x->term + e->x->count; m++) {
      if (m->stage != stage || m->node != node) continue;
      if (used >> m->k & 1)
        stf_axpy(space, m->w * h, e->D[m->of], e->b[m->k]);
      else
        stf_scale(space, m->w * h, e->D[m->of], e->b[m->k]);
      used |= 1u << m->k;
    }
    if (!used) continue;
    STEIF_TRY(apply(s, h, node, used, *any ? e->work : out));
    if (*any) stf_axpy(space, 1, e->work, out);
    *any = true;
  }
  return STEIF_OK;
}

/* D = f(t, Y) - F - L (Y - y_n) - (t - t_n) v, from f(t, Y) in D. */
static int difference(stf_step *s, sunrealtype t, N_Vector dY, N_Vector D)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'A', dY, e->work));
  stf_axpy(space, 1, e->f0, e->work);
  if (e->renews && !s->problem->autonomous) stf_axpy(space, t - s->t, e->slope_t, e->work);
  stf_axpy(space, -1, e->work, D);
  return STEIF_OK;
}

static int stage(stf_step *s, sunrealtype h, int i)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  const int node = e->x->at[i];
  const sunrealtype t = s->t + e->x->node[node] * h;
  N_Vector linear;
  bool any;
  STEIF_TRY(flow(s, h, node, &linear));
  STEIF_TRY(terms(s, h, i, e->dY, &any));
  if (any)
    stf_axpy(space, 1, linear, e->dY);
  else
    stf_copy(space, linear, e->dY);
  stf_sum(space, 1, s->y, 1, e->dY, e->Y);
  STEIF_TRY(stf_system_rhs(&s->system, t, e->Y, e->D[i]));
  return difference(s, t, e->dY, e->D[i]);
}

/* D_1 = (h/h_old) (N_n - N_{n-1}) */
static int extrapolate(stf_step *s, sunrealtype h)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  stf_copy(space, e->slope, e->D[1]);
  stf_sum(space, 1, e->before, -1, s->y, e->dY);
  STEIF_TRY(difference(s, s->t - s->h, e->dY, e->D[1]));
  stf_scale(space, -h / s->h, e->D[1], e->D[1]);
  return STEIF_OK;
}

static int finish(stf_step *s, sunrealtype h)
{
  stf_exponential_step *e = s->state;
  const stf_space *space = &s->system.space;
  N_Vector linear;
  bool any;
  STEIF_TRY(flow(s, h, 0, &linear));
  stf_sum(space, 1, s->y, 1, linear, s->next);
  STEIF_TRY(terms(s, h, e->x->s, e->dY, &any));
  if (any) stf_axpy(space, 1, e->dY, s->next);
  STEIF_TRY(terms(s, h, e->x->s + 1, s->error, &any));
  if (any) stf_axpy(space, 1, s->error, s->next);
  if (!stf_finite(space, s->next))
    return STEIF_RECOVER(s->ctx, STEIF_NOT_FINITE,
                         "the step of problem '%s' from t = %.12g with h = %.6g is not finite: "
                         "f gave NaN or infinity, or the step is too large",
                         s->problem->name, s->t, h);
  return STEIF_OK;
}

static int step(stf_step *s, sunrealtype h)
{
  const stf_exponential_step *e = s->state;
  STEIF_TRY(start(s, h));
  aim(s);
  if (e->x->history && s->count > 0 && !s->restart)
    STEIF_TRY(extrapolate(s, h));
  else
    for (int i = 1; i < e->x->s; i++) STEIF_TRY(stage(s, h, i));
  return finish(s, h);
}

int stf_exponential_step_attempt(stf_step *s, sunrealtype h)
{
  stf_exponential_step *e = s->state;
  const long before = e->phis.factors;
  for (int node = 0; node < e->x->nodes; node++) e->flowed[node] = false;
  const int code = step(s, h);
  s->factors += e->phis.factors - before;
  return code;
}

void stf_exponential_step_commit(stf_step *s)
{
  stf_exponential_step *e = s->state;
  N_Vector slope = e->slope, drift = e->drift;
  stf_copy(&s->system.space, s->y, e->before);
  e->slope = e->f0, e->f0 = slope;
  e->drift = e->slope_t, e->slope_t = drift;
  e->held = e->fresh;
  e->known = e->fresh = false;
  stf_swap(s);
}

int stf_exponential_step_dense(stf_step *s, sunrealtype t, N_Vector y)
{
  const stf_exponential_step *e = s->state;
  return stf_hermite(s, t, e->before, e->slope, e->end, y);
}

/* The step once more, of length h, from where the last one began and with its L. */
static int shorter(stf_step *s, sunrealtype h)
{
  stf_exponential_step *e = s->state;
  if (!e->held) {
    STEIF_TRY(stf_system_linearise(&s->system, s->t, s->y, e->f0));
    STEIF_TRY(stf_phis_renew(&e->phis));
    e->held = true, e->fresh = false;
  }
  aim(s);
  for (int node = 0; node < e->x->nodes; node++) e->flowed[node] = false;
  for (int i = 1; i < e->x->s; i++) STEIF_TRY(stage(s, h, i));
  return finish(s, h);
}

int stf_exponential_step_again(stf_step *s, sunrealtype t, N_Vector y)
{
  stf_exponential_step *e = s->state;
  const sunrealtype now = s->t, from = now - s->h;
  if (t == from || t == now) {
    stf_copy(&s->system.space, t == now ? s->y : e->before, y);
    return STEIF_OK;
  }
  N_Vector end = s->y, next = s->next, error = s->error, f0 = e->f0, slope_t = e->slope_t;
  s->t = from, s->y = e->before, s->next = y, s->error = e->end;
  e->f0 = e->slope, e->slope_t = e->drift;
  const int code = shorter(s, t - from);
  s->t = now, s->y = end, s->next = next, s->error = error;
  e->f0 = f0, e->slope_t = slope_t;
  return code > 0 ? STEIF_FAIL(s->ctx, STEIF_NOT_FINITE,
                               "no dense output of problem '%s' at t = %.12g: its step cannot "
                               "be made once more",
                               s->problem->name, t)
                  : code;
}

void stf_exponential_step_keep(stf_step *s, stf_image *m)
{
  stf_exponential_step *e = s->state;
  stf_keep_vector(m, e->before);
  stf_keep_vector(m, e->slope);
  stf_keep_vector(m, e->drift);
  stf_keep_vector(m, e->end);
  STF_KEEP(m, e->known);
  STF_KEEP(m, e->fresh);
  STF_KEEP(m, e->held);
  stf_phis_keep(&e->phis, m);
}

int stf_exponential_step_propagator(steif_context *ctx, const steif_spec *spec,
                                    const steif_table *table, const sunrealtype z[2], int *r,
                                    sunrealtype *M)
{
  (void)ctx, (void)spec, (void)table;
  const bool far = !isfinite(z[0]) || !isfinite(z[1]);
  const sunrealtype size = far ? 0 : exp(z[0]);
  const sunrealtype R[2] = {far ? 0 : size * cos(z[1]), far ? 0 : size * sin(z[1])};
  stf_propagate_scalar(R, r, M);
  return STEIF_OK;
}

int stf_exponential_step_describe(steif_context *ctx, const steif_spec *spec,
                                  const stf_exponential *x, const char *family,
                                  steif_method_info *info)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  info->family = family, info->about = x->about;
  info->order = x->order, info->stages = x->s, info->adaptive = x->embedded > 0;
  info->claims = STEIF_A_STABLE | STEIF_L_STABLE;
  return STEIF_OK;
}
