/* test_claims.c: what tables claim is checked, and that they claim all they could: orders,
 * stage orders, stiff accuracy, symplecticity, symmetry, A- and L-stability.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "table.h"
#include <string.h>

static steif_context *ctx;

/* Call check on every table; families with all numbers of stages up to `most`. */
static void each(int most, void (*check)(const steif_table *t))
{
  ctx = steif_context_new(NULL);
  int count = 0;
  for (size_t i = 0; i < stf_table_count; i++) {
    const steif_table *item = steif_table_at(i);
    if (item->kind == STEIF_GLM) continue; /* test_general.c */
    for (int s = 1; s <= (item->build ? most : 1); s++) {
      char spec[80];
      snprintf(spec, sizeof spec, item->build ? "%s:s=%d" : "%s", item->name, s);
      steif_table *t = steif_table_new(ctx, spec);
      if (!t && s == 1 && item->build) continue; /* a family that starts with two stages */
      CU_ASSERT_FATAL(t != NULL);
      const unsigned before = CU_get_number_of_failures();
      check(t);
      if (CU_get_number_of_failures() != before) printf("  [%s]", spec);
      steif_table_free(ctx, &t);
      count++;
    }
  }
  CHECK(count >= 14);
  steif_context_free(&ctx);
}

static double defect(const steif_table *t, int p, int hat)
{
  double d = NAN;
  CHECK(steif_table_defect(ctx, t, p, hat, &d) == STEIF_OK);
  return d;
}

static void check_order(const steif_table *t)
{
  for (int p = 1; p <= t->order && p <= 8; p++) CHECK(defect(t, p, 0) < 1e-14);
  if (t->order < 8) CHECK(defect(t, t->order + 1, 0) > 1e-6);
  if (!t->bhat) return;
  for (int p = 1; p <= t->order_hat; p++) CHECK(defect(t, p, 1) < 1e-14);
  CHECK(defect(t, t->order_hat + 1, 1) > 1e-4);
}

static void orders_hold(void) { each(9, check_order); }

static long double B(const steif_table *t, int k)
{
  long double sum = -1.0L / k;
  for (int i = 0; i < t->s; i++) sum += t->b[i] * powl(t->c[i], k - 1);
  return fabsl(sum);
}

static long double C(const steif_table *t, int k)
{
  long double most = 0;
  for (int i = 0; i < t->s; i++) {
    long double sum = -powl(t->c[i], k) / k;
    for (int j = 0; j < t->s; j++) sum += t->A[i * t->s + j] * powl(t->c[j], k - 1);
    most = fmaxl(most, fabsl(sum));
  }
  return most;
}

static long double D(const steif_table *t, int k)
{
  long double most = 0;
  for (int j = 0; j < t->s; j++) {
    long double sum = -t->b[j] * (1 - powl(t->c[j], k)) / k;
    for (int i = 0; i < t->s; i++) sum += t->b[i] * powl(t->c[i], k - 1) * t->A[i * t->s + j];
    most = fmaxl(most, fabsl(sum));
  }
  return most;
}

static void check_stage_order(const steif_table *t)
{
  for (int k = 1; k <= t->stage_order; k++) CHECK(C(t, k) < 1e-15);
  if (t->s <= 6 && t->c[t->s - 1] > 0) CHECK(C(t, t->stage_order + 1) > 1e-7);
}

static void stage_orders_hold(void) { each(STEIF_STAGES, check_stage_order); }

/* Butcher: B(p), C(q), D(r) with p <= q + r + 1 and p <= 2q + 2 give order p, for any number of
 * stages. */
static void check_simplifying(const steif_table *t)
{
  if (t->kind != STEIF_COLLOCATION) return;
  const int q = t->stage_order, r = t->order - q - 1;
  CHECK(t->order <= 2 * q + 2);
  for (int k = 1; k <= t->order; k++) CHECK(B(t, k) < 1e-15);
  for (int k = 1; k <= r; k++) CHECK(D(t, k) < 1e-15);
  if (t->s <= 5) CHECK(B(t, t->order + 1) > 1e-8 || D(t, r + 1) > 1e-8 || C(t, q + 1) > 1e-8);
}

static void simplifying_conditions_hold(void) { each(STEIF_STAGES, check_simplifying); }

static bool stiffly_accurate(const steif_table *t)
{
  bool same = t->c[t->s - 1] == 1 || fabs(t->c[t->s - 1] - 1) < 4 * STF_EPS;
  for (int j = 0; j < t->s; j++) same = same && t->b[j] == t->A[(t->s - 1) * t->s + j];
  return same;
}

static bool symplectic(const steif_table *t)
{
  double most = 0;
  for (int i = 0; i < t->s; i++)
    for (int j = 0; j < t->s; j++)
      most = fmax(most, fabs(t->b[i] * t->A[i * t->s + j] + t->b[j] * t->A[j * t->s + i] -
                             t->b[i] * t->b[j]));
  return most < 1e-15;
}

static bool symmetric(const steif_table *t)
{
  const int s = t->s;
  double most = 0;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++)
      most = fmax(most, fabs(t->A[i * s + j] + t->A[(s - 1 - i) * s + s - 1 - j] - t->b[j]));
  return most < 1e-15;
}

static void check_algebra(const steif_table *t)
{
  CHECK(stiffly_accurate(t) == !!(t->claims & STEIF_STIFFLY_ACCURATE));
  CHECK(symplectic(t) == !!(t->claims & STEIF_SYMPLECTIC));
  CHECK(symmetric(t) == !!(t->claims & STEIF_SYMMETRIC));
}

static void algebraic_claims_hold(void) { each(16, check_algebra); }

