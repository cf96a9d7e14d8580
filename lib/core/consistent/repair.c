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

/* Take y as the start: of the copy of the problem, or as an error where only a check is wanted. enforced: of
 * each equation, its derivatives kept by stages; d, enforced NULL: there are none. */
static int use(stf_repair *r, const sunrealtype *y, const sunrealtype *yp,
               const steif_diagnosis *d, const int *enforced)
{
  stf_report_moved(r, y);
  if (!r->report.moved) return STEIF_OK;
  STEIF_TRY(stf_report_violated(r));
  if (enforced) stf_report_enforced(r, enforced);
  if (d) STEIF_TRY(stf_report_impulses(r, d, y));
  STEIF_TRY(stf_report_invariants(r, y));
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
  if (!code) code = use(r, start.y, start.yp, d, start.enforced);
  steif_start_clear(&start);
  return code;
}

/* A start that violates hidden constraints and stays as it is: said, or an error where a check is wanted. */
static int leave(stf_repair *r, const char *why)
{
  STEIF_CHECK(r->policy != STEIF_CHECK, r->ctx, STEIF_UNSUPPORTED,
              "hidden constraints of '%s' do not hold at its start, and it is not repaired: %s",
              r->given->name, why);
  stf_point_say(r->report.message,
                "start: hidden constraints do not hold, and nothing was moved: %s", why);
  return STEIF_OK;
}

static const char as_given[] = "it stays as given, and the first step jumps";

static bool descriptor(const stf_repair *r) { return r->point.system.form == STEIF_DESCRIPTOR; }

/* Who has the pencil finds where it jumps to. */
static int linear(stf_repair *r, sunrealtype jump)
{
  r->jumps = jump > 1 && r->policy != STEIF_AS_GIVEN;
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
  if (!code && descriptor(r))
    code = linear(r, jump);
  else if (!code && r->policy == STEIF_AS_GIVEN)
    code = jump > 1 ? leave(r, as_given) : STEIF_OK;
  else if (!code && (jump > 1 || any_fixed(r)) && ordered && d.index >= 0)
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
  if (declared && descriptor(r)) return linear(r, jump);
  if (declared && r->policy == STEIF_AS_GIVEN) return jump > 1 ? leave(r, as_given) : STEIF_OK;
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
  STEIF_TRY(stf_report_violated(r));
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
  return use(r, r->y, r->yp, NULL, NULL);
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
  if (!regular && r->judges) STEIF_TRY(stf_judge_pencil(r));
  if (!regular) return higher_index(r);
  if (r->count && r->problem.dae_index < 1) r->problem.dae_index = 1;
  return r->count && r->policy != STEIF_AS_GIVEN ? index_one(r) : STEIF_OK;
}

/* What a look cannot evaluate, the run meets itself and tells better. A start without a repair near it may
 * serve all the same: the run tries it, and the report has the reason. */
static int pass(stf_repair *r, int code)
{
  const bool check = r->policy == STEIF_CHECK;
  const bool ours = code == STEIF_NO_MEMORY || code == STEIF_BAD_INPUT || code == STEIF_OK ||
                    r->irregular ||
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
  stf_view_factor_close(&r->step);
  stf_view_free(&r->point, &r->view);
  return code;
}
