/* test_certificates.c: what is certified is right, and what is right is certified: pencils whose truth is
 * known from integers or from the blocks they are made of, and each reason not to certify.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_agreement.h"
#include "dense_algorithm.h"
#include "impulse/families.h"
#include "impulse/systems.h"

/* -- exactly singular pencils ------------------------------------------------------------------- */

/* A row of whole numbers, a combination of others: det(s E + F) = 0, and no zero is to be seen. */
static void exactly_singular(void)
{
  static const double E[9] = {-1, 13, 16, -1, 13, 16, 0, -4, -5};
  static const double F[9] = {4, -28, -34, 4, -28, -34, -3, 19, 23};
  steif_context *ctx = steif_context_new(NULL);
  steif_structure s = look(ctx, 3, E, F, STEIF_AUTOMATIC);
  CHECK(!s.regular && s.certified && s.index == -1 && s.finite == -1 && s.weyr_count == 0);
  CHECK(strstr(s.message, "singular: det(s E + F) = 0 for all s exactly") == s.message);
  CHECK(s.equations_count > 0 && s.unknowns_count > 0);
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

static double whole(sample *s, int most) { return floor(uniform(s) * (2 * most + 1)) - most; }

/* Column j of s E + F is a combination of columns a and b, in whole numbers, of a pencil that is random
 * else; and one entry changed makes it regular. */
static void random_whole_numbers(void)
{
  enum { N = 7, DRAWS = 60 };
  steif_context *ctx = steif_context_new(NULL);
  for (int draw = 0; draw < DRAWS; draw++) {
    sample r = {.state = 4711u + 100003u * (uint64_t)draw};
    const int n = 3 + draw % (N - 2), j = draw % n, a = (j + 1) % n, b = (j + 2) % n;
    double E[N * N], F[N * N];
    for (int k = 0; k < 10; k++) uniform(&r);
    for (int k = 0; k < n * n; k++) E[k] = whole(&r, 40), F[k] = whole(&r, 40);
    const double p = whole(&r, 5), q = 1 + fabs(whole(&r, 5));
    for (int i = 0; i < n; i++) {
      E[j * n + i] = p * E[a * n + i] - q * E[b * n + i];
      F[j * n + i] = p * F[a * n + i] - q * F[b * n + i];
    }
    steif_structure s = look(ctx, n, E, F, STEIF_AUTOMATIC);
    CHECK(!s.regular && s.certified);
    steif_structure_clear(ctx, &s);
    F[j * n + draw % n] += 1;
    s = look(ctx, n, E, F, STEIF_AUTOMATIC);
    CHECK(s.regular && s.certified && s.index <= 1);
    steif_structure_clear(ctx, &s);
  }
  steif_context_free(&ctx);
}

/* -- nothing right is lost -------------------------------------------------------------------- */

/* No finite eigenvalue at all, beyond transformations of condition 10. */
static void purely_infinite(void)
{
  static const int chains[][4] = {{2}, {3}, {4}, {2, 1}, {2, 2, 1}, {3, 1}, {4, 2}, {1, 1}};
  steif_context *ctx = steif_context_new(NULL);
  for (int draw = 0; draw < 80; draw++) {
    family f = {"infinite", 0, {0}, 1, false, 10};
    memcpy(f.sizes, chains[draw % 8], sizeof chains[0]);
    sample p;
    sample_open(&p, &f, 300 + (unsigned)draw);
    steif_structure s = look(ctx, p.n, p.E, p.F, STEIF_AUTOMATIC);
    CHECK(s.certified && s.index == p.k && s.finite == 0 && fabs(s.count) < 0.5);
    if (!s.certified) printf("\n  draw %d: %s", draw, s.message);
    steif_structure_clear(ctx, &s);
    sample_close(&p);
  }
  steif_context_free(&ctx);
}

/* x(0-) in the fast part and f = 0: x(0+) = 0, as certain as any other. */
static void nothing_is_left(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int draw = 0; draw < 12; draw++) {
    const family f = {"left", draw % 3, {2, 1}, 1, true, 10};
    sample p;
    sample_open(&p, &f, 700 + (unsigned)draw);
    SUNMatrix E = dense(ctx, p.n, p.E), F = dense(ctx, p.n, p.F);
    steif_impulse i;
    double *y = calloc((size_t)p.n, sizeof *y);
    for (int k = f.finite; k < p.n; k++) y[k] = normal(&p);
    apply(p.n, p.inverse, y, p.x0);
    CHECK(!steif_impulse_find(ctx, E, F, p.x0, 0, NULL, NULL, NULL, NULL, &i));
    CHECK(i.certified && i.estimate < 1e-9);
    for (int k = 0; k < p.n; k++) CHECK(fabs(i.x_plus[k]) < 1e-10);
    steif_impulse_clear(ctx, &i);
    SUNMatDestroy(E), SUNMatDestroy(F);
    free(y);
    sample_close(&p);
  }
  steif_context_free(&ctx);
}

