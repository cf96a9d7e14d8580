/* test_norm.c: norms of weak errors in H^-m, orders there, and that they bound every test function.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "weak/data.h"
#include <sunmatrix/sunmatrix_dense.h>

/* N-inc, component 1, [0, 1]: norms at h = 1/64 and 1/512 and the order between 1/256 and 1/512 for
 * m = k - 1, .., k + 2, by m-fold integration in 113-bit arithmetic, printed to five digits or more. */
static const struct row {
  const char *method, *start;
  enum steif_convention convention;
  int k;
  double coarse[4], fine[4], order[4];
} rows[] = {
  {"be",
   NULL,
   STEIF_R,
   2,
   {.17443062, .020072023, .011238274, .0042632991},
   {.061651616, .0025140934, .0014132204, 5.3865e-4},
   {.500, 1.000, .999, .998}},
  {"be",
   NULL,
   STEIF_R,
   3,
   {.43556016, .05194143, .03120569, .012427062},
   {.15434747, .0065317261, .003948258, .0015852919},
   {.500, .999, .998, .996}},
  {"be",
   NULL,
   STEIF_R,
   4,
   {.63683927, .075909696, .046882091, .019304302},
   {.22654533, .0095714326, .0059572594, .0024831975},
   {.499, .998, .997, .994}},
  {"be",
   NULL,
   STEIF_R,
   5,
   {.7528252, .097721859, .060194691, .024848749},
   {.26911191, .012350275, .0076803928, .0032216048},
   {.498, .998, .996, .993}},
  {"bdf:p=2",
   "cq",
   STEIF_C,
   2,
   {.019386001, 1.8267431e-4, 5.6046e-5, 2.8023e-5},
   {.0065463732, 7.4294848e-6, 8.8387e-7, 4.4728e-7},
   {.510, 1.518, 1.998, 1.996}},
  {"bdf:p=2",
   "cq",
   STEIF_C,
   3,
   {.28849056, .0025463645, 3.4750686e-4, 2.0580e-4},
   {.1019907, 1.1241187e-4, 5.4567531e-6, 3.2638e-6},
   {.500, 1.500, 1.999, 1.997}},
  {"bdf:p=2",
   "cq",
   STEIF_C,
   4,
   {.5661391, .0056769472, 5.2436765e-4, 3.2690e-4},
   {.2001731, 2.5132455e-4, 8.2103e-6, 5.1691e-6},
   {.500, 1.500, 2.000, 1.998}},
  {"bdf:p=3",
   "cq",
   STEIF_C,
   3,
   {.35105587, .0024293009, 2.8625513e-5, 4.1340677e-6},
   {.12409962, 1.0732298e-4, 1.5794e-7, 8.1346e-9},
   {.500, 1.500, 2.500, 2.998}},
  {"bdf:p=2",
   "ramp",
   STEIF_R,
   3,
   {73.931557, 28.850734, 8.1881695, 1.8184579},
   {589.93576, 228.70347, 64.492404, 14.232985},
   {-.999, -.998, -.997, -.995}},
  {"bdf:p=2",
   "constant",
   STEIF_R,
   3,
   {.49004414, .0050119556, 9.3246e-4, 4.1574e-4},
   {.17335674, 3.1673e-4, 7.0953e-5, 1.8014e-5},
   {.500, 1.252, 1.106, 1.333}},
  {"radau:s=2",
   NULL,
   STEIF_STAGE,
   3,
   {.41769872, .061745104, .035333651, .0135319},
   {.1478914, .0077836248, .0044889135, .0017360996},
   {.499, .998, .997, .995}},
  {"radau:s=3",
   NULL,
   STEIF_STAGE,
   3,
   {.342081, .0014809178, 9.7719168e-5, 5.6279e-5},
   {.12103847, 6.5499917e-5, 1.5226617e-6, 8.7884e-7},
   {.500, 1.500, 2.001, 2.000}},
  {"radau:s=3",
   NULL,
   STEIF_STAGE,
   4,
   {1.040136, .029532399, .015688055, .0057784486},
   {.3681116, .0036427752, .0020815961, 8.0143e-4},
   {.500, 1.003, .988, .979}},
  {"radau:s=3",
   NULL,
   STEIF_STAGE,
   5,
   {39.58081, 22.289717, 8.4868389, 2.3499775},
   {39.612673, 22.799709, 8.8120045, 2.4773523},
   {-.000, -.005, -.008, -.011}},
};

static int measure(steif_context *ctx, const struct row *r, const char *kind, int m,
                   steif_ball_row *row, steif_weak_ball *result)
{
  char problem[48];
  snprintf(problem, sizeof problem, "jordan:k=%d,case=%s", r->k, kind);
  const steif_weak_query query = {.method = r->method,
                                  .problem = problem,
                                  .convention = r->convention,
                                  .start = r->start,
                                  .h = 1.0 / 64,
                                  .rows = 4};
  const int code = steif_weak_measure_ball(ctx, &query, m, row, result);
  if (code) printf("\n  %s on %s: %s", r->method, problem, steif_message(ctx));
  return code;
}

