/* test_many_digits.c: runs in many digits: their numbers, against rational arithmetic and figures of 33
 * digits, and verdicts where rounding decides in double.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "real_table.h"
#include "weak/data.h"
#include <sunmatrix/sunmatrix_dense.h>

/* ---- arithmetic ------------------------------------------------------------------------------ */

static bool near(int limbs, const stf_real *a, const stf_real *b, int lost)
{
  stf_real d;
  stf_real_subtract(limbs, a, b, &d);
  return !d.sign || d.exponent <= (a->sign ? a->exponent : b->exponent) - limbs + lost;
}

static void sums_products_quotients(void)
{
  static const double part[] = {1, -3, 1e-30, 0.1, 7e40, -1 / 3.0, 4294967296.0, 1e-9};
  enum { L = 40, COUNT = sizeof part / sizeof *part };
  for (int i = 0; i < COUNT; i++)
    for (int j = 0; j < COUNT; j++) {
      const stf_real a = stf_real_of(part[i]), b = stf_real_of(part[j]);
      stf_real x, y;
      CHECK(stf_real_value(&a) == part[i]);
      stf_real_add(L, &a, &b, &x);
      stf_real_subtract(L, &x, &b, &x);
      CHECK(!stf_real_compare(L, &x, &a)); /* exact: all fit */
      stf_real_divide(L, &a, &b, &x);
      stf_real_multiply(L, &x, &b, &x);
      CHECK(near(L, &x, &a, 2));
      stf_real_add(L, &a, &b, &x); /* (a + b)^2 - (a - b)^2 = 4 a b */
      stf_real_subtract(L, &a, &b, &y);
      stf_real_multiply(L, &x, &x, &x);
      stf_real_multiply(L, &y, &y, &y);
      stf_real_subtract(L, &x, &y, &x);
      stf_real_multiply(L, &a, &b, &y);
      for (int k = 0; k < 2; k++) stf_real_add(L, &y, &y, &y);
      CHECK(!stf_real_compare(L, &x, &y));
    }
  const stf_real third = stf_real_ratio(L, 1, 3);
  for (int i = 0; i < L - 1; i++) CHECK(third.limb[i] == 0x55555555u);
  CHECK(stf_real_of(NAN).sign == 0 && stf_real_of(0).sign == 0);
  CHECK(stf_real_compare(L, &third, &third) == 0);
}

/* sum_j a_ij c_j^(q - 1) = c_i^q / q and sum_i b_i c_i^(q - 1) = 1 / q, and D(q) of Radau IA:
 * sum_i b_i c_i^(q - 1) a_ij = b_j (1 - c_j^q) / q; omega A = 1 by A = omega^-1 applied to omega. */
static void check_conditions(steif_context *ctx, const char *method, int order)
{
  enum { L = 20, LOST = 3 };
  stf_real_table t;
  stf_real power[STEIF_STAGES];
  CHECK(!stf_real_table_open(ctx, method, L, NULL, &t) && t.full);
  for (int i = 0; i < t.s; i++) power[i] = stf_real_of(1);
  for (int q = 1; q <= order; q++) {
    stf_real sum = {0};
    for (int i = 0; i < t.s; i++) {
      stf_real_gather(L, 1, t.b + i, power + i, &sum);
      stf_real_multiply(L, power + i, t.c + i, power + i);
    }
    const stf_real wanted = stf_real_ratio(L, 1, q);
    CHECK(near(L, &sum, &wanted, LOST));
  }
  /* b^T omega c = b^T omega A 1 = 1 where c = A 1, and w = b^T omega. */
  stf_real sum = {0}, one = stf_real_of(1);
  for (int j = 0; j < t.s; j++) stf_real_gather(L, 1, t.w + j, t.c + j, &sum);
  const bool rows_sum_to_nodes = strcmp(method, "radau1a:s=1") != 0;
  CHECK(!rows_sum_to_nodes || near(L, &sum, &one, LOST));
  stf_real_table_close(ctx, &t);
}

static void coefficients_to_all_digits(void)
{
  steif_context *ctx = steif_context_new(NULL);
  check_conditions(ctx, "gauss:s=3", 6);
  check_conditions(ctx, "gauss:s=7", 14);
  check_conditions(ctx, "radau:s=5", 9);
  check_conditions(ctx, "radau1a:s=4", 7);
  check_conditions(ctx, "lobatto3c:s=4", 6);
  steif_context_free(&ctx);
}

