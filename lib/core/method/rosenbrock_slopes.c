/* rosenbrock_slopes.c: Rosenbrock methods where M of M y' = f varies: for F(t, y, y') = M(t, y) y' - f(t, y) as
 *   y' = z,  0 = F(t, y, z),
 * of index 1 in (y, z) where M is regular, or regular but for rows and columns of zeros, whose z enters nowhere.
 * Methods of Rodas type keep their order there (Ch. Lubich, M. Roche, Computing 43 (1990); Hairer and Wanner,
 * Solving ODEs II, IV.7, VI.4). Of a stage u = (U, V), with E = dF/dz and A = -dF/dy,
 *   U/(gamma h) - V = Z_i + sum (c_ij/h) U_j =: r,
 *   E V - A U       = -F(t_i, Y_i, Z_i) - gamma_i h F_t,
 * so that V = U/(gamma h) - r and (E/(gamma h) - A) U = -F - gamma_i h F_t + E r: the matrices of one system.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "rosenbrock_data.h"
#include "step_error.h"
#include "varying_mass.h"
#include <math.h>

typedef struct state {
  const stf_rodas *r;
  N_Vector u[STF_RODAS_STAGES], old[STF_RODAS_STAGES], v[STF_RODAS_STAGES];
  N_Vector Y, Z, sum, product, F0, Ft, before;
  N_Vector z, next; /* at y_n, at y_{n+1} */
  bool have_z, have_F0;
} state;

static int check(stf_step *s, const char *name)
{
  STEIF_CHECK(stf_mass_regular(s->problem), s->ctx, STEIF_UNSUPPORTED,
              "'%s' takes a mass matrix that varies only where it is regular, but for rows and "
              "columns of "
              "zeros, as the one of problem '%s' is not at t = %.6g: take radau, bdf or dirk",
              name, s->problem->name, s->problem->t0);
  return stf_check_index(s, name);
}

static int open(stf_step *s, const steif_spec *spec, const steif_table *table)
{
  (void)table;
  state *e = s->state;
  stf_transform transform;
  e->r = stf_rodas_find(spec->name);
  STEIF_TRY(check(s, spec->name));
  STEIF_TRY(stf_transform_single(s->pool, 1 / e->r->g, &transform));
  STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  N_Vector *const all[] = {&e->Y,  &e->Z,      &e->sum, &e->product, &e->F0,
                           &e->Ft, &e->before, &e->z,   &e->next};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (!(*all[i] = stf_pool_vector(s->pool, s->y))) return STEIF_NO_MEMORY;
  for (int i = 0; i < e->r->s; i++)
    if (!(e->u[i] = stf_pool_vector(s->pool, s->y)) ||
        !(e->old[i] = stf_pool_vector(s->pool, s->y)) ||
        !(e->v[i] = stf_pool_vector(s->pool, s->y)))
      return STEIF_NO_MEMORY;
  s->newton.jacobian_new = false;
  STEIF_TRY(stf_share_open(s, spec->name, e->r->order - 1, e->r->order, 0.1));
  s->control.tolerance = fmin(0.1, 8 * s->control.tolerance);
  return STEIF_OK;
}

/* z of 0 = F(t, y, z) at a start: (S E - A) d = -F, z += S d, where S E outweighs A. */
static int find_slopes(stf_step *s, sunrealtype h)
{
  enum { ROUNDS = 4 };
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const sunrealtype S = 1e8 / h;
  if (s->yp_known) stf_copy(space, s->yp, e->z);
  STEIF_TRY(stf_system_linearise(&s->system, s->t, s->y, e->z));
  STEIF_TRY(steif_pencil_factor(s->system.pencil, 1, &(steif_shift){S, 0}));
  s->newton.factored = false;
  for (int k = 0; k < ROUNDS; k++) {
    STEIF_TRY(stf_system_residual(&s->system, s->t, s->y, e->z, e->sum));
    STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &e->sum, NULL));
    stf_axpy(space, -S, e->sum, e->z);
  }
  e->have_z = true;
  return STEIF_OK;
}

