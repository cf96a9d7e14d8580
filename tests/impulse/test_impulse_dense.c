/* test_impulse_dense.c: x(0+) and impulse coefficients of dense pencils by both
 * algorithms. SPDX-License-Identifier: BSD-3-Clause */
#include "drazin.h"
#include "impulse/families.h"
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const enum steif_algorithm both[] = {STEIF_STAIRCASE, STEIF_QZ};
static const double half_pi = 1.5707963267948966;

/* f = (cos t, sin 2t, 1 + t, cos 3t, t^2); user: the highest derivative known.
 */
static int force(sunrealtype t, int q, N_Vector out, void *user)
{
  const int *highest = user;
  double *f = N_VGetArrayPointer(out);
  if (highest && q > *highest) return 1;
  f[0] = cos(t + q * half_pi);
  f[1] = pow(2, q) * sin(2 * t + q * half_pi);
  f[2] = q == 0 ? 1 + t : q == 1;
  f[3] = pow(3, q) * cos(3 * t + q * half_pi);
  f[4] = q == 0 ? t * t : q == 1 ? 2 * t : q == 2 ? 2 : 0;
  return 0;
}

static const double before[5] = {1, 2, 3, 4, 5};
static const double after[5] = {-8, -2, 12, 0, 0};
static const double c[2][5] = {{1, 1, -1, 5, 0}, {5, 5, -5, 0, 0}};

static void exact_to(const steif_impulse *impulse, double tolerance)
{
  for (int i = 0; i < 5; i++) {
    CLOSE_FLOOR(impulse->x_plus[i], after[i], tolerance, 10);
    for (int j = 0; j < 2; j++) CLOSE_FLOOR(impulse->c[5 * j + i], c[j][i], tolerance, 5);
  }
}

/* The integers from the factors of the pencil, checked by Drazin and contour
 * formulas. */
