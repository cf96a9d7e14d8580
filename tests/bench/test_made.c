/* test_made.c: random problems have the solution that they say, and its Jacobian.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "base/failing.h"
#include "made.h"
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/solver.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { TIMES = 5, SEEDS = 6 };

/* Largest |M y' - f(t, y)| on the solution, relative to the terms. */
static double defect(made *m, double t, N_Vector y, N_Vector yp, N_Vector f)
{
  double most = 0;
  m->problem.exact(t, y, yp, m);
  m->problem.f(t, y, f, m);
  for (int i = 0; i < m->n; i++) {
    const double slope = i < m->differential ? NV_Ith_S(yp, i) : 0;
    most = fmax(most, fabs(slope - NV_Ith_S(f, i)) / (1 + fabs(slope)));
  }
  return most;
}

/* Largest difference of a column of the Jacobian and the central difference of f, relative to the column. */
static double off(made *m, double t, N_Vector y, N_Vector above, N_Vector below, SUNMatrix J)
{
  const double d = 1e-5;
  double most = 0;
  SUNMatZero(J);
  m->problem.jac(t, y, NULL, J, m, NULL, NULL, NULL);
  for (int j = 0; j < m->n; j++) {
    double size = 1, distance = 0;
    NV_Ith_S(y, j) += d;
    m->problem.f(t, y, above, m);
    NV_Ith_S(y, j) -= 2 * d;
    m->problem.f(t, y, below, m);
    NV_Ith_S(y, j) += d;
    for (int i = 0; i < m->n; i++) {
      const double slope = (NV_Ith_S(above, i) - NV_Ith_S(below, i)) / (2 * d);
      size = fmax(size, fabs(slope));
      distance = fmax(distance, fabs(slope - SM_ELEMENT_D(J, i, j)));
    }
    most = fmax(most, distance / size);
  }
  return most;
}

static void made_problems_have_their_solution(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int kind = 0; kind < MADE_KINDS; kind++)
    for (long seed = 1; seed <= SEEDS; seed++) {
      made m;
      made_new(&m, (enum made_kind)kind, seed);
      N_Vector v[4];
      for (int k = 0; k < 4; k++) v[k] = N_VNew_Serial(m.n, steif_sundials(ctx));
      SUNMatrix J = SUNDenseMatrix(m.n, m.n, steif_sundials(ctx));
      for (int k = 0; k < TIMES; k++) {
        const double t = m.problem.t1 * (k + 0.3) / TIMES;
        CHECK(defect(&m, t, v[0], v[1], v[2]) < 1e-12);
        m.problem.exact(t, v[0], NULL, &m);
        NV_Ith_S(v[0], 0) += 0.1; /* off the solution, where terms do not cancel */
        CHECK(off(&m, t, v[0], v[2], v[3], J) < 1e-6);
      }
      SUNMatDestroy(J);
      for (int k = 0; k < 4; k++) N_VDestroy(v[k]);
    }
  steif_context_free(&ctx);
}

/* Largest error of components of index above 1, in tolerances. */
static double hidden(const steif_problem *p, double rtol, N_Vector y, N_Vector known)
{
  double most = 0;
  p->exact(p->t1, known, NULL, p->user);
  for (sunindextype i = 0; i < p->n; i++) {
    const double value = NV_Ith_S(y, i), error = fabs(value - NV_Ith_S(known, i));
    if (p->index[i] > 1) most = fmax(most, error / (rtol * (1 + fabs(value))));
  }
  return most;
}

static void judge(steif_context *ctx, const steif_problem *p, const char *method, double rtol)
{
  const steif_options o = {.rtol = rtol};
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  CU_ASSERT_FATAL(s && steif_solve_to(s, p->t1) == STEIF_OK);
  N_Vector known = N_VClone(steif_solution(s));
  sunrealtype said;
  CHECK(steif_hidden_error(s, &said) == STEIF_OK);
  const double right = hidden(p, rtol, steif_solution(s), known);
  const int good = said < 2 * right + 0.05 && right < 2 * said + 0.05;
  if (!good) printf("\n  %s, %s, %g: %.3g, said %.3g", p->name, method, rtol, right, said);
  CHECK(good);
  N_VDestroy(known);
  steif_solver_free(&s);
}

/* Errors of multipliers and velocities are told, from a thousandth of a tolerance to thousands of them, within a
 * factor of 2. */
static void hidden_errors_are_told(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "bdf"};
  static const enum made_kind kinds[] = {MADE_CONSTRAINED, MADE_MECHANICAL};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++)
    for (double rtol = 1e-3; rtol > 0.5e-7; rtol *= 1e-2) {
      for (int k = 0; k < 2; k++)
        for (long seed = 1; seed <= SEEDS / 2; seed++) {
          made m;
          made_new(&m, kinds[k], seed);
          judge(ctx, &m.problem, methods[i], rtol);
        }
      steif_problem p;
      CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
      judge(ctx, &p, methods[i], rtol);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
}

