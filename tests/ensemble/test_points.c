/* test_points.c: members shown on their way, with the bits and steps of a run that is not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <math.h>
#include <steif/data.h>
#include <steif/ensemble.h>
#include <steif/steif.h>
#include <string.h>

enum { MEMBERS = 12, POINTS = 4 };

typedef struct record {
  double t[POINTS], y[POINTS], end;
  long steps;
  int seen, code;
  char sentence[200];
} record;

static record rows[MEMBERS];

static int rates(steif_context *ctx, long long i, steif_problem *p, steif_options *o,
                 void *user)
{
  (void)ctx, (void)user;
  p->parameters->value[0] = 0.01 + 0.005 * (double)i;
  o->t1 = 10 + (double)i;
  return STEIF_OK;
}

static int look(steif_context *ctx, long long i, int j, const steif_problem *p, steif_solver *s,
                void *of, void *user)
{
  record *r = of;
  const int *end_at = user;
  (void)ctx, (void)p;
  CHECK(j == r->seen);
  r->t[j] = steif_time(s);
  r->y[j] = N_VGetArrayPointer(steif_solution(s))[0];
  r->seen++;
  return end_at && i == *end_at ? STEIF_IO : STEIF_OK;
}

static int done(steif_context *ctx, long long i, const steif_problem *p, steif_solver *s,
                int code, void *of, void *user)
{
  record *r = of;
  (void)i, (void)p, (void)user;
  r->code = code;
  r->end = N_VGetArrayPointer(steif_solution(s))[0];
  r->steps = steif_statistics(s)->steps;
  if (code) snprintf(r->sentence, sizeof r->sentence, "%s", steif_message(ctx));
  return STEIF_OK;
}

static int keep(long long i, const void *of, void *user)
{
  (void)user;
  rows[i] = *(const record *)of;
  return 0;
}

static int run(int points, const double *times, int *end_at)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_ensemble_options e = {.problem = "rober",
                                    .method = "radau:s=3",
                                    .threads = 2,
                                    .record = sizeof(record),
                                    .row = keep,
                                    .user = end_at,
                                    .points = points,
                                    .times = times,
                                    .at = look};
  memset(rows, 0, sizeof rows);
  const int code = steif_ensemble(ctx, MEMBERS, rates, done, &e);
  steif_context_free(&ctx);
  return code;
}

static void the_steps_stay(void)
{
  double end[MEMBERS];
  long steps[MEMBERS];
  CHECK(run(0, NULL, NULL) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) {
    end[i] = rows[i].end, steps[i] = rows[i].steps;
    CHECK(rows[i].seen == 0);
  }
  CHECK(run(POINTS, NULL, NULL) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) {
    CHECK(rows[i].seen == POINTS && rows[i].end == end[i] && rows[i].steps == steps[i]);
    CHECK(rows[i].y[POINTS - 1] == end[i] && rows[i].y[0] == 1); /* y(0) = 1 */
    for (int j = 0; j < POINTS; j++)
      CLOSE(rows[i].t[j], (10 + (double)i) * j / (POINTS - 1), 1e-14);
  }
}

/* Times before the end; one beyond it, or backwards, is the failure of the member. */
static void times_are_given(void)
{
  static const double early[] = {1, 5, 5, 9}, late[] = {1, 5, 9, 15.5}, back[] = {1, 5, 4, 9};
  CHECK(run(POINTS, early, NULL) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) {
    CHECK(rows[i].seen == POINTS && rows[i].y[1] == rows[i].y[2]);
    CHECK(rows[i].y[3] < rows[i].y[2] && rows[i].end < rows[i].y[3]);
  }
  CHECK(run(POINTS, late, NULL) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) {
    CHECK(rows[i].code == (10 + i < 15.5 ? STEIF_BAD_INPUT : STEIF_OK));
    CHECK(!rows[i].code || strstr(rows[i].sentence, "time 15.5 of member"));
  }
  CHECK(run(POINTS, back, NULL) == STEIF_OK);
  for (int i = 0; i < MEMBERS; i++) CHECK(rows[i].code == STEIF_BAD_INPUT && rows[i].seen == 2);
}

static void a_look_can_end_it(void)
{
  int end_at = 5;
  CHECK(run(POINTS, NULL, &end_at) == STEIF_IO);
  CHECK(rows[4].seen <= POINTS && rows[5].seen == 0);
  steif_context *ctx = steif_context_new(NULL);
  const steif_ensemble_options blind = {.problem = "rober", .points = 2};
  CHECK(steif_ensemble(ctx, 1, rates, done, &blind) == STEIF_BAD_INPUT);
  CHECK(strstr(steif_message(ctx), "without the callback 'at'"));
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_points[] = {{"points leave the steps as they are", the_steps_stay},
                                 {"times are given", times_are_given},
                                 {"a look can end it", a_look_can_end_it},
                                 CU_TEST_INFO_NULL};
