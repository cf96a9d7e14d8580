/* A whole run as a function of time.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "smooth.h"

typedef struct both {
  steif_record *record;
  int count;
  double before, t[512], y[512][2]; /* dense output inside the steps */
} both;

static int watch(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  static const double inside[] = {0.03, 0.41, 0.87};
  both *b = user;
  N_Vector v = N_VClone(y);
  for (int i = 0; i < 3 && b->count < 512; i++, b->count++) {
    b->t[b->count] = b->before + inside[i] * (t - b->before);
    CHECK(!steif_dense(s, b->t[b->count], v));
    memcpy(b->y[b->count], N_VGetArrayPointer(v), sizeof b->y[0]);
  }
  N_VDestroy(v);
  b->before = t;
  return steif_record_step(s, t, y, b->record);
}

static void a_record_is_the_dense_output(void)
{
  static const char *const methods[] = {"radau:s=3", "gauss:s=2", "bdf", "dirk:esdirk43",
                                        "rodas4",    "cvode",     "ida", "rk4"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 8; m++) {
    both b = {.record = steif_record_new(ctx, 2, 0), .before = 0.25};
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-5, o.h = m == 7 ? 0.05 : 0, o.observe = watch, o.observer = &b;
    steif_solver *s = smooth_open(ctx, &smooth, methods[m], &o);
    CHECK(!steif_solve_to(s, 2) && b.count > 12);
    for (int k = 0; k < b.count; k++) {
      double y[2], yp[2];
      CHECK(!steif_record_at(b.record, b.t[k], y, yp));
      for (int i = 0; i < 2; i++) CLOSE_FLOOR(y[i], b.y[k][i], 1e-13, 1);
      CLOSE_FLOOR(yp[1], cos(b.t[k]), m == 5 || m == 6 ? 2e-2 : 2e-3, 1);
    }
    const double *t;
    const size_t steps = steif_record_steps(b.record, &t);
    CHECK((long)steps == steif_statistics(s)->steps && t[0] == 0.25 && t[steps] == 2);
    for (size_t k = 0; k <= steps; k++) { /* at the ends of steps exactly */
      double y[2], yp[2];
      CHECK(!steif_record_at(b.record, t[k], y, yp));
      CLOSE_FLOOR(y[1], sin(t[k]), 1e-3, 1);
      CLOSE_FLOOR(yp[1], cos(t[k]), 5e-2, 1);
    }
    steif_solver_free(&s);
    steif_record_free(&b.record);
  }
  steif_context_free(&ctx);
}

static void events_are_seen_from_behind(void)
{
  steif_problem p;
  steif_context *ctx = steif_context_new(NULL);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, "bounce", &p));
  steif_record *r = steif_record_new(ctx, 2, 3);
  steif_options o = steif_defaults();
  o.rtol = o.atol = 1e-9, o.observe = steif_record_step, o.observer = r;
  steif_solver *s = smooth_open(ctx, &p, "radau:s=3", &o);
  CHECK(!steif_solve_to(s, 3));
  const double *t;
  const size_t steps = steif_record_steps(r, &t);
  int events = 0;
  for (size_t k = 1; k < steps; k++)
    for (int e = 0; e < p.event_time_count; e++)
      if (fabs(t[k] - p.event_times[e]) < 1e-9) {
        double y[2];
        CHECK(!steif_record_at(r, t[k], y, NULL));
        CLOSE(y[1], 9.81 * sqrt(2 / 9.81) * pow(0.8, e + 1), 1e-9); /* upwards */
        CHECK(!steif_record_at(r, nextafter(t[k], 0), y, NULL));
        CLOSE(y[1], -9.81 * sqrt(2 / 9.81) * pow(0.8, e), 1e-9);
        events++;
      }
  CHECK(events == 6);
  for (int k = 0; k <= 300; k++) {
    double y[2];
    CHECK(!steif_record_at(r, 0.01 * k, y, NULL) && y[0] > -1e-9);
  }
  steif_solver_free(&s);
  steif_record_free(&r);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

