/* test_breaks.c: f with jumps and kinks: impulses at its breaks, limits of a step, meshes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak/broken.h"
#include "subject.h"
#include "base/failing.h"

/* Capacitor 1/2 across a source e = 2 step(t - 0.3), series R, L, C of 1 beside it: C v' = i_L,
 * L i_L' + v + R i_L = e, i = e'/2 + i_L; unknowns v, i_L, e, i, index 2. */
static void open_circuit(broken_system *s)
{
  static const double F[4][4] = {{0, -1, 0, 0}, {1, 1, -1, 0}, {0, 0, 1, 0}, {0, 1, 0, -1}};
  broken_open(s, 4, "0;0;2*step(t-0.3);0");
  SUNMatZero(s->linear.E);
  SM_ELEMENT_D(s->linear.E, 0, 0) = SM_ELEMENT_D(s->linear.E, 1, 1) = 1;
  SM_ELEMENT_D(s->linear.E, 3, 2) = 0.5;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) SM_ELEMENT_D(s->linear.F, i, j) = F[i][j];
}

/* int_a^1 (t - a)^q (1 - t)^8 / q! dt = 8! (1 - a)^(9 + q) / (9 + q)! */
static double tail(double a, int q)
{
  double value = pow(1 - a, 9 + q);
  for (int i = 9; i <= 9 + q; i++) value /= i;
  return value;
}

static void expect(broken_system *s, int n, const double *value, double tolerance)
{
  stf_subject subject;
  double found[BROKEN_MOST], accuracy;
  char how[160];
  CU_ASSERT_FATAL(!stf_subject_open(s->ctx, NULL, &s->linear, s->x0, &subject));
  subject.sides.count = s->count, subject.sides.breaks = s->breaks;
  CHECK(!stf_subject_pair(&subject, found, &accuracy, how, sizeof how));
  CHECK(subject.jumps == s->count && accuracy < 1e-12);
  for (int m = 0; m < n; m++) CLOSE_FLOOR(found[m], value[m], tolerance, 1e-3);
  stf_subject_close(&subject);
  broken_close(s);
}

static void impulses_at_breaks_are_paired(void)
{
  broken_system s;
  broken_open(&s, 2, "0;step(t-0.3)"); /* x1 = -delta, x2 = step */
  expect(&s, 2, (double[]){-pow(0.7, 8), tail(0.3, 0)}, 1e-13);
  broken_open(&s, 3, "0;ramp(t-1/4);step(t-1/2)"); /* x2 = ramp - delta, x1 = delta' - step */
  expect(&s, 3,
         (double[]){8 * pow(0.5, 7) - tail(0.25, 0), tail(0.25, 1) - pow(0.5, 8), tail(0.5, 0)},
         1e-13);
  broken_open(&s, 3, "0;0;ramp(t-0.3)"); /* a kink is an impulse of index 3 */
  expect(&s, 3, (double[]){pow(0.7, 8), -tail(0.3, 0), tail(0.3, 1)}, 1e-13);
  /* 2 ramp(t - 0.3) + 0.6 - t: x3(0+) = 0.6 and x2(0+) = 1 are jumps, too */
  broken_open(&s, 3, "0;0;abs(t-0.3)+min(t,0.3)+max(0,0.3-t)");
  CHECK(s.count == 1);
  expect(&s, 3,
         (double[]){0.6 * 8 + 2 * pow(0.7, 8) - 1, 1. / 9 - 2 * tail(0.3, 0) - 0.6,
                    0.6 / 9 - tail(0, 1) + 2 * tail(0.3, 1)},
         1e-13);
}

/* 40-digit quadrature of the closed solution. */
static void a_circuit_with_a_switched_source(void)
{
  broken_system s;
  open_circuit(&s);
  expect(&s, 4,
         (double[]){3.762179308764653e-5, 5.878959908535827e-4, 0.008967468222222222,
                    0.05823590599085358},
         1e-12);
}

/* ---- norms ------------------------------------------------------------------------------------ */

static int norms(broken_system *s, const char *method, enum steif_convention convention, int m,
                 int component, sunrealtype h, steif_ball_row *row, size_t rows,
                 steif_weak_ball *result)
{
  const steif_weak_query query = {.method = method,
                                  .linear = &s->linear,
                                  .x0 = s->x0,
                                  .convention = convention,
                                  .component = component,
                                  .h = h,
                                  .rows = rows,
                                  .cells = 8,
                                  .break_count = s->count,
                                  .breaks = s->breaks};
  return steif_weak_measure_ball(s->ctx, &query, m, row, result);
}

