/* circle_team.c: a circle that several processes work on: orders to the others, and what they answer.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle_orders.h"
#include "circle_parts.h"
#include <steif/team.h>
#include <stdint.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

int stf_circle_processes(const stf_circle *c) { return c->team ? c->team->others + 1 : 1; }

int stf_circle_first(const stf_circle *c, int batches, int p)
{
  const int all = stf_circle_processes(c);
  return (batches * p + all - 1) / all;
}

static int lost(const stf_circle *c, int p)
{
  return stf_fail(c->scaled.ctx, STEIF_IO,
                  "process %d of the team is lost: it took or sent nothing more", p);
}

bool stf_team_put(const steif_team *team, int to, const void *data, size_t bytes)
{
  const char *at = data;
  for (size_t part; bytes; bytes -= part, at += part) {
    part = bytes < STF_TEAM_PIECE ? bytes : STF_TEAM_PIECE;
    if (team->send(to, at, part, team->user)) return false;
  }
  return true;
}

bool stf_team_get(const steif_team *team, int from, void *data, size_t bytes)
{
  char waste[STF_TEAM_PIECE], *at = data;
  for (size_t part; bytes; bytes -= part) {
    part = bytes < STF_TEAM_PIECE ? bytes : STF_TEAM_PIECE;
    if (team->receive(from, at ? at : waste, part, team->user)) return false;
    if (at) at += part;
  }
  return true;
}

static bool put(const stf_circle *c, int p, const void *data, size_t bytes)
{
  return stf_team_put(c->team, p, data, bytes);
}

static bool get(const stf_circle *c, int p, void *data, size_t bytes)
{
  return stf_team_get(c->team, p, data, bytes);
}

static sunindextype entries(SUNMatrix M) { return SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; }

static stf_order order_of(const stf_circle *c, enum stf_order_kind kind)
{
  const stf_scaled *s = &c->scaled;
  stf_order o;
  memset(&o, 0, sizeof o); /* its gaps are sent, too */
  o.size = STF_ORDER_SIZE, o.kind = kind, o.circle = (intptr_t)c, o.n = s->n;
  o.points = c->points, o.refinements = c->refinements;
  o.batches = c->batches, o.careful = c->careful;
  o.pass = c->passes;
  o.pivots = c->pivots, o.visit = c->from_visit;
  o.from_radius = c->from_radius, o.from_at = c->from_at;
  o.radius = c->radius, o.at = s->size;
  return o;
}

/* ---- orders ------------------------------------------------------------------------------ */

static bool put_matrix(const stf_circle *c, int p, SUNMatrix M)
{
  const size_t columns = (size_t)c->scaled.n + 1, filled = (size_t)entries(M);
  return put(c, p, SM_INDEXPTRS_S(M), columns * sizeof(sunindextype)) &&
         put(c, p, SM_INDEXVALS_S(M), filled * sizeof(sunindextype)) &&
         put(c, p, SM_DATA_S(M), filled * sizeof(sunrealtype));
}

/* Before the first pass. */
static int introduce(stf_circle *c, int batches)
{
  const stf_scaled *s = &c->scaled;
  stf_order o = order_of(c, STF_ORDER_OPEN);
  o.entries[0] = entries(s->givenE), o.entries[1] = entries(s->givenF);
  for (int p = c->known + 1; p < stf_circle_processes(c); p++) {
    if (stf_circle_first(c, batches, p) >= batches) break;
    if (!put(c, p, &o, sizeof o) || !put_matrix(c, p, s->givenE) ||
        !put_matrix(c, p, s->givenF))
      return lost(c, p);
    c->known = p;
  }
  return STEIF_OK;
}

static bool put_right_side(const stf_circle *c, int p, const stf_polynomial *g)
{
  const size_t row = (size_t)c->scaled.n * sizeof(double);
  if (!g) return true;
  return put(c, p, g->constant, row) && put(c, p, g->power, (size_t)g->powers * row) &&
         put(c, p, g->scale, g->scale ? row : 0);
}

