/* stage_chain.c: stages one after another with one real shift 1/(gamma h), or explicit.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stage_chain.h"

static int find_gamma(stf_step *s, const char *name, stf_chain *e)
{
  e->gamma = 0;
  for (int i = 0; i < e->s; i++) {
    const sunrealtype a = e->A[i * (e->s + 1)];
    if (a == 0) continue;
    if (e->gamma == 0) e->gamma = a;
    STEIF_CHECK(a == e->gamma && a > 0, s->ctx, STEIF_UNSUPPORTED,
                "table '%s' has different diagonal entries %g and %g: only one shift is served",
                name, e->gamma, a);
  }
  return STEIF_OK;
}

int stf_chain_open(stf_step *s, const char *name, stf_chain *e)
{
  stf_transform transform;
  STEIF_TRY(find_gamma(s, name, e));
  if (e->gamma > 0) {
    STEIF_TRY(stf_transform_single(s->pool, 1 / e->gamma, &transform));
    STEIF_TRY(stf_newton_open(s->pool, &s->system, &transform, s->weights, &s->newton));
  }
  e->K = stf_pool_vectors(s->pool, e->s, s->y);
  e->X = stf_pool_vectors(s->pool, e->s, s->y);
  e->base = stf_pool_vector(s->pool, s->y);
  e->offset = stf_pool_vector(s->pool, s->y);
  e->Z = stf_pool_vector(s->pool, s->y);
  e->other = e->U ? stf_pool_vector(s->pool, s->y) : NULL;
  const bool good = e->K && e->X && e->base && e->offset && e->Z && (!e->U || e->other);
  return good ? STEIF_OK : STEIF_NO_MEMORY;
}

/* base = sum_j u_ij x_j + h sum_{l<i} a_il K_l */
static void stage_base(stf_step *s, stf_chain *e, int i, N_Vector *x, sunrealtype h)
{
  const stf_space *space = &s->system.space;
  N_Vector from = x[0];
  if (e->U) stf_combine(space, e->k, e->U + i * e->k, x, from = e->other);
  stf_combine(space, i, e->A + i * e->s, e->K, e->base);
  stf_sum(space, 1, from, h, e->base, e->base);
}

static int explicit_stage(stf_step *s, stf_chain *e, int i, sunrealtype h)
{
  stf_copy(&s->system.space, e->base, e->X[i]);
  return stf_system_rhs(&s->system, s->t + e->c[i] * h, e->X[i], e->K[i]);
}

static int implicit_stage(stf_step *s, stf_chain *e, int i, sunrealtype h)
{
  const stf_space *space = &s->system.space;
  const sunrealtype gh = e->gamma * h;
  const stf_stages g = {.t = s->t,
                        .h = h,
                        .c = e->c + i,
                        .base = s->absolute ? NULL : &e->base,
                        .offset = s->absolute ? &e->offset : NULL,
                        .Z = &e->Z,
                        .predicted = !s->absolute};
  if (s->absolute) {
    stf_scale(space, -1 / gh, e->base, e->offset);
    STEIF_TRY(stf_solve_stages(s, &g));
    stf_copy(space, e->Z, e->X[i]);
    stf_sum(space, 1 / gh, e->Z, -1 / gh, e->base, e->K[i]);
    return STEIF_OK;
  }
  N_Vector slope = i ? e->K[i - 1] : e->guess;
  if (!s->system.linear || s->system.krylov)
    slope ? stf_scale(space, gh, slope, e->Z) : stf_zero(space, e->Z);
  STEIF_TRY(stf_solve_stages(s, &g));
  stf_sum(space, 1, e->base, 1, e->Z, e->X[i]);
  stf_scale(space, 1 / gh, e->Z, e->K[i]);
  return STEIF_OK;
}

int stf_chain_run(stf_step *s, stf_chain *e, int first, N_Vector *x, sunrealtype h)
{
  for (int i = first; i < e->s; i++) {
    stage_base(s, e, i, x, h);
    const bool explicit_one = e->A[i * (e->s + 1)] == 0;
    STEIF_TRY((explicit_one ? explicit_stage : implicit_stage)(s, e, i, h));
  }
  return STEIF_OK;
}

int stf_chain_filter(stf_step *s, stf_chain *e)
{
  const stf_space *space = &s->system.space;
  if (e->gamma == 0) return stf_copy(space, e->base, s->error), STEIF_OK;
  STEIF_TRY(steif_pencil_product(s->system.pencil, 'E', e->base, s->error));
  return steif_pencil_solve(s->system.pencil, 0, 1, &s->error, NULL);
}
