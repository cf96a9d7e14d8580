/* test_split.c: eigenvalues, and the law T^{-1} B T = blockdiag(lambda) + S.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include "reference.h"
#include "table.h"
#include <string.h>

enum { SQUARE = STEIF_STAGES * STEIF_STAGES };

typedef struct made {
  steif_context *ctx;
  steif_table *table;
  stf_pool *pool;
  stf_transform transform;
} made;

static void make(made *m, const char *family, int s)
{
  char spec[80];
  snprintf(spec, sizeof spec, "%s:s=%d", family, s);
  m->ctx = steif_context_new(NULL);
  m->table = steif_table_new(m->ctx, spec);
  CU_ASSERT_FATAL(m->table != NULL);
  m->pool = stf_pool_new(m->ctx);
  const int code = stf_transform_build(m->pool, m->ctx, m->table, &m->transform);
  if (code) printf("\n  %s: %s", spec, steif_message(m->ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
}

static void drop(made *m)
{
  stf_pool_free(&m->pool);
  steif_table_free(m->ctx, &m->table);
  steif_context_free(&m->ctx);
}

static void multiply(int s, const double *X, const double *Y, double *Z)
{
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      long double sum = 0;
      for (int k = 0; k < s; k++) sum += (long double)X[i * s + k] * Y[k * s + j];
      Z[i * s + j] = (double)sum;
    }
}

static double norm(int s, const double *X)
{
  double most = 0;
  for (int i = 0; i < s; i++) {
    double sum = 0;
    for (int j = 0; j < s; j++) sum += fabs(X[i * s + j]);
    most = fmax(most, sum);
  }
  return most;
}

/* X - 1 */
static double off_unit(int s, double *X)
{
  for (int i = 0; i < s; i++) X[i * s + i] -= 1;
  return norm(s, X);
}

static void blocks(const stf_transform *p, double *L)
{
  const int s = p->s;
  for (int i = 0; i < s * s; i++) L[i] = p->coupling ? p->coupling[i] : 0;
  for (int k = 0; k < p->shifts; k++) {
    const int r = p->row[k];
    L[r * s + r] += p->re[k];
    if (p->im[k] == 0) continue;
    L[(r + 1) * s + r + 1] += p->re[k];
    L[r * s + r + 1] -= p->im[k], L[(r + 1) * s + r] += p->im[k];
  }
}

/* A B = 1, T Tinv = 1 and T (blockdiag + S) Tinv = B. */
static void obey(const steif_table *t, const stf_transform *p)
{
  const int s = p->s;
  static double L[SQUARE], X[SQUARE], Y[SQUARE];
  const double cond = norm(s, p->T) * norm(s, p->Tinv);
  CHECK(s == t->s);
  multiply(s, t->A, p->B, X);
  CHECK(off_unit(s, X) < 4 * STF_EPS * norm(s, t->A) * norm(s, p->B));
  multiply(s, p->T, p->Tinv, X);
  CHECK(off_unit(s, X) < 4 * STF_EPS * cond);
  blocks(p, L);
  multiply(s, p->T, L, X);
  multiply(s, X, p->Tinv, Y);
  for (int i = 0; i < s * s; i++) Y[i] -= p->B[i];
  CHECK(norm(s, Y) < 8 * STF_EPS * cond * norm(s, p->B));
  CHECK(!p->coupling || s > 26 || cond < 300); /* orthogonal, pairs scaled */
}

/* Rows of omega in lane order; coupling strictly right of the shifts' own blocks. */
static void keep_layout(const stf_transform *p)
{
  int next = 0;
  for (int k = 0; k < p->shifts; k++) {
    CHECK(p->row[k] == next && p->im[k] >= 0);
    CHECK(k == 0 || p->im[k] >= p->im[k - 1]);
    next += p->im[k] > 0 ? 2 : 1;
    for (int i = p->row[k]; p->coupling && i < next; i++)
      for (int j = 0; j < next; j++) CHECK(p->coupling[i * p->s + j] == 0);
  }
  CHECK(next == p->s);
}

static const char *const families[] = {"gauss", "radau", "lobatto3c", "radau1a"};

static void split_law(void)
{
  for (int f = 0; f < 4; f++)
    for (int s = f == 2 ? 2 : 1; s <= STEIF_STAGES; s++) {
      const unsigned before = CU_get_number_of_failures();
      made m;
      make(&m, families[f], s);
      CHECK(!m.transform.coupling == (s <= STF_EIGEN_STAGES));
      obey(m.table, &m.transform);
      if (s <= 26) keep_layout(&m.transform); /* beyond, double orders the real parts only */
      drop(&m);
      if (CU_get_number_of_failures() != before) printf("  [%s:s=%d]", families[f], s);
    }
}

