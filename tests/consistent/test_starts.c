/* test_starts.c: consistent start values against closed forms.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "models/models.h"
#include "suite.h"
#include <steif/data.h>
#include <steif/solver.h>
#include <string.h>

/* A start from guesses; y, yp NULL: those of the problem. */
typedef struct run {
  steif_context *ctx;
  steif_problem p;
  const model *m;
  steif_start start;
  int code;
} run;

static void begin(run *r, const char *name)
{
  *r = (run){.ctx = steif_context_new(NULL), .m = model_find(name)};
  if (r->m)
    r->p = model_problem(r->m, 1);
  else
    CU_ASSERT_FATAL(!steif_problem_find(r->ctx, name, &r->p));
}

static void find(run *r, const double *y, const double *yp, const char *attributes)
{
  enum steif_attribute attribute[200];
  const double *y0 = y ? y : r->p.y0;
  steif_point q = r->m ? model_inquiry(r->m) : (steif_point){0};
  q.y = y0, q.t = r->p.t0, q.yp = yp;
  for (sunindextype j = 0; attributes && j < r->p.n; j++)
    attribute[j] = attributes[j] == 'x'   ? STEIF_FIXED
                   : attributes[j] == '?' ? STEIF_FREE
                                          : STEIF_GUESS;
  const steif_request request = {.attribute = attributes ? attribute : NULL};
  r->code = steif_consistent(r->ctx, &r->p, &q, &request, &r->start);
}

static void end(run *r)
{
  steif_start_clear(&r->start);
  if (!r->m) steif_problem_clear(r->ctx, &r->p);
  steif_context_free(&r->ctx);
}

static void close_to(const run *r, const double *y, const double *yp, double tolerance)
{
  if (r->code) printf("\n  %s: %s", r->p.name, steif_message(r->ctx));
  CHECK(r->code == STEIF_OK);
  if (r->code) return;
  for (sunindextype j = 0; j < r->p.n; j++) {
    if (y) CLOSE_FLOOR(r->start.y[j], y[j], tolerance, 1);
    if (yp) CLOSE_FLOOR(r->start.yp[j], yp[j], tolerance, 1);
  }
}

/* From exact positions with everything else lost. */
static void published_starts(void)
{
  run r;
  double y[10];
  begin(&r, "pendulum3");
  memcpy(y, r.p.y0, 5 * sizeof *y);
  y[4] = 0;
  find(&r, y, (const double[5]){0}, NULL);
  close_to(&r, r.p.y0, NULL, 1e-14);
  close_to(&r, NULL, r.p.yp0, 1e-12);
  end(&r);
  begin(&r, "caraxis");
  find(&r, NULL, (const double[10]){0}, NULL);
  close_to(&r, r.p.y0, r.p.yp0, 1e-10);
  end(&r);
  begin(&r, "transamp");
  find(&r, NULL, (const double[8]){0}, NULL);
  close_to(&r, r.p.y0, r.p.yp0, 1e-10);
  end(&r);
  begin(&r, "chemakzo");
  memcpy(y, r.p.y0, 6 * sizeof *y);
  y[5] = .2;
  find(&r, y, (const double[6]){0}, NULL);
  close_to(&r, r.p.y0, r.p.yp0, 1e-12);
  end(&r);
}

/* Closed solutions of the models at their start; guesses wrong by some percent where the
 * start is determined anyway. */
static void closed_starts(void)
{
  static const char *const names[] = {"hess2", "jay3", "cstr", "reactors"};
  static const double tolerance[] = {1e-12, 1e-12, 1e-10, 1e-12};
  for (int k = 0; k < 4; k++) {
    run r;
    double y[5];
    begin(&r, names[k]);
    for (sunindextype j = 0; j < r.p.n; j++)
      y[j] = r.p.y0[j] * (k < 2 ? 1 : 1 + .03 * cos((double)j + 1));
    find(&r, y, (const double[5]){0}, NULL);
    close_to(&r, r.m->y0, r.m->yp0, tolerance[k]);
    end(&r);
  }
}

static void turned_problems(void)
{
  run r;
  double y[4];
  begin(&r, "rot1");
  find(&r, NULL, (const double[4]){0}, NULL);
  close_to(&r, r.m->y0, r.m->yp0, 1e-12);
  end(&r);
  begin(&r, "rot3");
  for (int j = 0; j < 4; j++) y[j] = r.p.y0[j];
  find(&r, y, (const double[4]){0}, NULL);
  close_to(&r, r.m->y0, r.m->yp0, 1e-10);
  end(&r);
}

static void circuits(void)
{
  run r;
  begin(&r, "mnacv");
  find(&r, (const double[]){.3, .1, .7}, (const double[3]){0}, NULL);
  close_to(&r, (const double[]){0, .1, 0}, NULL, 1e-12);
  CLOSE(r.start.yp[0], 1000, 1e-12);
  end(&r);
  begin(&r, "mnali");
  find(&r, (const double[]){.3, .1, .7}, (const double[3]){0}, NULL);
  close_to(&r, (const double[]){1.1, .1, 0}, NULL, 1e-12);
  end(&r);
}

