/* test_bad_fits.c: runs that fail within a fit, what is refused, and memory.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "made_data.h"
#include "suite.h"
#include <steif/collection.h>
#include <steif/model.h>
#include <string.h>

/* x' = a x^2, x(0) = 1 blows up at 1/a: steps to a > 1/1.5 make the run fail. */
static void failing_runs_are_rejected_steps(void)
{
  static const char text[] = "param a = 0.05\nstate x = 1\nx' = a*x^2\ntime 0 to 2\n";
  steif_context *ctx = steif_context_new(NULL);
  double t[] = {1.0, 1.25, 1.5}, value[3], sd[] = {1e-2, 1e-2, 1e-2};
  sunindextype component[] = {0, 0, 0};
  const steif_measurements data = {
    .count = 3, .t = t, .value = value, .sd = sd, .component = component};
  steif_problem p;
  steif_fit fit;
  for (int j = 0; j < 3; j++) value[j] = 1 / (1 - 0.65 * t[j]);
  CHECK(steif_model_parse(ctx, text, "pole", NULL, &p) == STEIF_OK);
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &data, NULL, &fit) == STEIF_OK);
  if (fit.p) {
    CLOSE(fit.p[0], 0.65, 1e-7);
    CHECK(fit.failed > 0 && *fit.failure && strstr(fit.message, "runs failed"));
  }
  steif_fit_free(ctx, &fit);
  const double beyond[] = {0.8};
  const steif_fit_options o = {.start = beyond};
  CHECK(steif_fit_find(ctx, &p, "radau:s=3", &data, &o, &fit) < 0 && !fit.p);
  CHECK(strstr(steif_message(ctx), "t = 1.2") != NULL);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void refused(steif_problem *p, const steif_measurements *data,
                    const steif_fit_options *o, const char *method, int code, const char *part)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_fit fit;
  CHECK(steif_fit_find(ctx, p, method, data, o, &fit) == code && !fit.p);
  const int said = strstr(steif_message(ctx), part) != NULL;
  if (!said) printf("\n  no '%s' in '%s'", part, steif_message(ctx));
  CHECK(said);
  steif_context_free(&ctx);
}

static void bad_input(void)
{
  steif_context *ctx = steif_context_new(NULL);
  static const int twice[] = {1, 1}, far[] = {7};
  static const double low[] = {5, 0, 0, 0}, minus[] = {-1, 1, 1, 1};
  made_data made;
  prey P;
  prey_data(ctx, &made);
  prey_open(&P, 1.6, 0.9, 2.8, 1.1);
  steif_problem *p = &P.problem, bare = P.problem;
  bare.parameters = NULL;
  steif_measurements d = made.data;
  const steif_fit_options two = {.parameter = twice, .count = 2},
                          none = {.parameter = far, .count = 1}, out = {.low = low},
                          log = {.start = minus, .scale = STEIF_FIT_LOG},
                          few = {.evaluations = -1}, unnamed = {.count = 1},
                          negative = {.count = -1}, scale = {.scale = (enum steif_fit_scale)3};
  refused(p, &d, &unnamed, "bdf", STEIF_BAD_INPUT, "options.count = 1 without");
  refused(p, &d, &negative, "bdf", STEIF_BAD_INPUT, "options.count = -1 without");
  refused(p, &d, &scale, "bdf", STEIF_BAD_INPUT, "options.scale = 3");
  refused(&bare, &d, NULL, "bdf", STEIF_BAD_INPUT, "has no parameters");
  refused(p, &d, &two, "bdf", STEIF_BAD_INPUT, "named twice");
  refused(p, &d, &none, "bdf", STEIF_BAD_INPUT, "must lie in 0 .. 3");
  refused(p, &d, &out, "bdf", STEIF_BAD_INPUT, "outside its bounds");
  refused(p, &d, &log, "bdf", STEIF_BAD_INPUT, "linear scale");
  refused(p, &d, &few, "bdf", STEIF_BAD_INPUT, "evaluations = -1");
  refused(p, &d, NULL, "exprb43", STEIF_UNSUPPORTED, "carries no sensitivities");
  refused(p, &d, NULL, "radao", STEIF_UNKNOWN_NAME, "radau");
  d.count = 3;
  refused(p, &d, NULL, "bdf", STEIF_BAD_INPUT, "3 measurements do not determine 4 parameters");
  d.count = 0;
  refused(p, &d, NULL, "bdf", STEIF_BAD_INPUT, "no measurements");
  d = made.data, made.t[3] = 10.5;
  refused(p, &d, NULL, "bdf", STEIF_BAD_INPUT, "measurement 4 at t = 10.5 lies outside");
  made.t[3] = 1, made.sd[5] = 0;
  refused(p, &d, NULL, "bdf", STEIF_BAD_INPUT, "deviation 0 of measurement 6");
  made.sd[5] = 1, made.value[2] = NAN;
  refused(p, &d, NULL, "bdf", STEIF_NOT_FINITE, "measurement 3 is nan");
  steif_context_free(&ctx);
}

