/* test_expo.c: exponential methods: order conditions, errors on a parabolic problem, error
 * estimates, matrix functions against their actions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential_data.h"
#include "integrator.h"
#include "suite.h"
#include <complex.h>
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

/* -- coefficients ------------------------------------------------------------------------------ */

static const stf_exponential *scheme_at(size_t i)
{
  if (i < stf_exponential_rk_count) return stf_exponential_rk + i;
  i -= stf_exponential_rk_count;
  return i < stf_exponential_rb_count ? stf_exponential_rb + i : NULL;
}

/* With L = 0, phi_k = 1/k! and a Runge-Kutta method is left: A (s x s) and b. */
static void limit(const stf_exponential *x, double *A, double *b)
{
  for (int i = 0; i < STF_EXP_STAGES * STF_EXP_STAGES; i++) A[i] = 0;
  for (int i = 0; i < STF_EXP_STAGES; i++) b[i] = 0;
  for (int i = 1; i < x->s; i++) A[i * x->s] = x->node[x->at[i]];
  b[0] = 1;
  for (const stf_exp_term *m = x->term; m < x->term + x->count; m++) {
    double *row = m->stage < x->s ? A + m->stage * x->s : b;
    const double w = m->w / tgamma(m->k + 1.0);
    row[m->of] += w, row[0] -= w;
  }
}

static void classical_conditions_hold(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double A[STF_EXP_STAGES * STF_EXP_STAGES], b[STF_EXP_STAGES], c[STF_EXP_STAGES] = {0}, defect;
  const stf_exponential *x;
  int seen = 0;
  for (size_t i = 0; (x = scheme_at(i)); i++, seen++) {
    limit(x, A, b);
    for (int j = 1; j < x->s; j++) c[j] = x->node[x->at[j]];
    const steif_table T = {.name = x->name, .s = x->s, .A = A, .b = b, .c = c};
    /* With L = 0 Rosenbrock methods have lost the terms in which L is the Jacobian. */
    const int order = x->embedded ? 1 : x->order;
    for (int p = 1; p <= order; p++) {
      CHECK(steif_table_defect(ctx, &T, p, 0, &defect) == STEIF_OK);
      CLOSE_FLOOR(defect, 0, 4e-16, 1);
    }
    CHECK(steif_table_defect(ctx, &T, order + 1, 0, &defect) == STEIF_OK);
    CHECK(x->embedded || defect > 1e-3);
  }
  CHECK(seen == 9);
  steif_context_free(&ctx);
}

/* sum_j (weight of D_j in `stage`) c_j^q - q! c^{q+1} phi_{q+1}(cz), at z, c of the stage. */
static double complex stiff_defect(const stf_exponential *x, int stage, int q, double complex z)
{
  const double c = stage < x->s ? x->node[x->at[stage]] : 1;
  double re[STF_EXP_ORDER + 1], im[STF_EXP_ORDER + 1];
  steif_phi_scalar(STF_EXP_ORDER, c * creal(z), c * cimag(z), re, im);
  double complex sum = -tgamma(q + 1.0) * pow(c, q + 1) * (re[q + 1] + I * im[q + 1]);
  for (const stf_exp_term *m = x->term; m < x->term + x->count; m++) {
    const int row = m->stage > x->s ? x->s : m->stage;
    if (row != stage) continue;
    const double nu = x->node[m->node];
    steif_phi_scalar(m->k, nu * creal(z), nu * cimag(z), re, im);
    sum += m->w * (re[m->k] + I * im[m->k]) * pow(x->node[x->at[m->of]], q);
  }
  return sum;
}

/* psi_{q+1} = 0 for all z: M. Hochbruck and A. Ostermann, Acta Numerica 19 (2010), table 2.2. */
static void stiff_conditions_hold(void)
{
  static const struct {
    const char *name;
    int stage, q, holds;
  } cases[] = {{"exp-midpoint", 2, 1, 0}, {"exp-trapezoidal", 2, 1, 1}, {"etdrk4", 4, 1, 1},
               {"etdrk4", 4, 2, 1},       {"etdrk4", 3, 1, 0},          {"krogstad", 4, 1, 1},
               {"krogstad", 4, 2, 1},     {"krogstad", 3, 1, 1},        {"krogstad", 2, 1, 0},
               {"hochost4", 5, 1, 1},     {"hochost4", 5, 2, 1},        {"hochost4", 3, 1, 1},
               {"hochost4", 4, 1, 1},     {"hochost4", 5, 3, 0},        {"exprb32", 2, 2, 1},
               {"exprb43", 3, 2, 1},      {"exprb43", 3, 3, 1}};
  static const double complex at[] = {-0.37, -13.9 + 4.1 * I, -2.3e3, 1.7 * I};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const stf_exponential *x = NULL;
    for (size_t j = 0; (x = scheme_at(j)) && strcmp(x->name, cases[i].name);) j++;
    double most = 0;
    for (int k = 0; k < 4; k++)
      most = fmax(most, cabs(stiff_defect(x, cases[i].stage, cases[i].q, at[k])));
    if ((most < 1e-15) != cases[i].holds)
      printf("\n  %s, stage %d, q = %d: %.2e", x->name, cases[i].stage, cases[i].q, most);
    CHECK((most < 1e-15) == cases[i].holds);
  }
}