/* ---- runs in rational arithmetic ------------------------------------------------------------- */

/* E = S diag(1, N) T, F = S diag(2, I) T with whole S, T and N of index 3; the entries are those products. */
static const double entry_E[4][4] = {{1, 1, 0, 0}, {1, 1, 1, 2}, {0, 0, 2, 5}, {1, 1, 0, 0}},
                    entry_F[4][4] = {{2, 2, 0, 0}, {2, 3, 1, 0}, {0, 2, 3, 2}, {2, 2, 0, 1}};

/* (t^2, 1, t, 1 - t) */
static int polynomials(sunrealtype t, int derivative, N_Vector g, void *user)
{
  sunrealtype *f = N_VGetArrayPointer(g);
  (void)user;
  f[0] = derivative == 0 ? t * t : derivative == 1 ? 2 * t : derivative == 2 ? 2 : 0;
  f[1] = derivative == 0;
  f[2] = derivative == 0 ? t : derivative == 1;
  f[3] = derivative == 0 ? 1 - t : derivative == 1 ? -1 : 0;
  return 0;
}

/* <x_h, g> at h = 1/8 and 1/16 from x(0-) = (1, -2, 3, 5) by the recurrences in fractions (Python's). */
static const struct {
  const char *method, *start;
  enum steif_convention convention;
  double value[2][4];
} rational[] = {
  {"be",
   NULL,
   STEIF_R,
   {{7.1423374341096446, -7.2241108857302203, 2.2526783814860716, .087608185389803514},
    {12.733893484185714, -12.821021432721055, 2.8787642776664546, .093322836308996349}}},
  {"bdf:p=2",
   "cq",
   STEIF_C,
   {{17.855382575006953, -17.963568138889968, 3.7526145554147661, .10954499011859298},
    {20.668974092933219, -20.766152656414306, 3.7446724596243257, .10089983815623782}}},
  {"bdf:p=2",
   "ramp",
   STEIF_R,
   {{-.53079134969193265, .44943832668165368, 1.8558353130809135, .087608185389803514},
    {-13.705798231954436, 13.619106683010209, 1.9625897731371476, .093322836308996349}}},
  {"radau:s=2",
   NULL,
   STEIF_STAGE,
   {{5.7431408417098737, -5.8345932729163916, 3.3137436882869866, .097373103780087789},
    {11.396778292845442, -11.488881467343539, 3.6070866341188763, .097902038383927345}}},
  {"gauss:s=1",
   NULL,
   STEIF_STAGE,
   {{18.75731143963851, -18.843796316178668, 3.3286518494314805, .092254686193882662},
    {21.089939118410229, -21.180678024563569, 3.6259960387150336, .09652339408344357}}},
  {"radau1a:s=2",
   NULL,
   STEIF_STAGE,
   {{20.109298000460569, -20.202154165631033, 3.7289224923419182, .098620589850447235},
    {21.394667279161133, -21.486951213696049, 3.7301345330835178, .09805970101600725}}},
  {"lobatto3c:s=3",
   NULL,
   STEIF_STAGE,
   {{20.521990556919295, -20.614248164381934, 3.7301640450144382, .098018120835452763},
    {21.517654123836977, -21.609858520836191, 3.7302942782491875, .097982208774374982}}}};

