/* test_members.c: what callbacks remember is saved and restored by members of the problem; when a run may be
 * saved.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include "suite.h"
#include <stddef.h>
#include <string.h>

/* A thermostat: heats while `on`, below 21 degrees until 23; hysteresis is state of the callbacks. */
typedef struct thermostat {
  int on, switched, broken;
} thermostat;

static int room(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const thermostat *h = user;
  (void)t;
  NV_Ith_S(r, 0) = -0.1 * (NV_Ith_S(y, 0) - 5) + (h->on ? 4 : 0);
  return 0;
}
static int limits(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0) - 21, g[1] = NV_Ith_S(y, 0) - 23;
  return 0;
}
static int turn(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  thermostat *h = user;
  (void)t, (void)y;
  h->on = fired[0] < 0 ? 1 : fired[1] > 0 ? 0 : h->on;
  h->switched++;
  return STEIF_RESTART;
}
static int begin(sunrealtype t, void *user)
{
  (void)t;
  ((thermostat *)user)->on = 1, ((thermostat *)user)->switched = 0;
  return 0;
}
static long save(void *bytes, void *user)
{
  const thermostat *h = user;
  if (h->broken) return -1;
  if (bytes) memcpy(bytes, h, sizeof *h);
  return (long)sizeof *h;
}
static int restore(const void *bytes, size_t count, void *user)
{
  if (count != sizeof(thermostat)) return -1;
  memcpy(user, bytes, count);
  return ((thermostat *)user)->broken;
}

static const sunrealtype cold[] = {12};

static steif_problem heated(thermostat *h)
{
  return (steif_problem){.name = "heated",
                         .n = 1,
                         .t1 = 30,
                         .y0 = cold,
                         .f = room,
                         .user = h,
                         .events = 2,
                         .event = limits,
                         .handle_event = turn,
                         .begin = begin,
                         .save = save,
                         .restore = restore};
}

/* Two problems with memories of their own: the second goes on where the first was, and ends as it does. */
static void memories_are_restored(void)
{
  const char *path = scratch("members");
  steif_context *ctx = steif_context_new(NULL);
  thermostat one = {0}, two = {0};
  const steif_problem p = heated(&one), q = heated(&two);
  steif_solver *a = steif_solver_new(ctx, &p, "radau:s=3", NULL);
  CU_ASSERT_FATAL(a && !steif_solve_to(a, 17.3));
  CHECK(one.switched > 4);
  CU_ASSERT_FATAL(!steif_checkpoint_save(a, path, NULL, 0));
  steif_solver *b = steif_checkpoint_load(ctx, path, &q, NULL);
  CU_ASSERT_FATAL(b != NULL);
  CHECK(two.on == one.on && two.switched == one.switched);
  CHECK(steif_time(b) == 17.3 &&
        NV_Ith_S(steif_solution(b), 0) == NV_Ith_S(steif_solution(a), 0));
  CHECK(!steif_solve_to(a, 30) && !steif_solve_to(b, 30));
  CHECK(two.on == one.on && two.switched == one.switched);
  CHECK(NV_Ith_S(steif_solution(b), 0) == NV_Ith_S(steif_solution(a), 0));
  steif_solver_free(&a), steif_solver_free(&b);
  remove(path), steif_context_free(&ctx);
}

static void members_that_fail_are_told(void)
{
  const char *path = scratch("broken");
  steif_context *ctx = steif_context_new(NULL);
  thermostat h = {0};
  steif_problem p = heated(&h);
  steif_solver *s = under_way(ctx, &p, "bdf", NULL);
  CU_ASSERT_FATAL(s != NULL);
  h.broken = 1;
  CHECK(steif_checkpoint_save(s, path, NULL, 0) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(ctx), "save of problem 'heated' returned -1") != NULL);
  h.broken = 0;
  CHECK(!steif_checkpoint_save(s, path, NULL, 0));
  h.broken = 1; /* its bytes are not asked for any more: restore fails by what it reads */
  CHECK(steif_checkpoint_load(ctx, path, &p, NULL) == NULL &&
        steif_status(ctx) == STEIF_CALLBACK);
  p.save = NULL;
  CHECK(steif_checkpoint_save(s, path, NULL, 0) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "restore without save") != NULL);
  p.restore = NULL; /* begin says that something is remembered */
  CHECK(steif_checkpoint_save(s, path, NULL, 0) == STEIF_UNSUPPORTED);
  steif_solver_free(&s), remove(path), steif_context_free(&ctx);
}

