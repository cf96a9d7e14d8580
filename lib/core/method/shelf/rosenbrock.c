/* rosenbrock.c: linearly implicit methods with one real shift and no iteration (rosenbrock_data.h): few digits,
 * smooth problems.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "rosenbrock_state.h"
#include "step_error.h"
#include <complex.h>
#include <math.h>

typedef stf_rosenbrock_state state;

/* Serial vectors and dense matrices of few unknowns. */
static bool serves(const stf_step *s)
{
  return s->system.space.serial && s->system.storage == STEIF_DENSE &&
         s->problem->n <= STF_ROSENBROCK;
}

/* The estimate of Rodas is so many times the error. */
static const sunrealtype GENEROUS = 8;

/* With the factors at hand, as a first stage. */
static int solve_unrolled(stf_step *s, sunrealtype h, N_Vector v)
{
  state *e = s->state;
  stf_rosenbrock_stage g = {.h = h,
                            .y = STF_ARRAY(s->y),
                            .f = STF_ARRAY(v),
                            .ft = STF_ARRAY(e->ft),
                            .Y = STF_ARRAY(e->Y)};
  g.u[0] = STF_ARRAY(e->sum);
  stf_rosenbrock_solve(&e->kernel, &g);
  stf_copy(&s->system.space, e->sum, v);
  s->solves++;
  return STEIF_OK;
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  state *e = s->state;
  stf_transform transform;
  e->r = stf_rodas_find(spec->name);
  STEIF_TRY(stf_check_index(s, spec->name));
  STEIF_TRY(stf_transform_single(s->pool, 1 / e->r->g, &transform));
  STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  N_Vector *const all[] = {&e->Y,      &e->sum,     &e->ft, &e->f0,
                           &e->before, &e->between, &e->Ep, &e->off};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (!(*all[i] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  for (int i = 0; i < e->r->s; i++)
    if (!(e->u[i] = stf_pool_vector(s->pool, s->y)) ||
        !(e->old[i] = stf_pool_vector(s->pool, s->y)))
      return STEIF_NO_MEMORY;
  e->unrolled = serves(s) && !s->options->sensitivities;
  if (e->unrolled) stf_system_rosenbrock_open(&s->system, &e->kernel);
  s->newton.jacobian_new = false;
  STEIF_TRY(stf_share_open(s, spec->name, e->r->order - 1, e->r->order, 0.1));
  e->wanted = fmin(0.1, GENEROUS * s->control.tolerance);
  e->carried.solve = e->unrolled ? solve_unrolled : NULL;
  return stf_carried_by_one_step(s, 6, 0.01, &e->carried);
}

/* f at the accepted point and its slope in t. */
static int start(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  STEIF_TRY(stf_system_rhs(&s->system, s->t, s->y, e->f0));
  STEIF_TRY(stf_slope_in_time(s, h, e->f0, e->ft, e->sum));
  e->have_f0 = stf_finite(&s->system.space, e->f0) && stf_finite(&s->system.space, e->ft);
  return STEIF_OK;
}

/* Y_i, the argument of stage i. */
static void argument(stf_step *s, int i)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  if (i >= e->r->rows) {
    stf_axpy(space, 1, e->u[i - 1], e->Y);
    return;
  }
  stf_combine(space, i, e->r->a + i * (i - 1) / 2, e->u, e->Y);
  stf_axpy(space, 1, s->y, e->Y);
}

static int stage(stf_step *s, int i, sunrealtype h)
{
  state *e = s->state;
  const stf_rodas *r = e->r;
  const stf_space *space = &s->system.space;
  sunrealtype c[STF_RODAS_STAGES];
  argument(s, i);
  if (i == 0)
    stf_copy(space, e->f0, e->u[0]);
  else
    STEIF_TRY(stf_system_rhs(&s->system, s->t + r->alpha[i] * h, e->Y, e->u[i]));
  if (r->gamma[i] != 0 && !s->problem->autonomous)
    stf_axpy(space, r->gamma[i] * h, e->ft, e->u[i]);
  if (i > 0) {
    for (int j = 0; j < i; j++) c[j] = r->c[i * (i - 1) / 2 + j] / h;
    stf_combine(space, i, c, e->u, e->sum);
    if (s->system.form == STEIF_MASS) {
      STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', e->sum, s->error));
      stf_axpy(space, 1, s->error, e->u[i]);
    } else
      stf_axpy(space, 1, e->sum, e->u[i]);
  }
  return steif_pencil_solve(s->system.pencil, 0, 1, &e->u[i], NULL);
}

static bool stale(const stf_step *s)
{
  return !s->newton.jacobian_new && (s->count > 0 || s->restart);
}

static int stages(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const int last = e->r->s - 1;
  STEIF_TRY(stf_newton_prepare(&s->newton, s->t, h, s->y, s->yp, stale(s)));
  s->newton.jacobian_new = true;
  for (int i = 0; i <= last; i++) STEIF_TRY(stage(s, i, h));
  stf_sum(&s->system.space, 1, e->Y, 1, e->u[last], s->next);
  return STEIF_OK;
}

static int prepare_unrolled(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  if (stale(s) && !s->system.linear) {
    e->h_factored = 0;
    STEIF_TRY(stf_system_matrices(&s->system, s->t, s->y, s->yp));
  }
  s->newton.jacobian_new = true;
  if (e->h_factored == h) return STEIF_OK;
  e->h_factored = 0;
  s->factors++;
  STEIF_TRY(stf_system_rosenbrock(&s->system, &e->kernel, e->r->g, s->t, h));
  e->h_factored = h;
  return STEIF_OK;
}

static int stages_unrolled(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  STEIF_TRY(prepare_unrolled(s, h));
  const stf_rodas *r = e->r;
  stf_rosenbrock_stage g = {.h = h, .y = STF_ARRAY(s->y), .Y = STF_ARRAY(e->Y)};
  for (int i = 0; i < r->s; i++) g.u[i] = STF_ARRAY(e->u[i]);
  stf_copy(&s->system.space, s->y, e->Y);
  g.ft = STF_ARRAY(e->ft);
  for (int i = 0; i < r->s; i++) {
    N_Vector f = i == 0 ? e->f0 : e->sum;
    if (i > 0) STEIF_TRY(stf_system_rhs(&s->system, s->t + r->alpha[i] * h, e->Y, f));
    g.i = i, g.f = STF_ARRAY(f), g.c = r->c + i * (i - 1) / 2;
    g.a = i + 1 < r->rows ? r->a + i * (i + 1) / 2 : NULL;
    g.slope = s->problem->autonomous ? 0 : r->gamma[i] * h;
    stf_rosenbrock_solve(&e->kernel, &g);
  }
  s->solves += r->s;
  stf_copy(&s->system.space, e->Y, s->next);
  return STEIF_OK;
}

/* (1 - x) y_n + x y_{n+1} + x (1 - x) sum (d_i + x d_{s+i}) u_i. */
static void combine(const stf_step *s, const stf_rodas *r, sunrealtype x, N_Vector before,
                    N_Vector end, N_Vector *u, N_Vector y)
{
  const stf_space *space = &s->system.space;
  sunrealtype c[STF_RODAS_STAGES];
  for (int i = 0; i < r->s; i++) c[i] = x * (1 - x) * (r->d[i] + x * r->d[r->s + i]);
  stf_combine(space, r->s, c, u, y);
  stf_axpy(space, 1 - x, before, y);
  stf_axpy(space, x, end, y);
}

static int inside(stf_step *s, sunrealtype x, N_Vector y)
{
  state *e = s->state;
  combine(s, e->r, x, s->y, s->next, e->u, y);
  return STEIF_OK;
}

static int look_between(stf_step *s, sunrealtype h)
{
  const state *e = s->state;
  static const sunrealtype x[] = {0.1, 0.3, 0.5, 0.7, 0.9};
  const stf_look look = {.x = x,
                         .points = 5,
                         .inside = inside,
                         .solve = e->unrolled ? solve_unrolled : stf_solve_by_pencil,
                         .y = e->between,
                         .Ep = e->Ep,
                         .off = e->off};
  return stf_look_between(s, h, &look);
}

/* y_n + x (d + p) + x^2 (q - p) - x^3 q is what `combine` has, d = y_{n+1} - y_n. */
static void between(stf_step *s)
{
  const state *e = s->state;
  const stf_rodas *r = e->r;
  const stf_space *space = &s->system.space;
  N_Vector c[] = {e->between, e->Ep, e->off};
  stf_combine(space, r->s, r->d, e->u, c[0]);
  stf_combine(space, r->s, r->d + r->s, e->u, c[2]);
  stf_sum(space, 1, c[2], -1, c[0], c[1]);
  stf_axpy(space, 1, s->next, c[0]);
  stf_axpy(space, -1, s->y, c[0]);
  stf_between_powers(s, 3, c);
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const int last = e->r->s - 1;
  STEIF_TRY(stf_carried_retry(s, &e->carried));
  s->control.tolerance = fmin(1, fmax(e->wanted, GENEROUS * stf_carried_share(&e->carried, 0)));
  if (!e->have_f0) STEIF_TRY(start(s, h));
  STEIF_TRY(e->unrolled ? stages_unrolled(s, h) : stages(s, h));
  stf_copy(space, e->u[last], s->error);
  if (!stf_finite(space, s->next))
    return STEIF_RECOVER(s->ctx, STEIF_NOT_FINITE,
                         "the step of problem '%s' from t = %.12g with h = %.6g is not finite: "
                         "f gave NaN or infinity, or the step is too large",
                         s->problem->name, s->t, h);
  if (s->adaptive) between(s);
  return look_between(s, h);
}

static void commit(stf_step *s)
{
  state *e = s->state;
  stf_scale(&s->system.space, 1 / GENEROUS, s->error, s->error);
  stf_carried_add(s, &e->carried, 1 / (e->r->g * s->h_try), s->error, s->error_norm / GENEROUS);
  stf_copy(&s->system.space, s->y, e->before);
  for (int i = 0; i < e->r->s; i++) {
    N_Vector u = e->old[i];
    e->old[i] = e->u[i], e->u[i] = u;
  }
  e->have_f0 = false;
  stf_swap(s);
}

int stf_rodas_inside(const stf_step *s, const stf_rodas *r, sunrealtype t, N_Vector before,
                     N_Vector end, N_Vector *u, N_Vector y)
{
  combine(s, r, (t - (s->t - s->h)) / s->h, before, end, u, y);
  return STEIF_OK;
}

static int dense(const stf_step *s, sunrealtype t, N_Vector y)
{
  const state *e = s->state;
  return stf_rodas_inside(s, e->r, t, e->before, s->y, (N_Vector *)(uintptr_t)e->old, y);
}

static void keep(stf_step *s, stf_image *m)
{
  state *e = s->state;
  stf_keep_vectors(m, e->r->s, e->old);
  stf_keep_vector(m, e->before);
  STF_KEEP(m, e->h_factored);
  STF_KEEP(m, e->kernel.order);
  STF_KEEP(m, e->kernel.lu);
  STF_KEEP(m, e->kernel.pivot);
  stf_carried_keep(&e->carried, m);
}

/* The step on y' = lambda y with exact Jacobian: u_i solved in complex arithmetic. */
static int propagator(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                      const sunrealtype z[2], int *r, sunrealtype *M)
{
  (void)table;
  const stf_rodas *t = stf_rodas_find(spec->name);
  const double complex zeta = z[0] + z[1] * I, pivot = 1 / t->g - zeta;
  double complex u[STF_RODAS_STAGES], Y = 1;
  sunrealtype R[2] = {0, 0};
  if (isfinite(z[0]) && isfinite(z[1])) {
    STEIF_CHECK(cabs(pivot) > 0, ctx, STEIF_SINGULAR, "z = %.17g is the pole of '%s'", z[0],
                spec->name);
    for (int i = 0; i < t->s; i++) {
      const sunrealtype *a = t->a + i * (i - 1) / 2, *c = t->c + i * (i - 1) / 2;
      double complex sum = 0;
      Y = i < t->rows ? 1 : Y + u[i - 1];
      for (int j = 0; j < i; j++) {
        if (i < t->rows) Y += a[j] * u[j];
        sum += c[j] * u[j];
      }
      u[i] = (zeta * Y + sum) / pivot;
    }
    Y += u[t->s - 1];
    R[0] = creal(Y), R[1] = cimag(Y);
  }
  stf_propagate_scalar(R, r, M);
  return STEIF_OK;
}

static int describe(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    steif_method_info *info)
{
  (void)table;
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){NULL}));
  const stf_rodas *r = stf_rodas_find(spec->name);
  info->family = "rosenbrock", info->about = r->about;
  info->order = r->order, info->stages = r->s, info->adaptive = 1;
  info->claims = STEIF_A_STABLE | STEIF_L_STABLE;
  return STEIF_OK;
}

static bool owns(const char *name) { return stf_rodas_find(name); }

static const steif_method *variant(const stf_step *s)
{
  return s->system.form == STEIF_IMPLICIT ? &steif_method_rosenbrock_slopes : NULL;
}

static stf_example example(size_t i)
{
  return (stf_example){i < stf_rodas_count ? stf_rodas_tables[i].name : NULL, 2};
}

const steif_method steif_method_rosenbrock = {
  .about = "Rosenbrock methods of Rodas type",
  .forms = STEIF_ODE | STEIF_MASS,
  .traits = STF_ADAPTIVE | STF_UNCORRECTED | STF_VARYING_MASS,
  .owns = owns,
  .variant = variant,
  .example = example,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .keep = keep,
  .propagator = propagator,
  .describe = describe,
  .carrier = &stf_rosenbrock_carrier,
};
