/* test_jumps.c: jumps of nonlinear systems: unique ones against closed forms, others refused.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base/failing.h"
#include "models/models.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/jump.h>
#include <steif/solver.h>
#include <string.h>

#define RESIDUAL(name) static void name(double t, const cplx *y, const cplx *yp, cplx *r)

/* y1' = z y2, y2' = z, y1 + y2 = 1: the direction (y2, 1) of the impulse jumps with it */
RESIDUAL(turned)
{
  (void)t;
  r[0] = yp[0] - y[2] * y[1], r[1] = yp[1] - y[2], r[2] = y[0] + y[1] - 1;
}

/* the same along (a, 1) */
RESIDUAL(straight)
{
  (void)t;
  r[0] = yp[0] - y[2] * .7, r[1] = yp[1] - y[2], r[2] = y[0] * y[0] + y[1] - 1;
}

/* Capacitors q = v + v^3/2 switched together: C(v) v' = i, and charges as unknowns. */
RESIDUAL(capacities)
{
  (void)t;
  r[0] = (1 + 1.5 * y[0] * y[0]) * yp[0] + y[2];
  r[1] = (1 + 1.5 * y[1] * y[1]) * yp[1] - y[2];
  r[2] = y[0] - y[1];
}

RESIDUAL(charges)
{
  (void)t;
  r[0] = yp[0] + y[4], r[1] = yp[1] - y[4];
  r[2] = y[0] - y[2] - .5 * y[2] * y[2] * y[2];
  r[3] = y[1] - y[3] - .5 * y[3] * y[3] * y[3];
  r[4] = y[2] - y[3];
}

/* two masses on a bar that lies along x, with lengths from springs of no force: M is not 1 */
RESIDUAL(bar)
{
  (void)t;
  r[0] = yp[0] - y[2], r[1] = yp[1] - y[3];
  r[2] = 1.5 * yp[2] - y[4], r[3] = .7 * yp[3] + y[4];
  r[4] = y[0] - y[1] + 1;
}

/* index 1, no zero column in E: (a + b)' = -c, 0 = a - b - c^3, 0 = c + c^3 - a */
RESIDUAL(mixed)
{
  (void)t;
  r[0] = yp[0] + yp[1] + y[2];
  r[1] = y[0] - y[1] - y[2] * y[2] * y[2];
  r[2] = y[2] + y[2] * y[2] * y[2] - y[0];
}

/* E moves with time: (1, t) (y1', y2') = ..., the constraint along it (Gear and Petzold) */
RESIDUAL(turning)
{
  r[0] = y[0] + 2 * t * y[1] - cexp(-t);
  r[1] = yp[0] + 2 * t * yp[1] + 3 * y[1];
}

static const model jumping[] = {
  {.name = "turned", .n = 3, .F = turned, .y0 = {.2, .3}},
  {.name = "straight", .n = 3, .F = straight, .y0 = {.2, .3}},
  {.name = "capacities", .n = 3, .F = capacities, .y0 = {1, 0}},
  {.name = "charges", .n = 5, .F = charges, .y0 = {1.5, 0, 1, 0}},
  {.name = "bar", .n = 5, .F = bar, .y0 = {0, 1, 3, 0, .2}},
  {.name = "mixed", .n = 3, .F = mixed, .y0 = {.2, .9, .1}},
  {.name = "turning", .n = 2, .F = turning, .t0 = .4, .y0 = {.2, .9}},
};

typedef struct scene {
  steif_context *ctx;
  steif_problem p;
  const model *m;
  steif_jump jump;
  int code;
} scene;

static void leap(scene *s, const char *name, const double *y, steif_jump_request request)
{
  *s = (scene){.ctx = steif_context_new(NULL)};
  for (size_t k = 0; k < sizeof jumping / sizeof *jumping; k++)
    if (!strcmp(jumping[k].name, name)) s->m = jumping + k;
  if (s->m)
    s->p = model_problem(s->m, 1);
  else
    CU_ASSERT_FATAL(!steif_problem_find(s->ctx, name, &s->p));
  const steif_point q = {.y = y ? y : s->p.y0, .t = s->p.t0};
  s->code = steif_jump_find(s->ctx, &s->p, &q, &request, &s->jump);
}