/* F and its slope in t at the accepted point. */
static int start(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  stf_system *system = &s->system;
  const sunrealtype d = fmax(1e-4 * h, 64 * STF_EPS * fabs(s->t));
  const sunrealtype c[] = {2 / d, -1.5 / d, -0.5 / d};
  N_Vector all[] = {e->Ft, e->F0, e->sum};
  if (!e->have_z) STEIF_TRY(find_slopes(s, h));
  STEIF_TRY(stf_system_residual(system, s->t, s->y, e->z, e->F0));
  STEIF_TRY(stf_system_residual(system, s->t + d, s->y, e->z, e->Ft));
  STEIF_TRY(stf_system_residual(system, s->t + 2 * d, s->y, e->z, e->sum));
  stf_combine(&system->space, 3, c, all, e->Ft);
  e->have_F0 = stf_finite(&system->space, e->F0) && stf_finite(&system->space, e->Ft);
  return STEIF_OK;
}

/* x_i of a row of arguments: x + sum a_ij u_j, or the one before and its stage. */
static void argument(stf_step *s, int i, N_Vector x, N_Vector *u, N_Vector X)
{
  const stf_rodas *r = ((const state *)s->state)->r;
  const stf_space *space = &s->system.space;
  if (i >= r->rows) {
    stf_axpy(space, 1, u[i - 1], X);
    return;
  }
  stf_combine(space, i, r->a + i * (i - 1) / 2, u, X);
  stf_axpy(space, 1, x, X);
}

static int stage(stf_step *s, int i, sunrealtype h)
{
  state *e = s->state;
  const stf_rodas *r = e->r;
  const stf_space *space = &s->system.space;
  sunrealtype c[STF_RODAS_STAGES];
  N_Vector u = e->u[i];
  argument(s, i, s->y, e->u, e->Y);
  argument(s, i, e->z, e->v, e->Z);
  if (i == 0)
    stf_copy(space, e->F0, u);
  else
    STEIF_TRY(stf_system_residual(&s->system, s->t + r->alpha[i] * h, e->Y, e->Z, u));
  if (r->gamma[i] != 0) stf_axpy(space, r->gamma[i] * h, e->Ft, u);
  for (int j = 0; j < i; j++) c[j] = r->c[i * (i - 1) / 2 + j] / h;
  stf_combine(space, i, c, e->u, e->sum);
  stf_axpy(space, 1, e->Z, e->sum);
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', e->sum, e->product));
  stf_sum(space, 1, e->product, -1, u, u);
  STEIF_TRY(steif_pencil_solve(s->system.pencil, 0, 1, &u, NULL));
  stf_sum(space, 1 / (r->g * h), u, -1, e->sum, e->v[i]);
  return STEIF_OK;
}

static int attempt(stf_step *s, sunrealtype h)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  const int last = e->r->s - 1;
  const bool stale = !s->newton.jacobian_new && (s->count > 0 || s->restart);
  bool found = false;
  if (s->restart && !s->rejected) e->have_z = e->have_F0 = false;
  if (!e->have_F0) {
    found = !e->have_z;
    STEIF_TRY(start(s, h));
  }
  STEIF_TRY(stf_newton_prepare(&s->newton, s->t, h, s->y, e->z, stale || found));
  s->newton.jacobian_new = true;
  for (int i = 0; i <= last; i++) STEIF_TRY(stage(s, i, h));
  stf_sum(space, 1, e->Y, 1, e->u[last], s->next);
  stf_sum(space, 1, e->Z, 1, e->v[last], e->next);
  stf_copy(space, e->u[last], s->error);
  if (!stf_finite(space, s->next) || !stf_finite(space, e->next))
    return STEIF_RECOVER(s->ctx, STEIF_NOT_FINITE,
                         "the step of problem '%s' from t = %.12g with h = %.6g is not finite: "
                         "f gave NaN or infinity, or the step is too large",
                         s->problem->name, s->t, h);
  return STEIF_OK;
}

static void commit(stf_step *s)
{
  state *e = s->state;
  const stf_space *space = &s->system.space;
  stf_copy(space, s->y, e->before);
  for (int i = 0; i < e->r->s; i++) {
    N_Vector u = e->old[i];
    e->old[i] = e->u[i], e->u[i] = u;
  }
  stf_copy(space, e->next, e->z);
  stf_copy(space, e->z, s->yp);
  s->yp_known = true;
  e->have_F0 = false;
  stf_swap(s);
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
  stf_keep_vector(m, e->z);
  STF_KEEP(m, e->have_z);
}

const steif_method steif_method_rosenbrock_slopes = {
  .about = "Rosenbrock methods of Rodas type, M(t, y)",
  .forms = STEIF_IMPLICIT,
  .traits = STF_ADAPTIVE | STF_UNCORRECTED | STF_VARYING_MASS,
  .size = sizeof(state),
  .open = open,
  .attempt = attempt,
  .commit = commit,
  .dense = dense,
  .keep = keep,
};
