/* Patterns found from values of f and F. SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "fixture.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

/* Neighbours at distance 1 and 3, one product that is 0 at the start, a root that is not defined below 0. */
enum { RING = 9 };
static int calls;
static int ring(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  calls++;
  for (int i = 0; i < RING; i++) {
    const double near = NV_Ith_S(y, (i + 1) % RING), far = NV_Ith_S(y, (i + 3) % RING);
    if (near < 0) return 1;
    NV_Ith_S(out, i) = i == 4 ? near * far - NV_Ith_S(y, 4) : far - 2 * sqrt(near);
  }
  return 0;
}

static int ring_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector out, void *user)
{
  const int code = ring(t, y, out, user);
  for (int i = 0; i < RING; i++) NV_Ith_S(out, i) -= NV_Ith_S(yp, (i + 5) % RING);
  return code;
}

static int has(const steif_pattern *p, sunindextype i, sunindextype j)
{
  for (sunindextype k = p->column[j]; k < p->column[j + 1]; k++)
    if (p->row[k] == i) return 1;
  return 0;
}

static void patterns_are_found(void)
{
  static const double y0[RING] = {0, 1, 2, 0, 0, 0, 0, 1, 3};
  steif_context *ctx = steif_context_new(NULL);
  for (int implicit = 0; implicit < 2; implicit++) {
    steif_problem p = {.name = "ring", .n = RING, .t1 = 1, .y0 = y0, .storage = STEIF_SPARSE};
    steif_pattern *found = NULL;
    if (implicit)
      p.F = ring_residual;
    else
      p.f = ring;
    calls = 0;
    const int code = steif_pattern_find(ctx, &p, &found);
    if (code) printf("\n  %s", steif_message(ctx));
    CU_ASSERT_FATAL(!code);
    CHECK(calls <= 3 + 9 + 3 * (1 + implicit) * (RING + 1));
    CHECK(found->column[0] == 0 && found->column[RING] == (3 + implicit) * RING);
    for (int i = 0; i < RING; i++) {
      CHECK(has(found, i, i) && has(found, i, (i + 1) % RING) && has(found, i, (i + 3) % RING));
      CHECK(has(found, i, (i + 5) % RING) == implicit);
    }
    for (int j = 0; j < RING; j++)
      for (sunindextype k = found->column[j] + 1; k < found->column[j + 1]; k++)
        CHECK(found->row[k] > found->row[k - 1]);
    steif_pattern_free(ctx, &found);
    CHECK(!found);
  }
  steif_context_free(&ctx);
}

/* Below and above the start different unknowns are heard, and one far away of it. */
static int switches(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const double *u = NV_DATA_S(y);
  (void)t, (void)user;
  NV_Ith_S(out, 0) = u[3] > 1 ? u[1] : u[2];
  NV_Ith_S(out, 1) = u[3] < 1 ? u[0] : -u[3];
  NV_Ith_S(out, 2) = fmax(0, fabs(u[3] - 1) - 0.03) * u[1] * u[0];
  NV_Ith_S(out, 3) = 0;
  return 0;
}

static void both_sides_of_a_switch_are_found(void)
{
  static const double y0[] = {1, 1, 1, 1};
  steif_context *ctx = steif_context_new(NULL);
  const steif_problem p = {.name = "switches", .n = 4, .t1 = 1, .y0 = y0, .f = switches};
  steif_pattern *found = NULL;
  CU_ASSERT_FATAL(!steif_pattern_find(ctx, &p, &found));
  CHECK(has(found, 0, 1) && has(found, 0, 2) && has(found, 1, 0) && has(found, 1, 3));
  CHECK(has(found, 2, 0) && has(found, 2, 1) && has(found, 2, 3) && has(found, 3, 3));
  CHECK(!has(found, 0, 3) && !has(found, 3, 0) && !has(found, 1, 2));
  steif_pattern_free(ctx, &found);
  steif_context_free(&ctx);
}

static int never(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  N_VConst(0, out);
  return NV_Ith_S(y, 0) != 1 || NV_Ith_S(y, 1) != 1 ? *(int *)user : 0;
}

static void patterns_that_cannot_be_found_are_told(void)
{
  static const double y0[] = {1, 1};
  int returns = 1;
  steif_problem p = {.name = "never", .n = 2, .t1 = 1, .y0 = y0, .f = never, .user = &returns};
  steif_pattern *found = NULL;
  steif_context *ctx = steif_context_new(NULL);
  CHECK(steif_pattern_find(ctx, &p, &found) == STEIF_NOT_FINITE && !found);
  CHECK(strstr(steif_message(ctx), "give the pattern by hand") != NULL);
  returns = -3;
  CHECK(steif_pattern_find(ctx, &p, &found) == STEIF_CALLBACK && !found);
  CHECK(steif_pattern_find(ctx, &p, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_pattern_find(ctx, NULL, &found) == STEIF_BAD_INPUT);
  CHECK(steif_pattern_find(NULL, &p, &found) == STEIF_BAD_INPUT);
  steif_context_free(&ctx);
  for (long k = 1, more = 1; more; k++) {
    failing x = {.refuse_at = k};
    const steif_setup setup = failing_setup(&x);
    steif_context *short_of = steif_context_new(&setup);
    returns = 0;
    const int code = short_of ? steif_pattern_find(short_of, &p, &found) : STEIF_NO_MEMORY;
    more = x.served >= k;
    CHECK(code == (more ? STEIF_NO_MEMORY : STEIF_OK));
    steif_pattern_free(short_of, &found);
    steif_context_free(&short_of);
    CHECK(x.alive == 0);
  }
}

CU_TestInfo tests_of_pattern[] = {
  {"patterns are found", patterns_are_found},
  {"both sides of a switch are found", both_sides_of_a_switch_are_found},
  {"patterns that cannot be found are told", patterns_that_cannot_be_found_are_told},
  CU_TEST_INFO_NULL};