/* -- moved guesses ----------------------------------------------------------------------- */

/* Radial projection of the position, then tangential of the velocity [closed form]. */
static void pendulum_moves_least(void)
{
  run r;
  double y[6];
  begin(&r, "pendulum3");
  memcpy(y, r.p.y0, 5 * sizeof *y);
  y[0] *= 1.05, y[1] *= 1.05, y[2] += .1, y[3] -= .05;
  find(&r, y, NULL, NULL);
  close_to(&r,
           (const double[]){0.8253356149096783, -0.5646424733950354, 0.4038308665035104,
                            0.5902779408732193, 6.050650080227801},
           NULL, 1e-12);
  CLOSE(r.start.moved[0], -.05 * 0.8253356149096783, 1e-11);
  CHECK(r.start.levels == 2 && r.start.enforced[4] == 2 && r.start.enforced[0] == 1);
  CHECK(strstr(r.start.message, "e5 is violated by 1.0") != NULL);
  end(&r);
  begin(&r, "pendulum3:index=2");
  find(&r, y, NULL, NULL);
  CHECK(r.code == STEIF_OK);
  CLOSE(r.start.y[0], 0.8353178153648, 1e-10);
  CLOSE(r.start.y[1], -0.6340874713799, 1e-10);
  CLOSE(r.start.y[4], 6.1268882731087, 1e-10);
  CHECK(r.start.levels == 1);
  end(&r);
  begin(&r, "pendulum3:index=ggl");
  y[5] = .3;
  find(&r, y, NULL, NULL);
  close_to(&r,
           (const double[]){0.79553107988136, -0.60591278328057, 0.43620126746248,
                            0.57270893588221, 6.4622714749576, 0},
           NULL, 1e-10);
  end(&r);
}

/* Minimal movement in the 2-norm, stage by stage (own prototype with 30 digits). */
static void other_guesses_move_least(void)
{
  run r;
  double y[10];
  begin(&r, "caraxis");
  memcpy(y, r.p.y0, sizeof y);
  y[0] = .02, y[3] = .52, y[5] = .1, y[8] = .3;
  find(&r, y, NULL, NULL);
  close_to(&r,
           (const double[]){0, .500003996404226, .9998001398522, .51999600359577,
                            -.500003996404226, .09996012778116, -.49800599061472,
                            3.9872218838e-5, 1.869308204816e-4, 1.434741488960e-4},
           NULL, 1e-10);
  end(&r);
  begin(&r, "jay3");
  find(&r, (const double[]){1.1, 1, .9, 1, .5}, (const double[5]){0}, NULL);
  close_to(&r,
           (const double[]){1.0827111877258, .9610449208662, .9998570504496, .8875012568635,
                            .9086313330995},
           NULL, 1e-10);
  end(&r);
  begin(&r, "hess2");
  find(&r, (const double[]){1.2, 1, .9}, (const double[3]){0}, NULL);
  close_to(&r, (const double[]){1.0470175364603, .9122042442182, 1.0962457216553}, NULL, 1e-10);
  end(&r);
}

/* Exact positions and velocities stay to rounding, whatever the multiplier is guessed. */
static void multipliers_do_not_move_positions(void)
{
  static const double guess[] = {0, 1e6};
  for (int k = 0; k < 2; k++) {
    run r;
    double y[5];
    begin(&r, "pendulum3");
    memcpy(y, r.p.y0, sizeof y);
    y[4] = guess[k];
    find(&r, y, NULL, NULL);
    CHECK(r.code == STEIF_OK);
    for (int j = 0; j < 4 && !r.code; j++) CLOSE(r.start.y[j], r.p.y0[j], 1e-15);
    if (!r.code) CLOSE(r.start.y[4], r.p.y0[4], 1e-13);
    end(&r);
  }
}

/* 2 z^2 - 3 z + 1 = 0 with y fixed at (1, 1): the guess chooses. */
static void two_branches(void)
{
  static const double guess[] = {.74, .76, 0, 5}, value[] = {.5, 1, .5, 1};
  for (int k = 0; k < 4; k++) {
    run r;
    begin(&r, "hess2");
    find(&r, (const double[]){1, 1, guess[k]}, (const double[3]){0}, "xx ");
    close_to(&r, (const double[]){1, 1, value[k]}, NULL, 1e-12);
    end(&r);
  }
}

/* -- fixed ------------------------------------------------------------------------------- */

