/* test_failures.c: callbacks that fail, values that are not finite, specs that are refused.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static const char *const all[] = {"cvode", "ida", "arkode"};

/* What goes wrong, and from which time on. */
typedef struct trouble {
  int verdict;
  sunrealtype value, from;
  int jacobian;
} trouble;

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const trouble *x = user;
  NV_Ith_S(ydot, 0) = -1.1 * NV_Ith_S(y, 0);
  NV_Ith_S(ydot, 1) = t - NV_Ith_S(y, 1);
  if (x->jacobian || t < x->from) return 0;
  if (x->value != 0) NV_Ith_S(ydot, 1) = x->value;
  return x->verdict;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)y, (void)fy, (void)a, (void)b, (void)c;
  const trouble *x = user;
  SM_ELEMENT_D(J, 0, 0) = -1.1;
  SM_ELEMENT_D(J, 1, 1) = -1;
  if (!x->jacobian || t < x->from) return 0;
  if (x->value != 0) SM_ELEMENT_D(J, 1, 0) = x->value;
  return x->verdict;
}

/* The code of a run with this trouble; its sentence must hold all of `words`. */
static int outcome(const char *engine, trouble x, const char *const *words)
{
  const sunrealtype y0[] = {1.21, 0.3};
  const steif_problem p = {
    .name = "trouble", .n = 2, .t1 = 3, .y0 = y0, .f = f, .jac = jac, .user = &x};
  ride r;
  const int code = ride_whole(&r, &p, engine, NULL);
  for (; *words; words++) {
    if (!strstr(ride_says(&r), *words)) printf("\n  no \"%s\" in: %s", *words, ride_says(&r));
    CU_ASSERT(strstr(ride_says(&r), *words) != NULL);
  }
  for (int i = 0; i < 2; i++) CHECK(isfinite(ride_y(&r, i)));
  ride_close(&r);
  return code;
}

#define WORDS(...)                                                                             \
  (const char *const[]) { __VA_ARGS__, NULL }

static void f_stops(void)
{
  for (int e = 0; e < 3; e++) {
    CHECK(outcome(all[e], (trouble){.verdict = -17, .from = 0.71},
                  WORDS("returned -17 at t = 0.", "stopped at t = 0.")) == STEIF_CALLBACK);
    CHECK(outcome(all[e], (trouble){.verdict = -17, .from = -1}, WORDS("-17", "t = 0")) ==
          STEIF_CALLBACK);
  }
}

static void f_fails_however_small_the_step(void)
{
  for (int e = 0; e < 3; e++) {
    CHECK(outcome(all[e], (trouble){.verdict = 5, .from = 0.71},
                  WORDS("f returned 5 at t = 0.7", "stopped at t = 0.7")) == STEIF_CALLBACK);
    CHECK(outcome(all[e], (trouble){.verdict = 5, .from = -1}, WORDS("5", "t = 0")) ==
          STEIF_CALLBACK);
  }
}

static void values_that_are_not_finite(void)
{
  for (int e = 0; e < 3; e++)
    for (int k = 0; k < 2; k++) {
      const sunrealtype value = k ? INFINITY : NAN;
      CHECK(outcome(all[e], (trouble){.value = value, .from = 0.71},
                    WORDS("component 2 of f was not finite at t = 0.7")) == STEIF_NOT_FINITE);
      CHECK(outcome(all[e], (trouble){.value = value, .from = -1}, WORDS("t = 0")) ==
            STEIF_NOT_FINITE);
      CHECK(outcome(all[e], (trouble){.value = value, .from = -1, .jacobian = 1},
                    WORDS("the Jacobian was not finite at t = ")) == STEIF_NOT_FINITE);
    }
}

static void jacobian_stops(void)
{
  for (int e = 0; e < 3; e++)
    CHECK(outcome(all[e], (trouble){.verdict = -23, .from = -1, .jacobian = 1},
                  WORDS("the Jacobian returned -23 at t = ")) == STEIF_CALLBACK);
}

/* y' = y^2 from 1.25 leaves every bound at t = 0.8. */
static int blow_up(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

static void a_pole_is_not_crossed(void)
{
  const sunrealtype y0[] = {1.25};
  const steif_problem p = {.name = "pole", .n = 1, .t1 = 2, .y0 = y0, .f = blow_up};
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &p, all[e], NULL) != STEIF_OK);
    CLOSE(r.run.t, 0.8, 1e-3);
    CHECK(strstr(ride_says(&r), "stopped at t = 0.") != NULL);
    ride_close(&r);
  }
}

