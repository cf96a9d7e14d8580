/* test_separable.c: separable problems of all shapes, halves of f, time in them, vectors of
 * any kind; and what is refused.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_manyvector.h>
#include <nvector/nvector_serial.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <string.h>

/* H = T(t, p) + V(t, q) with q' = p (1 + 0.3 sin t), p' = -q + 0.7 cos 2t: one half through
 * f, the other by its own callback, or both. */
static int general(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *x = N_VGetArrayPointer(y);
  sunrealtype *d = N_VGetArrayPointer(r);
  (void)user;
  d[0] = x[1] * (1 + 0.3 * sin(t));
  d[1] = -x[0] + 0.7 * cos(2 * t);
  return 0;
}

static int general_kick(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(r, 1) = -NV_Ith_S(y, 0) + 0.7 * cos(2 * t);
  return 0;
}

static int general_drift(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(r, 0) = NV_Ith_S(y, 1) * (1 + 0.3 * sin(t));
  return 0;
}

static const sunrealtype start[] = {0.83, -0.37};
static const steif_problem forced = {
  .name = "forced", .n = 2, .t1 = 3, .y0 = start, .f = general, .positions = 1};

static void end(steif_context *ctx, const steif_problem *p, const char *method, double h,
                double y[2])
{
  steif_options o = steif_defaults();
  o.h = h;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(code == STEIF_OK);
  memcpy(y, NV_DATA_S(steif_solution(s)), 2 * sizeof *y);
  steif_solver_free(&s);
}

/* With time in both halves the order is kept: against gauss:s=5 by halving. */
static void time_may_stand_in_both_halves(void)
{
  static const struct {
    const char *method;
    int order;
  } rows[] = {{"symeuler", 1},           {"verlet", 2},
              {"verlet:first=drift", 2}, {"kahanli6:first=drift", 6},
              {"yoshida4", 4},           {"blanesmoan6", 4}};
  steif_context *ctx = steif_context_new(NULL);
  double exact[2], a[2], b[2], again[2];
  end(ctx, &forced, "gauss:s=5", 0.05, exact);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    end(ctx, &forced, rows[i].method, 0.1, a);
    end(ctx, &forced, rows[i].method, 0.05, b);
    const double order =
      log2(hypot(a[0] - exact[0], a[1] - exact[1]) / hypot(b[0] - exact[0], b[1] - exact[1]));
    CLOSE_FLOOR(order, rows[i].order, 0.2, 1);
    steif_problem p = forced;
    p.kick = general_kick;
    end(ctx, &p, rows[i].method, 0.05, again);
    CHECK(again[0] == b[0] && again[1] == b[1]);
    p.drift = general_drift;
    end(ctx, &p, rows[i].method, 0.05, again);
    CHECK(again[0] == b[0] && again[1] == b[1]);
  }
  steif_context_free(&ctx);
}

static int start_of_two(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  (void)t, (void)user, (void)yp;
  NV_Ith_S(N_VGetSubvector_ManyVector(y, 0), 0) = start[0];
  NV_Ith_S(N_VGetSubvector_ManyVector(y, 1), 0) = start[1];
  return 0;
}

static int kick_of_two(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(N_VGetSubvector_ManyVector(r, 1), 0) =
    -NV_Ith_S(N_VGetSubvector_ManyVector(y, 0), 0) + 0.7 * cos(2 * t);
  return 0;
}

static int drift_of_two(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)user;
  NV_Ith_S(N_VGetSubvector_ManyVector(r, 0), 0) =
    NV_Ith_S(N_VGetSubvector_ManyVector(y, 1), 0) * (1 + 0.3 * sin(t));
  return 0;
}

static int both_of_two(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  return kick_of_two(t, y, r, user) + drift_of_two(t, y, r, user);
}

