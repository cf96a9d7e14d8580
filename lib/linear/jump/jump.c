/* jump.c: the jump of a DAE from y(t-): along the fast directions of a frozen pencil to a
 * consistent state. With Pi_s of the pencil, y <- C(y - Pi_s (y - y(t-))), C the nearest
 * consistent state, is repeated until nothing changes: for constant matrices y - Pi_s (y -
 * y(t-)) is consistent at once.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jump.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { MOST = 100, DRAWS = 3 };
/* Changes over sizes: none any more; small enough to end where rounding lets them fall no
 * further. */
static const sunrealtype settled = 16 * STF_EPS, stalled = 1e-9;

/* -- the frozen pencil ------------------------------------------------------------------- */

static int freeze(stf_jump_search *w, sunrealtype t, const sunrealtype *y,
                  const sunrealtype *yp)
{
  stf_point *s = &w->point;
  stf_view *v = &w->evidence.view;
  const int code = stf_view_take(s, t, y, yp, v);
  STEIF_CHECK(code <= 0, s->ctx, STEIF_CALLBACK,
              "the Jacobian of '%s' cannot be evaluated beside its jump at t = %.12g",
              s->problem.name, t);
  STEIF_TRY(code);
  SUNMatZero(w->E), SUNMatZero(w->F);
  for (size_t j = 0; j < s->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
      SM_COLUMN_D(w->E, j)[v->row[k]] = v->e[k], SM_COLUMN_D(w->F, j)[v->row[k]] = v->b[k];
  return STEIF_OK;
}

/* Pi_s d and the impulses of a start d without forces. */
static int respond(stf_jump_search *w, const sunrealtype *d)
{
  steif_context *ctx = w->point.ctx;
  steif_impulse_clear(ctx, &w->answer);
  STEIF_TRY(
    steif_impulse_find(ctx, w->E, w->F, d, w->point.t, NULL, NULL, NULL, NULL, &w->answer));
  STEIF_CHECK(
    w->answer.index == w->diagnosis.index, ctx, STEIF_SINGULAR,
    "the pencil of '%s' frozen at t = %.12g has index %d, the equations have index %d: "
    "its matrices turn with time or along the solution, and a frozen one does not tell "
    "the jump",
    w->point.problem.name, w->point.t, w->answer.index, w->diagnosis.index);
  return STEIF_OK;
}

/* -- one side ---------------------------------------------------------------------------- */

/* The consistent state nearest to y, in place. */
static int consist(stf_jump_search *w, sunrealtype *y, sunrealtype *yp)
{
  stf_point *s = &w->point;
  const size_t bytes = s->n * sizeof *y;
  const steif_request request = {.weight = w->weight};
  steif_start start;
  memcpy(s->y0, y, bytes), memcpy(s->yp0, yp, bytes);
  STEIF_TRY(stf_start_from(&w->evidence, &w->diagnosis, &request, &start));
  memcpy(y, start.y, bytes), memcpy(yp, start.yp, bytes);
  steif_start_clear(&start);
  return STEIF_OK;
}

static sunrealtype largest(const stf_jump_search *w, const sunrealtype *x)
{
  sunrealtype most = 0;
  for (size_t j = 0; j < w->point.n; j++) most = fmax(most, fabs(x[j]) * w->weight[j]);
  return most;
}

/* y(t+) with the matrices frozen now, or, `moving`, at y(t+) itself. */
static int reach(stf_jump_search *w, bool moving, sunrealtype *y, sunrealtype *yp)
{
  const stf_point *s = &w->point;
  sunrealtype last = INFINITY;
  memcpy(y, w->from, s->n * sizeof *y);
  memcpy(yp, w->slope, s->n * sizeof *yp);
  for (int k = 0; k < MOST; k++) {
    STEIF_TRY(consist(w, y, yp));
    if (moving) STEIF_TRY(freeze(w, s->t, y, yp));
    for (size_t j = 0; j < s->n; j++) w->d[j] = y[j] - w->from[j];
    STEIF_TRY(respond(w, w->d));
    const sunrealtype change = largest(w, w->answer.x_plus);
    if (change <= settled || (change < stalled && change > last / 2)) return STEIF_OK;
    for (size_t j = 0; j < s->n; j++) y[j] -= w->answer.x_plus[j];
    last = change;
  }
  return STEIF_FAIL(
    s->ctx, STEIF_NO_CONVERGENCE,
    "no consistent state of '%s' was found along its impulses at t = %.12g: the "
    "slow part still moves by %.1e of its size after %d corrections",
    s->problem.name, s->t, last, MOST);
}

/* c_i of the jump just found. */
static int keep_impulses(stf_jump_search *w, sunrealtype **c)
{
  const size_t count = (size_t)w->answer.count * w->point.n;
  *c = stf_pool_array(w->jump->memory, count + 1, sizeof **c);
  if (!*c) return STEIF_NO_MEMORY;
  for (size_t k = 0; k < count; k++) (*c)[k] = 0 - w->answer.c[k]; /* of y(t-) - y(t+) = -d */
  return STEIF_OK;
}

/* -- both sides -------------------------------------------------------------------------- */

/* The impulses that ten tolerances in y(t-) would make, in random directions, and rounding. */
static int find_noise(stf_jump_search *w)
{
  unsigned state = 1;
  const size_t n = w->point.n, count = (size_t)w->answer.count;
  const sunrealtype rounding = 1e-10 / (STF_TOLERANCES * w->rtol);
  w->noise = stf_pool_array(w->point.pool, count * n + 1, sizeof *w->noise);
  if (!w->noise) return STEIF_NO_MEMORY;
  for (int draw = 0; draw < DRAWS; draw++) {
    for (size_t j = 0; j < n; j++)
      w->d[j] = STF_TOLERANCES * w->tolerance[j] * (stf_point_random(&state) > 0 ? 1 : -1);
    STEIF_TRY(respond(w, w->d));
    for (size_t k = 0; k < count * n; k++)
      w->noise[k] = fmax(w->noise[k], fabs(w->answer.c[k]));
  }
  for (size_t i = 0; i < count; i++) {
    const sunrealtype most = rounding * largest(w, w->noise + i * n);
    for (size_t j = 0; j < n; j++) w->noise[i * n + j] += most / w->weight[j];
  }
  return STEIF_OK;
}

/* Does E change with time what c_0 makes of it? Then E c_0 delta' is not all there is at
 * delta'. */
static int check_turning(stf_jump_search *w)
{
  const stf_point *s = &w->point;
  const size_t n = s->n;
  const sunrealtype span = s->problem.t1 - s->t, *E = SM_DATA_D(w->E);
  const sunrealtype ahead = 1e-3 * (span > 0 ? span : 1), noise = 1e-6;
  if (!w->jump->count || s->system.linear) return STEIF_OK;
  memcpy(w->E_now, E, n * n * sizeof *E);
  STEIF_TRY(freeze(w, s->t + ahead, w->jump->y, w->jump->yp));
  for (size_t i = 0; i < n; i++) {
    sunrealtype sum = 0, size = 0;
    for (size_t j = 0; j < n; j++)
      if (fabs(w->jump->c[j]) > w->noise[j])
        sum += (E[j * n + i] - w->E_now[j * n + i]) * w->jump->c[j],
          size += fabs(w->E_now[j * n + i] * w->jump->c[j]);
    STEIF_CHECK(fabs(sum) <= noise * size, s->ctx, STEIF_SINGULAR,
                "E of '%s' changes with time in the directions of the impulses at t = %.12g "
                "(equation %zu): a frozen pencil does not tell the jump",
                s->problem.name, s->t, i + 1);
  }
  memcpy(SM_DATA_D(w->E), w->E_now, n * n * sizeof *E);
  return STEIF_OK;
}

static void set_tolerances(stf_jump_search *w)
{
  const stf_point *s = &w->point;
  w->rtol = w->request->rtol > 0 ? w->request->rtol : 1e-6;
  for (size_t j = 0; j < s->n; j++)
    w->tolerance[j] = w->rtol * (fmax(fabs(w->jump->y[j]), fabs(w->from[j])) + s->floor[j]);
}

/* Columns of E that are not 0: what they belong to cannot jump freely. */
static void find_carried(stf_jump_search *w)
{
  const size_t n = w->point.n;
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++) w->carried[j] |= SM_ELEMENT_D(w->E, i, j) != 0;
}

