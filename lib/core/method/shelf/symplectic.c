/* symplectic.c: splitting methods for separable systems q' = T_p(p), p' = -V_q(q): symplectic,
 * explicit, for long runs with equal steps. E. Hairer, C. Lubich and G. Wanner, Geometric
 * Numerical Integration, 2nd ed., Springer 2006, II.5 and V.3.
 *
 * A step is a sequence of kicks p += h b_i p'(q) and drifts q += h a_i q'(p). Where it
 * begins and ends with a kick the last force serves the next step. Parameters:
 * first=kick|drift (or p|q) where the scheme leaves that open, compensated=1|0: sums that
 * remember their rounding, by default in runs of LONG steps and more.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "kick_drift.h"
#include "splitting.h"
#include <string.h>

enum { LONG = 10000 };

typedef struct state {
  stf_passes passes;
  stf_kick_drift halves;
  N_Vector force;             /* p' at the positions last looked at ... */
  bool known;                 /* ... which are those of y */
  N_Vector error, next_error; /* what rounding took from y, from the trial; NULL: not kept */
} state;

static int parameters(steif_context *ctx, const steif_spec *spec, const stf_splitting **scheme,
                      bool *kick_first)
{
  const stf_splitting *x = stf_splitting_find(spec->name);
  const bool open_choice = x->kind != STF_ALTERNATING;
  const char *first = stf_spec_word(spec, "first");
  STEIF_TRY(stf_spec_only(ctx, spec,
                          open_choice ? (const char *const[]){"first", "compensated", NULL}
                                      : (const char *const[]){"compensated", NULL}));
  *scheme = x, *kick_first = x->kick_first;
  if (!first) return STEIF_OK;
  const bool kick = !strcmp(first, "kick") || !strcmp(first, "p");
  STEIF_CHECK(kick || !strcmp(first, "drift") || !strcmp(first, "q"), ctx, STEIF_BAD_INPUT,
              "parameter first=%s of '%s' must be kick (or p) or drift (or q)", first,
              spec->name);
  *kick_first = kick;
  return STEIF_OK;
}

