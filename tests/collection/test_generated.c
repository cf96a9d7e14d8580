/* test_generated.c: what must hold for every generated descriptor system: consistent starts stay,
 * only E x(0-) counts, physics is kept, the same seed gives the same system, short memory is told.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "known_structure.h"
#include "fixture.h"
#include "generated.h"

/* The start of `spec` with x(0-) = y0 where that is not NULL. */
static int find(fixture *s, const char *spec, const double *y0, stf_exact_start *x)
{
  if (!s->ctx && fixture_open(s, spec)) return 1;
  steif_problem p = s->p;
  if (y0) p.y0 = y0;
  const int code = stf_exact_start_find(s->ctx, &p, x);
  CU_ASSERT_EQUAL(code, STEIF_OK);
  return code;
}

static double largest(const double *x, sunindextype n)
{
  double most = 0;
  for (sunindextype i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

static void consistent_starts_stay(void)
{
  static const struct {
    const char *spec;
    double tolerance;
  } cases[] = {{"stokes:m=9,case=cons", 1e-11},
               {"springs:n=40,c=13,case=cons", 1e-12},
               {"hidden:n=40,lambda=1e5,case=cons", 1e-12},
               {"ladder:n=45,case=cons", 1e-13},
               {"bus:n=50,case=cons", 1e-13},
               {"blocks:sizes=4.2,case=cons", 1e-12},
               {"switchrlc:case=cons", 1e-14},
               {"impact:gap=0.4,case=cons", 1e-14}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    fixture s = {0};
    stf_exact_start x;
    if (find(&s, cases[k].spec, NULL, &x)) continue;
    const sunindextype n = s.p.n;
    const double size = largest(s.p.y0, n);
    CHECK(size > 0.1);
    for (sunindextype i = 0; i < n; i++)
      CLOSE_FLOOR(x.x_plus[i], s.p.y0[i], cases[k].tolerance, size);
    if (x.c) CLOSE_FLOOR(largest(x.c, n * (x.index - 1)), 0, cases[k].tolerance, size);
    stf_exact_start_clear(s.ctx, &x);
    fixture_close(&s);
  }
}

/* x(0-) moved along the kernel of E. */
static void only_E_x_counts(void)
{
  static const char *const specs[] = {"stokes:m=6",     "springs:n=12,c=5", "hidden:n=12,c=5",
                                      "ladder:n=23",    "bus:n=17",         "switchrlc",
                                      "impact:gap=-0.3"};
  for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
    fixture s = {0};
    stf_exact_start x, moved;
    if (find(&s, specs[k], NULL, &x)) continue;
    const sunindextype n = s.p.n;
    SUNMatrix E = fixture_matrix(&s, s.p.nnz_E);
    CHECK(s.p.E(0, s.y, s.yp, E, s.p.user) == 0);
    double *y0 = calloc((size_t)n, sizeof *y0);
    int free_ones = 0;
    for (sunindextype i = 0; i < n; i++) { /* all these E are diagonal */
      const int alone = fixture_element(E, i, i) == 0;
      y0[i] = s.p.y0[i] + (alone ? 17.3 - (double)i : 0);
      free_ones += alone;
    }
    CHECK(free_ones > 0 && find(&s, specs[k], y0, &moved) == 0);
    for (sunindextype i = 0; i < n; i++) CLOSE(moved.x_plus[i], x.x_plus[i], 0);
    for (sunindextype i = 0; i < n * (x.index - 1); i++) CLOSE(moved.c[i], x.c[i], 0);
    stf_exact_start_clear(s.ctx, &x), stf_exact_start_clear(s.ctx, &moved);
    SUNMatDestroy(E);
    free(y0);
    fixture_close(&s);
  }
}

static void closing_a_switch_keeps_the_charge(void)
{
  const double C1 = 2e-6, C2 = 3e-6;
  fixture s = {0};
  stf_exact_start x;
  if (find(&s, "switchrlc:v1=7.25,v2=-3.5", NULL, &x)) return;
  const double *v = x.x_plus, charge = C1 * 7.25 - C2 * 3.5;
  CLOSE(C1 * v[0] + C2 * v[1], charge, 1e-14);
  CLOSE(v[0], 0.8, 1e-14);       /* (14.5 - 10.5)/5 */
  CLOSE(x.c[4], 1.29e-5, 1e-14); /* 2 uF of 7.25 - 0.8 volts pass */
  CLOSE(x.c[4], C2 * (v[1] + 3.5), 1e-14);
  CLOSE(v[3], 6, 0);          /* the whole battery while no current flows */
  CLOSE(v[4], 0.0016, 1e-14); /* two fifths of the 4 mA through 200 ohms */
  stf_exact_start_clear(s.ctx, &x);
  fixture_close(&s);
}

static void an_impact_keeps_the_momentum(void)
{
  const double m1 = 1.5, m2 = 0.7;
  fixture s = {0};
  stf_exact_start x;
  if (find(&s, "impact:speed=4.4", NULL, &x)) return;
  CLOSE(x.x_plus[2], 3, 1e-14); /* 1.5 * 4.4 / 2.2 */
  CLOSE(x.x_plus[3], x.x_plus[2], 0);
  CLOSE(m1 * x.x_plus[2] + m2 * x.x_plus[3], m1 * 4.4, 1e-14);
  CLOSE(x.c[4], -2.1, 1e-14); /* 0.7 * 3, pushing the second mass along */
  CLOSE(x.x_plus[0], 0.4, 1e-14);
  CLOSE(x.x_plus[1], 0.4, 1e-14);
  CU_ASSERT_EQUAL(largest(x.c + 5, 5), 0);
  stf_exact_start_clear(s.ctx, &x);
  fixture_close(&s);
}

/* u(0+) = u(0-) = 0.7 at any rate, and what the chain does at 0 is not the mode's business. */
static void the_hidden_mode_is_continuous(void)
{
  static const char *const specs[] = {"hidden:lambda=1e2", "hidden:lambda=1e6",
                                      "hidden:lambda=1e10"};
  fixture plain = {0};
  stf_exact_start must, x;
  if (find(&plain, "springs", NULL, &must)) return;
  for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
    fixture s = {0};
    if (find(&s, specs[k], NULL, &x)) continue;
    CLOSE(x.x_plus[420], 0.7, 0);
    CU_ASSERT_EQUAL(x.c[420], 0);
    for (int i = 0; i < 400; i++) CLOSE(x.x_plus[i], must.x_plus[i], 1e-14);
    for (int i = 0; i < 420; i++) CLOSE(x.c[i], must.c[i], 1e-14);
    stf_exact_start_clear(s.ctx, &x);
    fixture_close(&s);
  }
  stf_exact_start_clear(plain.ctx, &must);
  fixture_close(&plain);
}