static void norms_and_orders(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int j = 0; j < 4; j++) {
      const struct row *r = rows + i;
      const int m = r->k - 1 + j;
      steif_ball_row row[4];
      steif_weak_ball result;
      CHECK(!measure(ctx, r, "N-inc", m, row, &result));
      CLOSE(row[0].norm, r->coarse[j], 3e-5 + 4 * row[0].rounding / r->coarse[j]);
      CLOSE(row[3].norm, r->fine[j], 3e-5 + 4 * row[3].rounding / r->fine[j]);
      CHECK(fabs(row[3].order - r->order[j]) < 1.5e-3);
      CHECK(row[3].usable && result.m == m && result.index == r->k);
    }
  steif_context_free(&ctx);
}

/* Order min(p, m - k + 3/2) of methods with weak order p for every k. */
static void orders_by_the_width_of_the_layer(void)
{
  static const struct {
    struct row of;
    int p;
  } known[] = {{{.method = "be", .convention = STEIF_R}, 1},
               {{.method = "bdf:p=2", .start = "cq", .convention = STEIF_C}, 2},
               {{.method = "bdf:p=3", .start = "cq", .convention = STEIF_C}, 3}};
  steif_context *ctx = steif_context_new(NULL);
  for (int i = 0; i < 3; i++)
    for (int k = 2; k <= 4; k++) {
      struct row r = known[i].of;
      steif_ball_row row[4];
      steif_weak_ball result;
      r.k = k;
      CHECK(!measure(ctx, &r, "N-inc", 0, row, &result));
      CHECK(result.m == k + known[i].p - 1 && result.converges == 1);
      for (int j = 0; j < result.count; j++) {
        const steif_ball_space *s = result.space + j;
        CHECK(s->converges == 1);
        CHECK(fabs(s->order - fmin(known[i].p, s->m - k + 1.5)) < 0.025);
      }
    }
  steif_context_free(&ctx);
}

static void verdicts_hold_for_every_function(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_ball_row row[4];
  steif_weak_ball result;
  struct row r = {.method = "radau:s=3", .convention = STEIF_STAGE, .k = 5};
  CHECK(!measure(ctx, &r, "N-inc", 6, row, &result) && result.converges == 0);
  CHECK(!strncmp(result.verdict, "does not converge in any H^-m up to 11", 38));
  CHECK(!measure(ctx, &r, "N-cons", 5, row, &result) && result.converges == 1);
  r.k = 4;
  CHECK(!measure(ctx, &r, "N-inc", 5, row, &result) && result.converges == 1);
  CHECK(!strncmp(result.verdict, "converges weakly in H^-5, order 0.9", 35));
  r = (struct row){.method = "dirk:crouzeix23", .convention = STEIF_STAGE, .k = 2};
  CHECK(!measure(ctx, &r, "N-inc", 3, row, &result) && result.converges == 1);
  r = (struct row){.method = "bdf:p=2", .start = "ramp", .convention = STEIF_R, .k = 2};
  CHECK(!measure(ctx, &r, "N-inc", 3, row, &result) && result.converges == 0);
  r = (struct row){.method = "be", .convention = STEIF_R, .k = 12};
  CHECK(!measure(ctx, &r, "N-inc", 12, row, &result) && result.converges == -1);
  r.k = 4;
  CHECK(measure(ctx, &r, "N-inc", 2, row, &result) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "m is 3 to") != NULL);
  steif_context_free(&ctx);
}

/* |<x_h - x, g>| <= norm |g|_m with g = (1 - t)^8, |g|_m = 8!/(8 - m)! / sqrt(17 - 2 m). */
static void no_function_beats_the_norm(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int m = rows[i].k - 1; m <= 6; m++) {
      steif_ball_row row[4];
      steif_weak_ball ball;
      steif_weak_row one[4];
      steif_weak_result weak;
      double size = 1 / sqrt(17 - 2 * m);
      for (int q = 0; q < m; q++) size *= 8 - q;
      CHECK(!measure(ctx, rows + i, "N-inc", m, row, &ball));
      CHECK(!weak_rows(ctx, rows[i].method, rows[i].k, "N-inc", rows[i].convention,
                       rows[i].start, 1.0 / 64, 4, one, &weak));
      for (int j = 0; j < 4; j++)
        CHECK(fabs(one[j].error) <= row[j].norm * size * (1 + 1e-9) + one[j].rounding);
    }
  steif_context_free(&ctx);
}

/* be on N-inc of index 3, h = 1/64, in 113-bit arithmetic: suprema over B-splines of degree m on 4, 16 and
 * 64 cells. They rise towards the norm, as every function on N cells is one on 2 N. */