/* -- the parabolic problem --------------------------------------------------------------------- */

/* Errors at t = 1 with 4, 8, 16, 32 steps: numpy, e^{hL} and phi_k in the sine basis, the methods
 * as printed in their papers. */
static const struct row {
  const char *method;
  double error[4];
} rows[] = {
  {"exp-euler", {1.02357302e-01, 4.62214884e-02, 2.15359981e-02, 1.03859944e-02}},
  {"exp-midpoint", {2.86437713e-02, 7.20430121e-03, 1.71991395e-03, 4.34714188e-04}},
  {"exp-trapezoidal", {7.51799848e-03, 2.17411677e-03, 5.74811477e-04, 1.46725709e-04}},
  {"etd2", {2.00575695e-02, 4.68123169e-03, 1.10602694e-03, 2.68639655e-04}},
  {"etdrk4", {2.27106982e-05, 1.97376862e-06, 5.25452877e-07, 1.13205178e-07}},
  {"krogstad", {1.26616922e-04, 9.70847134e-06, 6.21635226e-07, 3.78200646e-08}},
  {"hochost4", {8.85564755e-05, 6.00138100e-06, 3.55500226e-07, 2.17842361e-08}},
};

static steif_context *ctx;
static steif_problem problem;

static void open(const char *name)
{
  ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(steif_problem_find(ctx, name, &problem) == STEIF_OK);
}

static void close(void)
{
  steif_problem_clear(ctx, &problem);
  steif_context_free(&ctx);
}

static void parabolic_errors(void)
{
  open("parabolic");
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    steif_order_row row[4];
    CHECK(steif_order_measure(ctx, &problem, rows[i].method, NULL, 0.25, 4, row) == STEIF_OK);
    for (int k = 0; k < 4; k++)
      CLOSE(row[k].error, rows[i].error[k], 1e-7 + 3e-15 / rows[i].error[k]);
  }
  close();
}

/* The last observed order from t = 1/16 down, where stiff orders show. */
static void stiff_orders(void)
{
  static const struct {
    const char *method;
    double least, most;
  } cases[] = {
    {"etdrk4", 1.8, 3.2},  {"krogstad", 3.8, 4.2}, {"hochost4", 3.8, 4.2},
    {"exprb32", 2.8, 3.2}, {"exprb43", 3.8, 4.4},
  };
  open("parabolic:n=99");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    steif_order_row row[4];
    CHECK(steif_order_measure(ctx, &problem, cases[i].method, NULL, 0.125, 4, row) == STEIF_OK);
    for (int k = 1; k < 4; k++)
      CHECK(row[k].order > cases[i].least && row[k].order < cases[i].most);
  }
  close();
}

static N_Vector run(const char *method, const steif_options *o, steif_stats *stats)
{
  steif_solver *s = steif_solver_new(ctx, &problem, method, o);
  N_Vector end = NULL;
  if (s && steif_solve_to(s, problem.t1) == STEIF_OK) {
    end = N_VClone(steif_solution(s));
    N_VScale(1, steif_solution(s), end);
    *stats = *steif_statistics(s);
  }
  if (!end) printf("\n  %s: %s", method, steif_message(ctx));
  steif_solver_free(&s);
  CU_ASSERT_FATAL(end != NULL);
  return end;
}

static double distance(N_Vector a, N_Vector b)
{
  N_VLinearSum(1, a, -1, b, b);
  return N_VMaxNorm(b);
}

/* Steps given as a mesh take the action of the functions, equal steps their matrices. Band and
 * sparse storage; one factorisation for the whole run. */
static void actions_agree_with_matrices(void)
{
  static const char *const methods[] = {"etd2", "etdrk4", "krogstad", "hochost4"};
  sunrealtype mesh[9];
  steif_stats stats;
  for (int i = 0; i <= 8; i++) mesh[i] = i / 8.0;
  for (int k = 0; k < 8; k++) {
    open(k < 4 ? "parabolic" : "parabolic:storage=sparse");
    steif_options o = steif_defaults();
    o.h = 0.125;
    N_Vector a = run(methods[k % 4], &o, &stats);
    CHECK(stats.nsolve == 0 && stats.nje == 1);
    o.mesh = mesh, o.mesh_size = 9, o.h = 0;
    N_Vector b = run(methods[k % 4], &o, &stats);
    CHECK(stats.nlu == 1 && stats.nsolve > 50);
    CLOSE_FLOOR(distance(a, b), 0, 2e-11, 1);
    N_VDestroy(a), N_VDestroy(b);
    close();
  }
}