static void five_by_five(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  for (int i = 0; i < 2; i++) {
    steif_impulse impulse;
    const steif_analysis analysis = {.algorithm = both[i]};
    CHECK(steif_impulse_find(ctx, E, F, before, 0, force, NULL, &analysis, NULL, &impulse) ==
          STEIF_OK);
    CHECK(impulse.n == 5 && impulse.index == 3 && impulse.count == 2 && impulse.certified);
    exact_to(&impulse, 1e-11);
    CHECK(impulse.last < 1e-14 && impulse.chain < 1e-13 && impulse.first < 1e-13);
    CHECK(impulse.estimate < 1e-12 && !strcmp(impulse.method, i ? "qz" : "staircase"));
    CHECK(!!strstr(impulse.message, "index 3, 2 impulse coefficients by the "));
    steif_impulse_clear(ctx, &impulse);
    CHECK(!impulse.x_plus && !impulse.c);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* E (-1, -1, 1, 0, 0) = 0: only E x(0-) enters. */
static void kernel_of_E_does_not_matter(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  const double a = 37.25, moved[5] = {1 - a, 2 - a, 3 + a, 4, 5};
  const steif_analysis by[] = {{.algorithm = STEIF_STAIRCASE},
                               {.algorithm = STEIF_QZ},
                               {.algorithm = STEIF_CONTOUR, .radius = 30, .points = 32}};
  for (int i = 0; i < 3; i++) {
    steif_impulse impulse;
    CHECK(!steif_impulse_find(ctx, E, F, moved, 0, force, NULL, by + i, NULL, &impulse));
    exact_to(&impulse, i < 2 ? 1e-11 : 1e-9);
    steif_impulse_clear(ctx, &impulse);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* t = tau t~ divides E by tau; then c_i = tau^(i+1) c~_i and x(0+) stays. tau
 * is not a power of 2, the unknowns and equations are in other units besides.
 */
static void units_do_not_matter(void)
{
  static const double row[5] = {1e9, 3e-7, 2e5, 0.7, 4e-8};
  static const double column[5] = {5e-6, 8e8, 1.3, 2e-9, 6e4};
  const double tau = 3e-4;
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  double start[5], expected[3][5] = {{0}};
  steif_impulse plain, scaled;
  CHECK(steif_impulse_find(ctx, E, F, before, 0, NULL, NULL, NULL, NULL, &plain) == STEIF_OK);
  for (int i = 0; i < 5; i++) {
    for (int j = 0; j < 5; j++) {
      SM_ELEMENT_D(E, i, j) *= row[i] * column[j] / tau;
      SM_ELEMENT_D(F, i, j) *= row[i] * column[j];
    }
    start[i] = before[i] / column[i];
    expected[0][i] = plain.x_plus[i];
    expected[1][i] = plain.c[i] / tau;
    expected[2][i] = plain.c[5 + i] / (tau * tau);
  }
  CHECK(steif_impulse_find(ctx, E, F, start, 0, NULL, NULL, NULL, NULL, &scaled) == STEIF_OK);
  CHECK(scaled.certified && scaled.count == 2);
  for (int i = 0; i < 5; i++) {
    CLOSE_FLOOR(scaled.x_plus[i] * column[i], expected[0][i], 1e-8, 10);
    CLOSE_FLOOR(scaled.c[i] * column[i], expected[1][i], 1e-8, 1 / tau);
    CLOSE_FLOOR(scaled.c[5 + i] * column[i], expected[2][i], 1e-8, 1 / (tau * tau));
  }
  steif_impulse_clear(ctx, &plain), steif_impulse_clear(ctx, &scaled);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static void residuals_vanish(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int r = 0; r < 6; r++) {
    sample p;
    sample_open(&p, &table[r].family, 5);
    steif_impulse impulse = solve(ctx, &p, both[r % 2]);
    CHECK(impulse.last < 1e-11 && impulse.chain < 1e-11 && impulse.first < 1e-9);
    impulse.c[3] += 0.01;
    const double last = impulse.last, first = impulse.first;
    SUNMatrix E = dense(ctx, p.n, p.E), F = dense(ctx, p.n, p.F);
    stf_impulse_residuals(E, F, p.x0, &impulse);
    CHECK(impulse.first > first && impulse.first > 1e-7);
    CHECK(p.k > 2 ? impulse.last == last : impulse.last > last);
    SUNMatDestroy(E), SUNMatDestroy(F);
    steif_impulse_clear(ctx, &impulse);
    sample_close(&p);
  }
  steif_context_free(&ctx);
}

/* From x(0+) itself nothing jumps. */
static void consistent_starts_have_no_impulse(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int r = 0; r < 6; r++) {
    sample p;
    sample_open(&p, &table[r].family, 2);
    memcpy(p.x0, p.plus, (size_t)p.n * sizeof(double));
    steif_impulse impulse = solve(ctx, &p, both[r % 2]);
    CHECK(impulse.certified && off(p.n, impulse.x_plus, p.plus) < 1e-6);
    if (!impulse.certified) printf("\n  %s: %s", table[r].family.name, impulse.message);
    for (int i = 0; i < impulse.count * p.n; i++) CLOSE_FLOOR(impulse.c[i], 0, 1e-8, 1);
    steif_impulse_clear(ctx, &impulse);
    sample_close(&p);
  }
  steif_context_free(&ctx);
}

/* x_1' + 0.7 x_1 + 0.4 x_2 = cos t, 1.3 x_1 + 2.6 x_2 = sin 2t: x_1 stays, x_2
 * = -x_1 / 2. */
static void index_one_has_no_impulse(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense(ctx, 2, (const double[]){1, 0, 0, 0});
  SUNMatrix F = dense(ctx, 2, (const double[]){0.7, 1.3, 0.4, 2.6});
  int highest = 0;
  steif_impulse impulse;
  double wide[5] = {6.4, -9.1};
  for (int i = 0; i < 2; i++) {
    SUNMatrix e = SUNSparseFromDenseMatrix(E, 0, CSC_MAT);
    CHECK(steif_impulse_find(ctx, e, F, wide, 0, NULL, &highest,
                             &(steif_analysis){.algorithm = both[i]}, NULL, &impulse) == 0);
    CHECK(impulse.index == 1 && impulse.count == 0 && !impulse.c && impulse.certified);
    CLOSE(impulse.x_plus[0], 6.4, 1e-14);
    CLOSE(impulse.x_plus[1], -3.2, 1e-14);
    CHECK(impulse.last == 0 && impulse.chain == 0 && impulse.first < 1e-15);
    steif_impulse_clear(ctx, &impulse);
    SUNMatDestroy(e);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static int only_values(sunrealtype t, int q, N_Vector out, void *user)
{
  (void)user;
  N_VConst(2.5 + t, out);
  return q > 0;
}

/* E regular: x(0+) = x(0-), no derivative of f is asked for. */
static void index_zero_keeps_the_start(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense(ctx, 2, (const double[]){2.3, 0.4, -1.1, 0.9});
  SUNMatrix F = dense(ctx, 2, (const double[]){0.7, 1.9, -0.2, 0.6});
  const double x0[] = {3.7, -1.6};
  steif_impulse impulse;
  CHECK(steif_impulse_find(ctx, E, F, x0, 0, only_values, NULL, NULL, NULL, &impulse) == 0);
  CHECK(impulse.index == 0 && impulse.count == 0 && impulse.certified);
  CLOSE(impulse.x_plus[0], 3.7, 1e-14);
  CLOSE(impulse.x_plus[1], -1.6, 1e-14);
  steif_impulse_clear(ctx, &impulse);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* All unknowns algebraic: N_3 x' + x = 0 from (1, 2, 3): c_0 = (2, 3, 0), c_1 =
 * (-3, 0, 0). */
static void nothing_finite(void)
{
  static const double jumps[2][3] = {{2, 3, 0}, {-3, 0, 0}};
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense(ctx, 3, (const double[]){0, 0, 0, 1, 0, 0, 0, 1, 0});
  SUNMatrix F = dense(ctx, 3, (const double[]){1, 0, 0, 0, 1, 0, 0, 0, 1});
  for (int a = 0; a < 2; a++) {
    steif_impulse impulse;
    CHECK(steif_impulse_find(ctx, E, F, before, 0, NULL, NULL,
                             &(steif_analysis){.algorithm = both[a]}, NULL, &impulse) == 0);
    CHECK(impulse.certified && impulse.count == 2);
    for (int i = 0; i < 3; i++) {
      CLOSE_FLOOR(impulse.x_plus[i], 0, 1e-14, 1);
      for (int j = 0; j < 2; j++) CLOSE_FLOOR(impulse.c[3 * j + i], jumps[j][i], 1e-14, 1);
    }
    steif_impulse_clear(ctx, &impulse);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* Singular values 2, 1 and 4e-14 of E: an answer all the same, but not
 * certified. */
static void undecided_index_is_not_certified(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense(ctx, 3, (const double[]){2, 0, 0, 0, 1, 0, 0, 0, 4e-14});
  SUNMatrix F = dense(ctx, 3, (const double[]){0.3, 0.7, 0.2, -0.6, 1.1, 0.9, 0.4, -0.8, 1.7});
  for (int a = 0; a < 2; a++) {
    steif_impulse impulse;
    CHECK(steif_impulse_find(ctx, E, F, before, 0, NULL, NULL,
                             &(steif_analysis){.algorithm = both[a]}, NULL, &impulse) == 0);
    CHECK(!impulse.certified && impulse.x_plus && isfinite(impulse.x_plus[2]));
    CHECK(!!strstr(impulse.message, "leave the index open"));
    steif_impulse_clear(ctx, &impulse);
  }
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* The oracle's answer on a sparse copy; it goes down from the radius to a sigma at which a pencil
 * this full keeps its digits. */
static void by_drazin(steif_context *ctx, SUNMatrix E, SUNMatrix F, steif_structure *s,
                      steif_impulse *impulse)
{
  double Ex0[5] = {0}, f[15];
  N_Vector g = N_VNew_Serial(5, steif_sundials(ctx));
  const stf_sources sources = {5, 2, Ex0, f};
  SUNMatrix e = SUNSparseFromDenseMatrix(E, 0, CSC_MAT);
  SUNMatrix a = SUNSparseFromDenseMatrix(F, 0, CSC_MAT);
  stf_sources_product(E, before, Ex0);
  CHECK(stf_sources_force(ctx, force, NULL, 0, 2, g, f) == STEIF_OK);
  CHECK(drazin_impulse(ctx, e, a, NULL, before, &sources, s, impulse) == STEIF_OK);
  stf_impulse_residuals(E, F, before, impulse);
  SUNMatDestroy(e), SUNMatDestroy(a);
  N_VDestroy(g);
}

/* The same question to circles, in dense matrices: radius 30, 32 points; and to the oracle. */
static void sparse_algorithms_answer_too(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  const steif_analysis analysis = {.algorithm = STEIF_CONTOUR, .radius = 30, .points = 32};
  const double tolerance = 1e-9;
  steif_structure s;
  CHECK(steif_structure_find(ctx, E, F, &analysis, &s) == STEIF_OK);
  CHECK(s.index == 3 && s.finite == 2 && !strcmp(s.method, "contour"));
  for (int way = 0; way < 3; way++) {
    steif_impulse impulse = {0};
    if (way == 2)
      by_drazin(ctx, E, F, &s, &impulse);
    else
      CHECK(steif_impulse_find(ctx, E, F, before, 0, force, NULL, &analysis, way ? &s : NULL,
                               &impulse) == STEIF_OK);
    CHECK(!strcmp(impulse.method, way == 2 ? "drazin" : "contour"));
    exact_to(&impulse, tolerance);
    CHECK(fmax(impulse.last, fmax(impulse.chain, impulse.first)) < tolerance);
    steif_impulse_clear(ctx, &impulse);
  }
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static int stopping(sunrealtype t, int q, N_Vector out, void *user)
{
  (void)t, (void)user;
  N_VConst(q == 1 ? NAN : 0.25, out);
  return q == 2 ? -7 : 0;
}
static int stopping_at_once(sunrealtype t, int q, N_Vector out, void *user)
{
  (void)t, (void)q, (void)out, (void)user;
  return -7;
}

static void refused(steif_context *ctx, const double *x0, SUNMatrix E, SUNMatrix F,
                    steif_forcing f, void *user, const steif_structure *structure, int code,
                    const char *words)
{
  steif_impulse impulse;
  CHECK(steif_impulse_find(ctx, E, F, x0, 0, f, user, NULL, structure, &impulse) == code);
  CHECK(!!strstr(steif_message(ctx), words));
  if (!strstr(steif_message(ctx), words)) printf("\n  %s", steif_message(ctx));
  CHECK(!impulse.x_plus && !impulse.c);
}

static void bad_questions_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  const double bad[5] = {1, 2, NAN, 4, 5};
  int highest = 1;
  steif_structure s, other;
  CHECK(steif_structure_find(ctx, E, F, NULL, &s) == STEIF_OK);
  refused(ctx, NULL, E, F, force, NULL, NULL, STEIF_BAD_INPUT, "x(0-) is missing");
  refused(ctx, bad, E, F, force, NULL, &s, STEIF_NOT_FINITE, "x(0-) is not finite");
  refused(ctx, before, E, F, force, &highest, &s, STEIF_BAD_INPUT,
          "derivative 2 of the forcing is not known");
  refused(ctx, before, E, F, stopping_at_once, NULL, NULL, STEIF_CALLBACK, "returned -7");
  refused(ctx, before, E, F, stopping, NULL, NULL, STEIF_BAD_INPUT,
          "derivative 1 of the forcing is not known");
  other = s, other.n = 4;
  refused(ctx, before, E, F, force, NULL, &other, STEIF_BAD_INPUT, "structure is of order 4");
  other = s, other.index = 2;
  refused(ctx, before, E, F, force, NULL, &other, STEIF_BAD_INPUT, "index 3 needs derivatives");
  CHECK(steif_impulse_find(ctx, E, F, before, 0, NULL, NULL, NULL, NULL, NULL) ==
        STEIF_BAD_INPUT);
  for (int j = 0; j < 5; j++) SM_ELEMENT_D(E, 3, j) = SM_ELEMENT_D(F, 3, j) = 0;
  refused(ctx, before, E, F, force, NULL, NULL, STEIF_SINGULAR,
          "singular pencil: equation 4 is empty");
  refused(ctx, before, E, F, force, NULL, &s, STEIF_SINGULAR, "the pencil is singular");
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

static void a_known_structure_is_used(void)
{
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
  steif_structure s;
  steif_impulse with, without;
  CHECK(steif_structure_find(ctx, E, F, NULL, &s) == STEIF_OK);
  CHECK(steif_impulse_find(ctx, E, F, before, 0, force, NULL, NULL, &s, &with) == STEIF_OK);
  CHECK(steif_impulse_find(ctx, E, F, before, 0, force, NULL, NULL, NULL, &without) == 0);
  for (int i = 0; i < 5; i++) CHECK(with.x_plus[i] == without.x_plus[i]);
  CHECK(s.weyr_count == 3 && s.weyr[2] == 1 && s.unknowns_count == 3);
  exact_to(&with, 1e-11);
  steif_impulse_clear(ctx, &with), steif_impulse_clear(ctx, &without);
  steif_structure_clear(ctx, &s);
  SUNMatDestroy(E), SUNMatDestroy(F);
  steif_context_free(&ctx);
}

/* Every allocation in turn is the first that fails. */
static void memory_may_run_short(void)
{
  int code = STEIF_NO_MEMORY, hungry = 0;
  for (long meals = 1; code != STEIF_OK && meals < 1000; meals++) {
    long left = meals;
    steif_context *ctx = steif_context_new(
      &(steif_setup){.allocate = starving, .release = feeding, .user = &left});
    if (!ctx) continue;
    SUNMatrix E = dense5(ctx, ut5_E), F = dense5(ctx, ut5_F);
    steif_impulse impulse;
    code = steif_impulse_find(ctx, E, F, before, 0, force, NULL, NULL, NULL, &impulse);
    CHECK(code == STEIF_OK || (code == STEIF_NO_MEMORY && !impulse.x_plus && !impulse.c));
    hungry += code == STEIF_NO_MEMORY;
    if (code == STEIF_OK) exact_to(&impulse, 1e-11);
    steif_impulse_clear(ctx, &impulse);
    SUNMatDestroy(E), SUNMatDestroy(F);
    steif_context_free(&ctx);
  }
  CHECK(code == STEIF_OK && hungry > 40);
}

CU_TestInfo tests_of_impulse_dense[] = {
  {"the 5 x 5 pencil of index 3 gives integers", five_by_five},
  {"only E x(0-) enters", kernel_of_E_does_not_matter},
  {"units of time, equations and unknowns do not matter", units_do_not_matter},
  {"residuals vanish, and see a wrong coefficient", residuals_vanish},
  {"consistent starts have no impulse", consistent_starts_have_no_impulse},
  {"index 1 has no impulse", index_one_has_no_impulse},
  {"index 0 keeps the start", index_zero_keeps_the_start},
  {"a pencil may have no finite eigenvalue", nothing_finite},
  {"the sparse algorithms answer too", sparse_algorithms_answer_too},
  {"an undecided index is not certified", undecided_index_is_not_certified},
  {"bad questions are refused with a sentence", bad_questions_are_refused},
  {"a known structure is used", a_known_structure_is_used},
  {"memory may run short anywhere", memory_may_run_short},
  CU_TEST_INFO_NULL};
