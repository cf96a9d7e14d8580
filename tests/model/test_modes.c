/* test_modes.c: events and breaks from which on other equations of a DAE hold: constraints that appear make impulses,
 * by which charges, fluxes and velocities jump; all expected values follow from what the impulses keep.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <steif/checkpoint.h>
#include <steif/initial.h>
#include <steif/sensitivity.h>

static const char *const methods[] = {"auto", "radau:s=3", "radau:s=2", "bdf"};
enum { METHODS = sizeof methods / sizeof *methods };

/* Charge is kept: v = C1 4/(C1 + C2). By a discrete value, and by a condition in time alone. */
#define CAPACITORS                                                                             \
  "param C1 = 1, C2 = 3\nstate v1 = 4, v2 = 0, i = 0\n"                                        \
  "C1*v1' = -i\nC2*v2' = i\n"
static const char switched[] = CAPACITORS
  "discrete on = 0\n0 = if on > 0.5 then v1 - v2 else i\nwhen t >= 1: on = 1\ntime 0 to 2\n";
static const char timed[] = CAPACITORS "0 = if t >= 1 then v1 - v2 else i\ntime 0 to 2\n";

/* Two coils in series from t = 1 on: L1 i1 + L2 i2 is kept, then 4 i' = 1 - 2 i. */
static const char coils[] =
  "param L1 = 1, L2 = 3, R = 1\nstate i1 = 0, i2 = 0, u = 0\ndiscrete s = 0\n"
  "L1*i1' = 1 - R*i1 - u*s\nL2*i2' = -R*i2 + u*s\n0 = if s > 0.5 then i1 - i2 else u\n"
  "at 1: s = 1\ntime 0 to 3\n";

/* Wheels locked to each other, 3 w' = 3 - w; free from 1 to 2, 2 w1' = 3, w2' = -w2; locked again: index 2, 1, 2. */
static const char wheels[] =
  "state w1 = 1, w2 = 1, M ~ 0\ndiscrete open = 0\n2*w1' = 3 - M\nw2' = M - w2\n"
  "0 = if open > 0.5 then M else w1 - w2\nat 1: open = 1\nat 2: open = 0\ntime 0 to 3\n";

/* A fall on a rope of length 1, without rebound: index 1, then 3. The part of the velocity along the rope goes. */
#define ROPE                                                                                   \
  "param g = 9.81, L = 1, m = 2\nstate x = 0.6, y = 0, u = 0, v = 0, F = 0\n"                  \
  "discrete taut = 0\nx' = u\ny' = v\nm*u' = -2*x*F\nm*v' = -2*y*F - m*g\n"                    \
  "0 = if taut > 0.5 then x^2 + y^2 - L^2 else F\n"
static const char rope[] = ROPE "when x^2 + y^2 > L^2 and taut < 0.5: taut = 1\ntime 0 to 1\n";
/* The reaction changes nothing after the first time: the sliding along its own condition is no event of the equations. */
static const char careless[] = ROPE "when x^2 + y^2 > L^2: taut = 1\ntime 0 to 1\n";

typedef struct end {
  int code, jumps, events;
  char jumped[400], message[600];
  double y[8];
} end;

static int count_event(steif_solver *solver, sunrealtype t, N_Vector y, const int *fired,
                       void *user)
{
  (void)solver, (void)t, (void)y, (void)fired;
  (*(int *)user)++;
  return 0;
}

static end run_to(fixture *s, const char *method, double t)
{
  end e = {0};
  steif_options o = steif_defaults();
  o.rtol = 1e-8, o.on_event = count_event, o.observer = &e.events;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  e.code = solver ? steif_solve_to(solver, t) : steif_status(s->ctx);
  snprintf(e.message, sizeof e.message, "%s", steif_message(s->ctx));
  for (int i = 0; solver && i < s->p.n; i++) e.y[i] = NV_Ith_S(steif_solution(solver), i);
  if (solver) {
    const steif_repair *used = steif_initial_used(solver);
    e.jumps = used->jumps;
    snprintf(e.jumped, sizeof e.jumped, "%.399s", used->jumped);
  }
  steif_solver_free(&solver);
  return e;
}

static void ends(const char *text, int n, const double *expected, int jumps)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (int k = 0; k < METHODS; k++) {
    const end e = run_to(&s, methods[k], s.p.t1);
    if (e.code) printf("\n  %s: %s", methods[k], e.message);
    CHECK(e.code == STEIF_OK && e.jumps == jumps);
    CHECK(jumps == 0 || !strncmp(e.jumped, "t = ", 4));
    for (int i = 0; i < n; i++) CLOSE_FLOOR(e.y[i], expected[i], 1e-6, 1);
  }
  fixture_close(&s);
}