/* Shape of A: strictly lower, lower, full. */
static void check_kind(const steif_table *t)
{
  bool lower = true, strict = true;
  for (int i = 0; i < t->s; i++)
    for (int j = i; j < t->s; j++) {
      const bool zero = t->A[i * t->s + j] == 0;
      strict = strict && zero;
      lower = lower && (zero || i == j);
    }
  CHECK(strict == (t->kind == STEIF_EXPLICIT));
  if (t->kind == STEIF_DIRK) CHECK(lower);
  if (t->kind == STEIF_COLLOCATION && t->s > 1) CHECK(!lower);
}

static void kinds_hold(void) { each(16, check_kind); }

/* No pole in the closed left half plane: eigenvalues of A on its diagonal, or from the transform.
 * */
static bool poles_are_right(const steif_table *t)
{
  bool right = true;
  if (t->kind != STEIF_COLLOCATION) {
    for (int i = 0; i < t->s; i++) right = right && t->A[i * t->s + i] >= 0;
    return right;
  }
  stf_pool *pool = stf_pool_new(ctx);
  stf_transform transform;
  CHECK(stf_transform_build(pool, ctx, t, &transform) == STEIF_OK);
  for (int k = 0; k < transform.shifts; k++) right = right && transform.re[k] > 0;
  stf_pool_free(&pool);
  return right;
}

/* |R| <= 1 on the imaginary axis and at infinity, poles to the right: |R| <= 1 on the left by
 * the maximum principle. */
static bool a_stable(const steif_table *t)
{
  double most = 0, z[2] = {0}, R[2];
  for (int k = -300; k <= 600; k++) {
    z[1] = pow(10, k / 100.0);
    CHECK(steif_table_stability(ctx, t, z, R) == STEIF_OK);
    most = fmax(most, hypot(R[0], R[1]));
  }
  z[1] = INFINITY;
  CHECK(steif_table_stability(ctx, t, z, R) == STEIF_OK);
  most = fmax(most, hypot(R[0], R[1]));
  return most <= 1 + 1e-12 && poles_are_right(t);
}

static void check_stability(const steif_table *t)
{
  const double z[2] = {-INFINITY, 0};
  double R[2];
  const bool stable = a_stable(t);
  CHECK(stable == !!(t->claims & STEIF_A_STABLE));
  CHECK(steif_table_stability(ctx, t, z, R) == STEIF_OK);
  const bool damped = stable && hypot(R[0], R[1]) < 1e-13;
  CHECK(damped == !!(t->claims & STEIF_L_STABLE));
}

static void stability_claims_hold(void) { each(16, check_stability); }

static void wrong_questions_are_refused(void)
{
  ctx = steif_context_new(NULL);
  double d;
  steif_table *t = steif_table_new(ctx, "alexander3");
  CHECK(steif_table_defect(ctx, t, 0, 0, &d) == STEIF_BAD_INPUT);
  CHECK(steif_table_defect(ctx, t, 9, 0, &d) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "orders 1 to 8"));
  CHECK(steif_table_defect(ctx, t, 3, 0, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_table_defect(ctx, t, 2, 1, &d) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "'alexander3' has no embedded weights"));
  CHECK(steif_table_defect(ctx, NULL, 2, 0, &d) == STEIF_BAD_INPUT);
  steif_table_free(ctx, &t);
  for (size_t i = 0; i < stf_table_count; i++)
    if (steif_table_at(i)->build) {
      CHECK(steif_table_defect(ctx, steif_table_at(i), 2, 0, &d) == STEIF_BAD_INPUT);
      CHECK(strstr(steif_message(ctx), "steif_table_new"));
    } else if (steif_table_at(i)->kind == STEIF_GLM) {
      CHECK(steif_table_defect(ctx, steif_table_at(i), 2, 0, &d) == STEIF_UNSUPPORTED);
      CHECK(strstr(steif_message(ctx), "general linear method"));
    }
  const steif_table wide = {.s = STEIF_STAGES + 1, .A = &d, .b = &d};
  CHECK(steif_table_defect(ctx, &wide, 2, 0, &d) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
}

/* Elementary weights of one stage with A = (a): every tree with p vertices weighs b a^{p-1},
 * the bushy one is due 1/p and lies farthest away. */
static void defects_by_hand(void)
{
  ctx = steif_context_new(NULL);
  steif_table *t = steif_table_new(ctx, "euler");
  CLOSE(defect(t, 2, 0), 0.5, 0);
  steif_table_free(ctx, &t);
  const double A[] = {0.37}, b[] = {0.83};
  const steif_table one = {.s = 1, .A = A, .b = b};
  CLOSE(defect(&one, 1, 0), 0.17, 1e-15);
  CLOSE(defect(&one, 2, 0), 0.5 - 0.83 * 0.37, 1e-15);
  /* both trees of order 3 weigh b a^2, with 1/3 and 1/6 */
  CLOSE(defect(&one, 3, 0), 1 / 3.0 - 0.83 * 0.37 * 0.37, 1e-15);
  /* bushy tree of order 8: b a^7 against 1/8 */
  CLOSE(defect(&one, 8, 0), 1 / 8.0 - 0.83 * pow(0.37, 7), 1e-15);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_claims[] = {
  {"order conditions hold to the claimed order and fail beyond", orders_hold},
  {"stage orders hold and are the largest", stage_orders_hold},
  {"B(p), C(q), D(r) give the order for up to 32 stages", simplifying_conditions_hold},
  {"stiff accuracy, symplecticity, symmetry are claimed exactly", algebraic_claims_hold},
  {"A has the shape of its kind", kinds_hold},
  {"A- and L-stability are claimed exactly", stability_claims_hold},
  {"defects agree with those by hand", defects_by_hand},
  {"wrong questions are refused with a sentence", wrong_questions_are_refused},
  CU_TEST_INFO_NULL};