/* q and p as two vectors of their own give the same run. */
static void any_vector_will_do(void)
{
  static const char *const methods[] = {"verlet:compensated=0", "verlet:compensated=1",
                                        "pefrl:compensated=1", "symeuler:first=q"};
  steif_context *ctx = steif_context_new(NULL);
  N_Vector part[] = {N_VNew_Serial(1, steif_sundials(ctx)),
                     N_VNew_Serial(1, steif_sundials(ctx))};
  N_Vector like = N_VNew_ManyVector(2, part, steif_sundials(ctx));
  CU_ASSERT_FATAL(like != NULL);
  steif_problem p = forced;
  p.y0 = NULL, p.start = start_of_two, p.f = both_of_two;
  for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
    double y[2];
    end(ctx, &forced, methods[i], 0.05, y);
    steif_options o = steif_defaults();
    o.h = 0.05, o.like = like;
    p.kick = kick_of_two, p.drift = drift_of_two;
    steif_solver *s = steif_solver_new(ctx, &p, methods[i], &o);
    CU_ASSERT_FATAL(s != NULL);
    CHECK(steif_solve_to(s, p.t1) == STEIF_OK);
    for (int k = 0; k < 2; k++)
      CLOSE(NV_Ith_S(N_VGetSubvector_ManyVector(steif_solution(s), k), 0), y[k], 1e-15);
    steif_solver_free(&s);
    p.drift = NULL;
    CHECK(!steif_solver_new(ctx, &p, methods[i], &o));
    CHECK(steif_status(ctx) == STEIF_UNSUPPORTED &&
          strstr(steif_message(ctx), ".kick and .drift"));
  }
  N_VDestroy(like), N_VDestroy(part[0]), N_VDestroy(part[1]);
  steif_context_free(&ctx);
}

/* -- refusals ---------------------------------------------------------------------------------- */

static void refused(const steif_problem *p, const char *method, double h, int code,
                    const char *words)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_options o = steif_defaults();
  o.h = h;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int good = !s && steif_status(ctx) == code && strstr(steif_message(ctx), words);
  if (!good) printf("\n  %s: %d %s", method, steif_status(ctx), steif_message(ctx));
  CHECK(good);
  steif_solver_free(&s);
  steif_context_free(&ctx);
}

static int mixed(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const int code = general(t, y, r, user);
  NV_Ith_S(r, 1) -= 0.2 * NV_Ith_S(y, 1);
  return code;
}

static int wrong_kick(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const int code = general_kick(t, y, r, user);
  NV_Ith_S(r, 1) *= 1 + 1e-9;
  return code;
}

static void what_does_not_split_is_refused(void)
{
  steif_problem p = forced;
  p.positions = 0;
  refused(&p, "verlet", 0.1, STEIF_UNSUPPORTED, "not declared separable");
  p.positions = 2;
  refused(&p, "verlet", 0.1, STEIF_BAD_INPUT, "positions = 2");
  p = forced, p.f = mixed;
  refused(&p, "rkn6", 0.1, STEIF_UNSUPPORTED, "component 2 of f");
  p = forced, p.kick = wrong_kick;
  refused(&p, "verlet", 0.1, STEIF_BAD_INPUT, "component 2 of kick");
  p = forced, p.unit_mass = 1;
  p.t0 = 0.2;
  refused(&p, "verlet", 0.1, STEIF_BAD_INPUT, "says q' = p");
  refused(&forced, "verlet", 0, STEIF_UNSUPPORTED, "no error estimate");
  refused(&forced, "verlet:first=last", 0.1, STEIF_BAD_INPUT, "first=last");
  refused(&forced, "pefrl:first=kick", 0.1, STEIF_UNKNOWN_NAME, "compensated");
  refused(&forced, "verlet:compensated=2", 0.1, STEIF_BAD_INPUT, "compensated=2");
  refused(&forced, "gauss:s=2,compensated=0.5", 0.1, STEIF_BAD_INPUT, "compensated=0.5");
  refused(&forced, "verlett", 0.1, STEIF_UNKNOWN_NAME, "'verlet'");
}

CU_TestInfo tests_of_separable[] = {
  {"time may stand in both halves", time_may_stand_in_both_halves},
  {"any vector will do", any_vector_will_do},
  {"what does not split is refused", what_does_not_split_is_refused},
  CU_TEST_INFO_NULL};