/* -- chosen steps ------------------------------------------------------------------------------ */

static void tolerances_are_met(void)
{
  static const char *const methods[] = {"exprb32", "exprb43"};
  for (int m = 0; m < 2; m++)
    for (double rtol = 1e-4; rtol > 1e-7; rtol /= 100) {
      open("parabolic:n=400");
      steif_options o = steif_defaults();
      steif_stats stats;
      o.rtol = rtol, o.atol = rtol;
      N_Vector y = run(methods[m], &o, &stats), exact = N_VClone(y);
      problem.exact(1, exact, NULL, problem.user);
      const double error = distance(y, exact) / rtol;
      if (!(error < 2 && error > 1e-4)) printf("\n  %s, %g: %g", methods[m], rtol, error);
      CHECK(error < 2 && error > 1e-4);
      CHECK(stats.steps < 600 && stats.rejected <= stats.steps / 5 + 3);
      N_VDestroy(y), N_VDestroy(exact);
      close();
    }
}

/* The estimate is of the order of the embedded method plus one: halved steps from one point. */
static void estimates_have_their_order(void)
{
  static const char *const methods[] = {"exprb32", "exprb43"};
  static const double order[] = {3, 4};
  open("hires");
  for (int m = 0; m < 2; m++) {
    steif_solver *s = steif_solver_new(ctx, &problem, methods[m], NULL);
    CU_ASSERT_FATAL(s && steif_solve_to(s, 5) == STEIF_OK);
    double size[3];
    for (int k = 0; k < 3; k++) {
      CHECK(s->step.method->attempt(&s->step, 0.004 / (1 << k)) == STEIF_OK);
      size[k] = N_VMaxNorm(s->step.error);
    }
    for (int k = 1; k < 3; k++) CLOSE(log2(size[k - 1] / size[k]), order[m], 0.05);
    steif_solver_free(&s);
  }
  close();
}

/* The reference of the fronts is of an explicit method. */
static void fronts_meet_the_reference(void)
{
  steif_order_row row[3];
  open("allencahn");
  CHECK(steif_order_measure(ctx, &problem, "krogstad", NULL, 0.25, 3, row) == STEIF_OK);
  CHECK(row[2].error < 3e-8 && row[2].order > 3.7 && row[2].order < 4.1);
  close();
  open("allencahn:n=39");
  CHECK(steif_order_measure(ctx, &problem, "exprb43", NULL, 0.0625, 2, row) == STEIF_OK);
  CHECK(row[1].error < 1e-9 && row[1].order > 3.7 && row[1].order < 4.3);
  close();
}

/* A linear problem is solved exactly by any step; the estimate lets steps grow to the end. */
static void linear_problems_take_few_steps(void)
{
  steif_stats stats;
  open("heat:n=300");
  N_Vector y = run("exprb32", NULL, &stats), exact = N_VClone(y);
  problem.exact(problem.t1, exact, NULL, problem.user);
  CHECK(stats.steps < 12 && stats.rejected == 0 && stats.nje == 1);
  CLOSE_FLOOR(distance(y, exact), 0, 1e-7, 1);
  N_VDestroy(y), N_VDestroy(exact);
  close();
}

static void dense_output_follows(void)
{
  open("parabolic:n=50");
  steif_options o = steif_defaults();
  o.rtol = o.atol = 1e-7;
  steif_solver *s = steif_solver_new(ctx, &problem, "exprb43", &o);
  CU_ASSERT_FATAL(s != NULL);
  N_Vector exact = N_VClone(steif_solution(s));
  for (double t = 0.061; t < 1; t += 0.093) {
    CHECK(steif_solve_to(s, t) == STEIF_OK);
    problem.exact(t, exact, NULL, problem.user);
    CLOSE_FLOOR(distance(steif_solution(s), exact), 0, 2e-6, 1);
  }
  N_VDestroy(exact);
  steif_solver_free(&s);
  close();
}

CU_TestInfo tests_of_expo[] = {
  {"with L = 0 the classical order conditions hold", classical_conditions_hold},
  {"stiff order conditions hold as published", stiff_conditions_hold},
  {"errors on the parabolic problem meet the reference", parabolic_errors},
  {"krogstad and hochost4 keep order 4 there, etdrk4 does not", stiff_orders},
  {"actions of phi functions agree with their matrices", actions_agree_with_matrices},
  {"exponential Rosenbrock methods meet tolerances", tolerances_are_met},
  {"error estimates have the order of the embedded method", estimates_have_their_order},
  {"fronts of Allen and Cahn meet their reference", fronts_meet_the_reference},
  {"linear problems take few steps", linear_problems_take_few_steps},
  {"dense output follows the solution", dense_output_follows},
  CU_TEST_INFO_NULL};