/* The same by circles: masses on springs, thrown at a wall by x(0-) - Pi_s x(0-). */
static void nothing_is_left_by_circles(void)
{
  system_ s;
  system_open(&s, NULL, "springs");
  const size_t n = (size_t)s.n;
  steif_structure found;
  steif_impulse i;
  double *x = calloc(2 * n, sizeof *x), *slow = x + n;
  for (size_t k = 0; k < n; k++) x[k] = sin(1.7 * (double)k) + 2;
  const steif_analysis by = {.algorithm = STEIF_CONTOUR};
  CHECK(!steif_structure_find(s.ctx, s.E, s.F, &by, &found) && found.certified);
  CHECK(!steif_projector_apply(s.ctx, s.E, s.F, &by, &found, x, slow));
  for (size_t k = 0; k < n; k++) x[k] -= slow[k];
  CHECK(!steif_impulse_find(s.ctx, s.E, s.F, x, 0, NULL, NULL, &by, &found, &i));
  CHECK(i.certified && i.estimate < 1e-6);
  for (size_t k = 0; k < n; k++) CHECK(fabs(i.x_plus[k]) < 1e-9);
  steif_impulse_clear(s.ctx, &i);
  steif_structure_clear(s.ctx, &found);
  free(x);
  system_close(&s);
}

/* -- circles and ranks ---------------------------------------------------------------------------- */

/* A ring of capacitors 0.1, 0.2, 0.3 with a conductance of 1 from each node to ground: rounding of 0.1 +
 * 0.2 makes det E = 6e-18 and an eigenvalue beyond 1e16. */
static void rounded_sums(void)
{
  static const double E[9] = {0.1 + 0.3, -0.1, -0.3, -0.1,     0.1 + 0.2,
                              -0.2,      -0.3, -0.2, 0.2 + 0.3};
  static const double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e = system_dense(ctx, 3, E), f = system_dense(ctx, 3, F);
  for (int snap = 0; snap < 2; snap++) {
    const steif_analysis by = {.algorithm = STEIF_CONTOUR, .snap = snap};
    steif_structure s;
    CHECK(!steif_structure_find(ctx, e, f, &by, &s));
    CHECK(s.regular && s.finite == 2 && s.certified == snap && s.exact == (snap ? 2 : 3));
    CHECK(!!strstr(s.message, snap ? "are taken for exact sums" : "0.1 + 0.2"));
    CHECK(!!strstr(s.message, "2 rows, the first is 1"));
    CHECK(!snap || (s.index == 1 && s.rank_E == 2 && s.doubt > 0 && s.doubt < 1e-30));
    steif_structure_clear(ctx, &s);
  }
  SUNMatDestroy(e), SUNMatDestroy(f);
  /* Whole numbers need no help, and the pattern allows 3. */
  static const double whole_E[9] = {4, -1, -3, -1, 3, -2, -3, -2, 5};
  steif_structure s = look(ctx, 3, whole_E, F, STEIF_CONTOUR);
  CHECK(s.certified && s.index == 1 && s.finite == 2 && s.exact == 2 && s.degree == 3);
  CHECK(!!strstr(s.message, "degree 3 of the pattern less what cancels exactly"));
  steif_structure_clear(ctx, &s);
  steif_context_free(&ctx);
}

