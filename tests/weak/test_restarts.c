/* test_restarts.c: runs that begin anew at breaks of f, where no equal steps hold them all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/broken.h"

/* Two breaks in no rational ratio, and t1 = 1: no equal steps hold them. */
#define FIRST "0.31415926535897931"
#define SECOND "0.71828182845904523"
static const double first = 0.31415926535897931, second = 0.71828182845904523;

static steif_weak_query query_of(const broken_system *s, const char *method,
                                 enum steif_convention convention, const char *start,
                                 size_t rows)
{
  return (steif_weak_query){.method = method,
                            .linear = &s->linear,
                            .x0 = s->x0,
                            .convention = convention,
                            .start = start,
                            .rows = rows,
                            .break_count = s->count,
                            .breaks = s->breaks};
}

/* N x' + x = f by backward Euler, step by step: x_i = f_i - N (x_i - x_{i-1}) / h, component by component
 * from the last, h changing at breaks; f = the last component alone, a jump at each break. */
static double euler_by_hand(int k, const double *end, const int *steps, int segments)
{
  double x[4] = {0}, sum = 0, t = 0;
  for (int s = 0; s < segments; s++) {
    const double from = s ? end[s - 1] : 0, h = (end[s] - from) / steps[s];
    for (int i = 1; i <= steps[s]; i++) {
      const double before[4] = {x[0], x[1], x[2], x[3]};
      x[k - 1] = s;
      for (int m = k - 2; m >= 0; m--) x[m] = -(x[m + 1] - before[m + 1]) / h;
      const double next = from + i * h;
      sum += x[0] * (pow(1 - t, 9) - pow(fmax(0, 1 - next), 9)) / 9;
      t = next;
    }
  }
  return sum;
}

static void euler_is_that_by_hand(void)
{
  const double end[] = {first, second, 1};
  for (int k = 2; k <= 4; k++) {
    char f[96];
    steif_weak_row row[3];
    steif_weak_result result;
    broken_system s;
    snprintf(f, sizeof f, "%sstep(t-" FIRST ")+step(t-" SECOND ")", &"0;0;0;"[2 * (4 - k)]);
    broken_open(&s, k, f);
    const steif_weak_query q = query_of(&s, "be", STEIF_R, NULL, 3);
    CHECK(!steif_weak_measure(s.ctx, &q, row, &result));
    CHECK(strstr(result.mesh, "21 steps of 0.015 to t = 0.314159, 26 steps") != NULL);
    CLOSE(row[0].h, (second - first) / 26, 1e-14);
    for (int i = 0, n = 1; i < 3; i++, n *= 2)
      CLOSE(row[i].value, euler_by_hand(k, end, (int[]){21 * n, 26 * n, 19 * n}, 3), 1e-10);
    broken_close(&s);
  }
}

/* f_k = a jump, a kink and what is smooth; exact values from the closed solution by the pairing, which
 * test_breaks.c holds to 13 digits. Order s + 2 - k of Radau IIA, p of convolution quadrature, as on a mesh. */
static void orders_off_the_mesh(void)
{
  static const struct {
    const char *method, *start;
    int k, order;
  } known[] = {{"be", NULL, 2, 1},        {"be", NULL, 3, 1},        {"be", NULL, 4, 1},
               {"radau:s=2", NULL, 2, 2}, {"radau:s=2", NULL, 3, 1}, {"radau:s=2", NULL, 4, 0},
               {"radau:s=3", NULL, 2, 3}, {"radau:s=3", NULL, 3, 2}, {"gauss:s=2", NULL, 3, 0},
               {"bdf:p=2", "cq", 2, 2},   {"bdf:p=2", "cq", 3, 2},   {"bdf:p=3", "cq", 2, 3},
               {"bdf:p=3", "cq", 4, 3},   {"bdf:p=4", "cq", 3, 4}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    char f[128];
    steif_weak_row row[5];
    steif_weak_result r;
    broken_system s;
    snprintf(f, sizeof f, "%scos(t)+step(t-" FIRST ")*t+2*ramp(t-" SECOND ")",
             &"0;0;0;"[2 * (4 - known[i].k)]);
    broken_open(&s, known[i].k, f);
    const enum steif_convention reading = known[i].start              ? STEIF_C
                                          : known[i].method[0] == 'b' ? STEIF_R
                                                                      : STEIF_STAGE;
    const steif_weak_query q = query_of(&s, known[i].method, reading, known[i].start, 5);
    CHECK(!steif_weak_measure(s.ctx, &q, row, &r));
    CHECK(r.converges == (known[i].order > 0) && *r.mesh);
    CHECK(fabs(row[3].order - known[i].order) < 0.1);
    broken_close(&s);
  }
}

