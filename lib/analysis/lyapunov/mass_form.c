/* mass_form.c: E y' = A y + g(t) with constant matrices as E y' = f(t, y), f = A y + g.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jacobian.h"
#include "variation.h"

typedef struct linear_form {
  steif_problem problem;
  const steif_problem *of;
  SUNMatrix A;
  N_Vector room;
} linear_form;

static int rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const linear_form *l = user;
  if (SUNMatMatvec(l->A, y, ydot)) return -1;
  if (!l->of->g) return 0;
  const int code = l->of->g(t, 0, l->room, l->of->user);
  N_VLinearSum(1, ydot, 1, l->room, ydot);
  return code;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  const linear_form *l = user;
  (void)fy, (void)a, (void)b, (void)c;
  return l->of->A(t, y, NULL, J, l->of->user);
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const linear_form *l = user;
  return l->of->E(t, y, yp, E, l->of->user);
}

static void destroy(void *vector) { N_VDestroy(vector); }

int stf_mass_form(stf_pool *pool, steif_context *ctx, const steif_problem *of,
                  const steif_problem **form)
{
  linear_form *l = stf_pool_array(pool, 1, sizeof *l);
  if (!l) return STEIF_NO_MEMORY;
  l->of = of, *form = &l->problem;
  l->problem = (steif_problem){.name = of->name,
                               .about = of->about,
                               .n = of->n,
                               .names = of->names,
                               .t0 = of->t0,
                               .t1 = of->t1,
                               .y0 = of->y0,
                               .f = rhs,
                               .jac = jac,
                               .E = mass,
                               .user = l,
                               .storage = of->storage,
                               .lower = of->lower,
                               .upper = of->upper,
                               .nnz = of->nnz,
                               .nnz_E = of->nnz_E,
                               .pattern = of->pattern,
                               .index = of->index,
                               .dae_index = of->dae_index,
                               .autonomous = !of->g || of->autonomous,
                               .linear = 1,
                               .breaks = of->breaks,
                               .break_count = of->break_count};
  l->room = N_VNew_Serial(of->n, steif_sundials(ctx));
  STEIF_CHECK(l->room, ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld",
              (long long)of->n);
  STEIF_TRY(stf_pool_adopt(pool, l->room, destroy));
  const sunindextype stated = of->pattern ? of->pattern->column[of->n] : 1;
  l->A = stf_jacobian_new(pool, ctx, of->storage, of->n, of->lower, of->upper,
                          of->nnz > stated ? of->nnz : stated);
  if (!l->A) return STEIF_NO_MEMORY;
  stf_jacobian_clear(l->A);
  STEIF_CHECK(!of->A(of->t0, l->room, NULL, l->A, of->user), ctx, STEIF_CALLBACK,
              "the matrix A of '%s' failed at t = %g", of->name, of->t0);
  return STEIF_OK;
}