/* A circle that leaves one out: ranks know that it is there, and rounding has no part in it. */
static void one_is_outside(void)
{
  static const double E[9] = {1, 1, 0, 1, 1, 0, 0, 0, 1e-6}, F[9] = {1, 0, 0, 0, 2, 0, 0, 0, 1};
  const steif_analysis by = {.algorithm = STEIF_CONTOUR, .radius = 30};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix e = system_dense(ctx, 3, E), f = system_dense(ctx, 3, F);
  steif_structure s;
  CHECK(!steif_structure_find(ctx, e, f, &by, &s));
  CHECK(!s.certified && s.finite == 1 && s.exact == 2 && s.degree == 3);
  CHECK(!!strstr(s.message, "ranks modulo two primes find 2 (the pattern: 3)"));
  steif_structure_clear(ctx, &s);
  CHECK(!steif_structure_find(ctx, e, f, &(steif_analysis){.algorithm = STEIF_CONTOUR}, &s));
  CHECK(s.certified && s.finite == 2 && s.index == 1);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(e), SUNMatDestroy(f);
  steif_context_free(&ctx);
}

/* -- every reason --------------------------------------------------------------------------------- */

/* x(0+) or one impulse apart; impulses that are nothing beside F c_0 = -E (x(0+) - x(0-)) may differ. */
static void answers_are_compared(void)
{
  double E[4] = {1, 0, 0, 1}, F[4] = {1, 0, 0, 1}, Ex0[2] = {1, 2}, room[2];
  double plus[2] = {1, 1}, other[2] = {1, 1}, c[4] = {1, 0, 0.5, 0}, d[4] = {1, 0, 0.5, 0};
  const stf_dense_units units = {.n = 2, .E = E, .F = F};
  const stf_sources sources = {2, -1, Ex0, NULL};
  const steif_impulse one = {.n = 2, .index = 3, .count = 2, .x_plus = plus, .c = c};
  const steif_impulse two = {.n = 2, .index = 3, .count = 2, .x_plus = other, .c = d};
  const stf_two_starts both = {
    .units = &units, .sources = &sources, .one = &one, .two = &two, .difference = room};
  CHECK(stf_starts_agree(&both, 1e-3) && stf_starts_apart(&both) == 0);
  d[3] = 0.01;
  CHECK(!stf_starts_agree(&both, 1e-3) && stf_starts_apart(&both) == 0);
  d[3] = 0, d[1] = 0.01;
  CHECK(!stf_starts_agree(&both, 1e-3) && stf_starts_agree(&both, 0.1));
  c[0] = d[0] = d[1] = 1e-8, d[0] = 0, c[2] = d[2] = 0;
  CHECK(stf_starts_agree(&both, 1e-3));
  other[1] = 1.01;
  CHECK(!stf_starts_agree(&both, 1e-3));
  CLOSE(stf_starts_apart(&both), 0.01 / sqrt(2), 1e-12);
}