static void few_evaluations_leave_the_best(void)
{
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  prey P;
  steif_fit fit;
  prey_data(ctx, &made);
  prey_open(&P, 1.6, 0.9, 2.8, 1.1);
  const steif_fit_options o = {.evaluations = 2};
  CHECK(steif_fit_find(ctx, &P.problem, "radau:s=3", &made.data, &o, &fit) ==
        STEIF_NO_CONVERGENCE);
  CHECK(fit.p && fit.exhausted && fit.chi2 < 1e5);
  CHECK(strstr(steif_message(ctx), "were not enough") != NULL);
  steif_fit_free(ctx, &fit);
  steif_context_free(&ctx);
}

static volatile int stop;
static long steps_left;

static int count_down(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  (void)s, (void)t, (void)y, (void)user;
  if (--steps_left <= 0) stop = 1;
  return 0;
}

/* The later it is stopped, the better is what it keeps; before the end of the first run that is nothing. */
static void a_stopped_search_keeps_its_best(void)
{
  steif_context *ctx = steif_context_new(NULL);
  made_data made;
  prey P;
  steif_fit fit;
  steif_options run = steif_defaults();
  prey_data(ctx, &made);
  prey_open(&P, 1.6, 0.9, 2.8, 1.1);
  run.rtol = 1e-8, run.stop = &stop, run.observe = count_down;
  const steif_fit_options o = {.run = &run};
  double chi2[4] = {INFINITY};
  for (int k = 1; k < 4; k++) {
    steps_left = 2L << (3 * k), stop = 0;
    CHECK(steif_fit_find(ctx, &P.problem, "radau:s=3", &made.data, &o, &fit) == STEIF_STOPPED);
    chi2[k] = fit.p ? fit.chi2 : INFINITY;
    CHECK(chi2[k] <= chi2[k - 1]);
    if (fit.p) {
      sunrealtype sum = 0;
      for (size_t j = 0; j < fit.residuals; j++) sum += fit.residual[j] * fit.residual[j];
      CHECK(fabs(sum - fit.chi2) <= 1e-12 * sum && fit.exhausted == STEIF_STOPPED);
      CHECK(strstr(steif_message(ctx), "the best of") != NULL);
    }
    steif_fit_free(ctx, &fit);
  }
  CHECK(isfinite(chi2[3]) && chi2[3] < chi2[1]);
  steif_context_free(&ctx);
}

static int fit_product(steif_context *ctx)
{
  made_data made;
  steif_problem p;
  steif_fit fit;
  decay(&made, 1.3);
  int code = steif_model_parse(ctx, product, "product", NULL, &p);
  if (code) return code;
  code = steif_fit_find(ctx, &p, "radau:s=3", &made.data, NULL, &fit);
  steif_fit_free(ctx, &fit);
  steif_problem_clear(ctx, &p);
  return code;
}

static void failing_memory_leaks_nothing(void)
{
  failing count = {0};
  steif_setup setup = failing_setup(&count);
  steif_context *ctx = steif_context_new(&setup);
  CHECK(fit_product(ctx) == STEIF_OK);
  steif_context_free(&ctx);
  const long served = count.served, stride = served / 60 + 1;
  for (long k = 1; k <= served; k += k < 40 ? 1 : stride) {
    failing f = {.refuse_at = k};
    setup = failing_setup(&f);
    ctx = steif_context_new(&setup);
    const int code =
      ctx ? fit_product(ctx) : STEIF_NO_MEMORY; /* estimates beside a run are dispensable */
    CHECK(code == STEIF_NO_MEMORY || code == STEIF_OK);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
}

CU_TestInfo tests_of_bad_fits[] = {
  {"failing runs are rejected steps", failing_runs_are_rejected_steps},
  {"bad input", bad_input},
  {"few evaluations leave the best", few_evaluations_leave_the_best},
  {"a stopped search keeps its best", a_stopped_search_keeps_its_best},
  {"failing memory leaks nothing", failing_memory_leaks_nothing},
  CU_TEST_INFO_NULL};