static int both(stf_jump_search *w)
{
  steif_jump *j = w->jump;
  const size_t n = w->point.n;
  STEIF_TRY(freeze(w, w->point.t, w->from, w->slope));
  memcpy(w->E_before, SM_DATA_D(w->E), n * n * sizeof *w->E_before);
  STEIF_TRY(reach(w, false, j->before, j->yp));
  STEIF_TRY(keep_impulses(w, &j->before_c));
  STEIF_TRY(reach(w, true, j->y, j->yp));
  j->index = w->answer.index, j->count = w->answer.count;
  STEIF_TRY(keep_impulses(w, &j->c));
  set_tolerances(w);
  find_carried(w);
  STEIF_TRY(find_noise(w));
  STEIF_TRY(check_turning(w));
  return stf_jump_judge(w);
}

/* -- opening ----------------------------------------------------------------------------- */

static int claim(stf_jump_search *w)
{
  stf_point *s = &w->point;
  const size_t n = s->n;
  steif_jump *j = w->jump;
  sunrealtype *work = stf_pool_array(s->pool, 5 * n + 2 * n * n, sizeof *work);
  w->carried = stf_pool_array(s->pool, n, sizeof *w->carried);
  j->y = stf_pool_array(j->memory, 3 * n, sizeof *j->y);
  if (!work || !w->carried || !j->y) return STEIF_NO_MEMORY;
  j->yp = j->y + n, j->before = j->y + 2 * n;
  w->from = work, w->slope = work + n, w->d = work + 2 * n, w->weight = work + 3 * n;
  w->tolerance = work + 4 * n, w->E_before = work + 5 * n, w->E_now = w->E_before + n * n;
  memcpy(w->from, s->y0, n * sizeof *work), memcpy(w->slope, s->yp0, n * sizeof *work);
  for (size_t k = 0; k < n; k++) w->weight[k] = 1 / s->size[k];
  w->E = SUNDenseMatrix(s->problem.n, s->problem.n, steif_sundials(s->ctx));
  w->F = SUNDenseMatrix(s->problem.n, s->problem.n, steif_sundials(s->ctx));
  STEIF_CHECK(w->E && w->F, s->ctx, STEIF_NO_MEMORY, "no memory for matrices of order %zu", n);
  return STEIF_OK;
}

