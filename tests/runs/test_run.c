/* test_run.c: runs from x(0-) through jumps and impulses, against closed solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "impulse/systems.h"
#include <steif/runs.h>
#include <steif/weak.h>

/* What a run told: its jumps and its last step. */
enum { JUMPS = 4, MOST = 8 };
typedef struct told {
  int jumps, steps, stop_at; /* stop_at: the step whose observer refuses; 0: none */
  double t[JUMPS], before[JUMPS][MOST], after[JUMPS][MOST], c[JUMPS][2][MOST];
  double end, x[MOST], worst;
  void (*exact)(double t, double *x); /* worst: largest deviation from it over the steps */
} told;

static int on_jump(sunrealtype t, const sunrealtype *before, const steif_impulse *i, void *user)
{
  told *s = user;
  const int k = s->jumps++;
  CU_ASSERT_FATAL(k < JUMPS && i->n <= MOST && i->count <= 2);
  s->t[k] = t;
  memcpy(s->before[k], before, (size_t)i->n * sizeof *before);
  memcpy(s->after[k], i->x_plus, (size_t)i->n * sizeof *before);
  for (int q = 0; q < i->count; q++)
    memcpy(s->c[k][q], i->c + q * i->n, (size_t)i->n * sizeof *before);
  CHECK(i->certified);
  return 0;
}

static int on_step(sunrealtype t, N_Vector x, void *user)
{
  told *s = user;
  const int n = (int)N_VGetLength(x);
  double exact[MOST];
  s->end = t;
  memcpy(s->x, N_VGetArrayPointer(x), (size_t)n * sizeof(double));
  if (s->exact) s->exact(t, exact);
  for (int i = 0; s->exact && i < n; i++) s->worst = fmax(s->worst, fabs(s->x[i] - exact[i]));
  return ++s->steps == s->stop_at;
}

/* ---- UT5 ---------------------------------------------------------------------------------------- */

enum { N = 5, PARTS = 4 };

/* x(1): staircase, contour and Drazin formulas with 40 digits agree. */
static const double at_one[N] = {-9.83990493625282, -14.7438400658581, 6.64909590232396,
                                 -6.87665107291679, 3.08069506977476};

/* Errors at t = 1 of the slow part (x_1 + x_3, x_2 + x_3 + x_5), rows of the slow projector, and of
 * x_1, x_4, x_5, which have index 3, 2, 1. From x(0-) = (1, 2, 3, 4, 5). */
static int ut5_errors(const char *method, double h, double rtol, double *error)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_linear l;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "ut5", &p) && !steif_linear_of(ctx, &p, &l));
  steif_options o = steif_defaults();
  o.t1 = 1, o.h = h, o.rtol = rtol;
  told s = {0};
  const steif_linear_output out = {on_jump, on_step, &s};
  if (steif_linear_run(ctx, &l, p.y0, 0, method, &o, NULL, 0, NULL, &out))
    printf("\n  %s: %s", method, steif_message(ctx));
  CHECK(s.jumps == 1 && s.end == 1);
  double d[N];
  for (int i = 0; i < N; i++) d[i] = s.x[i] - at_one[i];
  error[0] = hypot(d[0] + d[2], d[1] + d[2] + d[4]);
  error[1] = fabs(d[0]), error[2] = fabs(d[3]), error[3] = fabs(d[4]);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return s.steps;
}

/* Slow, index 3, 2, 1. Radau IIA with s stages: 2s - 1, s + 2 - k; algebraic unknowns of index 1 are
 * exact. Gauss, s odd: 2s, and for index 1, 2, 3 s + 1 less two for each (the stability function is
 * -1 at infinity). Backward differentiation
 * keeps p, but its first steps of order 1 and 2 leave h^2 in the slow part. E. Hairer, C. Lubich, M. Roche, The Numerical
 * Solution of Differential-Algebraic Systems by Runge-Kutta Methods, Springer 1989. */
enum { EXACT = 99 };
static void orders_from_inconsistent_values(void)
{
  static const struct {
    const char *method;
    double h, order[PARTS];
  } row[] = {{"radau:s=3", 0.05, {5, 2, 3, EXACT}}, {"radau:s=2", 0.02, {3, 1, 2, EXACT}},
             {"gauss:s=3", 0.05, {6, 0, 2, 4}},     {"bdf:p=2", 0.01, {2, 2, 2, EXACT}},
             {"bdf:p=3", 0.02, {2, 2, 3, EXACT}},   {"be", 0.01, {1, 1, 1, EXACT}}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double coarse[PARTS], fine[PARTS];
    ut5_errors(row[i].method, row[i].h, 0, coarse);
    ut5_errors(row[i].method, row[i].h / 2, 0, fine);
    for (int k = 0; k < PARTS; k++) {
      const double order = log2(coarse[k] / fine[k]);
      const bool good =
        row[i].order[k] == EXACT ? fine[k] < 1e-9 : fabs(order - row[i].order[k]) < 0.25;
      CHECK(good);
      if (!good)
        printf("\n  %s, part %d: %.2e, %.2e, order %.2f", row[i].method, k, coarse[k], fine[k],
               order);
    }
  }
}