static void values_are_those_of_fractions(void)
{
  enum { n = 4 };
  steif_context *ctx = steif_context_new(NULL);
  const sunrealtype x0[n] = {1, -2, 3, 5};
  const steif_linear l = {SUNDenseMatrix(n, n, steif_sundials(ctx)),
                          SUNDenseMatrix(n, n, steif_sundials(ctx)), polynomials, NULL};
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      SM_ELEMENT_D(l.E, i, j) = entry_E[i][j];
      SM_ELEMENT_D(l.F, i, j) = entry_F[i][j];
    }
  for (size_t i = 0; i < sizeof rational / sizeof *rational; i++) {
    steif_weak_row row[2];
    steif_weak_result result;
    sunrealtype values[2 * n], exacts[n];
    const steif_weak_query query = {.method = rational[i].method,
                                    .linear = &l,
                                    .x0 = x0,
                                    .convention = rational[i].convention,
                                    .start = rational[i].start,
                                    .h = 0.125,
                                    .rows = 2,
                                    .component = STEIF_ALL,
                                    .values = values,
                                    .exacts = exacts,
                                    .exact = 1};
    CHECK(!steif_weak_measure(ctx, &query, row, &result) && result.index == 3);
    for (int j = 0; j < 2; j++) { /* maps to other coordinates and back are rounded */
      double apart = 0;
      for (int m = 0; m < n; m++)
        apart = hypot(apart, values[j * n + m] - rational[i].value[j][m]);
      CHECK(apart <= row[j].rounding && apart <= 1e-13 * fabs(row[j].value));
    }
  }
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  steif_context_free(&ctx);
}

/* ---- verdicts where rounding decides --------------------------------------------------------- */

static int exactly(steif_context *ctx, const char *method, const char *problem,
                   enum steif_convention convention, double h, size_t rows,
                   const steif_weight *g, steif_weak_row *row, steif_weak_result *result)
{
  const steif_weak_query query = {.method = method,
                                  .problem = problem,
                                  .convention = convention,
                                  .h = h,
                                  .rows = rows,
                                  .g = g,
                                  .exact = 1};
  const int code = steif_weak_measure(ctx, &query, row, result);
  if (code) printf("\n  %s on %s: %s", method, problem, steif_message(ctx));
  return code;
}

/* Errors at h, h/2, ...: 113-bit arithmetic, 33 digits, those printed are stable; H-inc rational. Order 0:
 * g = (1 - t)^8 sees nothing of the impulses of order 9 and 10. */
static const struct {
  const char *method, *problem;
  int from, order; /* 1/h */
  double error[5];
} known[] = {
  {"be",
   "jordan:k=12,case=N-inc",
   16,
   0,
   {71739.42309, 35238.01451, 17452.72568, 8683.609623, 4330.96062}},
  {"be", "jordan:k=11,case=N-inc", 64, 0, {16246.76101, 8051.061803, 4007.360165}},
  {"be", "jordan:k=12,case=N-cons", 64, 0, {829.7187723, 425.3288583, 215.082794}},
  {"be",
   "jordan:k=10,case=H-inc",
   64,
   0,
   {10577.44355, 5222.314482, 2594.713711, 1293.265643, 645.6124700131}},
  {"be",
   "jordan:k=12,case=H-inc",
   64,
   0,
   {10577.44355, 5222.314482, 2594.713711, 1293.265643, 645.6124700131}},
  {"be",
   "jordan:k=9,case=H-inc",
   64,
   1,
   {10577.44355, 5222.314482, 2594.713711, 1293.265643, 645.6124700131}},
  {"gauss:s=3",
   "jordan:k=4,case=N-inc",
   64,
   2,
   {.119079704885, .02981030616575, .007455100241128, .001863932790781}},
  {"gauss:s=3",
   "jordan:k=5,case=N-inc",
   64,
   2,
   {-6.635260667829, -1.660174326352, -.4151285291008, -.1037874414955}},
  {"gauss:s=3", "jordan:k=5,case=N-cons", 64, 4, {6.725083230e-9}},
  {"gauss:s=3", "jordan:k=4,case=H-inc", 64, 2, {.1023510064703, 0, 0, .001602126940085}},
  {"gauss:s=3", "jordan:k=5,case=H-inc", 64, 2, {-7.084237772324, 0, 0, -.1108107851687}}};

static void rounding_decides_nothing(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    steif_weak_row row[5];
    steif_weak_result result;
    const bool euler = !strcmp(known[i].method, "be");
    const size_t rows = euler ? 5 : 4;
    CHECK(!exactly(ctx, known[i].method, known[i].problem, euler ? STEIF_R : STEIF_STAGE,
                   1.0 / known[i].from, rows, NULL, row, &result));
    for (size_t j = 0; j < rows; j++) {
      const double error = known[i].error[j],
                   last = 5e-10 * fabs(error) + 1e-13; /* digits printed; x(0-) is a double */
      CHECK(error == 0 || fabs(row[j].error - error) <= last + row[j].rounding);
      CHECK(row[j].rounding <= 1e-6 * fabs(row[j].error) + 1e-13);
    }
    CHECK(strncmp(result.verdict, "exact", 5) != 0);
    if (known[i].order > 0) {
      const bool seen = row[rows - 1].usable; /* N-cons at k = 5: an error of 1e-12 of 0.4 */
      CHECK(!seen || result.converges == 1);
      CHECK(fabs(row[1].order - known[i].order) < 0.05);
    } else
      CHECK(result.converges == -1 && strstr(result.verdict, "such as (1 - t)^") != NULL);
  }
  steif_context_free(&ctx);
}