static bool is_long(const stf_step *s)
{
  const steif_options *o = s->options;
  if (o->mesh) return o->mesh_size > LONG;
  return (o->t1 - s->t0) / s->h_equal >= LONG;
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  state *e = s->state;
  const stf_splitting *scheme;
  bool kick_first;
  int compensated;
  STEIF_TRY(parameters(s->ctx, spec, &scheme, &kick_first));
  STEIF_TRY(stf_spec_int(s->ctx, spec, "compensated", 0, 1, is_long(s), &compensated));
  stf_splitting_passes(scheme, kick_first, &e->passes);
  STEIF_TRY(stf_kick_drift_open(s->pool, &s->system, spec->name, s->y, s->yp, &e->halves));
  if (!(e->force = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  if (!compensated) return STEIF_OK;
  e->error = stf_pool_vector(s->pool, s->y);
  e->next_error = stf_pool_vector(s->pool, s->y);
  return e->error && e->next_error ? STEIF_OK : STEIF_NO_MEMORY;
}

/* A step of length h from the accepted solution. */
static int flow(stf_step *s, sunrealtype h, stf_point to)
{
  state *e = s->state;
  const stf_passes *P = &e->passes;
  stf_point from = {s->y, e->error};
  for (int i = 0; i < P->count; i++) {
    if (P->kick[i] != 0 && !(i == 0 && e->known))
      STEIF_TRY(stf_kick_drift_force(&e->halves, s->t + P->kick_at[i] * h, from.y, e->force));
    e->known = false;
    STEIF_TRY(stf_kick_drift_pass(&e->halves, P->kick[i] * h, e->force, P->drift[i] * h,
                                  s->t + P->drift_at[i] * h, from, to));
    from = to;
  }
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  return flow(s, h, (stf_point){s->next, e->next_error});
}

static void commit(stf_step *s)
{
  state *e = s->state;
  N_Vector error = e->error;
  stf_swap(s);
  e->error = e->next_error, e->next_error = error;
  e->known = e->passes.reuses;
}

/* The same method back from the end of the step to t: as accurate as the steps themselves. */
static int dense_by_f(stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  return flow(s, t - s->t, (stf_point){y, e->next_error});
}

/* ---- derivatives by parameters: each flow is a shear, its derivative another ---------------------- */

static stf_carrier_size sizes(const stf_step *s)
{
  (void)s;
  return (stf_carrier_size){.points = 1};
}

/* out_k += c (df/dy out_k + df/dp_k) at (t, y), in components `low` to `high` - 1; of columns from `first` on. */
static int shear(stf_carry *T, sunrealtype t, N_Vector y, sunrealtype c, sunindextype low,
                 sunindextype high, int first, int count, N_Vector *out)
{
  if (c == 0) return STEIF_OK;
  STEIF_TRY(stf_carry_point(T, 0, t, y, T->last_slope));
  for (int k = 0; k < count; k++) {
    STEIF_TRY(stf_carry_residual(T, 0, first + k, out[k], NULL, T->Yp));
    for (sunindextype i = low; i < high; i++) STF_ARRAY(out[k])[i] += c * STF_ARRAY(T->Yp)[i];
  }
  return STEIF_OK;
}

/* Through a flow of length h from y, columns `first` on from S to out; without what rounding took. */
static int carry_flow(stf_carry *T, sunrealtype h, N_Vector y, int first, int count,
                      N_Vector *S, N_Vector *out)
{
  stf_step *s = T->step;
  state *e = s->state;
  const stf_passes *P = &e->passes;
  const sunindextype m = e->halves.m, n = s->problem->n;
  const stf_point at = {T->last, NULL};
  stf_zero(&s->system.space, T->last_slope);
  stf_copy(&s->system.space, y, at.y);
  for (int k = 0; k < count; k++) stf_copy(&s->system.space, S[k], out[k]);
  for (int i = 0; i < P->count; i++) {
    const sunrealtype a = P->kick[i] * h, b = P->drift[i] * h;
    const sunrealtype t = s->t + P->kick_at[i] * h, then = s->t + P->drift_at[i] * h;
    STEIF_TRY(shear(T, t, at.y, a, m, n, first, count, out));
    if (a != 0) STEIF_TRY(stf_kick_drift_force(&e->halves, t, at.y, T->Y));
    if (a != 0) STEIF_TRY(stf_kick_drift_pass(&e->halves, a, T->Y, 0, t, at, at));
    STEIF_TRY(shear(T, then, at.y, b, 0, m, first, count, out));
    if (b != 0) STEIF_TRY(stf_kick_drift_pass(&e->halves, 0, T->Y, b, then, at, at));
  }
  return STEIF_OK;
}

static int carry(stf_carry *T, sunrealtype h)
{
  return carry_flow(T, h, T->step->y, 0, T->count, T->S, T->next);
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  return carry_flow(T, t - T->step->t, T->step->y, k, 1, T->S + k, &S);
}

static const stf_carrier carrier = {.size = sizes, .carry = carry, .dense = carried_dense};

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vector(m, e->force);
  STF_KEEP(m, e->known);
  if (e->error) stf_keep_vector(m, e->error);
}

static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  (void)table, (void)z, (void)r, (void)M;
  return STEIF_FAIL(
    ctx, STEIF_UNSUPPORTED,
    "'%s' treats q and p differently: its step on y' = lambda y is not a function "
    "of h lambda; see what it keeps with 'steif energy harmonic %s --h 0.1'",
    spec->name, spec->name);
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  const stf_splitting *scheme;
  bool kick_first;
  int compensated;
  stf_passes passes;
  STEIF_TRY(parameters(ctx, spec, &scheme, &kick_first));
  STEIF_TRY(stf_spec_int(ctx, spec, "compensated", 0, 1, 0, &compensated));
  stf_splitting_passes(scheme, kick_first, &passes);
  info->family = "sympl", info->about = scheme->about;
  info->order = scheme->order, info->stages = passes.kicks;
  info->claims = STEIF_SYMPLECTIC | (scheme->kind == STF_EULER ? 0 : STEIF_SYMMETRIC);
  return STEIF_OK;
}

static bool owns(const char *name) { return stf_splitting_find(name); }

/* The other order of the two flows first, then all schemes. */
static stf_example example(size_t i)
{
  static const char *const spec[] = {"symeuler:first=q", "verlet:first=drift"};
  const size_t count = sizeof spec / sizeof *spec;
  if (i < count) return (stf_example){spec[i], 3};
  i -= count;
  return (stf_example){i < stf_splitting_count ? stf_splittings[i].name : NULL, 5};
}

const steif_method steif_method_symplectic = {
  .about = "splitting of separable systems, symplectic",
  .forms = STEIF_ODE,
  .traits = STF_EXPLICIT,
  .owns = owns,
  .example = example,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense_by_f = dense_by_f,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &carrier,
};