/* Backward Euler by hand, s = t - 0.3: the impulse -delta is the density -1/h of one step, so the error
 * has I e = 1 - s/h and I^2 e = s - s^2/(2h) on it, h/2 from there on; delta' is 1/h^2, -1/h^2 on two
 * steps, I^2 e = s^2/(2 h^2) - 1 and -(2 - s/h)^2/2. The kink of index 3 makes the same of its delta. */
static void norms_at_breaks_by_hand(void)
{
  static const struct {
    const char *f;
    int n, m;
  } known[] = {{"0;step(t-0.3)", 2, 1},
               {"0;step(t-0.3)", 2, 2},
               {"0;0;ramp(t-0.3)", 3, 2},
               {"0;0;step(t-0.3)", 3, 2}};
  for (int i = 0; i < 4; i++) {
    steif_ball_row row[5];
    steif_weak_ball result;
    broken_system s;
    broken_open(&s, known[i].n, known[i].f);
    CHECK(!norms(&s, "be", STEIF_R, known[i].m, 0, 0, row, 5, &result));
    CHECK(result.converges == 1 && row[4].usable);
    for (int j = 0; j < 5; j++) {
      const double h = row[j].h, on = 2 * pow(h, 3) / 15 + h * h / 4 * (0.7 - h);
      CLOSE(row[j].norm, i == 0 ? sqrt(h / 3) : i == 3 ? sqrt(h * 23 / 30) : sqrt(on), 1e-12);
      CHECK(row[j].splines <= row[j].norm * (1 + 1e-14));
    }
    CHECK(fabs(row[4].order - (i == 0 || i == 3 ? 0.5 : 1)) < 0.01);
    broken_close(&s);
  }
}

/* A break at the part p of its step: I e = -s/h and then 1 - s/h over it. */
static void norms_with_breaks_inside_steps(void)
{
  steif_ball_row row[4];
  steif_weak_ball result;
  broken_system s;
  broken_open(&s, 2, "0;step(t-0.3)");
  CHECK(!norms(&s, "be", STEIF_R, 1, 0, 1.0 / 64, row, 4, &result));
  for (int j = 0; j < 4; j++) {
    const double h = row[j].h, p = 0.3 / h - floor(0.3 / h);
    CLOSE(row[j].norm, sqrt(h * (pow(p, 3) + pow(1 - p, 3)) / 3), 1e-12);
    CHECK(isnan(row[j].order));
  }
  CHECK(result.converges == -1 && strstr(result.verdict, "lies inside a step") != NULL);
  broken_close(&s);
}

/* Jumps, kinks and a circuit with states: |<x_h - x, g>| <= norm |g|_m, g = (1 - t)^8. */
static void no_function_beats_norms_with_breaks(void)
{
  static const char *const method[] = {"be", "radau:s=2", "radau:s=3", "bdf:p=2"};
  for (int i = 0; i < 12; i++) {
    const enum steif_convention reading = i % 4 == 0 || i % 4 == 3 ? STEIF_R : STEIF_STAGE;
    const int m = 2 + i / 4 % 2;
    steif_ball_row ball[3];
    steif_weak_ball norm;
    steif_weak_row row[3];
    steif_weak_result weak;
    broken_system s;
    if (i < 4)
      open_circuit(&s);
    else
      broken_open(&s, 3,
                  i < 8 ? "0;ramp(t-1/4);step(t-1/2)" : "1;exp(t);abs(t-0.3)+step(t-0.6)");
    const int component = i < 4 ? 3 : 0;
    const steif_weak_query query = {.method = method[i % 4],
                                    .linear = &s.linear,
                                    .x0 = s.x0,
                                    .convention = reading,
                                    .component = component,
                                    .rows = 3,
                                    .break_count = s.count,
                                    .breaks = s.breaks};
    double size = 1 / sqrt(17 - 2 * m);
    for (int q = 0; q < m; q++) size *= 8 - q;
    CHECK(!norms(&s, method[i % 4], reading, m, component, 0, ball, 3, &norm));
    CHECK(!steif_weak_measure(s.ctx, &query, row, &weak) && s.count > 0);
    for (int j = 0; j < 3; j++)
      CHECK(fabs(row[j].error) <= ball[j].norm * size * (1 + 1e-9) + row[j].rounding);
    for (int j = 0; j + 1 < norm.count; j++)
      CHECK(norm.space[j + 1].order > norm.space[j].order - 0.1);
    broken_close(&s);
  }
}

