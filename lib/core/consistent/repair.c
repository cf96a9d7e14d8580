/* repair.c: the start of a run, on one page: index 1 by Newton's iteration; else the index of the components,
 * a look whether hidden constraints hold, and stages where they do not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "repair.h"
#include <math.h>
#include <string.h>

/* -- opening ----------------------------------------------------------------------------- */

static int allocate(stf_repair *r)
{
  const size_t n = r->point.n;
  r->y = stf_pool_array(r->pool, 3 * n, sizeof *r->y);
  r->algebraic = stf_pool_array(r->pool, n, sizeof *r->algebraic);
  if (!r->y || !r->algebraic) return STEIF_NO_MEMORY;
  r->yp = r->y + n, r->weight = r->y + 2 * n;
  for (size_t j = 0; j < n; j++) {
    r->y[j] = r->point.y0[j], r->yp[j] = r->point.yp0[j];
    r->weight[j] = r->rtol * fabs(r->y[j]) + (r->atols ? r->atols[j] : r->atol);
  }
  return STEIF_OK;
}

static int look(stf_repair *r)
{
  STEIF_TRY(allocate(r));
  STEIF_TRY(stf_view_take(&r->point, r->point.t, r->y, r->yp, &r->view));
  r->count = 0;
  for (size_t j = 0; j < r->view.n; j++) {
    bool there = false;
    for (sunindextype k = r->view.column[j]; k < r->view.column[j + 1]; k++)
      there = there || (r->view.has[k] & 1);
    r->algebraic[j] = !there;
    r->count += !there;
  }
  return STEIF_OK;
}

static bool fixed(const stf_repair *r, size_t j)
{
  return r->attribute && r->attribute[j] == STEIF_FIXED;
}

static bool any_fixed(const stf_repair *r)
{
  for (size_t j = 0; j < r->point.n; j++)
    if (r->algebraic[j] && fixed(r, j)) return true;
  return false;
}

/* -- what was done ----------------------------------------------------------------------- */

/* In tolerances. */
static sunrealtype movement(const stf_repair *r, const sunrealtype *y, size_t j)
{
  return fabs(y[j] - r->point.y0[j]) / r->weight[j];
}

/* Those of `count` moved components without, or with, a derivative that moved most. */
static void list_moved(stf_repair *r, const sunrealtype *y, bool algebraic, int count)
{
  enum { SHOWN = 4 };
  char room[STEIF_SPEC_WORD], *text = r->report.message;
  sunrealtype below = INFINITY;
  for (int shown = 0; shown < SHOWN && shown < count; shown++) {
    size_t at = 0;
    sunrealtype most = -1;
    for (size_t j = 0; j < r->point.n; j++) {
      const sunrealtype part = movement(r, y, j);
      if (r->algebraic[j] == algebraic && part < below && part > most) most = part, at = j;
    }
    below = most;
    stf_point_say(text, "%s%s by %.3g",
                  shown     ? ", "
                  : text[0] ? ", and without a derivative "
                            : "start: moved ",
                  stf_point_unknown(&r->point, at, room), y[at] - r->point.y0[at]);
  }
  if (count > SHOWN) stf_point_say(text, " and %d more", count - SHOWN);
}

/* Count what moved, and name it: jumps of velocities and charges before the forces that follow from them. */
static void report_moved(stf_repair *r, const sunrealtype *y)
{
  int count[2] = {0, 0};
  for (size_t j = 0; j < r->point.n; j++) {
    const sunrealtype part = movement(r, y, j);
    count[r->algebraic[j]] += part > 1;
    r->report.largest = fmax(r->report.largest, part);
  }
  r->report.moved = count[0] + count[1];
  for (int k = 0; k < 2; k++) list_moved(r, y, k, count[k]);
}

/* F_i = 0 where equation i has derivatives, or where tolerances of its unknowns, allowed_i in all, make as
 * much of it. */
static void keep_violations(const stf_repair *r, sunrealtype *F, sunrealtype *allowed)
{
  const stf_view *v = &r->view;
  for (size_t j = 0; j < v->n; j++)
    for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++) {
      if (v->has[k] & 1) F[v->row[k]] = 0;
      allowed[v->row[k]] += fabs(v->b[k]) * r->weight[j];
    }
  for (size_t i = 0; i < v->n; i++)
    if (fabs(F[i]) <= 0.1 * allowed[i]) F[i] = 0;
}

