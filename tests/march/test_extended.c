/* test_extended.c: references of more digits than a run in double precision reaches: orbits that grow apart, in
 * 31 digits by two methods; and E5 without its cancellation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "extended.h"
#include "smooth.h"

#define LENGTH(array) ((int)(sizeof(array) / sizeof *(array)))

/* Both methods give the reference, to its digits or to a rounding of double precision. */
static void agree(const char *name, int n, const term *terms, int count, const pair *start,
                  int steps)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, name, &p) && p.reference);
  const steif_reference *r = p.reference;
  const double claimed = fmax(pow(10, -r->digits), ldexp(1, -53));
  for (int method = 0; method < 2; method++) {
    pair y[LARGEST];
    memcpy(y, start, (size_t)n * sizeof *y);
    (method ? extended_midpoint : extended_taylor)(n, terms, count, y, r->t, steps);
    for (int i = 0; i < (r->count ? (int)r->count : (int)p.n); i++) {
      const pair at = y[r->component ? r->component[i] : i];
      const double error = fabs((at.hi - r->value[i]) + at.lo);
      const double size = claimed > 1e-15 ? 1 + fabs(r->value[i]) : fabs(r->value[i]);
      if (!(error <= 1.001 * claimed * size))
        printf("\n  %s, y%d = %.17g + %.2g, reference %.17g", name, i + 1, at.hi, at.lo,
               r->value[i]);
      CHECK(error <= 1.001 * claimed * size);
    }
  }
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static pair ratio(double a, double b) { return pair_divide(pair_of(a), b); }

static void lorenz(void)
{
  const term terms[] = {{0, 1, ONE, {10, 0}},     {0, 0, ONE, {-10, 0}}, {1, 0, ONE, {28, 0}},
                        {1, 1, ONE, {-1, 0}},     {1, 0, 2, {-1, 0}},    {2, 0, 1, {1, 0}},
                        {2, 2, ONE, ratio(-8, 3)}};
  agree("lorenz", 3, terms, LENGTH(terms), (const pair[]){{1, 0}, {1, 0}, {20, 0}}, 1000);
}

static void roessler(void)
{
  const term terms[] = {{0, 1, ONE, {-1, 0}},       {0, 2, ONE, {-1, 0}},
                        {1, 0, ONE, {1, 0}},        {1, 1, ONE, ratio(1, 5)},
                        {2, ONE, ONE, ratio(1, 5)}, {2, 0, 2, {1, 0}},
                        {2, 2, ONE, ratio(-57, 10)}};
  agree("roessler", 3, terms, LENGTH(terms), (const pair[]){{1, 0}, {1, 0}, {0, 0}}, 500);
}

static void lorenz96(void)
{
  enum { SIZE = 40 };
  term terms[4 * SIZE];
  pair start[SIZE];
  for (int i = 0; i < SIZE; i++) {
    const int before = (i + SIZE - 1) % SIZE;
    terms[4 * i] = (term){i, (i + 1) % SIZE, before, {1, 0}};
    terms[4 * i + 1] = (term){i, (i + SIZE - 2) % SIZE, before, {-1, 0}};
    terms[4 * i + 2] = (term){i, i, ONE, {-1, 0}};
    terms[4 * i + 3] = (term){i, ONE, ONE, {8, 0}};
    start[i] = pair_of(8);
  }
  start[SIZE / 2 - 1] = ratio(8008, 1000);
  agree("lorenz96", SIZE, terms, LENGTH(terms), start, 100);
}

/* q' = p, p' = -s, s = sin q, c = cos q; sin 1 and cos 1 by their series. */
static void pendulum(void)
{
  const term terms[] = {
    {0, 1, ONE, {1, 0}}, {1, 2, ONE, {-1, 0}}, {2, 3, 1, {1, 0}}, {3, 2, 1, {-1, 0}}};
  pair start[] = {{1, 0}, {0, 0}, {0, 0}, {1, 0}}, next = {1, 0};
  for (int k = 1; k < 30; k++) {
    next = pair_divide(next, k % 4 == 2 || k % 4 == 0 ? -k : k);
    start[2 + (k % 2 == 0)] = pair_add(start[2 + (k % 2 == 0)], next);
  }
  agree("pendulum", 4, terms, LENGTH(terms), start, 200);
}

/* w = q^2 */
static void oscillator(const char *name, double mu, int steps)
{
  const term terms[] = {{0, 1, ONE, {1, 0}},
                        {1, 1, ONE, {mu, 0}},
                        {1, 2, 1, {-mu, 0}},
                        {1, 0, ONE, {-1, 0}},
                        {2, 0, 1, {2, 0}}};
  agree(name, 3, terms, LENGTH(terms), (const pair[]){{2, 0}, {0, 0}, {4, 0}}, steps);
}

static void orbits_in_31_digits(void)
{
  lorenz();
  roessler();
  lorenz96();
  pendulum();
  oscillator("vdpol:mu=10", 10, 5000);
  oscillator("vdpol:mu=30", 30, 15000);
}

/* E5 with y2 = y3 + y4 put in: y3' has no small difference of large terms, and double precision is enough. */
static int sums(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y), capture = 1.1e7 * u[0] * u[1];
  sunrealtype *d = N_VGetArrayPointer(r);
  (void)t, (void)user;
  d[0] = -7.89e-10 * u[0] - capture;
  d[1] = 7.89e-10 * u[0] - capture - 1.13e9 * (u[1] + u[2]) * u[1] + 1.13e3 * u[2];
  d[2] = capture - 1.13e3 * u[2];
  return 0;
}

static void e5_without_differences(void)
{
  static const char *const methods[] = {"radau:s=7", "gauss:s=4"};
  static const sunrealtype y0[] = {1.76e-3, 0, 0};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem published;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "e5", &published) && published.reference);
  const steif_reference *r = published.reference;
  const steif_problem p = {.name = "sums", .n = 3, .t1 = r->t, .y0 = y0, .f = sums};
  for (int m = 0; m < 2; m++) {
    steif_options o = steif_defaults();
    o.rtol = 1e-13, o.atol = 1e-36;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(steif_solve_to(s, r->t) == STEIF_OK);
    const sunrealtype *y = N_VGetArrayPointer(steif_solution(s));
    for (int i = 0; i < 2; i++) CLOSE(y[1] + i * y[2], r->value[i], pow(10, -r->digits));
    steif_solver_free(&s);
  }
  steif_problem_clear(ctx, &published);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_extended[] = {
  {"orbits in 31 digits by two methods", orbits_in_31_digits},
  {"E5 without differences by two methods", e5_without_differences},
  CU_TEST_INFO_NULL};
