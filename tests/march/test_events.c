/* Events: found where they are, each once, in order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "watched.h"
#include <stdlib.h>

static const char *const methods[] = {"radau:s=3", "bdf", "dirk:hw43", "rodas4",
                                      "cvode",     "ida", "arkode"};
enum { METHODS = 7 };

typedef struct record {
  int count;
  double t[SEEN];
} record;

static int note(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  record *r = user;
  (void)y, (void)fired;
  CHECK(steif_time(s) == t && r->count < SEEN);
  r->t[r->count++ % SEEN] = t;
  return 0;
}

/* Times of the collection: closed forms, stated there. The errors are those of the solution at
 * rtol = atol = 1e-8, divided by the slope of g; the search adds rounding errors only, as bounce
 * shows with methods of order 2 and above. */
static void known_times_are_met(void)
{
  static const struct {
    const char *problem, *method;
    double within;
  } rows[] = {{"bounce", "radau:s=3", 1e-13},   {"bounce", "bdf", 1e-6},
              {"bounce", "dirk:hw43", 1e-13},   {"bounce", "rodas4", 1e-13},
              {"bounce", "cvode", 1e-6},        {"bounce", "ida", 1e-9},
              {"bounce", "arkode", 1e-13},      {"bounce:e=0.5", "radau:s=3", 1e-13},
              {"rectifier", "radau:s=3", 1e-8}, {"rectifier", "bdf", 3e-7},
              {"rectifier", "dirk:hw43", 3e-7}, {"rectifier", "rodas4", 1e-9},
              {"rectifier", "cvode", 3e-7},     {"rectifier", "ida", 3e-7},
              {"rectifier", "arkode", 1e-9},    {"swing", "radau:s=3", 1e-7},
              {"swing", "bdf", 1e-5},           {"swing", "dirk:hw43", 1e-5},
              {"swing", "rodas4", 1e-6},        {"swing", "ida", 1e-5},
              {"swing", "auto", 1e-7}};
  steif_context *ctx = steif_context_new(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    steif_problem p;
    record r = {0};
    CU_ASSERT_FATAL(!steif_problem_find(ctx, rows[i].problem, &p));
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-8, o.on_event = note, o.observer = &r;
    o.t1 = strchr(rows[i].problem, ':') ? 1.3 : p.t1; /* before all bounces are over */
    steif_solver *s = smooth_open(ctx, &p, rows[i].method, &o);
    CHECK(!steif_solve_to(s, o.t1));
    int due = 0;
    while (due < p.event_time_count && p.event_times[due] < o.t1) due++;
    const int good = due > 3 && r.count == due;
    if (!good) printf("\n  %s %s: %d", rows[i].problem, rows[i].method, r.count);
    CHECK(good);
    for (int k = 0; good && k < due; k++) CLOSE(r.t[k], p.event_times[k], rows[i].within);
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
  }
  steif_context_free(&ctx);
}

/* Roots at 0.3, 0.7, 1.9; the same as the first, written otherwise; rising at 1.5. */
static int several(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const double x = NV_Ith_S(y, 0);
  (void)t, (void)user;
  g[0] = (x - 0.3) * (x - 0.7) * (1.9 - x);
  g[1] = exp(0.3) - exp(x);
  g[2] = atan(1e4 * (x - 1.5));
  return 0;
}

static void events_of_one_time_are_one(void)
{
  static const double at[] = {0.3, 0.7, 1.5, 1.9}, h[] = {0, 0, 0, 0, 0, 0, 0, 2, 0.5};
  static const int who[][3] = {{-1, -1, 0}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
  const steif_problem p = watched_problem(3, several);
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS + 2; m++) { /* the last two: 1 and 4 equal steps */
    watched w;
    CHECK(!watched_run(ctx, &p, m < METHODS ? methods[m] : "radau:s=3", h[m], &w));
    CHECK(w.count == 4);
    for (int k = 0; k < 4 && k < w.count; k++) {
      CLOSE(w.t[k], at[k], 1e-12); /* y1 = t carries rounding errors */
      CHECK(!memcmp(w.fired[k], who[k], sizeof who[k]));
    }
  }
  steif_context_free(&ctx);
}

static int waves(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  for (int i = 0; i < 3; i++) g[i] = cos(20 * NV_Ith_S(y, 0));
  return 0;
}

