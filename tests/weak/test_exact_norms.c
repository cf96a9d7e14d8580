/* test_exact_norms.c: norms in H^-m in many digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/broken.h"
#include "base/failing.h"

/* Backward Euler on N x' + x = 0 from the last unit vector, index k: x_1 is a backward difference of order
 * n - 1 = k - 2 of the density 1/h on one step, up to its sign, and I (difference / h) a mean over h: the
 * (k - 1)-fold integral is the distribution function F of a sum of n uniform numbers on (0, h), that of the
 * exact impulse a unit step. So the norm in H^-(k-1) is (h J_n)^(1/2),
 *   J_n = int (1 - F(u h))^2 du = E min(S, S'), of two such sums on (0, 1),
 * which is rational (Irwin-Hall). */
static const struct {
  int k;
  double J;
} hall[] = {{2, 1.0 / 3},
            {3, 23.0 / 30},
            {4, 1021.0 / 840},
            {6, 1703617.0 / 798336},
            {9, 6554066435311.0 / 1852538688000.0},
            {11, 4.483667389793383},
            {12, 4.9585908872125284}};

static void norms_of_impulses_by_probability(void)
{
  for (size_t i = 0; i < sizeof hall / sizeof *hall; i++) {
    const int k = hall[i].k;
    sunrealtype x0[12] = {0};
    steif_ball_row row[3];
    steif_weak_ball ball;
    steif_context *ctx = steif_context_new(NULL);
    steif_linear l = {SUNDenseMatrix(k, k, steif_sundials(ctx)),
                      SUNDenseMatrix(k, k, steif_sundials(ctx)), NULL, NULL};
    for (int m = 0; m < k; m++) SM_ELEMENT_D(l.F, m, m) = 1;
    for (int m = 0; m + 1 < k; m++) SM_ELEMENT_D(l.E, m, m + 1) = 1;
    x0[k - 1] = 1;
    const steif_weak_query q = {.method = "be",
                                .linear = &l,
                                .x0 = x0,
                                .convention = STEIF_R,
                                .h = 1.0 / 256,
                                .rows = 3,
                                .exact = 1};
    CHECK(!steif_weak_measure_ball(ctx, &q, k > 2 ? k - 1 : 1, row, &ball));
    CHECK(ball.converges == 1);
    for (int j = 0; j < 3; j++) CLOSE(row[j].norm, sqrt(row[j].h * hall[i].J), 1e-12);
    CHECK(fabs(row[2].order - 0.5) < 1e-9 && row[2].rounding < 1e-12);
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
    steif_context_free(&ctx);
  }
}

/* Where double has digits both agree within the rounding that it prints; all conventions, stages whose nodes
 * do not ascend (hw43), restarts at a break. */
static void norms_are_those_in_double(void)
{
  static const struct {
    const char *method, *start;
    enum steif_convention convention;
  } known[] = {{"be", NULL, STEIF_P},
               {"be", NULL, STEIF_R},
               {"radau:s=3", NULL, STEIF_STAGE},
               {"dirk:hw43", NULL, STEIF_STAGE},
               {"bdf:p=2", "cq", STEIF_C},
               {"gauss:s=2", NULL, STEIF_STAGE}};
  for (int i = 0; i < 12; i++) {
    steif_ball_row row[2], exact[2];
    steif_weak_ball ball;
    broken_system s;
    broken_open(&s, 3,
                i < 6 ? "cos(t);exp(t);sin(t)" : "0;1;step(t-0.3)+cos(t)+step(t-0.6180339887)");
    s.x0[0] = 1, s.x0[2] = 2;
    steif_weak_query q = {.method = known[i % 6].method,
                          .start = known[i % 6].start,
                          .linear = &s.linear,
                          .x0 = s.x0,
                          .convention = known[i % 6].convention,
                          .component = i % 2 ? STEIF_ALL : 0,
                          .rows = 2,
                          .cells = 8,
                          .break_count = s.count,
                          .breaks = s.breaks};
    CHECK(!steif_weak_measure_ball(s.ctx, &q, 4, row, &ball));
    q.exact = 1;
    CHECK(!steif_weak_measure_ball(s.ctx, &q, 4, exact, &ball) && (i < 6) == !*ball.mesh);
    for (int j = 0; j < 2; j++) {
      CHECK(fabs(row[j].norm - exact[j].norm) <= row[j].rounding + exact[j].rounding);
      CHECK(fabs(row[j].splines - exact[j].splines) <= row[j].rounding + exact[j].rounding);
    }
    broken_close(&s);
  }
}