static void memory_of_norms_may_fail(void)
{
  int code = STEIF_NO_MEMORY;
  long failed = 0;
  for (long at = 1; code && at < 9000; at += 3) {
    failing f = {.refuse_at = 0};
    const steif_setup setup = failing_setup(&f);
    steif_ball_row row[1];
    steif_weak_ball result;
    broken_system s;
    broken_open(&s, 2, "0;step(t-0.3)");
    steif_context *ctx = s.ctx;
    s.ctx = steif_context_new(&setup);
    f.refuse_at = f.served + at;
    code = norms(&s, "be", STEIF_R, 2, 0, 0.1, row, 1, &result);
    CHECK(code == STEIF_OK || code == STEIF_NO_MEMORY);
    failed += code != 0;
    steif_context_free(&s.ctx);
    CHECK(f.alive == 0);
    s.ctx = ctx;
    broken_close(&s);
  }
  CHECK(!code && failed > 10);
}

/* Of component 0 of N x' + x = f, where only the last f is not 0. */
static steif_weak_result measure(const char *method, int n, const char *f,
                                 enum steif_convention convention, sunrealtype h,
                                 steif_weak_row *row, size_t rows)
{
  broken_system s;
  steif_weak_result result;
  broken_open(&s, n, f);
  const steif_weak_query query = {.method = method,
                                  .linear = &s.linear,
                                  .x0 = s.x0,
                                  .convention = convention,
                                  .h = h,
                                  .rows = rows,
                                  .break_count = s.count,
                                  .breaks = s.breaks};
  CHECK(!steif_weak_measure(s.ctx, &query, row, &result));
  broken_close(&s);
  return result;
}

/* Backward Euler: 1; Radau IIA of s stages, which restarts at the break since the stage at its end takes
 * the limit from the left: s + 2 - k. */
static void orders_on_the_mesh(void)
{
  static const struct {
    const char *method, *f;
    int k, order;
  } known[] = {{"be", "0;step(t-0.3)", 2, 1},
               {"be", "0;0;step(t-0.3)", 3, 1},
               {"radau:s=2", "0;step(t-0.3)", 2, 2},
               {"radau:s=2", "0;0;step(t-0.3)", 3, 1},
               {"radau:s=2", "0;0;0;step(t-0.3)", 4, 0},
               {"radau:s=3", "0;step(t-0.3)", 2, 3},
               {"radau:s=3", "0;0;step(t-0.3)", 3, 2},
               {"radau:s=3", "0;0;0;step(t-0.3)", 4, 1}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    steif_weak_row row[5];
    const steif_weak_result r = measure(known[i].method, known[i].k, known[i].f,
                                        i < 2 ? STEIF_R : STEIF_STAGE, 0, row, 5);
    CHECK(r.converges == (known[i].order > 0));
    CHECK(fabs(row[4].order - known[i].order) < 0.05);
    CHECK(fabs(0.3 / row[0].h - round(0.3 / row[0].h)) < 1e-9);
  }
}

/* Off the mesh errors jump: 113-bit arithmetic, h = 1/64 .. 1/1024. */
static void no_order_off_the_mesh(void)
{
  static const double error[] = {.00295248, .000496064, -.000780842, -.000129853, .000192474};
  steif_weak_row row[5];
  const steif_weak_result r = measure("be", 2, "0;step(t-0.3)", STEIF_R, 1.0 / 64, row, 5);
  CHECK(r.converges == -1 && strstr(r.verdict, "break of f at 0.3 lies inside a step") != NULL);
  for (int i = 0; i < 5; i++) CLOSE(row[i].error, error[i], 1e-5);
  for (int i = 0; i < 5; i++) CHECK(isnan(row[i].order));
}

static void meshes_hold_all_breaks(void)
{
  const sunrealtype both[] = {0.25, 0.3}, odd[] = {0.1, 0.31415926535897931};
  const sunrealtype h = stf_break_step(2, both, 1, 1. / 64);
  CHECK(stf_break_inside(2, both, 1, h) == 2 && h > 1. / 128 && h < 1. / 32);
  CHECK(stf_break_inside(2, both, 1, 1. / 64) == 1 &&
        stf_break_inside(2, both, 0.3, 1. / 64) == 2);
  CHECK(isnan(stf_break_step(2, odd, 1, 1. / 64)));
  CHECK(stf_break_step(0, NULL, 1, 1. / 64) == 1. / 64);
}

/* ---- breaks that nobody declares -------------------------------------------------------------- */