static void closed_solutions_begin_at_x_plus_and_satisfy_the_equations(void)
{
  static const struct {
    const char *spec;
    double t, h;
  } cases[] = {{"switchrlc", 1.7e-4, 3e-6},
               {"switchrlc:v1=-2,v2=9,case=cons", 6.3e-4, 3e-6},
               {"impact", 0.83, 0.01},
               {"impact:gap=0.12,speed=-2.2", 3.1, 0.01}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    fixture s = {0};
    stf_exact_start x;
    const double t = cases[k].t;
    if (find(&s, cases[k].spec, NULL, &x)) continue;
    CHECK(s.p.exact(0, s.y, NULL, s.p.user) == 0);
    for (int i = 0; i < 5; i++) CLOSE_FLOOR(NV_Ith_S(s.y, i), x.x_plus[i], 2e-14, 1);
    CHECK(s.p.exact(t, s.y, s.yp, s.p.user) == 0 && fixture_residual(&s, t) == 0);
    CLOSE_FLOOR(fixture_largest(s.r), 0, 1e-13, 1 + N_VMaxNorm(s.y));
    N_VScale(1, s.yp, s.r);
    fixture_difference(&s, s.p.exact, t, cases[k].h);
    for (int i = 0; i < 5; i++)
      CLOSE_FLOOR(NV_Ith_S(s.yp, i), NV_Ith_S(s.r, i), 1e-8, 1e-3 * N_VMaxNorm(s.r));
    stf_exact_start_clear(s.ctx, &x);
    fixture_close(&s);
  }
}

