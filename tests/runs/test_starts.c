/* test_starts.c: methods with adaptive steps from any x(0-) of E x' + F x = f, whose constraints may stand in any
 * combination of its rows.
 *
 * Truth by construction: z_i = sin(w_i t + p_i), x = Q z, and f is what makes this the solution of
 *   P (E_0 z' + F_0 z) = f,  E_0 = [M 0; 0 0],  F_0 = [K B; G D],
 * of index 1 where D is not 0, else 2. Only what E_0 x(0-) has of the slow part enters: from z(0) + (M^{-1} B l, m) with any
 * l and m, D = 0, the jump leads to z(0); for D = 1 from z(0) + (0, m).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <stdbool.h>
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <steif/initial.h>
#include <steif/linear.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { V = 3, N = 4 }; /* unknowns with a derivative in z, and all */

typedef struct made {
  double P[N][N], E0[N][N], F0[N][N], w[N], p[N], x0[N];
  SUNMatrix E, F;
} made;

static unsigned state;
static double any(void)
{
  state = 1664525u * state + 1013904223u;
  return (state >> 8) / 8388608.0 - 1;
}

static double derivative_of(const made *s, int i, int k, double t)
{
  return pow(s->w[i], k) * sin(s->w[i] * t + s->p[i] + k * 1.5707963267948966);
}

static int f(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const made *s = user;
  double r[N];
  for (int i = 0; i < N; i++) {
    r[i] = 0;
    for (int j = 0; j < N; j++)
      r[i] += s->E0[i][j] * derivative_of(s, j, derivative + 1, t) +
              s->F0[i][j] * derivative_of(s, j, derivative, t);
  }
  for (int i = 0; i < N; i++) {
    NV_Ith_S(g, i) = 0;
    for (int j = 0; j < N; j++) NV_Ith_S(g, i) += s->P[i][j] * r[j];
  }
  return 0;
}

/* M^{-1} B for a lower triangular M. */
static void impulse_way(const made *s, double *way)
{
  for (int i = 0; i < V; i++) {
    way[i] = s->F0[i][V];
    for (int j = 0; j < i; j++) way[i] -= s->E0[i][j] * way[j];
    way[i] /= s->E0[i][i];
  }
}

static void fill(made *s, int index, bool mixed)
{
  double way[V];
  memset(s, 0, sizeof *s);
  for (int i = 0; i < V; i++) {
    for (int j = 0; j < V; j++) s->F0[i][j] = (i == j) + 0.5 * any();
    for (int j = 0; j < i; j++) s->E0[i][j] = 0.5 * any();
    s->E0[i][i] = 1.5 + any() / 2;
    s->F0[i][V] = s->F0[V][i] = i == 0 ? 1.5 : 0.5 * any();
  }
  s->F0[V][V] = index == 1;
  for (int i = 0; i < N; i++) {
    s->w[i] = 1 + fabs(any()), s->p[i] = 3 * any();
    for (int j = 0; j < N; j++) s->P[i][j] = (i == j ? 2 : 0) + (mixed ? any() : 0);
  }
  impulse_way(s, way);
  const double l = any();
  for (int i = 0; i < N; i++) s->x0[i] = sin(s->p[i]);
  for (int i = 0; i < V && index == 2; i++) s->x0[i] += l * way[i];
  s->x0[V] += 1 + fabs(any());
}

static void matrices(steif_context *ctx, made *s)
{
  s->E = SUNDenseMatrix(N, N, steif_sundials(ctx));
  s->F = SUNDenseMatrix(N, N, steif_sundials(ctx));
  for (int i = 0; i < N; i++)
    for (int j = 0; j < N; j++) {
      SM_ELEMENT_D(s->E, i, j) = SM_ELEMENT_D(s->F, i, j) = 0;
      for (int k = 0; k < N; k++) {
        SM_ELEMENT_D(s->E, i, j) += s->P[i][k] * s->E0[k][j];
        SM_ELEMENT_D(s->F, i, j) += s->P[i][k] * s->F0[k][j];
      }
    }
}

/* rtol 1e-7: errors of x at 1 below 1e-4, of index 2 in the multiplier too. */
static void one(steif_context *ctx, made *s, const char *method)
{
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = 1e-7;
  matrices(ctx, s);
  const steif_linear l = {s->E, s->F, f, s};
  CU_ASSERT_FATAL(!steif_linear_problem(ctx, &l, s->x0, 0, 1, &p));
  steif_solver *solver = steif_solver_new(ctx, &p, method, &o);
  const int code = solver ? steif_solve_to(solver, 1) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(code == STEIF_OK);
  for (int i = 0; !code && i < N; i++)
    CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), i), derivative_of(s, i, 0, 1), 1e-4, 1);
  if (solver && strcmp(method, "auto")) CHECK(steif_initial_used(solver)->moved > 0);
  steif_solver_free(&solver);
  steif_problem_clear(ctx, &p);
  SUNMatDestroy(s->E), SUNMatDestroy(s->F);
}

