/* test_ut5.c: the 5 x 5 pencil of index 3 with two finite eigenvalues, every answer known.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/data.h"

enum { N = 5 };

/* Rounding in this pencil of index k = 3 enters as eps h^-2(k-1), from the resolvent twice. */
static double rounding(double n) { return 2.2e-16 * n * n * n * n; }

/* <x, g> of the distributional solution and x(1): staircase, contour and Drazin formulas agree. */
static const double paired[N] = {39.5766969234249, 40.5487357059799, -39.4580672725173,
                                 4.87926131714857, 1.5612155130093e-4};
static const double at_one[N] = {-9.83990493625282, -14.7438400658581, 6.64909590232396,
                                 -6.87665107291679, 3.08069506977476};

typedef struct run {
  steif_context *ctx;
  steif_problem problem;
  stf_trace trace;
} run;

static void start(run *r, const char *method, const char *procedure, size_t steps, size_t made)
{
  r->ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(steif_problem_find(r->ctx, "ut5", &r->problem) == STEIF_OK);
  r->trace = (stf_trace){.count = N, .steps = made};
  r->trace.t = stf_allocate(r->ctx, made + 1, sizeof(double));
  r->trace.x = stf_allocate(r->ctx, (made + 1) * N, sizeof(double));
  const int code =
    stf_trace_run(r->ctx, &r->problem, method, procedure, 1 / (double)steps, &r->trace);
  CHECK(code == STEIF_OK);
  if (code != STEIF_OK) printf("\n  %s", steif_message(r->ctx));
}

static void finish(run *r)
{
  stf_release(r->ctx, r->trace.t);
  stf_release(r->ctx, r->trace.x);
  steif_problem_clear(r->ctx, &r->problem);
  steif_context_free(&r->ctx);
}

/* Weak values in convention C and x(1) of CQ-BDF-p with the given number of steps. */
static void quadrature(int p, size_t steps, double *weak, double *last)
{
  run r;
  char method[16];
  snprintf(method, sizeof method, "bdf:p=%d", p);
  start(&r, method, "cq", steps, steps);
  double *one = stf_allocate(r.ctx, steps + 1, sizeof *one);
  for (int m = 0; m < N; m++) {
    for (size_t i = 0; i <= steps; i++) one[i] = r.trace.x[i * N + (size_t)m];
    weak[m] = steif_pair(STEIF_C, steps, r.trace.t, one);
    last[m] = one[steps];
  }
  stf_release(r.ctx, one);
  finish(&r);
}

static double distance(const double *a, const double *b)
{
  double sum = 0;
  for (int m = 0; m < N; m++) sum += (a[m] - b[m]) * (a[m] - b[m]);
  return sqrt(sum);
}

/* The first three steps at h = 1/64; x_1 and x_2 carry the impulse. */
static void backward_euler_values(void)
{
  static const double x[3][N] = {
    {2.0540877390e4, 2.0547446593e4, -2.0537361314e4, 3.1992839342e2, -1.4277341699e-2},
    {-2.0489470279e4, -2.0482358575e4, 2.0492503920e4, -2.3259136262e-1, -2.5841441570e-2},
    {-10.322026675, -2.6952716878, 12.8757401708, -0.3970680545, -0.034669054}};
  run r;
  start(&r, "be", NULL, 64, 3);
  for (int i = 0; i < 3; i++)
    for (int m = 0; m < N; m++) CLOSE_FLOOR(r.trace.x[(i + 1) * N + m], x[i][m], 5e-11, 5e4);
  finish(&r);
}

