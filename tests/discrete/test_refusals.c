/* test_refusals.c: what is refused, and what the sentence says.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"
#include <stdlib.h>
#include <string.h>

static void expect(steif_context *ctx, int code, int expected, const char *words)
{
  CHECK(code == expected);
  CHECK(strstr(steif_message(ctx), words) != NULL);
  if (!strstr(steif_message(ctx), words)) printf("\n  '%s'", steif_message(ctx));
}

static void one(double k, const char *scheme, double dt, int code, const char *words)
{
  double A[4];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(k, A);
  steif_discrete d;
  expect(ctx, steif_c2d(ctx, &s, scheme, dt, &d), code, words);
  CHECK(d.memory == NULL);
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

static void steps_and_names(void)
{
  one(4, "zoh", 0, STEIF_BAD_INPUT, "dt = 0");
  one(4, "zoh", -0.25, STEIF_BAD_INPUT, "dt = -0.25");
  one(4, "zoh", NAN, STEIF_BAD_INPUT, "dt = ");
  one(4, "zoh", INFINITY, STEIF_BAD_INPUT, "dt = inf");
  one(4, "zho", 0.1, STEIF_UNKNOWN_NAME, "did you mean 'zoh'");
  one(4, "bilinaer", 0.1, STEIF_UNKNOWN_NAME, "did you mean 'bilinear'");
  one(4, "zoh:w=2", 0.1, STEIF_UNKNOWN_NAME, "no parameter 'w'");
  one(4, "gbt", 0.1, STEIF_BAD_INPUT, "gbt:alpha=");
  one(4, "gbt:alpha=1.5", 0.1, STEIF_BAD_INPUT, "alpha");
  one(4, "bilinear:w=31.5", 0.1, STEIF_BAD_INPUT, "below pi/dt = 31.4159");
  one(4, "bilinear:w=-1", 0.1, STEIF_BAD_INPUT, "w = -1");
  one(4, NULL, 0.1, STEIF_BAD_INPUT, "no scheme");
  one(NAN, "zoh", 0.1, STEIF_NOT_FINITE, "A(2, 1)");
}

static void sizes(void)
{
  static const double A[] = {1, 2, 3, 4}, B[] = {1, 0, 0, 1}, C[] = {1, 1};
  steif_context *ctx = steif_context_new(NULL);
  steif_discrete d;
  steif_state_space s = {.n = 0, .A = A};
  expect(ctx, steif_c2d(ctx, &s, "zoh", 1, &d), STEIF_BAD_INPUT, "0 states");
  s = (steif_state_space){.n = 2, .m = 1, .A = A};
  expect(ctx, steif_c2d(ctx, &s, "zoh", 1, &d), STEIF_BAD_INPUT, "B is NULL: a 2 x 1 array");
  s = (steif_state_space){.n = 2, .m = 2, .p = 1, .A = A, .B = B, .C = C};
  expect(ctx, steif_c2d(ctx, &s, "matched", 1, &d), STEIF_UNSUPPORTED, "one input");
  s = (steif_state_space){.n = 2, .m = 1, .p = 1, .A = A, .B = B, .C = B + 2};
  expect(ctx, steif_c2d(ctx, NULL, "zoh", 1, &d), STEIF_BAD_INPUT, "no system");
  const double diagonal[] = {1, 0, 0, 4};
  s.A = diagonal; /* the input drives state 0, the output shows state 1 */
  expect(ctx, steif_c2d(ctx, &s, "matched", 1, &d), STEIF_BAD_INPUT, "does not reach");
  steif_context_free(&ctx);
}