/* The index of the equations, from all tests. */
static int find_index(stf_jump_search *w)
{
  const stf_point *s = &w->point;
  STEIF_TRY(stf_diagnose(&w->point, &w->evidence, &w->diagnosis));
  STEIF_CHECK(w->diagnosis.index >= 0, s->ctx, STEIF_SINGULAR, "no jump of '%s': %s",
              s->problem.name, w->diagnosis.message);
  return STEIF_OK;
}

static int nonlinear(steif_context *ctx, const steif_problem *p, const steif_point *inquiry,
                     stf_jump_search *w)
{
  STEIF_TRY(stf_point_open(ctx, p, inquiry, &w->point));
  w->evidence.point = &w->point;
  int code = STEIF_OK;
  if (w->point.n > STEIF_DIAGNOSE_LARGEST)
    code =
      STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
                 "'%s' has %zu unknowns: a jump of nonlinear equations is found for at most "
                 "%d",
                 p->name, w->point.n, STEIF_DIAGNOSE_LARGEST);
  if (!code) code = claim(w);
  if (!code) code = find_index(w);
  if (!code) code = both(w);
  if (!code && !w->jump->unique && w->request->stages) {
    memcpy(w->jump->y, w->from, w->point.n * sizeof *w->from);
    memcpy(w->jump->yp, w->slope, w->point.n * sizeof *w->slope);
    code = consist(w, w->jump->y, w->jump->yp);
  }
  steif_impulse_clear(ctx, &w->answer);
  if (w->E) SUNMatDestroy(w->E);
  if (w->F) SUNMatDestroy(w->F);
  stf_evidence_free(&w->evidence);
  steif_diagnosis_clear(&w->diagnosis);
  stf_point_close(&w->point);
  return code;
}