/* g^(q+1) against central differences of g^(q). */
static int forcing_order;
static int forcing(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)yp;
  return ((const steif_problem *)user)
    ->g(t, forcing_order, y, ((const steif_problem *)user)->user);
}

static void derivatives_of_forcing_are_derivatives(void)
{
  static const struct {
    const char *spec;
    double h;
  } cases[] = {{"stokes:m=4", 1e-2},  {"springs:n=11", 3e-2}, {"hidden:n=7", 3e-2},
               {"ladder:n=16", 1e-4}, {"bus:n=13", 2e-2},     {"blocks", 3e-2}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    fixture s = {0};
    if (fixture_open(&s, cases[k].spec)) continue;
    steif_problem self = s.p;
    s.p.user = &self;
    for (forcing_order = 0; forcing_order < 5; forcing_order++) {
      fixture_difference(&s, forcing, 0.37, cases[k].h);
      CHECK(self.g(0.37, forcing_order + 1, s.y, self.user) == 0);
      const double size = N_VMaxNorm(s.y);
      CHECK(size > 0.01);
      for (sunindextype i = 0; i < self.n; i++)
        CLOSE_FLOOR(NV_Ith_S(s.yp, i), NV_Ith_S(s.y, i), 1e-8, size);
    }
    CHECK(self.g(0.37, -1, s.y, self.user) < 0);
    s.p.user = self.user;
    fixture_close(&s);
  }
}

static void dense_and_sparse_storage_hold_the_same(void)
{
  static const char *const pairs[][2] = {
    {"stokes:m=4", "stokes:m=4,storage=dense"},   {"springs:n=9", "springs:n=9,storage=dense"},
    {"ladder:n=12", "ladder:n=12,storage=dense"}, {"bus:n=14", "bus:n=14,storage=dense"},
    {"blocks:storage=sparse", "blocks"},          {"impact:storage=sparse", "impact"}};
  for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
    fixture s, d;
    if (fixture_open(&s, pairs[k][0])) continue;
    if (fixture_open(&d, pairs[k][1])) continue;
    SUNMatrix M[] = {fixture_matrix(&s, s.p.nnz_E), fixture_matrix(&s, s.p.nnz),
                     fixture_matrix(&d, 0), fixture_matrix(&d, 0)};
    CHECK(s.p.storage == STEIF_SPARSE && d.p.storage == STEIF_DENSE);
    CHECK(s.p.E(0, s.y, s.yp, M[0], s.p.user) == 0 && s.p.A(0, s.y, s.yp, M[1], s.p.user) == 0);
    CHECK(d.p.E(0, d.y, d.yp, M[2], d.p.user) == 0 && d.p.A(0, d.y, d.yp, M[3], d.p.user) == 0);
    for (sunindextype i = 0; i < s.p.n; i++)
      for (sunindextype j = 0; j < s.p.n; j++)
        for (int m = 0; m < 2; m++)
          CLOSE(fixture_element(M[m], i, j), fixture_element(M[2 + m], i, j), 0);
    for (int m = 0; m < 4; m++) SUNMatDestroy(M[m]);
    fixture_close(&s), fixture_close(&d);
  }
}