/* 1 - dt A/2 is singular for A = 2/dt; e^A overflows. */
static void systems(void)
{
  const double fast = 20, huge = 1e6;
  steif_context *ctx = steif_context_new(NULL);
  steif_state_space s = {.n = 1, .A = &fast};
  steif_discrete d;
  double H[2];
  expect(ctx, steif_c2d(ctx, &s, "bilinear", 0.1, &d), STEIF_SINGULAR, "eigenvalue near 20");
  s.A = &huge;
  expect(ctx, steif_c2d(ctx, &s, "zoh", 0.1, &d), STEIF_NOT_FINITE, "range");
  s = (steif_state_space){.n = 1, .m = 1, .p = 1, .A = &fast, .B = &fast, .C = &fast};
  expect(ctx, steif_response(ctx, &s, 20, 0, H), STEIF_SINGULAR, "pole");
  steif_context_free(&ctx);
}

static void logarithms(void)
{
  static const double mirror[] = {-0.5, 0, 0, 0.25}, dead[] = {0, 0, 1, 0};
  double A[4];
  steif_context *ctx = steif_context_new(NULL);
  expect(ctx, steif_d2c(ctx, 2, 0, mirror, NULL, 0.1, A, NULL), STEIF_UNSUPPORTED, "Nyquist");
  CHECK(strstr(steif_message(ctx), "eigenvalue 0 of Ad is -0.5") != NULL);
  expect(ctx, steif_d2c(ctx, 2, 0, dead, NULL, 0.1, A, NULL), STEIF_UNSUPPORTED, "is 0");
  expect(ctx, steif_d2c(ctx, 2, 0, mirror, NULL, -1, A, NULL), STEIF_BAD_INPUT, "dt = -1");
  steif_context_free(&ctx);
}

static int input(double t, double *u, void *user)
{
  *u = t > 0.35 ? NAN : 1;
  return user && t > 0.15;
}

static void runs(void)
{
  double A[4], h[20];
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(4, A);
  steif_discrete d = {0};
  expect(ctx, steif_discrete_run(ctx, &d, NULL, NULL, 0, NULL, 9, h), STEIF_BAD_INPUT, "empty");
  CHECK(steif_c2d(ctx, &s, "averaged", 0.1, &d) == STEIF_OK);
  expect(ctx, steif_discrete_run(ctx, &d, input, NULL, 0, NULL, 9, h), STEIF_NOT_FINITE,
         "t = 0.4");
  expect(ctx, steif_discrete_run(ctx, &d, input, h, 0, NULL, 9, h), STEIF_CALLBACK, "t = 0.2");
  expect(ctx, steif_discrete_run(ctx, &d, input, NULL, 0, NULL, -1, h), STEIF_BAD_INPUT, "-1");
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
}

/* An allocator that fails at its countdown. */
static void *stingy(size_t bytes, void *left)
{
  return (*(int *)left)-- > 0 ? malloc(bytes) : NULL;
}
static void give_back(void *block, void *left) { (void)left, free(block); }

static void memory_may_end_anywhere(void)
{
  static const char *const scheme[] = {"foh", "bilinear", "matched"};
  double A[4];
  const steif_state_space s = oscillator(4, A);
  for (int i = 0; i < 3; i++) {
    int done = 0, tries = 0;
    for (int allowed = 100; !done && tries < 40; tries++) {
      int left = allowed;
      steif_context *ctx = steif_context_new(
        &(steif_setup){.allocate = stingy, .release = give_back, .user = &left});
      steif_discrete d;
      left = tries;
      const int code = steif_c2d(ctx, &s, scheme[i], 0.1, &d);
      CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
      done = code == STEIF_OK;
      steif_discrete_clear(ctx, &d);
      left = allowed;
      steif_context_free(&ctx);
    }
    CHECK(done && tries > 3);
  }
}

CU_TestInfo tests_of_refusals[] = {{"steps and names are checked", steps_and_names},
                                   {"sizes are checked", sizes},
                                   {"systems without a result are named", systems},
                                   {"logarithms at the Nyquist limit are refused", logarithms},
                                   {"runs stop at the input that failed", runs},
                                   {"memory may end anywhere", memory_may_end_anywhere},
                                   CU_TEST_INFO_NULL};