/* -- linear systems ---------------------------------------------------------------------- */

static int copy(steif_jump *j, const steif_impulse *i)
{
  const size_t n = (size_t)i->n, count = (size_t)i->count * n;
  j->y = stf_pool_array(j->memory, 3 * n + 2 * count, sizeof *j->y);
  if (!j->y) return STEIF_NO_MEMORY;
  j->yp = j->y + n, j->before = j->y + 2 * n, j->c = j->y + 3 * n, j->before_c = j->c + count;
  memcpy(j->y, i->x_plus, n * sizeof *j->y), memcpy(j->before, i->x_plus, n * sizeof *j->y);
  if (count) memcpy(j->c, i->c, count * sizeof *j->c);
  if (count) memcpy(j->before_c, i->c, count * sizeof *j->c);
  j->unique = i->certified, j->index = i->index, j->count = i->count;
  stf_point_say(j->message, "%s", i->message);
  return STEIF_OK;
}

static int linear(steif_context *ctx, const steif_problem *p, const steif_point *q,
                  steif_jump *j)
{
  steif_linear l;
  steif_impulse i = {0};
  const bool here = q && q->y;
  STEIF_CHECK(here || p->y0, ctx, STEIF_BAD_INPUT, "a jump of '%s' needs values y(t-)",
              p->name);
  STEIF_TRY(steif_linear_of(ctx, p, &l));
  int code = steif_impulse_find(ctx, l.E, l.F, here ? q->y : p->y0, here ? q->t : p->t0, l.f,
                                l.user, NULL, NULL, &i);
  if (!code) code = copy(j, &i);
  steif_impulse_clear(ctx, &i);
  SUNMatDestroy(l.E), SUNMatDestroy(l.F);
  return code;
}

/* -- public ------------------------------------------------------------------------------ */

void steif_jump_clear(steif_jump *jump)
{
  if (!jump) return;
  stf_pool *pool = jump->memory;
  stf_pool_free(&pool);
  *jump = (steif_jump){0};
}

int steif_jump_find(steif_context *ctx, const steif_problem *problem,
                    const steif_point *inquiry, const steif_jump_request *request,
                    steif_jump *jump)
{
  STF_NAMED(problem);
  static const steif_jump_request none = {0};
  const steif_jump_request *r = request ? request : &none;
  STEIF_CHECK(jump, ctx, STEIF_BAD_INPUT, "a place for the jump is needed, got NULL");
  *jump = (steif_jump){0};
  const int form = steif_problem_form(ctx, problem);
  if (!form) return steif_status(ctx);
  STEIF_CHECK(r->restitution >= 0 && r->restitution <= 1 && r->rtol >= 0 && isfinite(r->rtol),
              ctx, STEIF_BAD_INPUT,
              "restitution %g must lie in [0, 1] and rtol %g must not be negative",
              r->restitution, r->rtol);
  if (!(jump->memory = stf_pool_new(ctx))) return STEIF_NO_MEMORY;
  stf_jump_search w = {.request = r, .jump = jump};
  const int code = form == STEIF_DESCRIPTOR ? linear(ctx, problem, inquiry, jump)
                                            : nonlinear(ctx, problem, inquiry, &w);
  if (code)
    steif_jump_clear(jump);
  else
    steif_forget(ctx);
  return code;
}