static void splines_rise_to_the_norm(void)
{
  static const struct {
    int m;
    double of[3], norm;
  } known[] = {{3, {.051741524, .051784562, .051904924}, .05194143},
               {2, {.11736, .24628, .42257}, .43556016}};
  steif_context *ctx = steif_context_new(NULL);
  steif_weak_query query = {
    .method = "be", .problem = "jordan:k=3,case=N-inc", .convention = STEIF_R, .rows = 1};
  steif_ball_row row[1];
  steif_weak_ball result;
  for (int i = 0; i < 2; i++) {
    for (int c = 0; c < 3; c++) {
      query.cells = 4 << 2 * c;
      CHECK(!steif_weak_measure_ball(ctx, &query, known[i].m, row, &result));
      CLOSE(row->splines, known[i].of[c], i ? 2e-5 : 1e-8);
      CLOSE(row->norm, known[i].norm, 1e-7);
    }
    sunrealtype before = 0;
    for (query.cells = 1; query.cells <= 1 << 14; query.cells *= 2) {
      CHECK(!steif_weak_measure_ball(ctx, &query, known[i].m, row, &result));
      CHECK(row->splines >= before && row->splines <= row->norm * (1 + 1e-14));
      before = row->splines;
    }
    CLOSE(row->splines, row->norm, 1e-4);
  }
  query.cells = -1;
  CHECK(steif_weak_measure_ball(ctx, &query, 3, row, &result) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "-1 cells") != NULL);
  query.cells = 0;
  CHECK(!steif_weak_measure_ball(ctx, &query, 3, row, &result) && isnan(row->splines));
  steif_context_free(&ctx);
}

/* (1 - t/T)^8 by its Taylor coefficients. */
static int power(long double t, int order, long double *c, void *user)
{
  const long double T = *(const sunrealtype *)user, u = 1 - t / T;
  long double binomial = 1;
  for (int j = 0; j <= order; j++) {
    c[j] = j > 8 ? 0 : binomial * powl(u, 8 - j) * powl(-1 / T, j);
    binomial = binomial * (8 - j) / (j + 1);
  }
  return 0;
}

/* On [0, T] of time constants T times as long the norm is T times as large. */
static void norms_have_units(void)
{
  enum { n = 2 };
  steif_context *ctx = steif_context_new(NULL);
  const sunrealtype T = 1e-3, x0[n] = {1, 2};
  steif_linear l = {SUNDenseMatrix(n, n, steif_sundials(ctx)),
                    SUNDenseMatrix(n, n, steif_sundials(ctx)), NULL, NULL};
  steif_ball_row row[2][3];
  steif_weak_ball result;
  for (int i = 0; i < 2; i++) {
    sunrealtype t1 = i ? T : 1;
    const steif_weight g = {.taylor = power, .user = &t1, .t1 = t1};
    SUNMatZero(l.E), SUNMatZero(l.F);
    SM_ELEMENT_D(l.E, 0, 1) = t1;
    SM_ELEMENT_D(l.F, 0, 0) = SM_ELEMENT_D(l.F, 1, 1) = 1;
    const steif_weak_query query = {.method = "be",
                                    .linear = &l,
                                    .x0 = x0,
                                    .convention = STEIF_R,
                                    .rows = 3,
                                    .component = STEIF_ALL,
                                    .g = &g};
    CHECK(!steif_weak_measure_ball(ctx, &query, 2, row[i], &result) && result.converges == 1);
  }
  for (int j = 0; j < 3; j++) CLOSE(row[1][j].norm, T * row[0][j].norm, 1e-9);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

static void every_allocation_may_fail(void)
{
  int code = STEIF_NO_MEMORY;
  long failed = 0;
  for (long at = 1; code && at < 3000; at++) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_ball_row row[1];
    steif_weak_ball result;
    const steif_weak_query query = {.method = at % 2 ? "be" : "radau:s=2",
                                    .problem = at % 3 ? "jordan:k=2" : "ut5",
                                    .convention = at % 2 ? STEIF_R : STEIF_STAGE,
                                    .h = 0.25,
                                    .rows = 1};
    f.refuse_at = f.served + at;
    code = steif_weak_measure_ball(ctx, &query, 0, row, &result);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    failed += code != 0;
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(!code && failed > 30);
}

CU_TestInfo tests_of_norm[] = {
  {"norms and orders in H^-m", norms_and_orders},
  {"orders are min(p, m - k + 3/2)", orders_by_the_width_of_the_layer},
  {"verdicts hold for every test function", verdicts_hold_for_every_function},
  {"no test function beats the norm", no_function_beats_the_norm},
  {"B-splines rise to the norm", splines_rise_to_the_norm},
  {"norms have units", norms_have_units},
  {"every allocation may fail", every_allocation_may_fail},
  CU_TEST_INFO_NULL};
