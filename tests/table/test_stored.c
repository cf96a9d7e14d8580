/* Kept tables are what the computation gives, to rounding.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stored.h"
#include "suite.h"

static void same(const char *what, int s, int count, const double *kept, const double *made)
{
  for (int i = 0; i < count; i++) {
    const int good = fabs(kept[i] - made[i]) <= 2e-15 * fmax(1, fabs(made[i]));
    if (!good) printf("\n  %s of %d stages, entry %d: %a %a", what, s, i, kept[i], made[i]);
    CHECK(good);
  }
}

static void kept_is_computed(void)
{
  steif_context *ctx = steif_context_new(NULL);
  CHECK(stf_stored_count == 8);
  for (size_t i = 0; i < stf_stored_count; i++) {
    const stf_stored *k = stf_stored_tables + i;
    const int s = k->s, radau = k->family[0] == 'r';
    double A[2 * 49], b[7], c[7];
    steif_table t = {.name = k->family, .kind = STEIF_COLLOCATION, .s = s};
    stf_pool *pool = stf_pool_new(ctx);
    stf_transform transform;
    CHECK(!stf_family_compute(ctx, radau ? STF_RADAU_RIGHT : STF_GAUSS, NULL, &t, A, b, c));
    CHECK(!stf_transform_compute(pool, ctx, &t, &transform));
    same("c", s, s, k->c, c);
    same("b", s, s, k->b, b);
    same("A", s, s * s, k->A, A);
    same("A_low", s, s * s, k->A_low, A + s * s);
    same("B", s, s * s, k->B, transform.B);
    same("T", s, s * s, k->T, transform.T);
    same("Tinv", s, s * s, k->Tinv, transform.Tinv);
    stf_transform kept;
    stf_stored_transform(k, &kept);
    CHECK(kept.shifts == transform.shifts && !transform.coupling);
    for (int m = 0; m < kept.shifts; m++) CHECK(kept.row[m] == transform.row[m]);
    same("re", s, kept.shifts, kept.re, transform.re);
    same("im", s, kept.shifts, kept.im, transform.im);
    stf_pool_free(&pool);
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_stored[] = {
  {"kept tables are what the computation gives", kept_is_computed}, CU_TEST_INFO_NULL};
