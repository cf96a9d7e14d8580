/* test_directions.c: derivatives along a line of parameters and start values, of all that one parameter has.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subjects.h"
#include "base/failing.h"
#include <stdbool.h>
#include <steif/data.h>
#include <string.h>

enum { MOST = 64 };

/* Columns of the run at t1: count of them, n numbers each. */
static void columns(steif_context *ctx, const steif_problem *p, const char *method,
                    const steif_options *given, int count, sunrealtype *S)
{
  steif_options o = *given;
  o.sensitivities = 1;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  int code = s ? steif_solve_to(s, o.t1) : steif_status(ctx);
  if (code) printf("\n  %s, %s: %s", p->name, method, steif_message(ctx));
  CU_ASSERT_FATAL(s && code >= 0);
  N_Vector y = N_VClone(steif_solution(s));
  for (int k = 0; k < count; k++) {
    CHECK(steif_sensitivity(s, o.t1, k, y) == STEIF_OK);
    memcpy(S + k * p->n, NV_DATA_S(y), (size_t)p->n * sizeof *S);
  }
  N_VDestroy(y);
  steif_solver_free(&s);
}

/* S v from one column against the sum of P columns. */
static void one_column(steif_context *ctx, const steif_problem *p, const char *method,
                       const steif_options *o, double tolerance)
{
  const int P = p->parameters->count;
  static sunrealtype S[16 * MOST];
  sunrealtype v[16], Sv[MOST], kept[16];
  CU_ASSERT_FATAL(P <= 16 && p->n <= MOST);
  for (int k = 0; k < P; k++) {
    kept[k] = p->parameters->value[k];
    v[k] = sin(1 + k) * (kept[k] != 0 ? fabs(kept[k]) : 1);
  }
  columns(ctx, p, method, o, P, S);
  steif_direction *d = steif_direction_new(ctx, p, v, NULL);
  CU_ASSERT_FATAL(d != NULL);
  columns(ctx, steif_direction_problem(d), method, o, 1, Sv);
  for (sunindextype i = 0; i < p->n; i++) {
    sunrealtype sum = 0, size = 0;
    for (int k = 0; k < P; k++)
      sum += S[k * p->n + i] * v[k], size = fmax(size, fabs(S[k * p->n + i] * v[k]));
    CLOSE_FLOOR(Sv[i], sum, tolerance, size);
  }
  CHECK(!memcmp(kept, p->parameters->value, (size_t)P * sizeof *kept));
  steif_direction_free(&d);
  CHECK(d == NULL);
}

static void sum_of_columns(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=2", "bdf:p=3", "dirk:hw43"};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  steif_options o = steif_defaults();
  o.t1 = 1, o.h = 0.0625, o.newton = 1e-8;
  for (int m = 0; m < 4; m++) {
    subject_lotka(&s);
    one_column(ctx, &s.problem, methods[m], &o, 1e-11);
    s.parameters.dFdp = NULL; /* differences along the line */
    one_column(ctx, &s.problem, methods[m], &o, 1e-8);
    for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
      subject_brusselator(&s, (enum steif_storage)storage);
      one_column(ctx, &s.problem, methods[m], &o, 1e-11);
    }
  }
  subject_pendulum(&s);
  o.newton = 1e-3;
  one_column(ctx, &s.problem, "radau:s=3", &o, 1e-9);
  steif_context_free(&ctx);
}