static void constraints_in_any_rows(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "bdf", "auto"};
  steif_context *ctx = steif_context_new(NULL);
  state = 20;
  for (int k = 0; k < 24; k++) {
    made s;
    fill(&s, 1 + k % 2, k % 4 > 1);
    for (int m = 0; m < 4; m++) one(ctx, &s, methods[m]);
  }
  steif_context_free(&ctx);
}

static steif_linear of_index_two(steif_context *ctx, made *s)
{
  state = 7;
  fill(s, 2, false);
  matrices(ctx, s);
  return (steif_linear){s->E, s->F, f, s};
}

/* Prescribed steps, and starts that are to stay, begin where x0 is. */
static void starts_that_stay(void)
{
  steif_context *ctx = steif_context_new(NULL);
  made s;
  const steif_linear l = of_index_two(ctx, &s);
  for (int k = 0; k < 3; k++) {
    steif_problem p;
    steif_options o = steif_defaults();
    if (k == 0) o.h = 0.1;
    if (k == 1) o.initial = STEIF_AS_GIVEN;
    if (k == 2) o.initial = STEIF_CHECK;
    CU_ASSERT_FATAL(!steif_linear_problem(ctx, &l, s.x0, 0, 1, &p));
    steif_solver *solver = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CHECK((solver != NULL) == (k < 2));
    if (solver) CHECK(NV_Ith_S(steif_solution(solver), 0) == s.x0[0]);
    if (k == 2) CHECK(steif_status(ctx) == STEIF_BAD_INPUT);
    if (k == 2) CHECK(strstr(steif_message(ctx), "is not consistent") != NULL);
    steif_solver_free(&solver);
    steif_problem_clear(ctx, &p);
  }
  SUNMatDestroy(s.E), SUNMatDestroy(s.F);
  steif_context_free(&ctx);
}

static int from_zero(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)t, (void)user;
  N_VConst(0, y), N_VConst(0, yp);
  return 0;
}

static int same(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  N_VScale(1, x, out);
  return 0;
}

/* Where the start cannot be looked at, it is as given; asked for a check, the run does not begin. */
static void a_check_that_cannot_be_made_is_told(void)
{
  static const char *const words[] = {"storage Krylov", "options.like", "problem.start"};
  steif_context *ctx = steif_context_new(NULL);
  made s;
  const steif_linear l = of_index_two(ctx, &s);
  for (int k = 0; k < 3; k++) {
    steif_problem p;
    steif_options o = steif_defaults();
    CU_ASSERT_FATAL(!steif_linear_problem(ctx, &l, s.x0, 0, 1, &p));
    N_Vector like = N_VNew_Serial(p.n, steif_sundials(ctx));
    if (k == 0) p.storage = STEIF_KRYLOV, p.Ev = same, p.Av = same, p.E = p.A = NULL;
    if (k == 1) o.like = like;
    if (k == 2) p.start = from_zero;
    for (int initial = STEIF_REPAIR; initial <= STEIF_AS_GIVEN; initial++) {
      o.initial = (enum steif_initial)initial;
      steif_solver *solver = steif_solver_new(ctx, &p, "radau:s=3", &o);
      CHECK((solver != NULL) == (initial != STEIF_CHECK));
      if (!solver) CHECK(steif_status(ctx) == STEIF_UNSUPPORTED);
      if (!solver) CHECK(strstr(steif_message(ctx), words[k]) != NULL);
      steif_solver_free(&solver);
    }
    N_VDestroy(like);
    steif_problem_clear(ctx, &p);
  }
  SUNMatDestroy(s.E), SUNMatDestroy(s.F);
  steif_context_free(&ctx);
}

/* Two capacitors put together, as M y' = f(y) that says that it is linear: no `descriptor` takes that form, and the stages
 * keep the charge: v = 4/(1 + 3). */
static int currents(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 2), NV_Ith_S(r, 1) = NV_Ith_S(y, 2);
  NV_Ith_S(r, 2) = NV_Ith_S(y, 0) - NV_Ith_S(y, 1);
  return 0;
}
static int capacities(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(M, 0, 0) = 1, SM_ELEMENT_D(M, 1, 1) = 3;
  return 0;
}

static void linear_with_a_mass_matrix(void)
{
  static const sunrealtype y0[] = {4, 0, 0};
  static const char *const methods[] = {"radau:s=3", "bdf", "auto"};
  const steif_problem p = {
    .name = "caps", .n = 3, .t1 = 1, .y0 = y0, .f = currents, .E = capacities, .linear = 1};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 3; m++) {
    steif_solver *solver = steif_solver_new(ctx, &p, methods[m], NULL);
    CHECK(solver && steif_solve_to(solver, 1) == STEIF_OK);
    for (int i = 0; solver && i < 2; i++) CLOSE(NV_Ith_S(steif_solution(solver), i), 1, 1e-6);
    CHECK(solver && steif_initial_used(solver)->moved > 0);
    steif_solver_free(&solver);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_starts[] = {
  {"constraints in any rows", constraints_in_any_rows},
  {"starts that stay", starts_that_stay},
  {"a check that cannot be made is told", a_check_that_cannot_be_made_is_told},
  {"linear with a mass matrix", linear_with_a_mass_matrix},
  CU_TEST_INFO_NULL,
};