static void directions_are_told_apart(void)
{
  static const steif_event list[] = {{.direction = 1}, {.direction = -1}, {0}};
  const double pi = acos(-1);
  steif_problem p = watched_problem(3, waves);
  p.event_list = list;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    watched w;
    CHECK(!watched_run(ctx, &p, methods[m], 0, &w));
    CHECK(w.count == 13); /* (k + 1/2) pi/20 < 2 */
    for (int k = 0; k < w.count; k++) {
      const int fired[] = {k % 2, k % 2 - 1, k % 2 ? 1 : -1};
      CLOSE(w.t[k], (k + 0.5) * pi / 20, 1e-12); /* y1 = t carries rounding errors */
      CHECK(!memcmp(w.fired[k], fired, sizeof fired));
    }
  }
  steif_context_free(&ctx);
}

/* 0 from the start, then below; 0 between 0.6 and 1.1, then above; 0 between them, then below
 * again; 0 at the start only. */
static int flats(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  const double x = NV_Ith_S(y, 0);
  (void)t, (void)user;
  g[0] = x < 0.4 ? 0 : 0.4 - x;
  g[1] = x < 0.6 ? x - 0.6 : x < 1.1 ? 0 : x - 1.1;
  g[2] = x < 0.6 ? x - 0.6 : x < 1.1 ? 0 : 1.1 - x;
  g[3] = sin(3 * x);
  return 0;
}

static void functions_that_stay_at_zero_fire_once(void)
{
  const steif_problem p = watched_problem(4, flats);
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    static const int first[] = {0, 1, 1, 0}, second[] = {0, 0, 0, -1};
    watched w;
    CHECK(!watched_run(ctx, &p, methods[m], 0, &w));
    CHECK(w.count == 2); /* 0.6 and pi/3 */
    CLOSE(w.t[0], 0.6, 1e-12);
    CLOSE(w.t[1], acos(-1) / 3, 1e-12);
    CHECK(!memcmp(w.fired[0], first, sizeof first) &&
          !memcmp(w.fired[1], second, sizeof second));
  }
  steif_context_free(&ctx);
}

static int at_ends(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  g[0] = t - 0.5, g[1] = 1.5 - t;
  return 0;
}

static void a_root_at_the_end_of_a_step_is_seen_once(void)
{
  const steif_problem p = watched_problem(2, at_ends);
  static const char *const given[] = {"radau:s=2", "be", "dirk:trbdf2", "rk4", "arkode"};
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < 5; m++) {
    watched w;
    CHECK(!watched_run(ctx, &p, given[m], 0.25, &w));
    CHECK(w.count == 2);
    CHECK(w.fired[0][0] == 1 && w.fired[0][1] == 0);
    CHECK(w.fired[1][0] == 0 && w.fired[1][1] == -1);
    CLOSE(w.t[0], 0.5, 2e-15);
    CLOSE(w.t[1], 1.5, 2e-15);
  }
  steif_context_free(&ctx);
}

/* A cubic in t. */
static double root[3];
static int cubic(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  *g = (t - root[0]) * (t - root[1]) * (t - root[2]);
  return 0;
}

/* In one step of length 2: all three roots where they are an eighth of it apart, and an odd
 * number of them always. */
static void no_odd_number_is_missed(void)
{
  const steif_problem p = watched_problem(1, cubic);
  steif_context *ctx = steif_context_new(NULL);
  unsigned state = 7;
  int all = 0;
  for (int k = 0; k < 200; k++) {
    double least = 2;
    for (int i = 0; i < 3; i++) {
      state = state * 1103515245u + 12345u;
      root[i] = 1e-3 + 1.998 * (state >> 16 & 32767) / 32768;
      for (int j = 0; j < i; j++) least = fmin(least, fabs(root[i] - root[j]));
    }
    watched w;
    CHECK(!watched_run(ctx, &p, "radau:s=2", 2, &w));
    CHECK(w.count == 3 || (w.count == 1 && least < 0.25));
    all += w.count == 3;
  }
  CHECK(all > 150); /* the parabola at the bottom finds most of the closer ones too */
  steif_context_free(&ctx);
}

/* 26 changes in the interval of length 2, from two thirds of one in a step to all. */
static int rapid(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  *g = sin(40 * t - 0.3);
  return 0;
}

static void steps_longer_than_the_function_are_halved(void)
{
  const steif_problem p = watched_problem(1, rapid);
  static const double h[] = {0.05, 0.5, 1, 2};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 4; k++) {
    watched w;
    CHECK(!watched_run(ctx, &p, "radau:s=2", h[k], &w));
    CHECK(w.count == 26);
    for (int i = 0; i < w.count; i++) CLOSE(w.t[i], (i * acos(-1) + 0.3) / 40, 1e-13);
  }
  steif_context_free(&ctx);
}