static void radau_eigenvalues_agree(void)
{
  for (int k = 0; k < REFERENCES; k++) {
    const struct reference *r = radau_reference + k;
    made m;
    make(&m, "radau", r->s);
    CHECK(m.transform.shifts == (r->s + 1) / 2);
    for (int lane = 0; lane < m.transform.shifts; lane++) {
      CLOSE(m.transform.re[lane], r->re[lane], 1e-14);
      CLOSE(m.transform.im[lane], r->im[lane], 1e-14);
    }
    drop(&m);
  }
}

/* Gap of lane k to the shifts before it, and to its own conjugate. */
static double gap(const stf_transform *p, int k)
{
  double least = p->im[k] > 0 ? 2 * p->im[k] : INFINITY;
  for (int i = 0; i < k; i++)
    least = fmin(least, hypot(p->re[k] - p->re[i], p->im[k] - p->im[i]));
  return least;
}

/* Computed in 60 digits for s = 2 .. 16: floor(s/2) pairs, s mod 2 real, all in the right half
 * plane; smallest gap 2.0 (Lobatto IIIC, s = 2), above 2.6 from s = 3 on. */
static void shifts_are_pairs(void)
{
  for (int f = 0; f < 3; f++)
    for (int s = 2; s <= 16; s++) {
      made m;
      make(&m, families[f], s);
      int pairs = 0, reals = 0;
      for (int k = 0; k < m.transform.shifts; k++) {
        m.transform.im[k] > 0 ? pairs++ : reals++;
        CHECK(m.transform.re[k] > 0);
        CHECK(gap(&m.transform, k) > (s == 2 ? 1.999 : 2.6));
      }
      CHECK(pairs == s / 2 && reals == s % 2);
      drop(&m);
    }
}

static void eigenvectors_end_in_one(void)
{
  made m;
  make(&m, "radau", 5);
  const double *last = m.transform.T + 20;
  const double expected[] = {1, 2, 0, 2, 0};
  for (int j = 0; j < 5; j++) CLOSE_FLOOR(last[j], expected[j], 1e-16, 1);
  /* sum over the conjugate pair: 2 Re v, so a stage vector (1, 1, 1, 1, 1) comes back */
  for (int i = 0; i < 5; i++) {
    double back = 0;
    for (int k = 0; k < 5; k++)
      for (int j = 0; j < 5; j++)
        back += m.transform.T[i * 5 + k] * m.transform.Tinv[k * 5 + j];
    CLOSE(back, 1, 1e-13);
  }
  drop(&m);
}

void dgesvd_(const char *jobu, const char *jobvt, const int *m, const int *n, double *a,
             const int *lda, double *values, double *u, const int *ldu, double *vt,
             const int *ldvt, double *work, const int *lwork, int *info);

/* Of the complex eigenvectors with unit length: [v, conj v] is a unitary mix of sqrt(2) Re v
 * and sqrt(2) Im v, so a real singular value decomposition will do. */
static double condition(const stf_transform *p)
{
  static double X[SQUARE], values[STEIF_STAGES], work[SQUARE], none[1];
  const int s = p->s, one = 1, lwork = SQUARE;
  int info = 0;
  for (int k = 0; k < p->shifts; k++) {
    const int width = p->im[k] > 0 ? 2 : 1;
    double sum = 0;
    for (int i = 0; i < s; i++)
      for (int j = p->row[k]; j < p->row[k] + width; j++)
        sum += p->T[i * s + j] * p->T[i * s + j];
    for (int i = 0; i < s; i++)
      for (int j = p->row[k]; j < p->row[k] + width; j++)
        X[j * s + i] = p->T[i * s + j] * sqrt(width / sum);
  }
  dgesvd_("N", "N", &s, &s, X, &s, values, none, &one, none, &one, work, &lwork, &info);
  CHECK(info == 0);
  return values[0] / values[s - 1];
}

/* Gauss, s = 3, 5, .. 11, computed in 60 digits (V inverted, singular values): 12.8376,
 * 165.004, 2211.85, 30052.1, 411332. Radau IIA 0.5-0.7 of that, Lobatto IIIC 0.2-0.3. */
static void conditions_are_as_designed(void)
{
  const double gauss[] = {12.8376, 165.004, 2211.85, 30052.1, 411332};
  for (int k = 0; k < 5; k++) {
    double cond[3];
    for (int f = 0; f < 3; f++) {
      made m;
      make(&m, families[f], 2 * k + 3);
      cond[f] = condition(&m.transform);
      drop(&m);
    }
    CLOSE(cond[0], gauss[k], 5e-6);
    CHECK(cond[1] / cond[0] > 0.45 && cond[1] / cond[0] < 0.75);
    CHECK(cond[2] / cond[0] > 0.15 && cond[2] / cond[0] < 0.35);
  }
}