/* Every allocation fails once: a code and a sentence, or nothing is said; the run goes on. */
static void hidden_errors_without_memory(void)
{
  failing memory = {0};
  steif_setup setup = failing_setup(&memory);
  steif_context *ctx = steif_context_new(&setup);
  sunrealtype said = 0;
  made m;
  made_new(&m, MADE_MECHANICAL, 1);
  steif_solver *s = steif_solver_new(ctx, &m.problem, "radau:s=3", NULL);
  CU_ASSERT_FATAL(s && !steif_solve_to(s, m.problem.t1 / 2));
  const long before = memory.served, alive = memory.alive;
  CHECK(!steif_hidden_error(s, &said) && said > 0);
  const long count = memory.served - before;
  int refused = 0;
  for (long k = 1; k <= count; k++) {
    memory.refuse_at = memory.served + k;
    const int code = steif_hidden_error(s, &said);
    CHECK(code == STEIF_OK || (code == STEIF_NO_MEMORY && strlen(steif_message(ctx)) > 10));
    CHECK(code == STEIF_OK || isnan(said));
    CHECK(memory.alive == alive);
    refused += code == STEIF_NO_MEMORY;
  }
  memory.refuse_at = 0;
  CHECK(refused > 0);
  CHECK(!steif_solve_to(s, m.problem.t1));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  CHECK(memory.alive == 0);
}

/* NaN where nothing is hidden: index 1, and before the first step. */
static void without_hidden_components_nothing_is_said(void)
{
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype said = 0;
  made m;
  made_new(&m, MADE_ALGEBRAIC, 1);
  steif_solver *s = steif_solver_new(ctx, &m.problem, "radau:s=3", NULL);
  CHECK(s && !steif_solve_to(s, m.problem.t1) && !steif_hidden_error(s, &said) && isnan(said));
  steif_solver_free(&s);
  made_new(&m, MADE_MECHANICAL, 1);
  s = steif_solver_new(ctx, &m.problem, "radau:s=3", NULL);
  said = 0;
  CHECK(s && !steif_hidden_error(s, &said) && isnan(said));
  steif_solver_free(&s);
  said = 0;
  CHECK(!steif_hidden_error(NULL, &said) && isnan(said));
  steif_context_free(&ctx);
}

/* Largest error in tolerances, of p to its end. */
static double error_of(steif_context *ctx, const steif_problem *p, const char *method,
                       double rtol)
{
  const steif_options o = {.rtol = rtol};
  const double scale = p->rtol_scale > 0 ? p->rtol_scale : 1;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  CU_ASSERT_FATAL(s && steif_solve_to(s, p->t1) == STEIF_OK);
  N_Vector y = steif_solution(s), known = N_VClone(y);
  if (p->exact)
    p->exact(p->t1, known, NULL, p->user);
  else
    memcpy(NV_DATA_S(known), p->reference->value, (size_t)p->n * sizeof(double));
  double most = 0;
  for (sunindextype i = 0; i < p->n; i++) {
    const double right = NV_Ith_S(known, i), error = fabs(NV_Ith_S(y, i) - right);
    most = fmax(most, error / (rtol * (scale + fabs(right))));
  }
  if (!(most < 10)) printf("\n  %s, %s, %g: %.3g tolerances", p->name, method, rtol, most);
  N_VDestroy(known);
  steif_solver_free(&s);
  return most;
}

/* Newton's corrections vanish after the second one where components feed others in one direction only. That says
 * nothing of the first correction of the next step: 165 tolerances off if it is believed. */
static void one_directional_coupling_keeps_its_digits(void)
{
  static const char *const methods[] = {"radau:s=3", "radau:s=5", "radau:s=7", "gauss:s=3"};
  static const long seeds[] = {8, 14, 5001, 5037};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 4; k++) {
    made m;
    made_new(&m, MADE_BENT, seeds[k]);
    for (int i = 0; i < 4; i++)
      for (double rtol = 1e-3; rtol > 1e-10; rtol *= 0.1)
        CHECK(error_of(ctx, &m.problem, methods[i], rtol) < 10);
  }
  steif_context_free(&ctx);
}

/* What Newton's iteration leaves adds up where steps are many: to 121 tolerances in 196,646 steps at 1e-10, if it may be a
 * thousandth in each. */
static void many_steps_keep_their_digits(void)
{
  static const double rtols[] = {1e-8, 1e-9, 1e-10};
  steif_context *ctx = steif_context_new(NULL);
  made m;
  made_new(&m, MADE_BENT, 8);
  for (int k = 0; k < 3; k++) CHECK(error_of(ctx, &m.problem, "dirk:hw43", rtols[k]) < 10);
  steif_context_free(&ctx);
}

/* Errors of many steps of Gauss's methods of high order add up where nothing damps them. */
static void gauss_keeps_its_digits(void)
{
  static const char *const methods[] = {"gauss:s=4", "gauss:s=5", "gauss:s=7"};
  static const char *const names[] = {"orego", "swing", "plei"};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 3; k++) {
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, names[k], &p));
    for (int i = 0; i < 3; i++)
      for (double rtol = 1e-4; rtol > 0.5e-11; rtol *= 0.1)
        CHECK(error_of(ctx, &p, methods[i], rtol) < 10);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_made[] = {
  {"one-directional coupling keeps its digits", one_directional_coupling_keeps_its_digits},
  {"many steps keep their digits", many_steps_keep_their_digits},
  {"Gauss keeps its digits", gauss_keeps_its_digits},
  {"hidden errors are told", hidden_errors_are_told},
  {"hidden errors without memory", hidden_errors_without_memory},
  {"without hidden components nothing is said", without_hidden_components_nothing_is_said},
  {"made problems have their solution", made_problems_have_their_solution},
  CU_TEST_INFO_NULL};