/* The equations without derivatives that the given start violates most. */
static int list_violated(stf_repair *r)
{
  enum { SHOWN = 3 };
  stf_point *s = &r->point;
  char room[STEIF_SPEC_WORD];
  sunrealtype *F = stf_allocate(r->ctx, 2 * s->n, sizeof *F), below = INFINITY;
  if (!F) return STEIF_NO_MEMORY;
  int code = stf_point_residual(s, s->t, s->y0, s->yp0, F);
  if (!code) keep_violations(r, F, F + s->n);
  for (int shown = 0; shown < SHOWN && !code; shown++) {
    size_t at = 0;
    sunrealtype most = 0;
    for (size_t i = 0; i < s->n; i++)
      if (fabs(F[i]) < below && fabs(F[i]) > most) most = fabs(F[i]), at = i;
    if (!(most > 0)) break;
    below = most;
    stf_point_say(r->report.message, "%s%s (off by %.2g)", shown ? ", " : " to fulfil ",
                  stf_point_equation(s, at, room), most);
  }
  stf_release(r->ctx, F);
  return code < 0 ? code : STEIF_OK;
}

/* Hidden constraints: those whose derivatives the stages have enforced. */
static void list_enforced(stf_repair *r, const int *enforced)
{
  enum { SHOWN = 3 };
  char room[STEIF_SPEC_WORD];
  int shown = 0, most = 0;
  for (size_t i = 0; i < r->point.n; i++) most = enforced[i] > most ? enforced[i] : most;
  for (size_t i = 0; i < r->point.n && most > 0; i++) {
    if (enforced[i] < most) continue;
    if (shown++ < SHOWN)
      stf_point_say(r->report.message, "%s%s",
                    shown > 1 ? ", " : "; kept with their derivatives: ",
                    stf_point_equation(&r->point, i, room));
  }
  if (shown > SHOWN) stf_point_say(r->report.message, " and %d more", shown - SHOWN);
}

/* Energy and other invariants that the movement has changed. */
static int list_invariants(stf_repair *r, const sunrealtype *y)
{
  const steif_problem *p = r->given;
  if (p->invariants <= 0 || !p->invariant) return STEIF_OK;
  const size_t count = (size_t)p->invariants;
  sunrealtype *a = stf_allocate(r->ctx, 2 * count, sizeof *a);
  if (!a) return STEIF_NO_MEMORY;
  memcpy(stf_array(r->point.y), r->point.y0, r->point.n * sizeof *y);
  int code = p->invariant(r->point.t, r->point.y, a, p->user);
  memcpy(stf_array(r->point.y), y, r->point.n * sizeof *y);
  if (!code) code = p->invariant(r->point.t, r->point.y, a + count, p->user);
  for (size_t k = 0; k < count && !code; k++)
    if (fabs(a[count + k] - a[k]) > r->rtol * (fabs(a[k]) + 1))
      stf_point_say(r->report.message, "; invariant %zu changes by %.3g", k + 1,
                    a[count + k] - a[k]);
  stf_release(r->ctx, a);
  return STEIF_OK;
}

/* Take y as the start: of the copy of the problem, or as an error where only a check is wanted. enforced: of
 * each equation, its derivatives kept by stages; NULL: none. */
static int use(stf_repair *r, const sunrealtype *y, const sunrealtype *yp, const int *enforced)
{
  report_moved(r, y);
  if (!r->report.moved) return STEIF_OK;
  STEIF_TRY(list_violated(r));
  if (enforced) list_enforced(r, enforced);
  STEIF_TRY(list_invariants(r, y));
  STEIF_CHECK(
    r->policy == STEIF_REPAIR, r->ctx, STEIF_BAD_INPUT,
    "the start of '%s' is not consistent; a repair would have %s: give this start, or "
    "ask for the repair (options.initial = STEIF_REPAIR)",
    r->given->name, r->report.message + strlen("start: "));
  sunrealtype *kept = stf_pool_array(r->pool, 2 * r->point.n, sizeof *kept);
  if (!kept) return STEIF_NO_MEMORY;
  memcpy(kept, y, r->point.n * sizeof *y);
  r->problem.y0 = r->report.y = kept;
  if (!r->given->yp0) return STEIF_OK;
  memcpy(kept + r->point.n, yp, r->point.n * sizeof *yp);
  r->problem.yp0 = kept + r->point.n;
  return STEIF_OK;
}