/* Errors of the size of the tolerance in unknowns of every index: |x(1)| = 15. Steps at most as tolerance^(-1/4): order
 * 3 of the lowest estimate; -1/3 by hw43, whose order between ends is 2 in algebraic unknowns. */
static const char *const chosen[] = {"bdf",       "radau:s=3", "radau:s=5", "gauss:s=3",
                                     "gauss:s=4", "dirk:hw43", "auto"};
enum { CHOSEN = sizeof chosen / sizeof *chosen };
static void chosen_steps_come_through_the_start(void)
{
  static const double rtol[] = {1e-4, 1e-7, 1e-10};
  for (int i = 0, first = 0; i < CHOSEN; i++)
    for (int k = 0; k < 3; k++) {
      double error[PARTS], most = 0;
      const int steps = ut5_errors(chosen[i], 0, rtol[k], error);
      for (int part = 0; part < PARTS; part++) most = fmax(most, error[part]);
      if (!k) first = steps;
      const double bound = (k ? 1.5 * first : 200) * pow(rtol[0] / rtol[k], i == 5 ? .34 : .25);
      const bool good = steps > 5 && steps < bound && most < 15 * 15 * rtol[k];
      CHECK(good);
      if (!good) printf("\n  %s, %g: %d steps, error %.1e", chosen[i], rtol[k], steps, most);
    }
}

/* Jordan blocks N x' + x = f of index 1 to 6, f_m = cos(t + m): the smooth part by closed formula,
 * from consistent and inconsistent values alike. */
static void nilpotent_systems(void)
{
  static const char *const spec[] = {"N-inc", "N-cons"};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 1; k <= 6; k++)
    for (int i = 0; i < 2 * CHOSEN; i++) {
      char name[40];
      double end[6];
      steif_problem p;
      steif_linear l;
      snprintf(name, sizeof name, "jordan:k=%d,case=%s", k, spec[i % 2]);
      CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p) && !steif_linear_of(ctx, &p, &l));
      steif_options o = steif_defaults();
      o.t1 = 1, o.rtol = 1e-8;
      told s = {0};
      const steif_linear_output out = {.step = on_step, .user = &s};
      const int code =
        steif_linear_run(ctx, &l, p.y0, 0, chosen[i / 2], &o, NULL, 0, NULL, &out);
      CHECK(!code && s.end == 1);
      if (code) printf("\n  %s, %s: %s", name, chosen[i / 2], steif_message(ctx));
      CHECK(!steif_jordan_exact(ctx, k, p.g, p.user, p.y0, 1, end, NULL));
      for (int m = 0; m < k; m++) CLOSE_FLOOR(s.x[m], end[m], 3e-8, 1);
      SUNMatDestroy(l.E), SUNMatDestroy(l.F);
      steif_problem_clear(ctx, &p);
    }
  steif_context_free(&ctx);
}

/* ---- a switch ------------------------------------------------------------------------------------ */

/* y' + a y + x_1 = 0,  x_2' + x_1 = cos t,  x_2 = sin 2t + sum_j [t >= tau_j] (s_j + r (t - tau_j)),
 * unknowns (y, x_1, x_2). Where x_2 jumps by s, x_1 = -s delta + ... and y jumps by s, too. */
enum { BREAKS = 2 };
static const double a = 0.8, r = 0.3, tau[BREAKS] = {0.7, 1.3}, s[BREAKS] = {0.75, -1.85};
static const double start[3] = {0.3, 9.5, -0.4};

static int force(sunrealtype t, int q, N_Vector out, void *user)
{
  const double turn = acos(0.0);
  double *f = N_VGetArrayPointer(out);
  const int *highest = user;
  if (highest && q > *highest) return 1;
  f[0] = 0;
  f[1] = cos(t + q * turn);
  f[2] = pow(2, q) * sin(2 * t + q * turn);
  for (int j = 0; j < BREAKS; j++)
    if (t >= tau[j]) f[2] += q == 0 ? s[j] + r * (t - tau[j]) : q == 1 ? r : 0;
  return 0;
}

/* int_0^t e^{-a (t - u)} cos wu du. */
static double driven(double t, double w)
{
  return (a * cos(w * t) + w * sin(w * t) - a * exp(-a * t)) / (a * a + w * w);
}

