/* test_team.c: analyses that a team shares are those of one process, bit for bit; failures of one that serves, and lost
 * connections, are told and leave nothing behind.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/crew.h"
#include "impulse/systems.h"
#include "smooth_flow.h"

typedef struct found {
  steif_structure structure;
  steif_impulse impulse;
} found;

static int find(const system_ *s, const steif_analysis *analysis, found *out)
{
  memset(out, 0, sizeof *out);
  const int code = system_structure(s, analysis, &out->structure);
  return code ? code : system_start(s, analysis, &out->structure, &out->impulse);
}

static void drop(const system_ *s, found *f)
{
  steif_impulse_clear(s->ctx, &f->impulse);
  steif_structure_clear(s->ctx, &f->structure);
}

static bool same(const found *a, const found *b)
{
  const size_t bytes = (size_t)a->impulse.n * sizeof *a->impulse.c;
  return !memcmp(a->impulse.x_plus, b->impulse.x_plus, bytes) &&
         !memcmp(a->impulse.c, b->impulse.c, (size_t)a->impulse.count * bytes) &&
         a->structure.count == b->structure.count && a->structure.gap == b->structure.gap &&
         a->structure.cost.refactors == b->structure.cost.refactors &&
         a->impulse.cost.solves == b->impulse.cost.solves &&
         a->impulse.estimate == b->impulse.estimate && a->impulse.certified &&
         b->impulse.certified;
}

/* 8 to 40 nodes in batches of four, so that some teams have more processes than batches. Those of threads order
 * the same pattern at the same time. */
static void teams_agree(void)
{
  static const char *const spec[] = {"springs:n=1000,c=100", "ladder:n=700", "stokes:m=16"};
  for (int k = 0; k < 9; k++) {
    const steif_analysis analysis = {.points = k < 3 ? 16 : k < 6 ? 40 : 80};
    system_ s;
    found alone, shared;
    crew c;
    system_open(&s, &(steif_setup){.threads = 1 + k % 2}, spec[k % 3]);
    CHECK(find(&s, &analysis, &alone) == STEIF_OK);
    for (int others = 1; others <= MOST; others += 1 + k % 2) {
      assemble(&c, s.ctx, others, 1 + others % 2, 0);
      CHECK(find(&s, &analysis, &shared) == STEIF_OK);
      CHECK(same(&alone, &shared));
      drop(&s, &shared);
      part(&c, s.ctx, STEIF_OK);
      long served = 0;
      for (int p = 1; p <= others; p++) served += c.of[p].memory.served;
      CHECK(served > 50); /* they have done something */
    }
    drop(&s, &alone);
    system_close(&s);
  }
}

/* The same factors at many times. */
static void flows_agree(void)
{
  for (int others = 0; others <= 3; others++) {
    static sunrealtype first[3000];
    system_ s;
    found f;
    crew c;
    stf_smooth_flow flow;
    sunrealtype x[3000];
    const steif_analysis by = {.algorithm = STEIF_CONTOUR};
    system_open(&s, &(steif_setup){.threads = 1}, "springs:n=1000,c=100");
    CU_ASSERT_FATAL(s.n <= 3000);
    if (others) assemble(&c, s.ctx, others, 1, 0);
    CHECK(find(&s, NULL, &f) == STEIF_OK);
    const steif_linear l = {.E = s.E, .F = s.F, .f = s.problem.g, .user = s.problem.user};
    memcpy(x, s.problem.y0, (size_t)s.n * sizeof *x);
    CU_ASSERT_FATAL(
      !stf_smooth_flow_open(s.ctx, &l, &by, &f.structure, f.impulse.radius, &flow));
    for (int k = 0; k < 3; k++)
      CHECK(stf_smooth_flow_state(&flow, 0.1 * k, l.f, l.user, x) == STEIF_OK);
    stf_smooth_flow_close(&flow);
    if (!others) memcpy(first, x, (size_t)s.n * sizeof *x);
    CHECK(!memcmp(first, x, (size_t)s.n * sizeof *x));
    drop(&s, &f);
    if (others) part(&c, s.ctx, STEIF_OK);
    system_close(&s);
  }
}