/* A function that sees impulses of all orders below 14 decides at index 12. */
static int steep(long double t, int order, long double *c, void *user)
{
  enum { n = 14 };
  long double binomial = 1;
  (void)user;
  for (int j = 0; j <= order; j++) {
    c[j] = j > n ? 0 : (j % 2 ? -binomial : binomial) * powl(1 - t, n - j);
    binomial = binomial * (n - j) / (j + 1);
  }
  return 0;
}

static void index_twelve_is_decided(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_weight g = {steep, NULL, 1, 0};
  steif_weak_row row[5];
  steif_weak_result result;
  CHECK(!exactly(ctx, "be", "jordan:k=12,case=N-inc", STEIF_R, 1.0 / 512, 4, &g, row, &result));
  CHECK(result.converges == 1 && fabs(row[3].order - 1) < 0.02);
  CHECK(!exactly(ctx, "radau:s=3", "jordan:k=8,case=H-inc", STEIF_STAGE, 1.0 / 64, 4, &g, row,
                 &result));
  CHECK(result.converges == 0 && fabs(row[3].order + 3) < 0.05);
  steif_context_free(&ctx);
}

/* ---- what cannot be run ---------------------------------------------------------------------- */

static void what_is_not_known_is_told(void)
{
  steif_context *ctx = steif_context_new(NULL);
  static const char *const method[] = {"auto", "glm:bdf,p=3", "rk4"};
  steif_weak_row row[3];
  steif_weak_result result;
  for (int i = 0; i < 3; i++) {
    const steif_weak_query query = {
      .method = method[i], .problem = "jordan:k=3", .rows = 3, .exact = 1};
    CHECK(steif_weak_measure(ctx, &query, row, &result) == STEIF_UNSUPPORTED);
    CHECK(strstr(steif_message(ctx), "many digits") != NULL);
  }
  const steif_weak_query large = {
    .method = "radau:s=13", .problem = "jordan:k=8", .h = 1.0 / 65536, .rows = 1, .exact = 1};
  CHECK(steif_weak_measure(ctx, &large, row, &result) == STEIF_UNSUPPORTED);
  CHECK(strstr(steif_message(ctx), "take larger ones") != NULL);
  steif_context_free(&ctx);
}

static void check_memory(const char *method, enum steif_convention convention)
{
  const steif_weight g = {steep, NULL, 1, 0};
  int code = STEIF_NO_MEMORY;
  long failed = 0;
  for (long at = 1; code && at < 3000; at++) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_weak_row row[1];
    steif_weak_result result;
    f.refuse_at = f.served + at;
    const steif_weak_query query = {.method = method,
                                    .problem = "jordan:k=2",
                                    .convention = convention,
                                    .g = &g,
                                    .h = 0.25,
                                    .rows = 1,
                                    .exact = 1};
    code = steif_weak_measure(ctx, &query, row, &result);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    failed += code != 0;
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
  }
  CHECK(!code && failed > 12);
}

static void every_allocation_may_fail(void)
{
  check_memory("bdf:p=2", STEIF_R);
  check_memory("radau:s=2", STEIF_STAGE);
}

CU_TestInfo tests_of_many_digits[] = {
  {"sums, products and quotients", sums_products_quotients},
  {"coefficients of methods to all digits", coefficients_to_all_digits},
  {"runs are those of rational arithmetic", values_are_those_of_fractions},
  {"rounding decides nothing", rounding_decides_nothing},
  {"index 12 is decided", index_twelve_is_decided},
  {"what cannot be run is told", what_is_not_known_is_told},
  {"every allocation may fail", every_allocation_may_fail},
  CU_TEST_INFO_NULL};