static void step_limit(void)
{
  const sunrealtype y0[] = {1.25};
  const steif_problem p = {.name = "pole", .n = 1, .t1 = 0.7, .y0 = y0, .f = blow_up};
  steif_options o = ride_defaults();
  o.max_steps = 13;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &p, e == 2 ? "arkode:newton=1e-4" : all[e], &o) == STEIF_STEP_LIMIT);
    CHECK(r.run.stats.steps == 13 && strstr(ride_says(&r), "made 13 steps") != NULL);
    ride_close(&r);
  }
}

static void weights_must_be_positive(void)
{
  const sunrealtype y0[] = {0, 0.3};
  trouble none = {0};
  none.from = 10;
  const steif_problem p = {.name = "zero", .n = 2, .t1 = 3, .y0 = y0, .f = f, .user = &none};
  steif_options o = ride_defaults();
  o.atol = 0;
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &p, all[e], &o) == STEIF_BASELINE);
    CHECK(strstr(ride_says(&r), "aise atol above 0") != NULL);
    ride_close(&r);
  }
}

static void refused(const char *spec, const steif_options *o, int code, const char *word)
{
  const sunrealtype y0[] = {1.25};
  const steif_problem p = {.name = "pole", .n = 1, .t1 = 0.7, .y0 = y0, .f = blow_up};
  ride r;
  CHECK(ride_open(&r, &p, spec, o) == code);
  if (!strstr(ride_says(&r), word)) printf("\n  no \"%s\" in: %s", word, ride_says(&r));
  CU_ASSERT(strstr(ride_says(&r), word) != NULL);
  ride_close(&r);
}

static void specs_are_checked(void)
{
  refused("cvode:order=6", NULL, STEIF_BAD_INPUT, "order=6");
  refused("ida:order=0", NULL, STEIF_BAD_INPUT, "order=0");
  refused("arkode:order=9", NULL, STEIF_BAD_INPUT, "order=9");
  refused("cvode:orda=2", NULL, STEIF_UNKNOWN_NAME, "orda");
  refused("ida:table=alexander2", NULL, STEIF_UNKNOWN_NAME, "table");
  refused("arkode:table=alexandre2", NULL, STEIF_UNKNOWN_NAME, "alexander2");
  refused("arkode:table=alexander2,order=3", NULL, STEIF_BAD_INPUT, "not both");
  refused("arkode:table=alexander2", NULL, STEIF_UNSUPPORTED, "embedded");
  refused("arkode:table=rk4", NULL, STEIF_UNSUPPORTED, "diagonally implicit");
}

static void options_are_checked(void)
{
  const sunrealtype mesh[] = {0, 0.1, 0.7};
  steif_options h = ride_defaults(), m = h, b = h, c = h;
  h.h = 0.01, m.mesh = mesh, m.mesh_size = 3;
  b.force_storage = 1, b.storage = STEIF_BAND, c.consistent = 3;
  for (int e = 0; e < 3; e++) {
    if (e < 2) refused(all[e], &h, STEIF_UNSUPPORTED, "rtol");
    refused(all[e], &m, STEIF_UNSUPPORTED, "mesh");
    refused(all[e], &b, STEIF_UNSUPPORTED, "storage");
  }
  refused("ida", &c, STEIF_BAD_INPUT, "consistent = 3");
}

static void time_does_not_go_back(void)
{
  const sunrealtype y0[] = {1.25};
  const steif_problem p = {.name = "pole", .n = 1, .t1 = 0.7, .y0 = y0, .f = blow_up};
  for (int e = 0; e < 3; e++) {
    ride r;
    CHECK(ride_whole(&r, &p, all[e], NULL) == STEIF_OK);
    CHECK(r.engine->step(&r.run, r.state, 0.2) == STEIF_BAD_INPUT);
    CHECK(strstr(ride_says(&r), "t = 0.7") && strstr(ride_says(&r), "0.2"));
    ride_close(&r);
  }
}

CU_TestInfo tests_of_failures[] = {
  {"f asks to stop", f_stops},
  {"f fails however small the step", f_fails_however_small_the_step},
  {"values that are not finite are never accepted", values_that_are_not_finite},
  {"the Jacobian asks to stop", jacobian_stops},
  {"a pole of the solution is not crossed", a_pole_is_not_crossed},
  {"the step limit is kept", step_limit},
  {"error weights must be positive", weights_must_be_positive},
  {"specs are checked", specs_are_checked},
  {"options are checked", options_are_checked},
  {"time does not go back", time_does_not_go_back},
  CU_TEST_INFO_NULL};