/* Ball: events with reactions; both parts of a column of the initial height and of gravity. */
static void through_events(void)
{
  static const char *const methods[] = {"radau:s=3", "dirk:hw43", "bdf"};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
  o.t1 = 2, o.rtol = 1e-10;
  for (int m = 0; m < 3; m++) one_column(ctx, &p, methods[m], &o, 1e-7);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* w . (J v) = (J^T w) . v, with start values in v; the gradient of the line itself is that number too. */
static void with_start_values(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=2", "bdf:p=3", "dirk:esdirk43"};
  const sunrealtype v[] = {0.5, -1, 0.25, 2}, u[] = {0.3, -0.7};
  const steif_functional J = {.count = 1, .end = weighted_sum, .slopes = weighted_slopes};
  steif_context *ctx = steif_context_new(NULL);
  struct subject s;
  subject_lotka(&s);
  steif_options o = steif_defaults();
  o.t1 = 2, o.h = 0.125, o.newton = 1e-8;
  for (int with = 1; with < 4; with++)
    for (int m = 0; m < 4; m++) {
      steif_direction *d =
        steif_direction_new(ctx, &s.problem, with & 1 ? v : NULL, with & 2 ? u : NULL);
      CU_ASSERT_FATAL(d != NULL);
      steif_gradient g = {0}, line = {0};
      const steif_problem *along = steif_direction_problem(d);
      CU_ASSERT_FATAL(!steif_gradient_find(ctx, &s.problem, methods[m], &o, &J, &g));
      CU_ASSERT_FATAL(!steif_gradient_find(ctx, along, methods[m], &o, &J, &line));
      sunrealtype Jv[2], sum = 0;
      columns(ctx, along, methods[m], &o, 1, Jv);
      for (int k = 0; k < 4 && with & 1; k++) sum += g.dp[k] * v[k];
      for (int i = 0; i < 2 && with & 2; i++) sum += g.dy0[i] * u[i];
      CLOSE_FLOOR(cos(1) * Jv[0] + cos(2) * Jv[1], sum, 1e-12, 1);
      CLOSE_FLOOR(line.dp[0], sum, 1e-12, 1);
      CHECK(line.value[0] == g.value[0]);
      steif_gradient_free(ctx, &g), steif_gradient_free(ctx, &line);
      steif_direction_free(&d);
    }
  steif_context_free(&ctx);
}

/* Without parameters, start values have directions: y' = -y by u, and q = int y. */
static int decay(sunrealtype t, N_Vector y, N_Vector f, void *user)
{
  (void)t;
  NV_Ith_S(f, 0) = *(double *)user * NV_Ith_S(y, 0);
  return 0;
}

static int itself(sunrealtype t, N_Vector y, sunrealtype *q, void *user)
{
  (void)t;
  q[0] = *(double *)user * NV_Ith_S(y, 0);
  return 0;
}

static void without_parameters(void)
{
  double rate = -1, q = 0;
  const sunrealtype y0 = 2, u = 0.5;
  const steif_quadrature quadrature = {.count = 1, .value = itself};
  const steif_problem p = {.name = "decay",
                           .n = 1,
                           .t1 = 1,
                           .y0 = &y0,
                           .f = decay,
                           .user = &rate,
                           .quadrature = &quadrature};
  steif_context *ctx = steif_context_new(NULL);
  steif_direction *d = steif_direction_new(ctx, &p, NULL, &u);
  CU_ASSERT_FATAL(d != NULL);
  steif_options o = steif_defaults();
  o.sensitivities = 1, o.rtol = 1e-10;
  steif_solver *s = steif_solver_new(ctx, steif_direction_problem(d), "radau:s=3", &o);
  CU_ASSERT_FATAL(s && steif_solve_to(s, 1) == STEIF_OK);
  N_Vector S = N_VClone(steif_solution(s));
  CHECK(steif_sensitivity(s, 1, 0, S) == STEIF_OK);
  CLOSE(NV_Ith_S(S, 0), 0.5 * exp(-1), 1e-8);
  CHECK(steif_quadrature_sensitivity(s, 1, 0, &q) == STEIF_OK);
  CLOSE(q, 0.5 * (exp(-1) - 1), 1e-8);
  N_VDestroy(S);
  steif_solver_free(&s);
  steif_direction_free(&d);
  steif_context_free(&ctx);
}

static void refused_as(const steif_problem *p, const sunrealtype *v, const sunrealtype *u,
                       int code, const char *word)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_direction_new(ctx, p, v, u) == NULL);
  CHECK(steif_status(ctx) == code);
  if (!strstr(steif_message(ctx), word)) printf("\n  %s", steif_message(ctx));
  CHECK(strstr(steif_message(ctx), word) != NULL);
  steif_context_free(&ctx);
}

static void refused(void)
{
  struct subject s;
  subject_lotka(&s);
  const sunrealtype v[] = {0, NAN, 0, 0}, u[] = {INFINITY, 0};
  refused_as(&s.problem, NULL, NULL, STEIF_BAD_INPUT, "needs");
  refused_as(NULL, v, NULL, STEIF_BAD_INPUT, "needs");
  refused_as(&s.problem, v, NULL, STEIF_NOT_FINITE, "entry 2 of the direction of parameters");
  refused_as(&s.problem, NULL, u, STEIF_NOT_FINITE, "entry 1 of the direction of start");
  s.problem.parameters = NULL;
  refused_as(&s.problem, v, NULL, STEIF_BAD_INPUT, "no parameters");
  CHECK(steif_direction_new(NULL, &s.problem, v, NULL) == NULL);
  CHECK(steif_direction_problem(NULL) == NULL);
  steif_direction_free(NULL);
}

static void failing_requests(void)
{
  struct subject s;
  subject_lotka(&s);
  const sunrealtype v[] = {1, 2, 3, 4}, u[] = {1, 2};
  bool done = false;
  for (long k = 1; !done && k < 100; k++) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    f.served = 0, f.refuse_at = k;
    steif_direction *d = steif_direction_new(ctx, &s.problem, v, u);
    CHECK(d || steif_status(ctx) == STEIF_NO_MEMORY);
    done = d && f.served < k;
    steif_direction_free(&d);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(done);
}

CU_TestInfo tests_of_directions[] = {{"one column is the sum of all", sum_of_columns},
                                     {"through events", through_events},
                                     {"with start values, forward and back", with_start_values},
                                     {"without parameters", without_parameters},
                                     {"refused with a sentence", refused},
                                     {"failing requests for memory", failing_requests},
                                     CU_TEST_INFO_NULL};
