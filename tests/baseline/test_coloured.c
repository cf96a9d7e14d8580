/* test_coloured.c: sparse problems that tell their pattern only, beside the same with entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/solver.h>
#include <stdlib.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const steif_problem *p = user;
  const int seen = p->f(t, y, r, p->user);
  N_VLinearSum(1, yp, -1, r, r);
  return seen;
}

/* y' = f of a problem, without entries: as it is, or as the residual y' - f. */
static steif_problem bare(const steif_problem *p, bool implicit)
{
  steif_problem q = *p;
  q.jac = NULL, q.A = NULL;
  if (implicit) q.f = NULL, q.F = residual, q.user = (void *)(uintptr_t)p;
  return q;
}

static long steps_of(steif_context *ctx, const steif_problem *p, const char *method,
                     sunrealtype *y, long *nfe)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-6;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  const long steps = s ? steif_statistics(s)->steps : 0;
  *nfe = s ? steif_statistics(s)->nfe : 0;
  if (s) memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)p->n * sizeof *y);
  steif_solver_free(&s);
  return steps;
}

static void entries_are_found(void)
{
  static const char *const method[] = {"cvode", "ida", "arkode:newton=1e-3", "ida"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bruss2d:n=8", &p));
  sunrealtype *x = malloc(2 * (size_t)p.n * sizeof *x), *y = x + p.n;
  for (int k = 0; k < 4; k++) { /* the last one: F(t, y, y') = 0 */
    steif_problem q = bare(&p, k == 3);
    steif_pattern *pattern = NULL;
    long exact, differences;
    CU_ASSERT_FATAL(!steif_pattern_find(ctx, &q, &pattern));
    q.pattern = pattern;
    const long steps = steps_of(ctx, &p, method[k], x, &exact);
    CHECK(labs(steps_of(ctx, &q, method[k], y, &differences) - steps) <= steps / 5);
    CHECK(differences > exact);
    for (sunindextype i = 0; i < p.n; i++) CLOSE_FLOOR(y[i], x[i], 1e-3, 1);
    steif_pattern_free(ctx, &pattern);
  }
  free(x);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* M y' = f with M = diag(1, 1, 0), the kinetics of H. H. Robertson with its conservation law: a singular mass
 * matrix by .E, f by its pattern, here a full one. */
static int kinetics(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = NV_DATA_S(y), slow = 0.04 * u[0], back = 1e4 * u[1] * u[2],
                    fast = 3e7 * u[1] * u[1];
  (void)t, (void)user;
  NV_Ith_S(r, 0) = back - slow;
  NV_Ith_S(r, 1) = slow - back - fast;
  NV_Ith_S(r, 2) = u[0] + u[1] + u[2] - 1;
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SUNMatZero(E);
  for (sunindextype j = 0; j <= 3; j++) SM_INDEXPTRS_S(E)[j] = j < 2 ? j : 2;
  for (sunindextype k = 0; k < 2; k++) {
    SM_INDEXVALS_S(E)[k] = k;
    SM_DATA_S(E)[k] = 1;
  }
  return 0;
}

static void of_mass_forms(void)
{
  static const sunrealtype y0[] = {1, 0, 0};
  static const sunindextype column[] = {0, 3, 6, 9}, row[] = {0, 1, 2, 0, 1, 2, 0, 1, 2};
  const steif_pattern full = {column, row};
  const steif_problem p = {.name = "robertson",
                           .n = 3,
                           .t1 = 40,
                           .y0 = y0,
                           .f = kinetics,
                           .E = mass,
                           .nnz_E = 2,
                           .storage = STEIF_SPARSE,
                           .pattern = &full,
                           .rtol_scale = 1e-6};
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype y[3];
  long nfe;
  CHECK(steps_of(ctx, &p, "ida", y, &nfe) > 20);
  /* What the example cvRoberts_dns of SUNDIALS prints at t = 40. */
  CLOSE(y[0], 0.71583, 1e-5);
  CLOSE(y[0] + y[1] + y[2], 1, 1e-9);
  steif_problem blind = p;
  blind.pattern = NULL;
  steif_solver *s = steif_solver_new(ctx, &blind, "ida", NULL);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, 40)); /* it is found */
  CHECK(strstr(steif_method_used(s), "pattern found") != NULL);
  CLOSE(NV_Ith_S(steif_solution(s), 0), 0.71583, 1e-5);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_coloured[] = {
  {"entries are found by differences in a pattern", entries_are_found},
  {"mass matrices beside a pattern", of_mass_forms},
  CU_TEST_INFO_NULL};