/* The code of a run with f, and its sentence or verdict. */
static int undeclared(const char *f, int n, char *text, size_t room)
{
  steif_weak_row row[4];
  steif_weak_result result;
  broken_system s;
  broken_open(&s, n, f);
  const steif_weak_query query = {.method = "be",
                                  .linear = &s.linear,
                                  .x0 = s.x0,
                                  .convention = STEIF_R,
                                  .component = 0,
                                  .rows = 4};
  const int code = steif_weak_measure(s.ctx, &query, row, &result);
  snprintf(text, room, "%s", code ? steif_message(s.ctx) : result.verdict);
  broken_close(&s);
  return code;
}

static void undeclared_breaks_are_found(void)
{
  static const struct {
    const char *f, *says;
    int n;
  } known[] = {{"0;step(t-0.3)", "near t = 0.3, where derivative 0", 2},
               {"0;0;ramp(t-0.7)", "near t = 0.7, where derivative 1", 3},
               {"0;0;1e-3*step(t-1/7)", "near t = 0.142857142", 3},
               {"0;sqrt((t-0.3)^2)", "near t = 0.3, where derivative 1", 2}};
  char text[512];
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    CHECK(undeclared(known[i].f, known[i].n, text, sizeof text) == STEIF_BAD_INPUT);
    CHECK(strstr(text, known[i].says) != NULL && strstr(text, "(.breaks)") != NULL);
  }
}

/* What is fast, but smooth, asks for steps; what is slow, for nothing. */
static void fast_forcing_is_no_break(void)
{
  static const char *const fast[] = {"0;tanh((t-0.3)*1e6)", "0;sin(1e5*t)",
                                     "0;exp(-((t-0.3)*2e3)^2)"};
  static const char *const slow[] = {"0;sin(t)^2+cos(t)^2", "0;exp(-t)*cos(5*t)", "0;1",
                                     "1e6*t;1e-6*sin(t)", "0;t^7"};
  char text[512];
  for (int i = 0; i < 3; i++) {
    CHECK(!undeclared(fast[i], 2, text, sizeof text));
    CHECK(strstr(text, "do not resolve the forcing") != NULL);
  }
  for (int i = 0; i < 5; i++) {
    CHECK(!undeclared(slow[i], 2, text, sizeof text));
    CHECK(strstr(text, "forcing") == NULL);
  }
}

/* x2 = f2 = tanh((t - 0.3) / e), x1 = -f2': between e = 1e-3 and 1e-9 both integrals hardly change, and where
 * panels do not see the front, no value is told. Truth for sign(t - 0.3): f2 jumps by -1 at 0 and by 2 at 0.3. */
static void unseen_fronts_leave_values_open(void)
{
  static const char *const f[] = {"0;tanh((t-0.3)*1e3)", "0;tanh((t-0.3)*1e9)"};
  const double g = pow(0.7, 8), first = 1 - 2 * g;
  for (int i = 0; i < 2; i++) {
    steif_weak_row row[4];
    steif_weak_result result;
    broken_system s;
    broken_open(&s, 2, f[i]);
    const steif_weak_query query = {.method = "be",
                                    .linear = &s.linear,
                                    .x0 = s.x0,
                                    .convention = STEIF_R,
                                    .component = 0,
                                    .rows = 4};
    CHECK(!steif_weak_measure(s.ctx, &query, row, &result) && result.converges == -1);
    if (i == 0) CHECK(fabs(result.exact - first) <= 1e-4 && result.accuracy < 1e-10);
    if (i == 1) CHECK(isnan(result.exact) && !isfinite(result.accuracy));
    broken_close(&s);
  }
}

CU_TestInfo tests_of_breaks[] = {
  {"impulses at breaks of f are paired", impulses_at_breaks_are_paired},
  {"a circuit with a switched source pairs to 12 digits", a_circuit_with_a_switched_source},
  {"fronts that no panel sees leave values open", unseen_fronts_leave_values_open},
  {"breaks on the mesh leave orders as restarts do", orders_on_the_mesh},
  {"breaks inside steps leave no order", no_order_off_the_mesh},
  {"meshes hold all breaks", meshes_hold_all_breaks},
  {"norms at breaks are those by hand", norms_at_breaks_by_hand},
  {"norms with breaks inside steps have no order", norms_with_breaks_inside_steps},
  {"no test function beats norms with breaks", no_function_beats_norms_with_breaks},
  {"memory of norms may fail", memory_of_norms_may_fail},
  {"undeclared breaks are found", undeclared_breaks_are_found},
  {"fast forcing is no break", fast_forcing_is_no_break},
  CU_TEST_INFO_NULL};