/* At h = 1/64, to rounding. */
static void quadrature_values(void)
{
  static const double value[4][N] = {
    {37.62073482326, 38.68057177621, -37.52134726429, 4.888425106101, 1.764315209985e-4},
    {39.45213543557, 40.43069222734, -39.33507617781, 4.879133580415, 1.764315209985e-4},
    {39.56955361876, 40.54211075951, -39.45107790419, 4.879245351247, 1.60041831072e-4},
    {39.57633869149, 40.54841508405, -39.45772289005, 4.87925908445, 1.567024037085e-4}};
  for (int p = 1; p <= 4; p++) {
    double weak[N], last[N];
    quadrature(p, 64, weak, last);
    for (int m = 0; m < N; m++) CLOSE_FLOOR(weak[m], value[p - 1][m], rounding(64), 1);
  }
}

/* 2-norms of the weak error, h = 2^-4 .. 2^-7, and of the error at t = 1, h = 2^-5 .. 2^-8. The
 * last of p = 6 is the parasitic root 0.863^n giving way to the order. */
static const double weak_error[6][4] = {{12.253, 6.47252, 3.32668, 1.68644},
                                        {2.86447, 0.799387, 0.211132, 0.0542523},
                                        {0.618956, 0.0893707, 0.0119903, 1.55222e-3},
                                        {0.120929, 8.79779e-3, 5.91382e-4, 3.83017e-5},
                                        {0.0198266, 7.03842e-4, 2.33213e-5, 7.4947e-7},
                                        {2.45733e-3, 4.04988e-5, 6.41991e-7, 1.00677e-8}};
static const double point_error[6][4] = {
  {0.52216, 0.27835, 0.14439, 0.073602},        {0.10312, 0.025778, 6.4347e-3, 1.6069e-3},
  {4.002e-3, 5.0438e-4, 6.3609e-5, 7.9948e-6},  {7.1913e-4, 4.4302e-5, 2.7428e-6, 1.7053e-7},
  {9.6126e-5, 1.1197e-6, 3.5615e-8, 1.1239e-9}, {1.138e-2, 2.3296e-4, 1.5198e-8, 1.9829e-11}};

static void quadrature_has_order_p(void)
{
  for (int p = 1; p <= 6; p++)
    for (int i = 0; i < 5; i++) {
      double weak[N], last[N];
      quadrature(p, (size_t)16 << i, weak, last);
      const double n = 16 << i, weak_noise = 30 * rounding(n), point_noise = 300 * rounding(n);
      if (i < 4) {
        const double error = weak_error[p - 1][i];
        CLOSE(distance(weak, paired), error, 2e-5 + weak_noise / error);
      }
      if (i > 0) {
        const double error = point_error[p - 1][i - 1];
        CLOSE(distance(last, at_one), error, 1e-4 + point_noise / error);
      }
    }
}

/* Measured in coordinates in which N is triangular, the weak errors of the table are all there: what
 * rounding leaves is eps h^-(k-1) times 40. */
static void measured_errors_are_not_lost_in_rounding(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int p = 1; p <= 6; p++) {
    char method[16];
    steif_weak_row row[4];
    steif_weak_result result;
    snprintf(method, sizeof method, "bdf:p=%d", p);
    const steif_weak_query query = {.method = method,
                                    .problem = "ut5",
                                    .convention = STEIF_C,
                                    .start = "cq",
                                    .h = 1.0 / 16,
                                    .rows = 4,
                                    .component = STEIF_ALL};
    CHECK(!steif_weak_measure(ctx, &query, row, &result) && result.converges == 1);
    for (int i = 0; i < 4; i++) {
      const double noise = 40 * 2.2e-16 * pow(16 << i, 2);
      CLOSE(row[i].error, weak_error[p - 1][i], 2e-5 + noise / weak_error[p - 1][i]);
    }
    CHECK(fabs(row[3].order - p) < 0.06);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_ut5[] = {
  {"backward Euler carries the impulse in its first steps", backward_euler_values},
  {"CQ-BDF-p pairs to the tabled values at h = 1/64", quadrature_values},
  {"CQ-BDF-p has order p weakly and pointwise", quadrature_has_order_p},
  {"measured weak errors keep their digits", measured_errors_are_not_lost_in_rounding},
  CU_TEST_INFO_NULL};