static void land(scene *s)
{
  steif_jump_clear(&s->jump);
  if (!s->m) steif_problem_clear(s->ctx, &s->p);
  steif_context_free(&s->ctx);
}

/* The pendulum at the angle -0.6 hit to v- = (1, 1/2): Lambda = q . v-, v+ = v- - Lambda q,
 * lambda+ = |v+|^2 - g q_y; an impact with e = 1/2 takes 3/2 Lambda and the energy
 * (1 - e^2) Lambda^2 / 2. */
static void an_impact_is_unique(void)
{
  scene s;
  const double q[] = {cos(.6), -sin(.6)}, hit = .54301437821216062;
  const double y[] = {q[0], q[1], 1, .5, 6.0291426640052969};
  leap(&s, "pendulum3", y, (steif_jump_request){0});
  const double plus[] = {q[0], q[1], .5518308942534698, .80660898160278157, 6.4942780490601574};
  CHECK(!s.code && s.jump.unique && s.jump.index == 3);
  for (int j = 0; j < 5 && !s.code; j++) CLOSE(s.jump.y[j], plus[j], 1e-12);
  if (!s.code) CLOSE(s.jump.c[4], hit, 1e-12);
  land(&s);
  leap(&s, "pendulum3", y, (steif_jump_request){.restitution = .5});
  CHECK(!s.code && s.jump.unique);
  double energy = 0;
  for (int j = 0; j < 2 && !s.code; j++) {
    const double v = s.jump.y[2 + j], before = y[2 + j];
    CLOSE(v, before - 1.5 * hit * q[j], 1e-12);
    energy += (before * before - v * v) / 2;
  }
  CLOSE(energy, .110574230, 1e-8); /* 3/8 0.543014378^2 */
  CLOSE(energy, .375 * hit * hit, 1e-12);
  if (!s.code) CLOSE(s.jump.c[4], 1.5 * hit, 1e-12);
  land(&s);
  leap(&s, "pendulum3", (const double[]){1, 0, .3, -2, 0}, (steif_jump_request){0});
  CHECK(!s.code && s.jump.unique);
  if (!s.code) {
    CLOSE_FLOOR(s.jump.y[2], 0, 1e-12, 1);
    CLOSE(s.jump.y[3], -2, 1e-12);
    CLOSE(s.jump.y[4], 4, 1e-12);
    CLOSE(s.jump.c[4], .3, 1e-12);
  }
  land(&s);
}

/* What one mass loses the other gains: v+ = 1.5 * 3 / 2.2. */
static void masses_weigh_the_jump(void)
{
  scene s;
  leap(&s, "bar", NULL, (steif_jump_request){0});
  CHECK(!s.code && s.jump.unique);
  if (!s.code) {
    CLOSE(s.jump.y[2], 1.5 * 3 / 2.2, 1e-12);
    CLOSE(s.jump.y[3], 1.5 * 3 / 2.2, 1e-12);
    CLOSE(s.jump.c[4], -.7 * 1.5 * 3 / 2.2, 1e-12);
    CLOSE_FLOOR(s.jump.y[4], 0, 1e-10, 1);
  }
  land(&s);
}

/* Five percent off the rod: nothing decides what becomes of the velocities. */
static void positions_are_refused(void)
{
  scene s;
  const double q[] = {1.05 * cos(.6), -1.05 * sin(.6)};
  const double y[] = {q[0], q[1], 1, .5, 6};
  leap(&s, "pendulum3", y, (steif_jump_request){0});
  CHECK(!s.code && !s.jump.unique);
  CHECK(strstr(s.jump.message, "position jump") && strstr(s.jump.message, "ask for stages"));
  land(&s);
  leap(&s, "pendulum3", y, (steif_jump_request){.stages = 1});
  CHECK(!s.code && !s.jump.unique);
  CHECK(strstr(s.jump.message, "velocities kept tangentially"));
  const double tangential = y[2] * sin(.6) + y[3] * cos(.6);
  if (!s.code) {
    CLOSE(s.jump.y[0], cos(.6), 1e-12);
    CLOSE(s.jump.y[1], -sin(.6), 1e-12);
    CLOSE(s.jump.y[2], tangential * sin(.6), 1e-12);
    CLOSE(s.jump.y[3], tangential * cos(.6), 1e-12);
  }
  land(&s);
  /* As far off as the error of a run: within ten tolerances that is no jump of positions. */
  const double near[] = {(1 + 2e-6) * cos(.6), -(1 + 2e-6) * sin(.6), 1, .5, 6};
  leap(&s, "pendulum3", near, (steif_jump_request){0});
  CHECK(!s.code && s.jump.unique);
  land(&s);
  leap(&s, "pendulum3", near, (steif_jump_request){.rtol = 1e-8});
  CHECK(!s.code && !s.jump.unique);
  land(&s);
}