/* f_k = step(t - 1/2) cos(t - 1/2), h = 1/32 .. 1/256: the jump as a source of its own from 1/2 on, in
 * 113-bit arithmetic; exact values by 40-digit quadrature. */
static void quadrature_begins_anew_on_the_mesh(void)
{
  static const struct {
    const char *method, *f;
    int k;
    double exact, first, last;
  } known[] = {
    {"bdf:p=2", "0;step(t-1/2)*cos(t-1/2)", 2, -.0038954198279138, 1.45769e-4, 3.16601e-6},
    {"bdf:p=3", "0;step(t-1/2)*cos(t-1/2)", 2, -.0038954198279138, 4.27057e-5, 1.22856e-7},
    {"bdf:p=4", "0;step(t-1/2)*cos(t-1/2)", 2, -.0038954198279138, 1.08001e-5, 3.98834e-9},
    {"bdf:p=3", "0;0;step(t-1/2)*cos(t-1/2)", 3, .062283478535029, -1.05003e-3, -2.73351e-6},
    {"bdf:p=4", "0;0;step(t-1/2)*cos(t-1/2)", 3, .062283478535029, -2.11379e-4, -6.94242e-8}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    steif_weak_row row[4];
    steif_weak_result r;
    broken_system s;
    broken_open(&s, known[i].k, known[i].f);
    steif_weak_query q = query_of(&s, known[i].method, STEIF_C, "cq", 4);
    q.h = 1.0 / 32;
    CHECK(!steif_weak_measure(s.ctx, &q, row, &r) && r.converges == 1);
    CLOSE(r.exact, known[i].exact, 1e-12);
    CLOSE(row[0].error, known[i].first, 1e-5);
    CLOSE(row[3].error, known[i].last, 1e-5);
    broken_close(&s);
  }
}

/* On a mesh that holds the break a one-step method does the same with and without; in many digits and in
 * double within the rounding that is printed. */
static void restarts_change_nothing_on_the_mesh(void)
{
  static const char *const method[] = {"be", "radau:s=2", "radau:s=3", "gauss:s=2"};
  for (int i = 0; i < 4; i++) {
    steif_weak_row plain[3], anew[3], exact[3];
    steif_weak_result r;
    broken_system s;
    broken_open(&s, 3, "0;cos(t);step(t-1/4)*exp(t)");
    steif_weak_query q = query_of(&s, method[i], i ? STEIF_STAGE : STEIF_R, NULL, 3);
    q.h = 1.0 / 32;
    CHECK(!steif_weak_measure(s.ctx, &q, plain, &r) && !*r.mesh);
    q.restart = 1;
    CHECK(!steif_weak_measure(s.ctx, &q, anew, &r) && *r.mesh);
    q.exact = 1;
    CHECK(!steif_weak_measure(s.ctx, &q, exact, &r) && *r.mesh);
    for (int j = 0; j < 3; j++) {
      CHECK(anew[j].h == plain[j].h);
      CHECK(fabs(anew[j].value - plain[j].value) <= anew[j].rounding + plain[j].rounding);
      CHECK(fabs(anew[j].value - exact[j].value) <= anew[j].rounding + exact[j].rounding);
    }
    broken_close(&s);
  }
}