static void charges_and_fluxes_are_kept(void)
{
  ends(switched, 3, (double[]){1, 1, 0}, 1);
  ends(timed, 3, (double[]){1, 1, 0}, 1);
  const double before = 1 - exp(-1), i = 0.5 + (before / 4 - 0.5) * exp(-1);
  ends(coils, 3, (double[]){i, i, 0.75 - i / 2}, 1);
}

static void an_index_that_falls_and_rises_again(void)
{
  const double w = 3 - 2 * exp(-1.0 / 3), w1 = w + 1.5, w2 = w * exp(-1);
  const double locked = (2 * w1 + w2) / 3, last = 3 - (3 - locked) * exp(-1.0 / 3);
  ends(wheels, 2, (double[]){last, last}, 1);
}

/* At t the rope is taut, with energy of what is left behind the catch. */
static void a_rope_catches_a_fall(void)
{
  const double g = 9.81, v = -sqrt(2 * g * 0.8), along = -0.8 * v;
  const double u1 = -along * 0.6, v1 = v + along * 0.8,
               energy = (u1 * u1 + v1 * v1) / 2 - 0.8 * g;
  fixture s;
  const char *const texts[] = {rope, careless};
  for (int m = 0; m < 2; m++) {
    CU_ASSERT_FATAL(fixture_text(&s, texts[m], "") == STEIF_OK);
    for (int k = 0; k < METHODS; k++) {
      const end e = run_to(&s, methods[k], 1);
      if (e.code) printf("\n  %s: %s", methods[k], e.message);
      CHECK(e.code == STEIF_OK && e.jumps == 1);
      CHECK(e.events <= 3); /* the rope rests on the circle: errors are no events */
      CLOSE_FLOOR(e.y[0] * e.y[0] + e.y[1] * e.y[1], 1, 1e-7, 1);
      CLOSE_FLOOR(e.y[0] * e.y[2] + e.y[1] * e.y[3], 0, 1e-6, 1);
      CLOSE_FLOOR((e.y[2] * e.y[2] + e.y[3] * e.y[3]) / 2 + g * e.y[1], energy, 1e-6, 1);
    }
    fixture_close(&s);
  }
}

/* Thrown so that the rope catches the ball above its pivot, where it goes slack at once: the jump makes F negative, which is
 * an event of the same instant; then it falls, and is caught again. Free flight in closed form, times by bisection. */
static const char slack[] =
  "param g = 9.81\nstate x = 0.6, y = 0, u = 1, v = 4, F = 0\ndiscrete taut = 0\n"
  "x' = u\ny' = v\nu' = -x*F\nv' = -y*F - g\n"
  "0 = if taut > 0.5 then x^2 + y^2 - 1 else F\n"
  "when x^2 + y^2 > 1 and x*u + y*v > 1e-4 and taut < 0.5: taut = 1\n"
  "when F < 0 and taut > 0.5: taut = 0\ntime 0 to 2\n";

/* q = (x, y, u, v) flies until it is at distance 1, not before `from`, and loses its velocity along the rope. */
static void fly_and_catch(double *q, double from)
{
  const double g = 9.81;
  double low = from, high = 1;
  for (int k = 0; k < 200; k++) {
    const double t = (low + high) / 2, x = q[0] + q[2] * t, y = q[1] + q[3] * t - g * t * t / 2;
    x *x + y *y < 1 ? (low = t) : (high = t);
  }
  q[0] += q[2] * low, q[1] += q[3] * low - g * low * low / 2, q[3] -= g * low;
  const double along = q[0] * q[2] + q[1] * q[3];
  q[2] -= along * q[0], q[3] -= along * q[1];
}

static void a_jump_that_makes_an_event(void)
{
  const double g = 9.81;
  double q[] = {0.6, 0, 1, 4};
  fly_and_catch(q, 0);
  CHECK(q[2] * q[2] + q[3] * q[3] < g * q[1]); /* the rope would have to push */
  fly_and_catch(q, 0.1);
  const double energy = (q[2] * q[2] + q[3] * q[3]) / 2 + g * q[1];
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, slack, "") == STEIF_OK);
  for (int k = 0; k < METHODS; k++) {
    const end e = run_to(&s, methods[k], s.p.t1);
    if (e.code) printf("\n  %s: %s", methods[k], e.message);
    CHECK(e.code == STEIF_OK && e.jumps == 2);
    CLOSE_FLOOR(e.y[0] * e.y[0] + e.y[1] * e.y[1], 1, 1e-6, 1);
    CLOSE_FLOOR((e.y[2] * e.y[2] + e.y[3] * e.y[3]) / 2 + g * e.y[1], energy, 1e-4, 1);
  }
  fixture_close(&s);
}