/* Z^2 + 1.3 Z = 1/2 with the direction behind the jump, 1.3 Z = 1/2 with the one before it. */
static void turning_directions_are_refused_with_both_values(void)
{
  scene s;
  leap(&s, "turned", NULL, (steif_jump_request){0});
  CHECK(!s.code && !s.jump.unique && s.jump.index == 2);
  if (!s.code) {
    CLOSE(s.jump.c[2], (sqrt(3.69) - 1.3) / 2, 1e-12);
    CLOSE(s.jump.c[2], .310468635615, 1e-11);
    CLOSE(s.jump.before_c[2], .5 / 1.3, 1e-12);
    CHECK(strstr(s.jump.message, "directions of the impulses depend on jumping unknowns"));
    CHECK(strstr(s.jump.message, "0.310468635615") && strstr(s.jump.message, "0.384615384615"));
  }
  land(&s);
  leap(&s, "straight", NULL, (steif_jump_request){0});
  const double Z =
    (sqrt(1.28 * 1.28 + 4 * .49 * .66) - 1.28) / .98; /* (.2 + .7 Z)^2 + .3 + Z = 1 */
  CHECK(!s.code && s.jump.unique);
  if (!s.code) CLOSE(s.jump.c[2], Z, 1e-12);
  land(&s);
}

/* Charges decide: v + v^3/2 = 3/4. Where the capacities multiply v', the charge lost depends on
 * the side: v = 5/7 before, 1/2 behind. */
static void charges_are_kept(void)
{
  scene s;
  leap(&s, "charges", NULL, (steif_jump_request){0});
  CHECK(!s.code && s.jump.unique);
  if (!s.code) {
    CLOSE(s.jump.y[2], .626845275826244, 1e-12);
    CLOSE(s.jump.y[3], .626845275826244, 1e-12);
    CLOSE(s.jump.y[0] + s.jump.y[1], 1.5, 1e-12);
  }
  land(&s);
  leap(&s, "capacities", NULL, (steif_jump_request){0});
  CHECK(!s.code && !s.jump.unique);
  if (!s.code) {
    CHECK(strstr(s.jump.message, "E depends on jumping unknowns"));
    CLOSE(s.jump.before[0], 5. / 7, 1e-12);
    CLOSE(s.jump.y[0], .5, 1e-12);
  }
  land(&s);
}

/* At index 1 the sum a + b = 1.1 stays, and a and b do not: c = 0.434... of 2 c + c^3 = 1.1. */
static void index_one_keeps_what_E_sees(void)
{
  scene s;
  leap(&s, "mixed", NULL, (steif_jump_request){0});
  CHECK(!s.code && s.jump.unique && s.jump.index == 1 && s.jump.count == 0);
  if (!s.code) {
    const double c = s.jump.y[2];
    CLOSE(2 * c + c * c * c, 1.1, 1e-12);
    CLOSE(s.jump.y[0], c + c * c * c, 1e-12);
    CLOSE(s.jump.y[1], c, 1e-12);
  }
  land(&s);
}

static void moving_matrices_are_said(void)
{
  scene s;
  leap(&s, "turning", NULL, (steif_jump_request){0});
  CHECK(s.code == STEIF_SINGULAR);
  land(&s);
  leap(&s, "turned", NULL, (steif_jump_request){.restitution = 2});
  CHECK(s.code == STEIF_BAD_INPUT);
  land(&s);
}