/* One that serves has no memory: the call fails with its sentence, or, where what is left is enough, is right; the next
 * call goes through all the same. */
static void no_memory_elsewhere(void)
{
  int failures = 0;
  long requests = 0;
  system_ s;
  found alone;
  system_open(&s, &(steif_setup){.threads = 1}, "springs:n=60,c=6");
  CHECK(find(&s, NULL, &alone) == STEIF_OK);
  for (long k = 0; k <= requests; k++) {
    found shared, again;
    crew c;
    assemble(&c, s.ctx, 1, 1, k + 1 == 1 ? 0 : k + 1);
    const int code = find(&s, NULL, &shared);
    const bool told = strstr(steif_message(s.ctx), "process 1: ") != NULL;
    CHECK(code == STEIF_OK ? same(&alone, &shared) : code == STEIF_NO_MEMORY && told);
    failures += code != STEIF_OK;
    drop(&s, &shared);
    CHECK(find(&s, NULL, &again) == STEIF_OK && same(&alone, &again));
    drop(&s, &again);
    part(&c, s.ctx, STEIF_OK);
    if (!k) requests = c.of[1].memory.served / 2;
  }
  CHECK(failures > 20);
  drop(&s, &alone);
  system_close(&s);
}

static void connections_are_lost(void)
{
  long most = 1;
  for (long cut = 0; cut < most; cut += 1 + cut / 4) {
    system_ s;
    found f;
    crew c;
    system_open(&s, &(steif_setup){.threads = 1}, "springs:n=200,c=20");
    assemble(&c, s.ctx, 1, 1, 0);
    c.cut_at = cut;
    const int code = find(&s, NULL, &f);
    CHECK(code == (cut ? STEIF_IO : STEIF_OK));
    CHECK(!cut || strstr(steif_message(s.ctx), "process 1 of the team is lost"));
    if (!cut) most = c.pieces;
    drop(&s, &f);
    shutdown(c.of[1].ours, SHUT_RDWR);
    steif_team_lead(s.ctx, NULL);
    part(&c, s.ctx, STEIF_IO);
    CHECK(find(&s, NULL, &f) == STEIF_OK && f.impulse.certified); /* alone again */
    drop(&s, &f);
    system_close(&s);
  }
  CHECK(most > 10);
}

/* What a team has found serves when the team is gone. */
static void circles_outlive_teams(void)
{
  system_ s;
  found alone, shared;
  crew c;
  system_open(&s, &(steif_setup){.threads = 1}, "springs:n=200,c=20");
  CHECK(find(&s, NULL, &alone) == STEIF_OK);
  assemble(&c, s.ctx, 2, 1, 0);
  memset(&shared, 0, sizeof shared);
  CHECK(system_structure(&s, NULL, &shared.structure) == STEIF_OK);
  part(&c, s.ctx, STEIF_OK);
  CHECK(system_start(&s, NULL, &shared.structure, &shared.impulse) == STEIF_OK);
  CHECK(same(&alone, &shared));
  drop(&s, &alone), drop(&s, &shared);
  system_close(&s);
}

static void bad_teams(void)
{
  steif_context *ctx = steif_context_new(NULL);
  const steif_team none = {.others = 0, .send = lead_send, .receive = lead_receive},
                   mute = {.others = 1, .receive = lead_receive};
  CHECK(steif_team_lead(ctx, &none) == STEIF_BAD_INPUT);
  CHECK(steif_team_lead(ctx, &mute) == STEIF_BAD_INPUT);
  CHECK(steif_team_serve(ctx, &mute) == STEIF_BAD_INPUT);
  CHECK(steif_team_serve(ctx, NULL) == STEIF_BAD_INPUT);
  CHECK(steif_team_dismiss(ctx) == STEIF_OK);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_teams[] = {{"1 to 5 others give the bits of one process", teams_agree},
                                {"factors that are kept serve at other times", flows_agree},
                                {"no memory in one that serves", no_memory_elsewhere},
                                {"lost connections", connections_are_lost},
                                {"circles outlive the team", circles_outlive_teams},
                                {"bad teams", bad_teams},
                                CU_TEST_INFO_NULL};