/* -- index above 1 ----------------------------------------------------------------------- */

/* Positions of a system of index 3, its components of index 1 with a derivative, are no guesses as
 * velocities are: they move within errors of data only. */
static int check_positions(stf_repair *r, const steif_diagnosis *d, const steif_start *start)
{
  static const sunrealtype most = 1e-2;
  char room[STEIF_SPEC_WORD];
  sunrealtype size = 0, moved = 0;
  size_t at = 0;
  for (size_t j = 0; j < r->point.n && d->index >= 3; j++) {
    if (d->number[j] != 1 || r->algebraic[j]) continue;
    size = fmax(size, fabs(r->point.y0[j]));
    if (fabs(start->moved[j]) > moved) moved = fabs(start->moved[j]), at = j;
  }
  STEIF_CHECK(
    !(moved > most * size), r->ctx, STEIF_BAD_INPUT,
    "the start of '%s' lies off its constraints: position %s would have to move by %.3g, "
    "above %g of the largest, %.3g; correct it, or compute one by steif_consistent",
    r->given->name, stf_point_unknown(&r->point, at, room), start->moved[at], most, size);
  return STEIF_OK;
}

static int by_stages(stf_repair *r, stf_evidence *e, const steif_diagnosis *d)
{
  const size_t n = r->point.n;
  steif_start start = {0};
  stf_start_nodes nodes = {
    0}; /* found once for each stage: tolerances are wider than rounding */
  sunrealtype *weight = stf_pool_array(r->pool, n, sizeof *weight);
  enum steif_attribute *attribute = stf_pool_array(r->pool, n, sizeof *attribute);
  if (!weight || !attribute) return STEIF_NO_MEMORY;
  stf_start_inertia(&r->view, weight);
  for (size_t j = 0; j < n; j++)
    attribute[j] = r->attribute ? (enum steif_attribute)r->attribute[j] : STEIF_GUESS;
  const steif_request request = {.attribute = attribute, .weight = weight};
  STEIF_TRY(stf_start_with(e, d, &request, &nodes, &start));
  int code = check_positions(r, d, &start);
  if (!code) code = stf_keep_momenta(r, e, d, &request, &start);
  if (!code) code = use(r, start.y, start.yp, start.enforced);
  steif_start_clear(&start);
  return code;
}

/* A start that violates hidden constraints and stays as it is: said, or an error where a check is wanted. */
static int leave(stf_repair *r, const char *why)
{
  STEIF_CHECK(r->policy == STEIF_REPAIR, r->ctx, STEIF_UNSUPPORTED,
              "hidden constraints of '%s' do not hold at its start, and it is not repaired: %s",
              r->given->name, why);
  stf_point_say(r->report.message,
                "start: hidden constraints do not hold, and nothing was moved: %s", why);
  return STEIF_OK;
}

static int diagnosed(stf_repair *r, bool wanted)
{
  stf_evidence evidence;
  steif_diagnosis d = {.index = -1};
  sunrealtype jump = 0;
  r->point.quick = false, r->point.brief = true;
  r->point.views++;
  int code = stf_diagnose(&r->point, &evidence, &d);
  if (!code && wanted) code = stf_use_index(r, &evidence, &d);
  if (!code) code = stf_first_jump(r, &jump);
  const bool ordered =
    r->point.n <= STEIF_DIAGNOSE_LARGEST || stf_evidence_certified(&evidence);
  if (!code && (jump > 1 || any_fixed(r)) && ordered && d.index >= 0)
    code = by_stages(r, &evidence, &d);
  else if (!code && jump > 1)
    code = leave(r, d.index < 0 ? "its index is not decided"
                                : "its structure does not determine their order");
  stf_evidence_free(&evidence);
  steif_diagnosis_clear(&d);
  return code;
}