/* The same ends there: what is shown last is what the jump has left, no velocity along the rope. */
static int along_the_rope(steif_solver *solver, sunrealtype t, N_Vector y, void *user)
{
  double *along = user;
  const double *q = N_VGetArrayPointer(y);
  (void)solver, (void)t;
  *along = q[0] * q[2] + q[1] * q[3];
  return 0;
}

/* By a terminal event, or since the handler says so at the event that the jump makes. */
static int (*handler)(sunrealtype, N_Vector, const int *, void *);

static int ends_when_slack(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  const int wish = handler(t, y, fired, user);
  return fired[1] ? STEIF_FINISH : wish;
}

static void ends_at_the_jump(fixture *s, const char *method, const double *q)
{
  double along = 1;
  steif_options o = steif_defaults();
  o.observe = along_the_rope, o.observer = &along;
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, method, &o);
  CHECK(solver && steif_solve_to(solver, 2) == STEIF_EVENT);
  CLOSE_FLOOR(along, 0, 1e-6, 1);
  for (int i = 0; solver && i < 4; i++)
    CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), i), q[i], 1e-4, 1);
  steif_solver_free(&solver);
}

static void a_jump_that_ends_the_run(void)
{
  char text[sizeof slack + 60];
  const char *const last = strrchr(slack, ':');
  snprintf(text, sizeof text, "%.*s: stop \"slack\"\ntime 0 to 2\n", (int)(last - slack),
           slack);
  double q[] = {0.6, 0, 1, 4};
  fly_and_catch(q, 0);
  for (int told = 0; told < 2; told++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_text(&s, told ? slack : text, "") == STEIF_OK);
    handler = s.p.handle_event;
    if (told) s.p.handle_event = ends_when_slack;
    for (int k = 0; k < METHODS; k++) ends_at_the_jump(&s, methods[k], q);
    s.p.handle_event = handler;
    fixture_close(&s);
  }
}

/* A run that is asked for the time of the jump shows what is after it, and goes on from there. */
static void the_time_of_the_jump(void)
{
  const char *const texts[] = {switched, timed};
  for (int k = 0; k < 2; k++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_text(&s, texts[k], "") == STEIF_OK);
    for (int m = 0; m < METHODS; m++) {
      steif_options o = steif_defaults();
      steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
      CHECK(solver && steif_solve_to(solver, 1) == STEIF_OK);
      CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), 0), 1, 1e-6, 1);
      CHECK(steif_solve_to(solver, 2) == STEIF_OK);
      CLOSE_FLOOR(NV_Ith_S(steif_solution(solver), 1), 1, 1e-6, 1);
      CHECK(steif_initial_used(solver)->jumps == 1);
      steif_solver_free(&solver);
    }
    fixture_close(&s);
  }
}

/* Both sides of the jump are shown, at a break as at an event. */
typedef struct seen {
  int count;
  double v1[4];
} seen;

static int watch(steif_solver *solver, sunrealtype t, N_Vector y, void *user)
{
  seen *w = user;
  (void)solver;
  if (t == 1 && w->count < 4) w->v1[w->count++] = NV_Ith_S(y, 0);
  return 0;
}

static void both_sides_are_shown(void)
{
  const char *const texts[] = {switched, timed};
  for (int k = 0; k < 2; k++) {
    fixture s;
    seen w = {0};
    CU_ASSERT_FATAL(fixture_text(&s, texts[k], "") == STEIF_OK);
    steif_options o = steif_defaults();
    o.observe = watch, o.observer = &w;
    steif_solver *solver = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
    CHECK(solver && steif_solve_to(solver, 2) == STEIF_OK);
    CHECK(w.count == 2);
    CLOSE_FLOOR(w.v1[0], 4, 1e-6, 1);
    CLOSE_FLOOR(w.v1[1], 1, 1e-6, 1);
    steif_solver_free(&solver);
    fixture_close(&s);
  }
}