/* Convolution quadrature and Radau IIA in many digits, off every mesh. */
static void many_digits_agree(void)
{
  for (int i = 0; i < 2; i++) {
    steif_weak_row row[2], exact[2];
    steif_weak_result r;
    broken_system s;
    broken_open(&s, 3, "0;step(t-" FIRST ");cos(t)+step(t-" SECOND ")");
    steif_weak_query q =
      query_of(&s, i ? "bdf:p=3" : "radau:s=3", i ? STEIF_C : STEIF_STAGE, i ? "cq" : NULL, 2);
    CHECK(!steif_weak_measure(s.ctx, &q, row, &r));
    q.exact = 1;
    CHECK(!steif_weak_measure(s.ctx, &q, exact, &r) && *r.mesh);
    for (int j = 0; j < 2; j++)
      CHECK(fabs(row[j].value - exact[j].value) <= row[j].rounding + exact[j].rounding);
    broken_close(&s);
  }
}

/* Backward Euler: the impulse -delta at a break is the density -1/h' of the first step h' behind it, so that
 * I e = 1 - s/h' there: norms in H^-1 are (sum of h'/3)^(1/2) over both breaks. */
static void norms_by_hand(void)
{
  steif_ball_row row[4];
  steif_weak_ball ball;
  broken_system s;
  broken_open(&s, 2, "0;step(t-" FIRST ")+step(t-" SECOND ")");
  const steif_weak_query q = query_of(&s, "be", STEIF_R, NULL, 4);
  CHECK(!steif_weak_measure_ball(s.ctx, &q, 1, row, &ball));
  CHECK(ball.converges == 1 && *ball.mesh);
  for (int j = 0, n = 1; j < 4; j++, n *= 2)
    CLOSE(row[j].norm, sqrt(((second - first) / 26 + (1 - second) / 19) / n / 3), 1e-12);
  CHECK(fabs(row[3].order - 0.5) < 1e-6);
  broken_close(&s);
}

static void refusals_say_why(void)
{
  steif_weak_row row[3];
  steif_weak_result r;
  broken_system s;
  broken_open(&s, 2, "0;step(t-" FIRST ")+step(t-" SECOND ")");
  steif_weak_query q = query_of(&s, "bdf:p=2", STEIF_R, NULL, 3);
  CHECK(!steif_weak_measure(s.ctx, &q, row, &r) && r.converges == -1 && !*r.mesh);
  CHECK(strstr(r.verdict, "inside a step") != NULL &&
        strstr(r.verdict, ".start = \"cq\"") != NULL);
  q.restart = 1;
  CHECK(steif_weak_measure(s.ctx, &q, row, &r) == STEIF_UNSUPPORTED);
  q.method = "be", q.restart = 0, q.h = 1.0 / 64;
  CHECK(!steif_weak_measure(s.ctx, &q, row, &r) && r.converges == -1 && isnan(row[2].order));
  CHECK(strstr(r.verdict, "let steps end there (.restart)") != NULL);
  const sunrealtype near[] = {0.3, 0.3 + 1e-9};
  q.breaks = near, q.restart = 1;
  CHECK(steif_weak_measure(s.ctx, &q, row, &r) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(s.ctx), "no room for steps") != NULL);
  broken_close(&s);
}

CU_TestInfo tests_of_restarts[] = {
  {"backward Euler is that by hand", euler_is_that_by_hand},
  {"orders off every mesh are those on one", orders_off_the_mesh},
  {"convolution quadrature begins anew on a mesh, too", quadrature_begins_anew_on_the_mesh},
  {"on a mesh one-step methods do the same", restarts_change_nothing_on_the_mesh},
  {"many digits agree", many_digits_agree},
  {"norms are those by hand", norms_by_hand},
  {"refusals say why", refusals_say_why},
  CU_TEST_INFO_NULL};