/* From the right. y(0+) = y(0-) + x_2(0+) - x_2(0-) = 0.7. */
static void exact(double t, double *x)
{
  x[0] = 0.7 * exp(-a * t) - driven(t, 1) + 2 * driven(t, 2);
  x[1] = cos(t) - 2 * cos(2 * t);
  x[2] = sin(2 * t);
  for (int j = 0; j < BREAKS; j++) {
    const double u = t - tau[j];
    if (u < 0) continue;
    x[0] += s[j] * exp(-a * u) + r * (1 - exp(-a * u)) / a;
    x[1] -= r, x[2] += s[j] + r * u;
  }
}

/* The same from the left at a break. */
static void exact_before(double t, double *x) { exact(t - 1e-15, x); }

static steif_linear circuit(steif_context *ctx, bool sparse)
{
  static const double E[9] = {1, 0, 0, 0, 0, 1, 0, 0, 0}, F[9] = {0.8, 1, 0, 0, 1, 0, 0, 0, 1};
  steif_linear l = {.f = force};
  SUNMatrix *M[2] = {&l.E, &l.F};
  for (int k = 0; k < 2; k++) {
    const double *entry = k ? F : E;
    *M[k] = sparse ? system_dense(ctx, 3, entry) : SUNDenseMatrix(3, 3, steif_sundials(ctx));
    for (int i = 0; i < 9 && !sparse; i++) SM_ELEMENT_D((*M[k]), i / 3, i % 3) = entry[i];
  }
  return l;
}

static void close_circuit(steif_linear *l) { SUNMatDestroy(l->E), SUNMatDestroy(l->F); }

static void jumps_are_exact(const told *k)
{
  double plus[3];
  CHECK(k->jumps == 3);
  for (int j = 0; j < k->jumps && j < 3; j++) {
    CLOSE(k->t[j], j ? tau[j - 1] : 0, 0);
    exact(k->t[j], plus);
    for (int i = 0; i < 3; i++) CLOSE_FLOOR(k->after[j][i], plus[i], 1e-7, 1);
    CLOSE(k->c[j][0][1], j ? -s[j - 1] : -0.4, 1e-13); /* x_2(0-) - x_2(0+) = -0.4 */
    CLOSE_FLOOR(k->c[j][0][0], 0, 1e-13, 1);
    CLOSE_FLOOR(k->c[j][0][2], 0, 1e-13, 1);
    if (!j) continue;
    exact_before(k->t[j], plus);
    for (int i = 0; i < 3; i++) CLOSE_FLOOR(k->before[j][i], plus[i], 1e-7, 1);
  }
}

/* Dense, sparse, and sparse with circles, as if it were large. */
static const steif_analysis circles = {.algorithm = STEIF_CONTOUR};

static void steps_restart_at_breaks(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int way = 0; way < 3; way++) {
    steif_linear l = circuit(ctx, way > 0);
    steif_options o = steif_defaults();
    o.t1 = 2.1, o.rtol = 1e-9;
    told k = {0};
    const steif_linear_output out = {on_jump, on_step, &k};
    CHECK(!steif_linear_run(ctx, &l, start, 0, "radau:s=3", &o, way > 1 ? &circles : NULL,
                            BREAKS, tau, &out));
    jumps_are_exact(&k);
    double end[3];
    exact(2.1, end);
    for (int i = 0; i < 3; i++) CLOSE_FLOOR(k.x[i], end[i], 1e-6, 1);
    close_circuit(&l);
  }
  steif_context_free(&ctx);
}

/* The last segment alone has exact values at every step. */
static void method_keeps_its_order(void)
{
  static const struct {
    const char *method;
    double order;
  } row[] = {{"be", 1}, {"bdf:p=2", 2}, {"bdf:p=3", 2}, {"radau:s=2", 2}, {"gauss:s=3", 2}};
  steif_context *ctx = steif_context_new(NULL);
  steif_linear l = circuit(ctx, false);
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double error[2], end[3];
    for (int half = 0; half < 2; half++) {
      steif_options o = steif_defaults();
      o.t1 = 2.1, o.h = 0.02 / (1 + half);
      told k = {0};
      const steif_linear_output out = {NULL, on_step, &k};
      CHECK(!steif_linear_run(ctx, &l, start, 0, row[i].method, &o, NULL, BREAKS, tau, &out));
      exact(2.1, end);
      error[half] = fmax(fabs(k.x[0] - end[0]), fabs(k.x[1] - end[1]));
    }
    const double order = log2(error[0] / error[1]);
    const bool good = fabs(order - row[i].order) < 0.25;
    CHECK(good);
    if (!good)
      printf("\n  %s: %.3e %.3e, order %.2f", row[i].method, error[0], error[1], order);
  }
  close_circuit(&l);
  steif_context_free(&ctx);
}

