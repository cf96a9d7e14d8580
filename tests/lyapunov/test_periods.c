/* test_periods.c: a period of A(t) that nobody has told is found where every entry comes back, and nowhere
 * else; one that was told is tested. Truths: x' = a(t) x decays at the mean of a, which is that of its
 * closed integral: mean of e^{c cos} = I_0(c), of 1/(1.25 + cos) = 1/sqrt(1.25^2 - 1) = 4/3.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/steif.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const double pi = 3.14159265358979323846;

/* a(t) = -1 + shape(2 pi t/period) + share second(t). */
typedef struct wave {
  int shape, second;
  double period, share;
} wave;
enum { COSINE, SHARP, PEAKS, FIFTH, NOTHING };
enum { NONE, ROOT, NEAR, DRIFT, FADES, THIRD, CHIRP };

static double shape_at(const wave *s, double t)
{
  const double u = 2 * pi * t / s->period;
  switch (s->shape) {
  case COSINE: return 2 * cos(u);
  case SHARP: return exp(3 * (cos(u) - 1));
  case PEAKS: return 0.5 / (1.25 + cos(u));
  case FIFTH: return cos(5 * u) + sin(u);
  default: return 0;
  }
}

static double second_at(const wave *s, double t)
{
  const double u = 2 * pi * t / s->period;
  switch (s->second) {
  case ROOT: return cos(sqrt(2) * u);
  case NEAR: return cos((1 + 1e-8) * u);
  case DRIFT: return t;
  case FADES: return exp(-t);
  case THIRD: return cos(u / 3);
  case CHIRP: return cos(u * (1 + 1e-5 * t));
  default: return 0;
  }
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector u,
               N_Vector v, N_Vector w)
{
  const wave *s = user;
  (void)y, (void)fy, (void)u, (void)v, (void)w;
  SM_ELEMENT_D(J, 0, 0) = -1 + shape_at(s, t) + s->share * second_at(s, t);
  SM_ELEMENT_D(J, 0, 1) = 0.25 * shape_at(s, t);
  SM_ELEMENT_D(J, 1, 1) = -4;
  return 0;
}

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const wave *s = user;
  const double *x = NV_DATA_S(y), a = -1 + shape_at(s, t) + s->share * second_at(s, t);
  NV_Ith_S(r, 0) = a * x[0] + 0.25 * shape_at(s, t) * x[1];
  NV_Ith_S(r, 1) = -4 * x[1];
  return 0;
}

static int judge(steif_context *ctx, wave *s, const char *method, double h, double told,
                 steif_decay *d)
{
  static const double y0[] = {1, 1};
  const steif_problem p = {
    .name = "wave", .n = 2, .t1 = 120, .y0 = y0, .f = f, .jac = jac, .user = s};
  const steif_lyapunov_options o = {.h = h, .linear = 1};
  return steif_decay_find(ctx, &p, method, &o, told, 0, d);
}

static void periods_are_found(void)
{
  static const struct {
    wave s;
    double h, period, lambda;
  } rows[] = {{{COSINE, NONE, 0.1, 0}, 0.03, 0.1, -1},
              {{COSINE, NONE, 0.31415926, 0}, 0.01, 0.31415926, -1},
              {{COSINE, NONE, 37, 0}, 0.05, 37, -1},
              /* e^{-3} I_0(3): Abramowitz and Stegun, table 9.8 */
              {{SHARP, NONE, 2, 0}, 0.02, 2, -1 + 0.2430003541618254},
              {{PEAKS, NONE, 2, 0}, 0.02, 2, -1 + 2. / 3},
              {{FIFTH, NONE, 5, 0}, 0.02, 5, -1},
              {{COSINE, THIRD, 1, 0.5}, 0.02, 3, -1}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    wave s = rows[i].s;
    steif_decay d = {0};
    CHECK(judge(ctx, &s, "radau:s=3", rows[i].h, 0, &d) == STEIF_OK);
    CHECK(d.found && d.periodic && strstr(d.sentence, "all entries of A come back") != NULL);
    CLOSE(d.period, rows[i].period, 1e-11);
    CLOSE(d.lambda, rows[i].lambda, 1e-9);
  }
  steif_context_free(&ctx);
}