/* Hidden constraints may be violated; where the index of components is known, a cheap look first. */
static int higher_index(stf_repair *r)
{
  const bool declared = r->given->index || r->given->dae_index == 1;
  sunrealtype jump = INFINITY;
  if (declared) STEIF_TRY(stf_first_jump(r, &jump));
  return jump > 1 ? diagnosed(r, !declared) : STEIF_OK;
}

/* -- the start --------------------------------------------------------------------------- */

/* Differential components stay, and algebraic ones follow from them. */
static int check_fixed(stf_repair *r)
{
  char room[STEIF_SPEC_WORD];
  for (size_t j = 0; j < r->point.n; j++)
    STEIF_CHECK(
      !r->algebraic[j] || !fixed(r, j) || fabs(r->y[j] - r->point.y0[j]) <= r->weight[j],
      r->ctx, STEIF_BAD_INPUT,
      "the start of '%s' fixes %s, which would have to move by %.3g to fulfil the "
      "equations with the components that have a derivative: free it, or change those",
      r->given->name, stf_point_unknown(&r->point, j, room), r->y[j] - r->point.y0[j]);
  return STEIF_OK;
}

static int unsolved(stf_repair *r)
{
  STEIF_TRY(list_violated(r));
  return STEIF_FAIL(
    r->ctx, STEIF_NO_CONVERGENCE,
    "the start of '%s' is not consistent, and Newton's iteration finds no values "
    "of the components without a derivative%.400s: give better guesses of them",
    r->given->name, r->report.message);
}

static int index_one(stf_repair *r)
{
  sunrealtype first = 0;
  const int code = stf_algebraic_newton(r, &first);
  if (code > 0) return unsolved(r);
  STEIF_TRY(code);
  if (first <= 1) return STEIF_OK;
  STEIF_TRY(stf_nearest_branch(r, first));
  STEIF_TRY(check_fixed(r));
  return use(r, r->y, r->yp, NULL);
}

/* Components of index 2 or 3 are declared: no factors are needed to see that. */
static bool declared_higher(const stf_repair *r)
{
  const int *index = r->given->index;
  for (size_t j = 0; index && j < r->point.n; j++)
    if (index[j] >= 2) return true;
  return false;
}

static int start(stf_repair *r)
{
  bool regular = false;
  STEIF_TRY(look(r));
  if (!declared_higher(r)) STEIF_TRY(stf_index_one(r, &regular));
  if (!regular) return higher_index(r);
  if (r->count && r->problem.dae_index < 1) r->problem.dae_index = 1;
  return r->count ? index_one(r) : STEIF_OK;
}

/* What a look cannot evaluate, the run meets itself and tells better. A start without a repair near it may
 * serve all the same: the run tries it, and the report has the reason. */
static int pass(stf_repair *r, int code)
{
  const bool check = r->policy == STEIF_CHECK;
  const bool ours = code == STEIF_NO_MEMORY || code == STEIF_BAD_INPUT || code == STEIF_OK ||
                    (check && (code == STEIF_NO_CONVERGENCE || code == STEIF_UNSUPPORTED));
  if (ours) return code;
  r->problem = *r->given;
  r->report = (steif_repair){0};
  r->unsolved = code == STEIF_NO_CONVERGENCE;
  if (r->unsolved)
    stf_point_say(r->report.message, "start: not repaired; %s", steif_message(r->ctx));
  steif_forget(r->ctx);
  return STEIF_OK;
}

static void close_point(void *point) { stf_point_close(point); }

int stf_repair_start(stf_repair *r)
{
  r->problem = *r->given;
  r->report = (steif_repair){0};
  sunrealtype *size = stf_allocate(r->ctx, (size_t)r->given->n, sizeof *size);
  if (!size) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < r->given->n; j++) size[j] = r->atol / r->rtol;
  int code = stf_point_open(r->ctx, r->given, &(steif_point){.size = size}, &r->point);
  stf_release(r->ctx, size);
  if (code) return pass(r, code == STEIF_BAD_INPUT ? STEIF_RETRY : code);
  code = stf_pool_adopt(r->pool, &r->point, close_point);
  if (code) return code;
  r->point.quick = true;
  r->view = (stf_view){0};
  code = pass(r, start(r));
  stf_view_factor_close(&r->first);
  stf_view_free(&r->point, &r->view);
  return code;
}