/* N-inc: cos(t + m) from (1, .., k). At k = 11 double has one norm above rounding; Gauss grows like h^-3 in
 * H^-4 at k = 5 and converges from H^-8 on. */
static void what_rounding_hides_is_decided(void)
{
  steif_ball_row row[4];
  steif_weak_ball ball;
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_query q = {.method = "be",
                        .problem = "jordan:k=11,case=N-inc",
                        .convention = STEIF_R,
                        .h = 1.0 / 64,
                        .rows = 4};
  CHECK(!steif_weak_measure_ball(ctx, &q, 11, row, &ball) && ball.converges == -1);
  CHECK(strstr(ball.verdict, ".exact") != NULL);
  q.exact = 1;
  CHECK(!steif_weak_measure_ball(ctx, &q, 11, row, &ball) && ball.converges == 1);
  CHECK(fabs(row[3].order - 1) < 0.02 && ball.space[0].m == 10);
  CHECK(fabs(ball.space[0].order - 0.5) < 0.02);
  q.method = "gauss:s=3", q.problem = "jordan:k=5,case=N-inc", q.convention = STEIF_STAGE;
  CHECK(!steif_weak_measure_ball(ctx, &q, 8, row, &ball) && ball.converges == 1);
  for (int i = 0; i < 6; i++) /* H^-4 .. H^-9 */
    CHECK(fabs(ball.space[i].order - (i - 3)) < 0.05 && ball.space[i].converges == (i > 3));
  steif_context_free(&ctx);
}

/* E = S N S^-1 in doubles is nilpotent to rounding only. */
static void rounded_structures_are_refused(void)
{
  steif_ball_row row[3];
  steif_weak_ball ball;
  broken_system s;
  const double c = cos(1), d = sin(1);
  broken_open(&s, 2, "0;cos(t)");
  SM_ELEMENT_D(s.linear.E, 0, 0) = -c * d, SM_ELEMENT_D(s.linear.E, 0, 1) = c * c;
  SM_ELEMENT_D(s.linear.E, 1, 0) = -d * d, SM_ELEMENT_D(s.linear.E, 1, 1) = c * d;
  steif_weak_query q = {.method = "be",
                        .linear = &s.linear,
                        .x0 = s.x0,
                        .convention = STEIF_R,
                        .rows = 3,
                        .component = STEIF_ALL};
  CHECK(!steif_weak_measure_ball(s.ctx, &q, 2, row, &ball) && ball.converges == 1);
  q.exact = 1;
  CHECK(steif_weak_measure_ball(s.ctx, &q, 2, row, &ball) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(s.ctx), "to the last bit") != NULL);
  broken_close(&s);
}

static int short_of_memory(const char *method, enum steif_convention convention, long at)
{
  failing f = {.refuse_at = 0};
  const steif_setup setup = failing_setup(&f);
  steif_ball_row row[1];
  steif_weak_ball ball;
  steif_context *ctx = steif_context_new(&setup);
  f.refuse_at = f.served + at;
  const steif_weak_query q = {.method = method,
                              .problem = "jordan:k=2",
                              .convention = convention,
                              .h = 0.25,
                              .rows = 1,
                              .exact = 1};
  const int code = steif_weak_measure_ball(ctx, &q, 2, row, &ball);
  CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
  steif_context_free(&ctx);
  CHECK(f.alive == 0);
  return code;
}

static void memory_may_fail(void)
{
  for (int i = 0; i < 2; i++) {
    long at = 1;
    while (at < 9000 &&
           short_of_memory(i ? "be" : "radau:s=2", i ? STEIF_R : STEIF_STAGE, at) != STEIF_OK)
      at++;
    CHECK(at > 10 && at < 9000);
  }
}

CU_TestInfo tests_of_exact_norms[] = {
  {"norms of impulses are those of probability", norms_of_impulses_by_probability},
  {"where double has digits both agree", norms_are_those_in_double},
  {"what rounding hides is decided", what_rounding_hides_is_decided},
  {"rounded structures are refused", rounded_structures_are_refused},
  {"memory may fail", memory_may_fail},
  CU_TEST_INFO_NULL};