/* Sums without a common period, a drift of 1e-9 in the run, a beginning that fades. */
static void what_does_not_come_back_has_none(void)
{
  static const wave rows[] = {
    {COSINE, ROOT, 1, 1},      {COSINE, ROOT, 1, 1e-8}, {COSINE, NEAR, 1, 1},
    {COSINE, DRIFT, 1, 1e-11}, {SHARP, FADES, 1, 1},    {NOTHING, CHIRP, 1, 1},
    {NOTHING, NONE, 1, 0},     {COSINE, NONE, 50, 0},   {NOTHING, DRIFT, 1, 1e-3}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    wave s = rows[i];
    steif_decay d = {0};
    CHECK(judge(ctx, &s, "be", 0.05, 0, &d) == STEIF_OK);
    CHECK(!d.found && !d.periodic && d.period == 0 && d.turns == 0);
  }
  steif_context_free(&ctx);
}

/* Radau IIA of order 3 on -1 + 2 cos 20 pi t: bad steps lie just above 0.0995, in a hole that steps in a ratio
 * of 2^(1/24) pass over. The border by products of maps in another program: 0.0995. */
static void holes_near_the_period_are_seen(void)
{
  wave s = {COSINE, NONE, 0.1, 0};
  steif_decay d = {0};
  steif_context *ctx = steif_context_new(NULL);
  CHECK(judge(ctx, &s, "radau:s=2", 0.2, 0, &d) == STEIF_OK);
  CHECK(d.found && d.turns == 2 && d.parts == 1 && d.h_good < 0.0996 && d.h_good > 0.098);
  CHECK(d.verdict == STEIF_DECAY_LOST && strstr(d.sentence, "they decay for h below 0.099"));
  /* Without a period nothing is said of steps that were not tried. */
  s.second = ROOT, s.share = 0.5;
  CHECK(judge(ctx, &s, "radau:s=2", 0.2, 0, &d) == STEIF_OK && !d.found);
  CHECK(!strstr(d.sentence, "for h below"));
  steif_context_free(&ctx);
}

static void a_period_that_is_none_is_refused(void)
{
  static const double y0[] = {1, 1};
  wave s = {COSINE, NONE, 0.1, 0};
  steif_decay d = {0};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {
    .name = "wave", .n = 2, .t1 = 5, .y0 = y0, .f = f, .jac = jac, .user = &s};
  double exponent[2], error[2];
  const steif_lyapunov_options o = {.h = 0.005, .linear = 1, .error = error};
  steif_lyapunov_facts facts;
  steif_lyapunov_check check[4];
  int count;
  CHECK(judge(ctx, &s, "be", 0.035, 0.07, &d) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "0.07 is not a period of 'wave'") != NULL);
  CHECK(judge(ctx, &s, "be", 0.02, 0.2, &d) == STEIF_OK && d.periodic && !d.found);
  CLOSE(d.lambda, -1, 1e-9);
  CHECK(steif_lyapunov(ctx, &p, "be", &o, exponent, NULL, &facts) == STEIF_OK);
  CHECK(steif_lyapunov_verify(ctx, &p, "be", &o, 0, 0.1, exponent, &facts, check, &count) ==
        STEIF_OK);
  CHECK(steif_lyapunov_verify(ctx, &p, "be", &o, 0, 0.07, exponent, &facts, check, &count) ==
        STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

static void short_memory_is_told(void)
{
  wave s = {COSINE, NONE, 1, 0};
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code != STEIF_OK && k < 1000; k++) {
    failing mine = {0};
    const steif_setup setup = failing_setup(&mine);
    steif_context *ctx = steif_context_new(&setup);
    steif_decay d;
    mine.refuse_at = mine.served + k;
    code = judge(ctx, &s, "gauss:s=1", 0.05, 0, &d);
    CHECK(code == STEIF_OK ? d.found : code == STEIF_NO_MEMORY);
    steif_context_free(&ctx);
    CHECK(mine.alive == 0);
  }
  CHECK(code == STEIF_OK);
}

CU_TestInfo tests_of_periods[] = {
  {"periods are found", periods_are_found},
  {"what does not come back has none", what_does_not_come_back_has_none},
  {"holes near the period are seen", holes_near_the_period_are_seen},
  {"a period that is none is refused", a_period_that_is_none_is_refused},
  {"short memory is told", short_memory_is_told},
  CU_TEST_INFO_NULL};