/* A user's table with full A. */
static int split_of(made *m, int s, const double *A)
{
  m->ctx = steif_context_new(NULL);
  m->table = NULL;
  m->pool = stf_pool_new(m->ctx);
  const steif_table own = {
    .name = "own", .kind = STEIF_COLLOCATION, .s = s, .order = 1, .A = A, .b = A};
  const int code = stf_transform_build(m->pool, m->ctx, &own, &m->transform);
  if (!code) obey(&own, &m->transform), keep_layout(&m->transform);
  return code;
}

static void any_full_table_splits(void)
{
  made m;
  /* two real eigenvalues of A, 1/2 and 1/4; the vector of 1/2 is (1, 0), its last entry 0 */
  CHECK(split_of(&m, 2, (const double[]){0.5, 0.125, 0, 0.25}) == STEIF_OK);
  CHECK(m.transform.shifts == 2 && !m.transform.coupling);
  CLOSE(m.transform.re[0] + m.transform.re[1], 6, 1e-15);
  CLOSE(m.transform.re[0] * m.transform.re[1], 8, 1e-15);
  CHECK(m.transform.im[0] == 0 && m.transform.im[1] == 0);
  drop(&m);
}

/* A = [3/4 1/4; -1/4 1/4] has the double eigenvalue 1/2 and one eigenvector, so B has 2 twice:
 * eigenvectors would be parallel, the Schur form is not. */
static void defective_tables_are_coupled(void)
{
  made m;
  m.ctx = steif_context_new(NULL);
  m.table = NULL;
  m.pool = stf_pool_new(m.ctx);
  const double A[] = {0.75, 0.25, -0.25, 0.25};
  const steif_table own = {.name = "own", .kind = STEIF_COLLOCATION, .s = 2, .A = A, .b = A};
  CHECK(stf_transform_build(m.pool, m.ctx, &own, &m.transform) == STEIF_OK);
  CHECK(m.transform.coupling != NULL);
  for (int k = 0; k < m.transform.shifts; k++) CLOSE(m.transform.re[k], 2, 1e-7);
  double L[4], X[4], Y[4];
  blocks(&m.transform, L);
  multiply(2, m.transform.T, L, X);
  multiply(2, X, m.transform.Tinv, Y);
  for (int i = 0; i < 4; i++) CLOSE_FLOOR(Y[i], m.transform.B[i], 1e-7, 1);
  drop(&m);
}

static void refused(steif_context *ctx, const steif_table *t, int code, const char *words)
{
  stf_pool *pool = stf_pool_new(ctx);
  stf_transform transform;
  CHECK(stf_transform_build(pool, ctx, t, &transform) == code);
  if (!strstr(steif_message(ctx), words)) printf("\n  %s", steif_message(ctx));
  CHECK(strstr(steif_message(ctx), words));
  stf_pool_free(&pool);
}

static void tables_without_a_split_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  /* Lobatto IIIA with three stages, first row 0: Hairer, Wanner, table IV.5.7 */
  const double A[] = {0, 0, 0, 5 / 24.0, 1 / 3.0, -1 / 24.0, 1 / 6.0, 2 / 3.0, 1 / 6.0};
  steif_table own = {.name = "3a", .kind = STEIF_COLLOCATION, .s = 3, .A = A, .b = A + 6};
  refused(ctx, &own, STEIF_UNSUPPORTED, "the A of table '3a' is singular");
  const double bad[] = {0.25, NAN, 0.5, 0.75};
  own.A = bad, own.b = bad, own.s = 2;
  refused(ctx, &own, STEIF_NOT_FINITE, "entry (1, 2)");
  steif_table *t = steif_table_new(ctx, "cranknicolson");
  refused(ctx, t, STEIF_UNSUPPORTED, "'cranknicolson' has a triangular A");
  steif_table_free(ctx, &t);
  refused(ctx, NULL, STEIF_BAD_INPUT, "NULL");
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_transform[] = {
  {"T (shifts + coupling) Tinv = B for 1 to 32 stages", split_law},
  {"Radau's eigenvalues agree with 20 published digits", radau_eigenvalues_agree},
  {"shifts are s/2 pairs in the right half plane, well apart", shifts_are_pairs},
  {"eigenvectors have last component 1", eigenvectors_end_in_one},
  {"eigenvector conditions are those of the design", conditions_are_as_designed},
  {"any full regular table splits", any_full_table_splits},
  {"a defective table is split with coupling", defective_tables_are_coupled},
  {"tables without a split are refused with a sentence", tables_without_a_split_are_refused},
  CU_TEST_INFO_NULL};