/* A matrix without room, by rows or of another size is rejected by a fatal code. */
static void wrong_matrices_are_rejected(void)
{
  fixture s;
  if (fixture_open(&s, "springs:n=8")) return;
  const SUNContext sun = steif_sundials(s.ctx);
  SUNMatrix M[] = {SUNSparseMatrix(17, 17, s.p.nnz - 1, CSC_MAT, sun),
                   SUNSparseMatrix(17, 17, s.p.nnz, CSR_MAT, sun), SUNDenseMatrix(16, 16, sun),
                   SUNBandMatrix(17, 16, 16, sun)};
  CU_ASSERT_EQUAL(s.p.n, 17);
  for (int k = 0; k < 4; k++) {
    CHECK(s.p.A(0, s.y, s.yp, M[k], s.p.user) < 0);
    SUNMatDestroy(M[k]);
  }
  fixture_close(&s);
}

static void seeds_choose_the_numbers(void)
{
  fixture a, b, c;
  if (fixture_open(&a, "bus:n=30") || fixture_open(&b, "bus:n=30,seed=1") ||
      fixture_open(&c, "bus:n=30,seed=2"))
    return;
  for (sunindextype i = 0; i < a.p.n; i++) {
    CLOSE(b.p.y0[i], a.p.y0[i], 0);
    CHECK(fabs(c.p.y0[i] - a.p.y0[i]) > 1e-9);
  }
  fixture_close(&a), fixture_close(&b), fixture_close(&c);
  /* The first 64-bit outputs for the state 1234567, divided by 2^64; S. Vigna's reference
   * program prints 6457827717110365317, 3203168211198807973, 9817491932198370423. */
  stf_random r = {1234567};
  CLOSE(stf_random_in(&r, 0, 1), 6457827717110365317.0 / 18446744073709551616.0, 4e-16);
  CLOSE(stf_random_in(&r, -1, 1), 2 * (3203168211198807973.0 / 18446744073709551616.0) - 1,
        1e-15);
  CU_ASSERT_EQUAL(stf_random_below(&r, 1000), 423);
  double mean = 0, square = 0, fourth = 0;
  for (int k = 0; k < 40000; k++) {
    const double x = stf_random_normal(&r);
    mean += x / 40000, square += x * x / 40000, fourth += x * x * x * x / 40000;
  }
  CLOSE_FLOOR(mean, 0, 0.02, 1); /* four standard deviations: 1, 1.41, 9.8 over 200 */
  CLOSE(square, 1, 0.03);
  CLOSE(fourth, 3, 0.07);
}