static void each_reason_stands(void)
{
  steif_structure a = {.index = 2, .finite = 3, .count = 3.01}, b = {.index = 2, .radius = 10};
  const stf_both_ways good = {
    .staircase = &a, .schur = &b, .other_index = -1, .resolution = 1e6, .agreed = true};
  char text[240];
  CHECK(!stf_dense_objection(&good, text, sizeof text));
  const stf_both_ways bad[] = {
    {&a, &b, 1, 0, 1e6, 0, 0, true},         {&a, &b, -1, 2, 1e6, 0, 0, true},
    {&a, &b, -1, 0, 9, 0, 0, true},          {&a, &b, -1, 0, NAN, 0, 0, true},
    {&a, &b, -1, 0, 1e6, 0.2, 0, false},     {&a, &b, -1, 0, 1e6, 0, 0.1, true},
    {&a, &b, -1, 0, 1e6, 0, INFINITY, true},
  };
  static const char *const words[] = {
    "other units",      "carry 2 more", "beyond |s| = 9.0e+00", "beyond |s| = nan",
    "apart by 2.0e-01", "by 1.0e-01",   "changes the index"};
  for (int k = 0; k < 7; k++) {
    const char *said = stf_dense_objection(bad + k, text, sizeof text);
    CHECK(said && strstr(said, words[k]));
  }
  static const double counts[] = {1.897, 4, NAN};
  for (int k = 0; k < 3; k++) {
    a.count = counts[k];
    const char *said = stf_dense_objection(&good, text, sizeof text);
    CHECK(said && strstr(said, "Jensen"));
  }
  a.count = 3;
  b.index = 3;
  CHECK(!!stf_dense_objection(&good, text, sizeof text));
  b.index = -1;
  CHECK(!!stf_dense_objection(&good, text, sizeof text));
  b.index = 2, a.index = -1;
  CHECK(!!stf_dense_objection(&good, text, sizeof text));
}

/* E x' + F x = 0 with the finite eigenvalue 0 only, x(0-) = (1, 2, 3): x_3 = 6 x_1, x_2 = -x_1'/2, x_3' = 0,
 * so x_3(0+) = 3, x_1 = 1/2, and E (x(0+) - x(0-)) = (1/4, 0, 0) asks for c_0 = (0, 1/4, 0). Circles of
 * radius 1e-35, which such a spectrum allows, lose c_0, and agree: whoever asks for them is told. */
static void agreement_on_what_is_wrong(void)
{
  const double entry[2][9] = {{-.5, 0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 3, -1, 0, 0, 0, 0, -.5}};
  const double x0[] = {1, 2, 3}, right[] = {0, 0.25, 0};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix M[2];
  for (int m = 0; m < 2; m++) {
    M[m] = SUNDenseMatrix(3, 3, steif_sundials(ctx));
    memcpy(SM_DATA_D(M[m]), entry[m], sizeof entry[m]);
  }
  for (int k = 0; k < 5; k++) {
    const steif_analysis by = {.algorithm = k ? STEIF_CONTOUR : STEIF_STAIRCASE,
                               .radius = k < 2 ? 0 : pow(10, 10 - 15 * (k - 1))};
    steif_impulse found;
    CU_ASSERT_FATAL(!steif_impulse_find(ctx, M[0], M[1], x0, 0, NULL, NULL, &by, NULL, &found));
    CHECK(!found.certified || (found.c && fabs(found.c[0] - right[0]) < 1e-10 &&
                               fabs(found.c[2] - right[2]) < 1e-10));
    CHECK(k || found.certified);
    steif_impulse_clear(ctx, &found);
  }
  for (int m = 0; m < 2; m++) SUNMatDestroy(M[m]);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_certificates[] = {
  {"a pencil in whole numbers is singular exactly", exactly_singular},
  {"so are random ones, and regular by one entry", random_whole_numbers},
  {"pencils without finite eigenvalues are certified", purely_infinite},
  {"x(0+) = 0 is certified", nothing_is_left},
  {"by circles, too", nothing_is_left_by_circles},
  {"sums that are rounded are not certified, or snapped", rounded_sums},
  {"ranks know of eigenvalues outside", one_is_outside},
  {"x(0+) and every impulse are compared", answers_are_compared},
  {"each reason not to certify stands alone", each_reason_stands},
  {"circles that agree on what is wrong certify nothing", agreement_on_what_is_wrong},
  CU_TEST_INFO_NULL};