int stf_circle_hand_out(const stf_pass *now, int batches, bool factor)
{
  stf_circle *c = now->c;
  if (!c->team) return STEIF_OK;
  STEIF_TRY(introduce(c, batches));
  c->passes++;
  stf_order o = order_of(c, factor ? STF_ORDER_FACTOR : STF_ORDER_SOLVE);
  o.given = now->g != NULL;
  o.scaled = now->g && now->g->scale;
  o.powers = now->g ? now->g->powers : 0;
  for (int p = 1; p < stf_circle_processes(c); p++) {
    const int first = stf_circle_first(c, batches, p),
              end = stf_circle_first(c, batches, p + 1);
    const int from = now->done + first * STF_LANES, to = now->done + end * STF_LANES;
    if (first >= end) continue;
    o.count = (to < now->count ? to : now->count) - from;
    if (!put(c, p, &o, sizeof o) ||
        !put(c, p, now->visit + from, factor ? (size_t)o.count * sizeof(int) : 0) ||
        !put_right_side(c, p, now->g))
      return lost(c, p);
  }
  return STEIF_OK;
}

/* ---- answers ------------------------------------------------------------------------------- */

/* From the order of the unknowns to that of our pivots. */
static void sort(const stf_circle *c, const double *restrict from, double *restrict to)
{
  enum { ENTRY = 2 * STF_LANES };
  for (sunindextype k = 0; k < c->scaled.n; k++)
    for (int q = 0; q < ENTRY; q++)
      to[ENTRY * k + q] = from[ENTRY * (sunindextype)c->sequence->unknown[k] + q];
}

static int take_answer(stf_circle *c, int p)
{
  stf_answer a = {.code = STEIF_OK};
  c->answer = STEIF_IO;
  if (!get(c, p, &a, sizeof a) || a.circle != (intptr_t)c || a.pass != c->passes)
    return lost(c, p);
  c->answer = a.code;
  a.text[sizeof a.text - 1] = 0;
  return a.code ? stf_fail(c->scaled.ctx, a.code, "process %d: %s", p, a.text) : STEIF_OK;
}

int stf_circle_take(const stf_pass *now, int batches, int k, stf_multishift *b)
{
  stf_circle *c = now->c;
  int p = 1;
  while (stf_circle_first(c, batches, p + 1) <= k) p++;
  if (k == stf_circle_first(c, batches, p)) STEIF_TRY(take_answer(c, p));
  if (c->answer) return c->answer;
  stf_lanes_done out;
  *b = c->batch[0];
  if (!get(c, p, &out, sizeof out) ||
      !get(c, p, b->r, now->g ? (size_t)c->scaled.n * 2 * STF_LANES * sizeof *b->r : 0)) {
    c->answer = STEIF_IO;
    return lost(c, p);
  }
  if (now->g) sort(c, b->r, b->x);
  for (int q = 0; q < STF_LANES; q++) {
    b->log_det[q] = out.log_det[q], b->error[q] = out.error[q];
    b->solves[q] = out.solves[q], b->good[q] = out.good[q];
  }
  return STEIF_OK;
}

void stf_circle_leave(stf_circle *c)
{
  const stf_order o = order_of(c, STF_ORDER_CLOSE);
  for (int p = 1; c->team && p <= c->known; p++) put(c, p, &o, sizeof o);
  c->known = 0;
}

/* ---- the team ------------------------------------------------------------------------------ */

int steif_team_lead(steif_context *ctx, const steif_team *team)
{
  STEIF_CHECK(!team || (team->others >= 1 && team->others < 1024), ctx, STEIF_BAD_INPUT,
              "a team of %d others: give 1 to 1023, or no team", team ? team->others : 0);
  STEIF_CHECK(!team || (team->send && team->receive), ctx, STEIF_BAD_INPUT,
              "a team needs .send and .receive");
  stf_context_lead(ctx, team);
  return STEIF_OK;
}

int steif_team_dismiss(steif_context *ctx)
{
  long long number;
  const steif_team *team = stf_team(ctx, &number);
  stf_order o;
  int lost = 0;
  memset(&o, 0, sizeof o);
  o.size = STF_ORDER_SIZE, o.kind = STF_ORDER_LEAVE;
  for (int p = 1; team && p <= team->others; p++)
    if (!stf_team_put(team, p, &o, sizeof o) && !lost) lost = p;
  stf_context_lead(ctx, NULL);
  STEIF_CHECK(!lost, ctx, STEIF_IO, "process %d of the team is lost: it could not be dismissed",
              lost);
  return STEIF_OK;
}