static void rejected(const char *spec, int code, const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  const int got = steif_problem_find(ctx, spec, &p);
  if (got != code || !strstr(steif_message(ctx), words))
    printf("\n  %s: code %d, \"%s\"", spec, got, steif_message(ctx));
  CU_ASSERT_EQUAL(got, code);
  CU_ASSERT_PTR_NOT_NULL(strstr(steif_message(ctx), words));
  CHECK(!p.name && !p.user);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void wrong_specs_are_rejected(void)
{
  rejected("stokes:m=1", STEIF_BAD_INPUT, "from 2 to");
  rejected("springs:n=30,c=31", STEIF_BAD_INPUT, "from 1 to 30");
  rejected("ladder:storage=band", STEIF_UNSUPPORTED, "no band storage");
  rejected("ladder:n=5000,storage=dense", STEIF_UNSUPPORTED, "choose sparse");
  rejected("bus:case=odd", STEIF_UNKNOWN_NAME, "inc or cons");
  rejected("blocks:sizes=3.a", STEIF_BAD_INPUT, "3.2.1 or 2x50.3x20");
  rejected("blocks:sizes=3.", STEIF_BAD_INPUT, "3.2.1 or 2x50.3x20");
  rejected("blocks:sizes=13", STEIF_BAD_INPUT, "from 1 to 12");
  rejected("blocks:sizes=3x0", STEIF_BAD_INPUT, "from 1 to 12");
  rejected("blocks:sizes=10x100", STEIF_BAD_INPUT, "at most 1000");
  rejected("blocks:sizes=2,index=2", STEIF_BAD_INPUT, "not both");
  rejected("blocks:nf=7", STEIF_BAD_INPUT, "even");
  rejected("blocks:kind=round", STEIF_UNKNOWN_NAME, "osc or stiff");
  rejected("hidden:lambda=0", STEIF_BAD_INPUT, "lambda=0");
  rejected("switchrlc:m=3", STEIF_UNKNOWN_NAME, "v1, v2, case, storage");
  rejected("impact:seed=0", STEIF_UNKNOWN_NAME, "no parameter 'seed'");
  rejected("stokes:seed=0", STEIF_BAD_INPUT, "seed=0");
}

static void other_problems_do_not_know_their_start(void)
{
  fixture s;
  stf_exact_start x;
  if (fixture_open(&s, "jordan:k=3")) return;
  CU_ASSERT_EQUAL(stf_exact_start_find(s.ctx, &s.p, &x), STEIF_UNSUPPORTED);
  CU_ASSERT_PTR_NOT_NULL(strstr(steif_message(s.ctx), "'jordan:k=3'"));
  CHECK(!x.x_plus && !x.c);
  CU_ASSERT_EQUAL(stf_exact_start_find(s.ctx, NULL, &x), STEIF_BAD_INPUT);
  CU_ASSERT_EQUAL(stf_exact_start_find(s.ctx, &s.p, NULL), STEIF_BAD_INPUT);
  stf_exact_start_clear(s.ctx, NULL);
  fixture_close(&s);
}

/* Find the problem and its start with the k-th request rejected; true when all were served. */
static int starved(const char *spec, long k)
{
  failing f = {0};
  const steif_setup setup = failing_setup(&f);
  steif_context *ctx = steif_context_new(&setup);
  const long before = f.alive;
  steif_problem p;
  stf_exact_start x = {0};
  f.served = 0, f.refuse_at = k;
  int code = steif_problem_find(ctx, spec, &p);
  if (!code) code = stf_exact_start_find(ctx, &p, &x);
  CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
  if (code) CHECK(!x.x_plus && !x.c && steif_status(ctx) == STEIF_NO_MEMORY);
  const int served = f.served < k;
  CHECK(served == (code == STEIF_OK));
  stf_exact_start_clear(ctx, &x);
  steif_problem_clear(ctx, &p);
  CU_ASSERT_EQUAL(f.alive, before);
  steif_context_free(&ctx);
  CU_ASSERT_EQUAL(f.alive, 0);
  return served;
}

static void short_memory_is_told(void)
{
  static const char *const specs[] = {
    "stokes:m=5", "springs:n=20",     "hidden:n=20,case=cons", "ladder:n=9",
    "bus:n=20",   "blocks:index=3",   "stokes:m=3,case=cons",  "bus:n=8,case=cons",
    "switchrlc",  "impact:case=cons", "blocks:case=cons"};
  for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
    long k = 1;
    while (k < 200 && !starved(specs[i], k)) k++;
    CHECK(k > 10 && k < 200);
  }
}

CU_TestInfo tests_of_generated[] = {
  {"consistent starts stay where they are", consistent_starts_stay},
  {"only E x(0-) counts", only_E_x_counts},
  {"closing a switch keeps the charge", closing_a_switch_keeps_the_charge},
  {"an impact keeps the momentum", an_impact_keeps_the_momentum},
  {"the hidden mode is continuous", the_hidden_mode_is_continuous},
  {"closed solutions begin at x(0+) and satisfy the equations",
   closed_solutions_begin_at_x_plus_and_satisfy_the_equations},
  {"derivatives of the forcing are derivatives", derivatives_of_forcing_are_derivatives},
  {"dense and sparse storage hold the same", dense_and_sparse_storage_hold_the_same},
  {"wrong matrices are rejected", wrong_matrices_are_rejected},
  {"seeds choose the numbers", seeds_choose_the_numbers},
  {"wrong specs are rejected", wrong_specs_are_rejected},
  {"other problems do not know their start", other_problems_do_not_know_their_start},
  {"short memory is told and nothing leaks", short_memory_is_told},
  CU_TEST_INFO_NULL};
