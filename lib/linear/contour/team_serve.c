/* team_serve.c: a process that factors and solves around the circles of another.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle_orders.h"
#include "circle_parts.h"
#include "pencil.h"
#include <limits.h>
#include <steif/team.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* A circle of the process that leads. */
typedef struct served {
  struct served *next;
  long long number, pivots;
  int code; /* why it could not be opened */
  char text[600];
  SUNMatrix E, F;
  stf_circle *circle;
  double *rows; /* right-hand sides, (powers + 2) x n */
  size_t room;  /* in n */
} served;

typedef struct server {
  steif_context *ctx;
  const steif_team *team;
  served *all;
} server;

static bool put(const server *s, const void *data, size_t bytes)
{
  return stf_team_put(s->team, 0, data, bytes);
}

static bool get(const server *s, void *data, size_t bytes)
{
  return stf_team_get(s->team, 0, data, bytes);
}

static int lost(const server *s)
{
  return stf_fail(s->ctx, STEIF_IO,
                  "process 0 of the team is lost: it took or sent nothing more");
}

/* ---- circles --------------------------------------------------------------------------------- */

static void forget(server *s, served *v)
{
  stf_circle_close(s->ctx, &v->circle);
  if (v->E) SUNMatDestroy(v->E);
  if (v->F) SUNMatDestroy(v->F);
  if (v->rows) stf_release(s->ctx, v->rows);
  stf_release(s->ctx, v);
}

static served *find(const server *s, long long number)
{
  served *v = s->all;
  while (v && v->number != number) v = v->next;
  return v;
}

static void close_one(server *s, long long number)
{
  served **at = &s->all;
  while (*at && (*at)->number != number) at = &(*at)->next;
  served *v = *at;
  if (!v) return;
  *at = v->next;
  forget(s, v);
}

static bool get_matrix(const server *s, SUNMatrix M, sunindextype n, sunindextype entries)
{
  const size_t columns = ((size_t)n + 1) * sizeof(sunindextype), filled = (size_t)entries;
  return get(s, M ? SM_INDEXPTRS_S(M) : NULL, columns) &&
         get(s, M ? SM_INDEXVALS_S(M) : NULL, filled * sizeof(sunindextype)) &&
         get(s, M ? SM_DATA_S(M) : NULL, filled * sizeof(sunrealtype));
}

static SUNMatrix matrix(const server *s, sunindextype n, sunindextype entries)
{
  return SUNSparseMatrix(n, n, entries > 0 ? entries : 1, CSC_MAT, steif_sundials(s->ctx));
}

static int open_circle(const server *s, const stf_order *o, served *v)
{
  const steif_analysis how = {.points = o->points,
                              .refinements = o->refinements ? o->refinements : -1};
  STEIF_CHECK(v->E && v->F, s->ctx, STEIF_NO_MEMORY, "no memory for matrices of %lld entries",
              (long long)(o->entries[0] + o->entries[1]));
  STEIF_TRY(stf_circle_open(s->ctx, v->E, v->F, &how, 0, &v->circle));
  stf_circle *c = v->circle;
  c->batches = o->batches;
  c->batch = stf_pool_array(c->scaled.pool, (size_t)c->batches, sizeof *c->batch);
  return c->batch ? STEIF_OK : STEIF_NO_MEMORY;
}

static void note(const server *s, int code, served *v)
{
  v->code = code;
  if (code) snprintf(v->text, sizeof v->text, "%s", steif_message(s->ctx));
}

static int open_one(server *s, const stf_order *o)
{
  served *v = stf_allocate(s->ctx, 1, sizeof *v);
  if (v) {
    v->number = o->circle, v->pivots = -1;
    v->next = s->all, s->all = v;
    v->E = matrix(s, o->n, o->entries[0]), v->F = matrix(s, o->n, o->entries[1]);
  }
  if (!get_matrix(s, v ? v->E : NULL, o->n, o->entries[0]) ||
      !get_matrix(s, v ? v->F : NULL, o->n, o->entries[1]))
    return lost(s);
  if (v) note(s, open_circle(s, o, v), v);
  return STEIF_OK;
}

/* ---- passes ---------------------------------------------------------------------------------- */

static int scale_to(stf_circle *c, sunrealtype size)
{
  if (c->scaled.size == size) return STEIF_OK;
  c->scaled.size = 0;
  return stf_scaled_set(&c->scaled, size);
}

/* Pivots, scales and radius as they are where it leads. */
static int follow(served *v, const stf_order *o)
{
  stf_circle *c = v->circle;
  c->careful = o->careful;
  if (v->pivots != o->pivots) {
    v->pivots = -1;
    STEIF_TRY(scale_to(c, o->from_at));
    c->radius = o->from_radius;
    STEIF_TRY(stf_circle_pivot(c, o->visit));
    v->pivots = o->pivots;
  }
  STEIF_TRY(scale_to(c, o->at));
  if (c->filled != c->scaled.size) stf_sequence_fill(c->scaled.pencil, c->sequence);
  c->filled = c->scaled.size;
  c->radius = o->radius;
  return STEIF_OK;
}