static int undefined(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = 1, g[1] = sqrt(1.2 - NV_Ith_S(y, 0));
  return 0;
}

static int unwilling(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)y, (void)user;
  *g = 1;
  return t > 0.8 ? -4 : 0;
}

static void nan_and_refusal_stop_the_run(void)
{
  static const steif_event list[] = {{.name = "above"}, {.name = "depth"}};
  steif_problem p = watched_problem(2, undefined), q = watched_problem(1, unwilling);
  p.event_list = list;
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    watched w;
    CHECK(watched_run(ctx, &p, methods[m], 0, &w) == STEIF_NOT_FINITE);
    CHECK(strstr(steif_message(ctx), "event function 'depth' of problem 'watched' is NaN"));
    CHECK(watched_run(ctx, &q, methods[m], 0, &w) == STEIF_CALLBACK);
    CHECK(strstr(steif_message(ctx), "returned -4"));
  }
  steif_context_free(&ctx);
}

static int fractions(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)user;
  g[0] = 0.25 - NV_Ith_S(y, 1), g[1] = t - 0.125;
  return 0;
}

/* y2 = exp(-t) reaches 1/4 at ln 4. */
static void a_terminal_event_ends_the_run(void)
{
  static const steif_event list[] = {{.name = "quarter", .terminal = 1}, {.name = "early"}};
  steif_problem p = watched_problem(2, fractions);
  p.event_list = list;
  for (int m = 0; m < METHODS; m++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_options o = steif_defaults();
    o.rtol = o.atol = 1e-9;
    steif_solver *s = smooth_open(ctx, &p, methods[m], &o);
    CHECK(steif_solve_to(s, 2) == STEIF_EVENT && steif_status(ctx) == STEIF_EVENT);
    CHECK(strstr(steif_message(ctx), "by the event 'quarter'"));
    const double t = steif_time(s);
    CLOSE(t, log(4), 1e-6);
    CLOSE(NV_Ith_S(steif_solution(s), 1), 0.25, 1e-12);
    CLOSE(NV_Ith_S(steif_solution(s), 0), t, 1e-12);
    CHECK(steif_solve_to(s, 2) == STEIF_EVENT && steif_solve_step(s) == STEIF_EVENT);
    CHECK(!steif_solve_to(s, t) && steif_time(s) == t && steif_status(ctx) == STEIF_OK);
    N_Vector y = N_VClone(steif_solution(s));
    CHECK(!steif_dense(s, t - 1e-6, y));
    CLOSE(NV_Ith_S(y, 0), t - 1e-6, 1e-12);
    CHECK(steif_dense(s, t + 1e-3, y) == STEIF_BAD_INPUT);
    N_VDestroy(y);
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

/* Watching does not move the steps. */
static void events_without_reaction_cost_no_steps(void)
{
  steif_problem p = watched_problem(3, waves), plain = watched_problem(0, NULL);
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < METHODS; m++) {
    watched w, v;
    CHECK(!watched_run(ctx, &p, methods[m], 0, &w) &&
          !watched_run(ctx, &plain, methods[m], 0, &v));
    CHECK(w.count > 10 && v.count == 0 && w.steps == v.steps);
    for (int k = 0; k < w.steps; k++) CHECK(w.step_t[k] == v.step_t[k]);
  }
  steif_context_free(&ctx);
}

static void half_a_declaration_is_refused(void)
{
  steif_problem p = smooth;
  p.events = 2;
  smooth_refused(&p, "radau:s=3", NULL, STEIF_BAD_INPUT, "announces 2 event functions");
}

CU_TestInfo tests_of_events[] = {
  {"known times are met", known_times_are_met},
  {"events of one time are one", events_of_one_time_are_one},
  {"directions are told apart", directions_are_told_apart},
  {"functions that stay at zero fire once", functions_that_stay_at_zero_fire_once},
  {"a root at the end of a step is seen once", a_root_at_the_end_of_a_step_is_seen_once},
  {"no odd number of roots is missed", no_odd_number_is_missed},
  {"steps longer than the function are halved", steps_longer_than_the_function_are_halved},
  {"NaN and refusal stop the run", nan_and_refusal_stop_the_run},
  {"a terminal event ends the run", a_terminal_event_ends_the_run},
  {"events without reaction cost no steps", events_without_reaction_cost_no_steps},
  {"half a declaration is refused", half_a_declaration_is_refused},
  CU_TEST_INFO_NULL};
