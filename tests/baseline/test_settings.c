/* test_settings.c: IDA in every setting it allows, on DAEs of index 1 to 4 and on starts with impulses.
 * Steps and errors beside each row were found by a separate C program on IDA of SUNDIALS 6.4.1 (dense
 * solver, analytic Jacobian, atol = rtol times the scale of the problem); truth: x(0+) by
 * steif_impulse_find, x(t1) closed, published or by steif_linear_exact.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include "suite.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/collection.h>
#include <steif/runs.h>
#include <string.h>

enum { MOST = 120, NO = -1 };

typedef struct expected {
  const char *problem, *method;
  sunrealtype rtol;
  long steps;             /* 0: the run fails */
  sunrealtype start, end; /* errors in the maximum norm; NO: not asked */
} expected;

static const expected rows[] = {
  {"jordan:k=1,case=N-inc", "ida:suppress=1", 1e-6, 11, NO, 0},
  {"jordan:k=1,case=N-inc", "ida:ic=1", 1e-6, 35, 0, NO},
  {"jordan:k=1,case=N-inc", "ida:ic=2", 1e-8, 49, 0, NO},
  {"jordan:k=1,case=N-inc", "ida", 1e-6, 0, NO, NO},
  {"jordan:k=2,case=N-cons", "ida:suppress=1", 1e-6, 30, 0, 4.5e-6},
  {"jordan:k=2,case=N-cons", "ida:suppress=1", 1e-8, 54, 0, 2.3e-8},
  {"jordan:k=2,case=N-inc", "ida:suppress=1,ic=2", 1e-6, 29, 0.45, 3.6e-6},
  {"jordan:k=2,case=N-inc", "ida:suppress=1,ic=1", 1e-6, 0, NO, NO},
  {"jordan:k=3,case=N-cons", "ida", 1e-6, 0, NO, NO},
  {"jordan:k=3,case=N-cons", "ida:suppress=1,id=index", 1e-6, 25, 0, 2.5e-4},
  {"jordan:k=3,case=N-cons", "ida:suppress=1,id=index", 1e-8, 42, 0, 3.2e-5},
  {"jordan:k=3,case=N-inc", "ida:suppress=1,id=index,ic=2", 1e-6, 30, 2.28, 1.7e-4},
  {"jordan:k=4,case=N-cons", "ida:suppress=1", 1e-6, 0, NO, NO},
  {"jordan:k=4,case=N-cons", "ida:suppress=1,id=index", 1e-6, 29, 0, 9e-3},
  {"jordan:k=4,case=N-cons", "ida:suppress=1,id=index", 1e-8, 49, 0, 4.8e-4},
  {"jordan:k=4,case=N-inc", "ida:suppress=1,id=index,ic=2", 1e-8, 49, 4.75, 1e-4},
  {"switchrlc", "ida", 1e-6, 0, NO, NO},
  {"switchrlc", "ida:suppress=1,ic=2", 1e-6, 105, 2.21, 9.14e-3},
  {"switchrlc", "ida:suppress=1,ic=2", 1e-8, 199, 2.21, 9.15e-3},
  {"switchrlc:case=cons", "ida:suppress=1", 1e-6, 117, NO, NO},
  {"ladder:n=20", "ida:suppress=1,ic=2", 1e-6, 176, 73.7, 44.7},
  {"ladder:n=20,case=cons", "ida", 1e-6, 293, 0, 5.9e-6},
  {"bus:n=60", "ida:suppress=1,ic=1", 1e-6, 215, 0, 1.6e-5},
  {"bus:n=60", "ida:suppress=1", 1e-6, 225, NO, 1.3e-4},
  {"bus:n=60", "ida:ic=2,suppress=1", 1e-6, 0, NO, NO},
  {"pendulum3:index=3", "ida:suppress=1,id=index", 1e-6, 195, 0, 5.1e-2},
  {"pendulum3:index=3", "ida:suppress=1,id=index", 1e-8, 423, 0, 5.8e-5},
  {"pendulum3:index=2", "ida:suppress=1", 1e-6, 216, 0, 2.8e-4},
  {"pendulum3:index=1", "ida:suppress=1", 1e-6, 145, 0, 1e-5},
};

static sunrealtype distance(sunindextype n, const sunrealtype *x, const sunrealtype *y)
{
  sunrealtype most = 0;
  for (sunindextype i = 0; i < n; i++) most = fmax(most, fabs(x[i] - y[i]));
  return most;
}