/* Without jump: the impulse is part of the scheme. C. Lubich, Numer. Math. 52 (1988). */
static void convolution_quadrature_starts_anywhere(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_linear l = circuit(ctx, false);
  double end[3];
  exact(0.6, end);
  for (int p = 1; p <= 4; p++) {
    double error[2] = {0};
    for (int half = 0; half < 2; half++) {
      steif_problem problem;
      char method[24];
      snprintf(method, sizeof method, "bdf:p=%d,start=cq", p);
      CHECK(!steif_linear_problem(ctx, &l, start, 0, 0.6, &problem));
      steif_options o = steif_defaults();
      o.h = 0.01 / (1 + half);
      steif_solver *solver = steif_solver_new(ctx, &problem, method, &o);
      CU_ASSERT_FATAL(solver && !steif_solve_to(solver, 0.6));
      for (int i = 0; i < 3; i++)
        error[half] =
          fmax(error[half], fabs(N_VGetArrayPointer(steif_solution(solver))[i] - end[i]));
      steif_solver_free(&solver);
    }
    const double order = log2(error[0] / error[1]);
    CHECK(fabs(order - p) < 0.2);
    if (fabs(order - p) >= 0.2) printf("\n  p = %d: %.3e, order %.2f", p, error[0], order);
  }
  close_circuit(&l);
  steif_context_free(&ctx);
}

/* ---- what can go wrong --------------------------------------------------------------------------- */

static int try_run(steif_context *ctx, const steif_linear *l, double t1, size_t count,
                   const double *breaks, told *k)
{
  steif_options o = steif_defaults();
  o.t1 = t1, o.h = 0.05;
  const steif_linear_output out = {on_jump, on_step, k};
  return steif_linear_run(ctx, l, start, 0, "radau:s=2", &o, NULL, count, breaks, &out);
}

static void bad_requests_are_refused(void)
{
  static const double falling[] = {1.3, 0.7}, late[] = {0.7, 2.5};
  const int highest = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_linear l = circuit(ctx, false);
  told k = {0};
  CHECK(try_run(ctx, &l, 2, 2, falling, &k) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(ctx), "breaks must ascend"));
  k.jumps = 0;
  CHECK(try_run(ctx, &l, 2, 2, late, &k) == STEIF_BAD_INPUT &&
        strstr(steif_message(ctx), "2.5"));
  k = (told){.stop_at = 3};
  CHECK(try_run(ctx, &l, 2, 2, tau, &k) == STEIF_CALLBACK && k.steps == 3);
  l.user = (void *)&highest;
  CHECK(try_run(ctx, &l, 2, 2, tau, &k) == STEIF_BAD_INPUT);
  CHECK(!!strstr(steif_message(ctx), "derivative 1 of the forcing"));
  SUNMatZero(l.E), SUNMatZero(l.F);
  CHECK(try_run(ctx, &l, 2, 2, tau, &k) == STEIF_SINGULAR);
  close_circuit(&l);
  steif_context_free(&ctx);
}

/* Given steps on a dense system; chosen ones on a sparse one with circles. */
static int chosen_run(steif_context *ctx, const steif_linear *l, told *k)
{
  steif_options o = steif_defaults();
  o.t1 = 0.9;
  const steif_linear_output out = {on_jump, on_step, k};
  return steif_linear_run(ctx, l, start, 0, "bdf", &o, &circles, 1, tau, &out);
}

static long fail_each_allocation(bool sparse)
{
  long refused = 0;
  int code = STEIF_NO_MEMORY;
  for (long at = 1; code; at++) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_linear l = circuit(ctx, sparse);
    told k = {0};
    f.refuse_at = f.served + at;
    code = sparse ? chosen_run(ctx, &l, &k) : try_run(ctx, &l, 0.9, 1, tau, &k);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    if (code && code != STEIF_NO_MEMORY) printf("\n  %ld: %s", at, steif_message(ctx));
    refused += code != 0;
    close_circuit(&l);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
    CU_ASSERT_FATAL(at < 2000);
  }
  return refused;
}

static void every_allocation_may_fail(void)
{
  CHECK(fail_each_allocation(false) > 50);
  CHECK(fail_each_allocation(true) > 50);
}

CU_TestInfo tests_of_run[] = {
  {"UT5 from (1, 2, 3, 4, 5) arrives with the order of the method",
   orders_from_inconsistent_values},
  {"chosen steps come through an index-3 start", chosen_steps_come_through_the_start},
  {"nilpotent systems of index 1 to 6 to tolerance", nilpotent_systems},
  {"a run restarts at breaks with their jumps and impulses", steps_restart_at_breaks},
  {"through two breaks a method keeps its order", method_keeps_its_order},
  {"CQ-BDF-p from x(0-) has order p at a fixed time", convolution_quadrature_starts_anywhere},
  {"bad requests are refused", bad_requests_are_refused},
  {"every allocation may fail", every_allocation_may_fail},
  CU_TEST_INFO_NULL};