static void fixed_values(void)
{
  run r;
  double y[5];
  begin(&r, "pendulum3");
  memcpy(y, r.p.y0, sizeof y);
  y[0] *= 1.05, y[1] *= 1.05;
  find(&r, y, NULL, "xx   ");
  CHECK(r.code == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(r.ctx), "{e5}") != NULL);
  CHECK(strstr(steif_message(r.ctx), "{x, y}") != NULL);
  CHECK(strstr(steif_message(r.ctx), "0.1025") != NULL); /* 1.05^2 - 1 */
  end(&r);
  begin(&r, "pendulum3");
  y[0] = .6, y[3] = 1.3;
  find(&r, y, NULL, "x  x ");
  close_to(&r, (const double[]){.6, -.8, 1.3 * .8 / .6, 1.3, 0}, NULL, 100);
  if (!r.code) {
    CHECK(r.start.y[0] == .6 && r.start.y[3] == 1.3);
    CLOSE(r.start.y[1], -.8, 1e-13);
    CLOSE(r.start.y[2], 1.3 * .8 / .6, 1e-13);
    CLOSE(r.start.y[4], 1.3 * 1.3 / .36 + 9.81 * .8, 1e-12); /* u^2 + v^2 - g y */
  }
  end(&r);
  begin(&r, "mnacv");
  find(&r, (const double[]){.3, .1, 0}, NULL, "x  ");
  CHECK(r.code == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(r.ctx), "e1: it can never be prescribed") != NULL);
  end(&r);
}

/* Fixed values that happen to fulfil the equations are no contradiction. */
static void redundant_fixed_values_are_accepted(void)
{
  run r;
  begin(&r, "pendulum3");
  find(&r, NULL, NULL, "xxxx ");
  close_to(&r, r.p.y0, r.p.yp0, 1e-12);
  end(&r);
}

static void hopeless_starts_say_so(void)
{
  run r;
  begin(&r, "ltva");
  find(&r, NULL, NULL, NULL);
  CHECK(r.code == STEIF_SINGULAR && strstr(steif_message(r.ctx), "not unique") != NULL);
  end(&r);
  begin(&r, "fold"); /* x = y^2 with x = -1 fixed */
  find(&r, (const double[]){-1, 1}, NULL, "x ");
  CHECK(r.code < 0 && strstr(steif_message(r.ctx), "e2") != NULL);
  end(&r);
}

/* The list of what a repair moved begins with what it moved most. */
static void moves_are_listed_by_size(void)
{
  static const char *const problems[] = {"pendulum3", "caraxis", "impact"};
  enum { MOST = 10 };
  steif_context *c = steif_context_new(NULL);
  for (int k = 0; k < 3; k++) {
    steif_problem p;
    CU_ASSERT_FATAL(!steif_problem_find(c, problems[k], &p) && p.n <= MOST);
    sunrealtype y[MOST];
    for (int i = 0; i < p.n; i++)
      y[i] = p.y0[i] + (i % 2 ? 0.01 : -0.01) * (i + 1) * (fabs(p.y0[i]) + 0.1);
    const steif_point at = {.t = p.t0, .y = y};
    const steif_request request = {.weight = NULL};
    steif_start start;
    CU_ASSERT_FATAL(!steif_consistent(c, &p, &at, &request, &start));
    double before = INFINITY;
    int listed = 0;
    const char *text = strstr(start.message, "moved ");
    for (; text && (text = strstr(text, " by ")); text += 4, listed++) {
      const double size = fabs(strtod(text + 4, NULL));
      if (!(size <= before)) printf("\n  %s: %s", problems[k], start.message);
      CHECK(size <= before);
      before = size;
    }
    CHECK(listed > 2);
    steif_start_clear(&start);
    steif_problem_clear(c, &p);
  }
  steif_context_free(&c);
}

/* What solves leave by rounding is no reason against a start: the same values for all tolerances. */
static void rounding_is_no_obstacle(void)
{
  static const double rtol[] = {1e-5, 1e-8, 1e-9, 1e-11, 1e-13};
  steif_context *c = steif_context_new(NULL);
  steif_problem p;
  CU_ASSERT_FATAL(!steif_problem_find(c, "bus:case=inc", &p));
  double first[300];
  CU_ASSERT_FATAL(p.n == 300);
  for (int k = 0; k < 5; k++) {
    steif_options o = steif_defaults();
    o.rtol = rtol[k];
    steif_solver *s = steif_solver_new(c, &p, "bdf", &o);
    const steif_repair *r = s ? steif_initial_used(s) : NULL;
    CU_ASSERT_FATAL(r && r->y && r->moved == 200);
    if (!k) memcpy(first, r->y, sizeof first);
    for (int i = 0; i < 300; i++) CLOSE(r->y[i], first[i], 1e-11);
    steif_solver_free(&s);
  }
  steif_problem_clear(c, &p);
  steif_context_free(&c);
}

CU_TestInfo tests_of_starts[] = {
  {"published starts", published_starts},
  {"closed starts", closed_starts},
  {"turned problems", turned_problems},
  {"circuits", circuits},
  {"pendulum moves least", pendulum_moves_least},
  {"other guesses move least", other_guesses_move_least},
  {"multipliers do not move positions", multipliers_do_not_move_positions},
  {"two branches", two_branches},
  {"fixed values", fixed_values},
  {"redundant fixed values are accepted", redundant_fixed_values_are_accepted},
  {"hopeless starts say so", hopeless_starts_say_so},
  {"moves are listed by size", moves_are_listed_by_size},
  {"rounding is no obstacle", rounding_is_no_obstacle},
  CU_TEST_INFO_NULL};