/* x(0+) and x(t1). */
static int truth(steif_context *ctx, const steif_problem *p, sunrealtype *plus,
                 sunrealtype *end)
{
  const size_t size = (size_t)p->n * sizeof *end;
  memcpy(plus, p->y0, size);
  if (p->exact) {
    N_Vector x = N_VMake_Serial(p->n, end, steif_sundials(ctx));
    const int seen = p->exact(p->t1, x, NULL, p->user);
    N_VDestroy(x);
    if (seen || !p->A) return seen;
  }
  steif_linear l;
  steif_impulse i = {0};
  steif_linear_truth how;
  int code = steif_linear_of(ctx, p, &l);
  if (code) return code;
  code = steif_impulse_find(ctx, l.E, l.F, p->y0, p->t0, l.f, l.user, NULL, NULL, &i);
  if (!code) memcpy(plus, i.x_plus, size);
  if (!code && !p->exact)
    code = steif_linear_exact(ctx, &l, p->y0, p->t0, NULL, 0, NULL, 1, &p->t1, NULL, end, &how);
  steif_impulse_clear(ctx, &i);
  SUNMatDestroy(l.E);
  SUNMatDestroy(l.F);
  return code;
}

static bool near(sunrealtype got, sunrealtype figure, sunrealtype factor, sunrealtype none)
{
  if (figure == NO) return true;
  return figure > 0 ? got <= factor * figure && got >= figure / factor : got <= none;
}

static void run(steif_context *ctx, const expected *e)
{
  steif_problem p;
  sunrealtype plus[MOST], end[MOST];
  steif_options o = steif_defaults();
  o.rtol = e->rtol, o.max_steps = 300000;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, e->problem, &p) && p.n <= MOST);
  CHECK(truth(ctx, &p, plus, end) == STEIF_OK);
  steif_solver *s = steif_solver_new(ctx, &p, e->method, &o);
  const sunrealtype start = s ? distance(p.n, NV_DATA_S(steif_solution(s)), plus) : 0;
  const int code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  const long steps = s ? steif_statistics(s)->steps : 0;
  const sunrealtype error = s ? distance(p.n, NV_DATA_S(steif_solution(s)), end) : 0;
  const bool good = e->steps
                      ? !code && near((sunrealtype)steps, (sunrealtype)e->steps, 1.5, 0) &&
                          near(start, e->start, 3, 1e-9) && near(error, e->end, 3, 1e-13)
                      : code < 0 && code != STEIF_STEP_LIMIT;
  if (!good)
    printf("\n  %s %s %g: code %d, %ld steps, errors %.3g, %.3g", e->problem, e->method,
           e->rtol, code, steps, start, error);
  CU_ASSERT(good);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

static void every_setting_does_what_it_did(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) run(ctx, &rows[i]);
  steif_context_free(&ctx);
}

static void rejected(steif_context *ctx, const char *problem, const char *method,
                     const char *word)
{
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_solver *s = steif_solver_new(ctx, &p, method, NULL);
  CHECK(!s && strstr(steif_message(ctx), word) != NULL);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

static void settings_are_checked(void)
{
  steif_context *ctx = steif_context_new(NULL);
  rejected(ctx, "rober", "ida:id=index", "suppress=1");
  rejected(ctx, "transamp", "ida:suppress=1,id=F", "id=F");
  rejected(ctx, "transamp", "ida:suppress=2", "suppress=2");
  rejected(ctx, "transamp", "ida:ic=3", "ic=3");
  rejected(ctx, "vdpol", "cvode:lmm=bdg", "lmm=bdg");
  rejected(ctx, "vdpol", "cvode:order=6", "order=6");
  rejected(ctx, "vdpol", "cvode:lmm=adams,stald=1", "stald=1");
  steif_context_free(&ctx);
}

/* Not stiff: Adams methods of higher order with fixed-point iteration need fewer steps than BDF and no
 * matrix. */
static void adams_needs_no_matrix(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  long steps[2] = {0};
  static const char *const method[] = {"cvode:lmm=adams", "cvode:stald=1"};
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "harmonic", &p));
  for (int k = 0; k < 2; k++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-10;
    steif_solver *s = steif_solver_new(ctx, &p, method[k], &o);
    sunrealtype scd = 0, mescd = 0;
    CHECK(s && steif_solve_to(s, p.t1) == STEIF_OK);
    CHECK(!steif_problem_digits(ctx, &p, p.t1, steif_solution(s), 1, &scd, &mescd));
    CHECK(mescd > 7);
    steps[k] = steif_statistics(s)->steps;
    CHECK((steif_statistics(s)->nje == 0) == (k == 0));
    steif_solver_free(&s);
  }
  CHECK(steps[0] < steps[1]);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_settings[] = {{"IDA in every setting", every_setting_does_what_it_did},
                                   {"settings are checked", settings_are_checked},
                                   {"Adams methods of CVODE", adams_needs_no_matrix},
                                   CU_TEST_INFO_NULL};