static int saves, refusals;
static int save_here(steif_solver *s, sunrealtype t, N_Vector y, void *path)
{
  (void)t, (void)y;
  const int code = steif_checkpoint_save(s, path, NULL, 0);
  saves += code == STEIF_OK;
  refusals += code == STEIF_BAD_INPUT;
  return 0;
}

/* The observer sees every step, and every event once before it is handled: there nothing is saved. */
static void observers_may_save(void)
{
  char path[128];
  snprintf(path, sizeof path, "%s", scratch("observer"));
  steif_context *ctx = steif_context_new(NULL);
  thermostat h = {0};
  const steif_problem p = heated(&h);
  steif_options o = steif_defaults();
  o.observe = save_here, o.observer = path;
  steif_solver *a = steif_solver_new(ctx, &p, "dirk:hw43", &o);
  CU_ASSERT_FATAL(a && !steif_solve_to(a, 20));
  const int switched = h.switched;
  CHECK(refusals == switched && switched > 4 && saves >= steif_statistics(a)->steps);
  const sunrealtype t = steif_statistics(a)->steps > 0 ? steif_time(a) : 0;
  CHECK(!steif_solve_to(a, 30));
  const sunrealtype end = NV_Ith_S(steif_solution(a), 0);
  steif_solver *b = steif_checkpoint_load(ctx, path, &p, &o);
  CU_ASSERT_FATAL(b != NULL);
  CHECK(!steif_solve_to(b, 30) && NV_Ith_S(steif_solution(b), 0) == end && t == 20);
  steif_solver_free(&a), steif_solver_free(&b);
  remove(path), steif_context_free(&ctx);
}

/* Structs as a caller with another header has them: shorter, longer, not initialised. */
static void structs_may_have_other_sizes(void)
{
  static struct {
    steif_problem p;
    unsigned char more[64];
  } later;
  steif_context *ctx = steif_context_new(NULL);
  later.p = oscillator();
  steif_options o = steif_defaults();
  const size_t same = sizeof o, longer = sizeof later,
               shorter = offsetof(steif_problem, reserved);
  steif_solver *s = steif_solver_new_sized(longer, same, ctx, &later.p, "bdf", &o);
  CHECK(s && !steif_solve_to(s, 1));
  steif_solver_free(&s);
  later.more[40] = 1; /* a member that the library does not know */
  CHECK(!steif_solver_new_sized(longer, same, ctx, &later.p, "bdf", &o));
  CHECK(steif_status(ctx) == STEIF_UNSUPPORTED);
  memset(later.p.reserved, 0xa5, sizeof later.p.reserved);
  CHECK(!steif_solver_new(ctx, &later.p, "bdf", &o) && steif_status(ctx) == STEIF_BAD_INPUT);
  s = steif_solver_new_sized(shorter, 0, ctx, &later.p, "bdf", &o);
  memset(&later, 0xa5, sizeof later); /* it has been copied */
  CHECK(s && !steif_solve_to(s, 1));
  steif_solver *copy = s ? steif_solver_copy(s, NULL) : NULL;
  steif_solver_free(&s); /* the copy stands alone */
  CHECK(copy && !steif_solve_to(copy, 3));
  steif_solver_free(&copy);
  o.reserved[11] = &o;
  const steif_problem p = oscillator();
  CHECK(!steif_solver_new(ctx, &p, "bdf", &o) && strstr(steif_message(ctx), "reserved[11]"));
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_members[] = {
  {"memories are restored", memories_are_restored},
  {"members that fail are told", members_that_fail_are_told},
  {"observers may save", observers_may_save},
  {"structs may have other sizes", structs_may_have_other_sizes},
  CU_TEST_INFO_NULL};