/* Whichever allocation fails: the code says so, and nothing is kept. */
static void hunger_is_survived(void)
{
  const steif_problem p = model_problem(jumping + 1, 1);
  int code = STEIF_NO_MEMORY;
  for (long k = 1; code && k < 1000000; k += 1 + k / 6) {
    failing memory = {.refuse_at = k};
    const steif_setup setup = failing_setup(&memory);
    steif_context *ctx = steif_context_new(&setup);
    steif_jump jump;
    if (!ctx) continue;
    code = steif_jump_find(ctx, &p, NULL, NULL, &jump);
    CHECK(code == STEIF_NO_MEMORY || (!code && memory.served < k));
    steif_jump_clear(&jump);
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
  }
  CHECK(!code);
}

/* -- runs -------------------------------------------------------------------------------- */

/* y1' = a z, y2' = z, y1 + y2 = 1/2, from t = 0.3 on 1; a = y2 or 0.7 */
RESIDUAL(stepped_turned)
{
  turned(t, y, yp, r);
  if (t < .3) r[2] += .5;
}

RESIDUAL(stepped)
{
  stepped_turned(t, y, yp, r);
  r[0] = yp[0] - .7 * y[2];
}

static void breaks_are_crossed_by_jumps(void)
{
  static const double at[] = {.3};
  static const model m[] = {
    {.name = "stepped", .n = 3, .F = stepped, .y0 = {.2, .3}},
    {.name = "stepped turned", .n = 3, .F = stepped_turned, .y0 = {.2, .3}}};
  for (int k = 0; k < 2; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p = model_problem(&m[k], 1);
    p.t1 = 1, p.breaks = at, p.break_count = 1, p.dae_index = 2;
    steif_options o = steif_defaults();
    o.reinitialise = steif_reinitialise;
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
    CU_ASSERT_FATAL(s != NULL);
    const int code = steif_solve_to(s, 1);
    if (k == 0) {
      CHECK(!code);
      CLOSE(NV_Ith_S(steif_solution(s), 1), .3 + .5 / 1.7, 1e-10);
    } else {
      CHECK(code == STEIF_NOT_CERTIFIED);
      CHECK(strstr(steif_message(ctx), "0.310468635615") != NULL);
    }
    steif_solver_free(&s);
    steif_context_free(&ctx);
  }
}

static int lowest(sunrealtype t, N_Vector y, sunrealtype *g, void *user)
{
  (void)t, (void)user;
  g[0] = NV_Ith_S(y, 0);
  return 0;
}

static double stretch; /* of the rod, by the blow */
static int hit(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 1) *= stretch, NV_Ith_S(y, 3) = -.5; /* against the rod */
  return STEIF_RESTART;
}

/* A blow along the rod is taken by it, and the run goes on as if there had been none; what it
 * would do to a rod that has become longer is not known. */
static void events_are_left_by_jumps(void)
{
  double end[2] = {0, 0};
  for (int k = 0; k < 4; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, "pendulum3", &p));
    if (k) p.events = 1, p.event = lowest, p.handle_event = hit;
    stretch = k > 1 ? 1.05 : 1;
    steif_options o = steif_defaults();
    o.rtol = 1e-9, o.t1 = 1,
    o.reinitialise = k < 3 ? steif_reinitialise : steif_reinitialise_stages;
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=5", &o);
    CU_ASSERT_FATAL(s != NULL);
    const int code = steif_solve_to(s, 1);
    CHECK(code == (k == 2 ? STEIF_NOT_CERTIFIED : STEIF_OK));
    if (k == 2) CHECK(strstr(steif_message(ctx), "position jump") != NULL);
    for (int j = 0; j < 2 && k != 2; j++) {
      const double value = NV_Ith_S(steif_solution(s), j);
      if (k) CLOSE(value, end[j], 1e-6);
      if (!k) end[j] = value;
    }
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_jumps[] = {{"breaks are crossed by jumps", breaks_are_crossed_by_jumps},
                                {"events are left by jumps", events_are_left_by_jumps},
                                {"an impact is unique", an_impact_is_unique},
                                {"masses weigh the jump", masses_weigh_the_jump},
                                {"jumps of positions are refused", positions_are_refused},
                                {"turning directions are refused with both values",
                                 turning_directions_are_refused_with_both_values},
                                {"charges are kept", charges_are_kept},
                                {"index 1 keeps what E sees", index_one_keeps_what_E_sees},
                                {"moving matrices are said", moving_matrices_are_said},
                                {"hunger is survived", hunger_is_survived},
                                CU_TEST_INFO_NULL};