/* After the jump the index is another one: a run that is saved there goes on to the same bits. */
static void a_saved_run_knows_its_mode(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, wheels, "") == STEIF_OK);
  char path[300];
  snprintf(path, sizeof path, "%s/run", s.folder);
  steif_options o = steif_defaults();
  o.rtol = 1e-8;
  steif_solver *a = steif_solver_new(s.ctx, &s.p, "radau:s=3", &o);
  CHECK(a && steif_solve_to(a, 2.5) == STEIF_OK);
  CHECK(steif_checkpoint_save(a, path, NULL, 0) == STEIF_OK);
  CHECK(steif_solve_to(a, 3) == STEIF_OK);
  double y[3];
  for (int i = 0; i < 3; i++) y[i] = NV_Ith_S(steif_solution(a), i);
  const long steps = steif_statistics(a)->steps;
  steif_solver_free(&a);
  steif_solver *b = steif_checkpoint_load(s.ctx, path, &s.p, &o);
  CHECK(b && steif_solve_to(b, 3) == STEIF_OK);
  for (int i = 0; b && i < 3; i++) CHECK(NV_Ith_S(steif_solution(b), i) == y[i]);
  CHECK(b && steif_statistics(b)->steps == steps);
  CHECK(b && steif_initial_used(b)->jumps == 1);
  steif_solver_free(&b);
  remove(path);
  fixture_close(&s);
}

static void refused(const char *text, const char *part)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, text, "") == STEIF_OK);
  for (int k = 0; k < METHODS; k++) {
    const end e = run_to(&s, methods[k], s.p.t1);
    CHECK(e.code == STEIF_BAD_INPUT);
    if (!strstr(e.message, part)) printf("\n  %s: %s", methods[k], e.message);
    CHECK(strstr(e.message, part) != NULL);
  }
  fixture_close(&s);
}

/* C(v1) v1' leaves open what the impulse does; a mass cannot be put elsewhere by the constraint on its place. */
static void jumps_that_nothing_determines(void)
{
  refused("state v1 = 4, v2 = 0, i = 0\ndiscrete on = 0\n(1 + v1)*v1' = -i\n3*v2' = i\n"
          "0 = if on > 0.5 then v1 - v2 else i\nat 1: on = 1\ntime 0 to 2\n",
          "not unique");
  refused("state x = 0, u = 1, F = 0\ndiscrete on = 0\nx' = u\nu' = F\n"
          "0 = if on > 0.5 then x - 3 else F\nat 1: on = 1\ntime 0 to 2\n",
          "x would have to move");
}

/* v = 4 C1/(C1 + C2) by C1 and C2; the current of the coils by L1, L2 and R: central differences of runs of radau:s=5 at
 * rtol 1e-12, 0.1 % to both sides. */
static void derivatives_pass_the_jump(void)
{
  static const struct {
    const char *text;
    int count;
    double S[3];
  } rows[] = {{switched, 2, {0.75, -0.25}},
              {timed, 2, {0.75, -0.25}},
              {coils, 3, {-0.0216827, -0.0459849, -0.2145588}}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_text(&s, rows[k].text, "") == STEIF_OK);
    for (int m = 1; m < METHODS; m += 2) { /* radau:s=3 and bdf */
      steif_options o = steif_defaults();
      o.rtol = 1e-8, o.sensitivities = 1;
      steif_solver *solver = steif_solver_new(s.ctx, &s.p, methods[m], &o);
      N_Vector dy = N_VNew_Serial(s.p.n, steif_sundials(s.ctx));
      CHECK(solver && steif_solve_to(solver, s.p.t1) == STEIF_OK);
      for (int i = 0; i < rows[k].count; i++) {
        CHECK(steif_sensitivity(solver, s.p.t1, i, dy) == STEIF_OK);
        CLOSE_FLOOR(NV_Ith_S(dy, 0), rows[k].S[i], 1e-5, 0.1);
      }
      N_VDestroy(dy);
      steif_solver_free(&solver);
    }
    fixture_close(&s);
  }
}

CU_TestInfo tests_of_modes[] = {
  {"charges and fluxes are kept", charges_and_fluxes_are_kept},
  {"an index that falls and rises again", an_index_that_falls_and_rises_again},
  {"a rope catches a fall", a_rope_catches_a_fall},
  {"a jump that makes an event", a_jump_that_makes_an_event},
  {"a jump that ends the run", a_jump_that_ends_the_run},
  {"the time of the jump", the_time_of_the_jump},
  {"both sides are shown", both_sides_are_shown},
  {"a saved run knows its mode", a_saved_run_knows_its_mode},
  {"jumps that nothing determines", jumps_that_nothing_determines},
  {"derivatives pass the jump", derivatives_pass_the_jump},
  CU_TEST_INFO_NULL,
};