static int work(const server *s, served *v, const stf_order *o, int *visit,
                const stf_polynomial *g)
{
  STEIF_CHECK(v, s->ctx, STEIF_NO_MEMORY, "no memory for a circle");
  if (v->code) return stf_fail(s->ctx, v->code, "%s", v->text);
  const bool factor = o->kind == STF_ORDER_FACTOR;
  if (factor) STEIF_TRY(follow(v, o));
  STEIF_CHECK(v->pivots == o->pivots, s->ctx, STEIF_BAD_INPUT,
              "there are no factors to solve by");
  const int batches = (o->count + STF_LANES - 1) / STF_LANES;
  STEIF_CHECK(!o->given || g, s->ctx, STEIF_NO_MEMORY, "no memory for right-hand sides");
  stf_pass now = {.c = v->circle, .g = g, .count = o->count, .visit = visit};
  stf_parallel(v->circle->threads, batches, factor ? stf_circle_work : stf_circle_solve, &now);
  return STEIF_OK;
}

/* The solutions of batch k in the order of the unknowns, by way of its scratch. */
static bool put_batch(const server *s, const stf_circle *c, int k, bool given)
{
  enum { ENTRY = 2 * STF_LANES };
  const stf_multishift *b = &c->batch[k];
  stf_lanes_done out;
  memset(&out, 0, sizeof out);
  for (int q = 0; q < STF_LANES; q++) {
    out.log_det[q] = b->log_det[q], out.error[q] = b->error[q];
    out.solves[q] = b->solves[q], out.good[q] = b->good[q];
  }
  if (!put(s, &out, sizeof out)) return false;
  for (sunindextype i = 0; given && i < c->scaled.n; i++)
    memcpy(b->r + ENTRY * (sunindextype)c->sequence->unknown[i], b->x + ENTRY * i,
           ENTRY * sizeof *b->r);
  return !given || put(s, b->r, (size_t)c->scaled.n * ENTRY * sizeof *b->r);
}

/* Room for the right-hand side that comes. */
static double *rows(const server *s, served *v, const stf_order *o)
{
  const size_t need = o->given ? (size_t)o->powers + 2 : 0, n = (size_t)o->n;
  if (!v || need <= v->room) return v ? v->rows : NULL;
  if (v->rows) stf_release(s->ctx, v->rows);
  v->rows = stf_allocate(s->ctx, need * n, sizeof *v->rows);
  v->room = v->rows ? need : 0;
  return v->rows;
}

static int pass(server *s, const stf_order *o)
{
  int visit[STF_CIRCLE_MOST];
  served *v = find(s, o->circle);
  const size_t n = (size_t)o->n, row = n * sizeof(double);
  double *at = rows(s, v, o);
  const stf_polynomial g = {o->powers, at, at ? at + n : NULL,
                            o->scaled && at ? at + n * (size_t)(o->powers + 1) : NULL};
  const bool factor = o->kind == STF_ORDER_FACTOR;
  if (!get(s, visit, factor ? (size_t)o->count * sizeof *visit : 0) ||
      !get(s, at, o->given ? row : 0) || !get(s, at ? at + n : NULL, row * (size_t)o->powers) ||
      !get(s, o->scaled && at ? at + n * (size_t)(o->powers + 1) : NULL, o->scaled ? row : 0))
    return lost(s);
  stf_answer a;
  memset(&a, 0, sizeof a); /* its gaps are sent, too */
  a.circle = o->circle, a.pass = o->pass;
  a.code = work(s, v, o, visit, o->given && at ? &g : NULL);
  if (a.code) snprintf(a.text, sizeof a.text, "%s", steif_message(s->ctx));
  steif_forget(s->ctx);
  if (!put(s, &a, sizeof a)) return lost(s);
  for (int k = 0; !a.code && k < (o->count + STF_LANES - 1) / STF_LANES; k++)
    if (!put_batch(s, v->circle, k, o->given)) return lost(s);
  return STEIF_OK;
}

/* ---- until dismissed ------------------------------------------------------------------------- */

static bool sensible(const stf_order *o)
{
  return o->size == STF_ORDER_SIZE && o->count >= 0 && o->count <= STF_CIRCLE_MOST &&
         o->powers >= 0 && o->powers <= STF_CIRCLE_MOST && o->n >= 0 && o->n < INT_MAX &&
         o->batches >= 0 && o->batches <= STF_CIRCLE_MOST;
}

static int obey(server *s, const stf_order *o, bool *leave)
{
  STEIF_CHECK(
    sensible(o), s->ctx, STEIF_BAD_INPUT,
    "process 0 of the team is another build of steif, or its bytes do not come as sent");
  switch (o->kind) {
  case STF_ORDER_OPEN: return open_one(s, o);
  case STF_ORDER_FACTOR:
  case STF_ORDER_SOLVE: return pass(s, o);
  case STF_ORDER_CLOSE: return close_one(s, o->circle), STEIF_OK;
  case STF_ORDER_LEAVE:
  default: return *leave = true, STEIF_OK;
  }
}

int steif_team_serve(steif_context *ctx, const steif_team *team)
{
  server s = {.ctx = ctx, .team = team};
  bool leave = false;
  int code = STEIF_OK;
  STEIF_CHECK(team && team->send && team->receive, ctx, STEIF_BAD_INPUT,
              "a team needs .send and .receive");
  while (!code && !leave) {
    stf_order o;
    code = get(&s, &o, sizeof o) ? obey(&s, &o, &leave) : lost(&s);
  }
  while (s.all) close_one(&s, s.all->number);
  return code;
}