/* y of each step as the solver shows it there; the start by a call of our own. */
static void steps_alone(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_record *r = steif_record_new(ctx, 2, STEIF_RECORD_STEPS);
  steif_options o = steif_defaults();
  const sunrealtype *t, h = 1.0 / 256;
  double at[2];
  o.h = h, o.observe = steif_record_step, o.observer = r;
  steif_solver *s = smooth_open(ctx, &smooth, "radau:s=3", &o);
  CHECK(!steif_record_step(s, 0.25, steif_solution(s), r));
  CHECK(!steif_solve_to(s, 1));
  CU_ASSERT_FATAL(steif_record_steps(r, &t) == 192);
  const sunrealtype *y = steif_record_values(r);
  for (int k = 0; k <= 192; k++) {
    CLOSE(t[k], 0.25 + k * h, 1e-14);
    CLOSE(y[2 * k + 1], sin(0.25 + k * h), 1e-12);
  }
  CHECK(y[385] == NV_Ith_S(steif_solution(s), 1));
  CHECK(steif_record_at(r, 0.5, at, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "steps alone") != NULL);
  steif_solver_free(&s);
  steif_record_free(&r);
  r = steif_record_new(ctx, 2, 3);
  CHECK(!steif_record_values(r));
  steif_record_free(&r);
  CHECK(!steif_record_new(ctx, 2, -2));
  steif_context_free(&ctx);
}

static void wrong_records_are_refused(void)
{
  steif_context *ctx = steif_context_new(NULL);
  double y[2];
  CHECK(!steif_record_new(ctx, 0, 3) && steif_status(ctx) == STEIF_BAD_INPUT);
  CHECK(!steif_record_new(ctx, 2, 21) && strstr(steif_message(ctx), "degree 21"));
  steif_record *r = steif_record_new(ctx, 2, 3), *three = steif_record_new(ctx, 3, 3);
  CHECK(steif_record_at(r, 1, y, NULL) == STEIF_BAD_INPUT);
  steif_options o = steif_defaults();
  o.observe = steif_record_step, o.observer = r;
  steif_solver *s = smooth_open(ctx, &smooth, "radau:s=3", &o);
  CHECK(!steif_solve_to(s, 1));
  CHECK(steif_record_at(r, 0.2499, y, NULL) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "lies outside the record"));
  CHECK(steif_record_at(r, NAN, y, NULL) == STEIF_BAD_INPUT);
  CHECK(!steif_record_at(r, 0.25, y, NULL));
  CLOSE(y[1], sin(0.25), 1e-14);
  steif_solver_free(&s);
  o.observer = three;
  s = smooth_open(ctx, &smooth, "radau:s=3", &o);
  CHECK(steif_solve_to(s, 1) ==
        STEIF_BAD_INPUT); /* what the record says, not that it stopped */
  CHECK(strstr(steif_message(ctx), "a record of 3 components") != NULL);
  steif_solver_free(&s);
  steif_record_free(&r), steif_record_free(&three), steif_record_free(NULL);
  steif_context_free(&ctx);
}

static void short_memory_ends_the_run_and_loses_nothing(void)
{
  for (long k = 1; k < 400; k++) {
    failing f = {.refuse_at = k};
    const steif_setup setup = failing_setup(&f);
    steif_context *ctx = steif_context_new(&setup);
    steif_record *r = ctx ? steif_record_new(ctx, 2, k % 2 ? 4 : STEIF_RECORD_STEPS) : NULL;
    steif_options o = steif_defaults();
    o.h = 1.75 / 200, o.observe = steif_record_step, o.observer = r;
    steif_solver *s = r ? steif_solver_new(ctx, &smooth, "be", &o) : NULL;
    const int code = s ? steif_solve_to(s, 2) : -1;
    CHECK(code == STEIF_OK || f.served >= k);
    steif_solver_free(&s);
    steif_record_free(&r);
    steif_context_free(&ctx);
    CHECK(f.alive == 0);
    if (code == STEIF_OK) return;
  }
  CU_FAIL("never enough memory");
}

CU_TestInfo tests_of_record[] = {
  {"a record is the dense output", a_record_is_the_dense_output},
  {"events are seen from behind", events_are_seen_from_behind},
  {"steps alone", steps_alone},
  {"wrong records are refused", wrong_records_are_refused},
  {"short memory ends the run and loses nothing", short_memory_ends_the_run_and_loses_nothing},
  CU_TEST_INFO_NULL};
