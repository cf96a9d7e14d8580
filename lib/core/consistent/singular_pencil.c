/* singular_pencil.c: is s E + F_y, constant, singular at every s? Runs with such a pencil end well where no pivot is
 * exactly 0, with unknowns that are rounding. One shift at which solutions have digits shows a regular one; it
 * is moderate, or that of a short step, whose factors others use; rows and columns are put to even units, since of systems
 * of higher index the condition grows like powers of the shift. J(y) that varies may be singular at a start alone, and is
 * not looked at.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "refined_factor.h"
#include "repair.h"
#include <math.h>
#include <string.h>

/* Entries of the null vector that are named, as parts of the largest. */
static const sunrealtype named = 0.1;

/* What says nothing of this pencil. */
static bool open_question(stf_repair *r, int code)
{
  const bool open = code == STEIF_SINGULAR || code == STEIF_NOT_FINITE;
  if (open) steif_forget(r->ctx);
  return open;
}

/* By the factors of a short step, which stay. */
static int by_step(stf_repair *r, sunrealtype *work, bool *regular)
{
  sunrealtype h[STF_JUMP_LENGTHS], part = INFINITY;
  int k = 0;
  stf_jump_lengths(r, h);
  while (k < STF_JUMP_LENGTHS && !(h[k] > 0)) k++;
  if (k == STF_JUMP_LENGTHS) return STEIF_OK;
  const stf_shifted M = {.view = &r->view, .s = 1 / h[k]};
  r->step_h = h[k];
  int code = stf_view_factor_open(r, 1 / h[k], NULL, 1, &r->step);
  if (!code) code = stf_lost_part(r->step.pencil, &M, r->point.r, work, &part);
  *regular = !code && part < STF_LOST;
  if (code || !*regular) stf_view_factor_close(&r->step);
  return open_question(r, code) ? STEIF_OK : code;
}

/* At shifts beside the rates of the system, and at that of the interval; *known: work has a null vector. */
static int by_shifts(stf_repair *r, stf_factor *f, const stf_view *v, sunrealtype *work,
                     bool *regular, bool *known)
{
  sunrealtype slow, fast, part;
  stf_view_rates(&r->point, v, &slow, &fast);
  const sunrealtype span = r->given->t1 - r->given->t0, middle = sqrt(slow * fast);
  const sunrealtype s[] = {1.37 * middle, 1.91 * fast, 0.63 * slow,
                           7.3 * fast,    1 / span,    1.37 * middle};
  const int count = sizeof s / sizeof *s;
  *known = false;
  for (int k = 0; k < count && !*regular; k++) {
    const bool last = k == count - 1;
    if (!(s[k] > 0 && isfinite(s[k])) || (last && *known)) continue;
    const int code = stf_factor_lost(f, v, s[k], last, work, &part);
    if (open_question(r, code)) continue;
    STEIF_TRY(code);
    *regular = part < STF_LOST;
    *known = !*regular;
  }
  return STEIF_OK;
}

/* The unknowns of the null vector x. */
static int told(stf_repair *r, const sunrealtype *x)
{
  const size_t n = r->point.n;
  char list[STEIF_SENTENCE] = "";
  sunrealtype most = 0;
  int *flag = stf_allocate(r->ctx, n, sizeof *flag);
  if (!flag) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < n; j++)
    if (isfinite(x[j])) most = fmax(most, fabs(x[j]));
  for (size_t j = 0; j < n; j++) flag[j] = !(fabs(x[j]) < named * most);
  stf_point_list(&r->point, list, false, flag, 1, false);
  stf_release(r->ctx, flag);
  r->irregular = true;
  return STEIF_FAIL(
    r->ctx, STEIF_SINGULAR,
    "the pencil s E - A of '%s' is singular at every s, to rounding: nothing fixes "
    "a combination of %.300s; is an equation missing, such as a pressure or a node "
    "that is set to a value, or given twice?",
    r->given->name, list);
}

static int by_even_units(stf_repair *r, sunrealtype *work, bool *regular)
{
  stf_view all = {0};
  stf_factor *f = NULL;
  bool known = false;
  const stf_point kept = r->point;
  r->point.every = true, r->point.views = 0; /* E and A are the same at all points */
  int code = stf_view_take(&r->point, kept.t, r->y, r->yp, &all);
  r->point.every = kept.every, r->point.views = kept.views;
  if (!code) code = stf_factor_open(&r->point, &all, &f);
  if (!code) code = by_shifts(r, f, &all, work, regular, &known);
  if (!code && !*regular && known) code = told(r, work);
  stf_factor_free(&f);
  stf_view_free(&r->point, &all);
  return code;
}

int stf_judge_pencil(stf_repair *r)
{
  bool regular = false;
  if (!r->point.system.linear || !r->point.analytic) return STEIF_OK;
  sunrealtype *work = stf_allocate(r->ctx, 4 * r->point.n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  int code = by_step(r, work, &regular);
  if (!code && !regular) code = by_even_units(r, work, &regular);
  stf_release(r->ctx, work);
  return code;
}

int stf_judge_system(stf_repair *r, const stf_system *system, N_Vector y, N_Vector scratch)
{
  const steif_problem *p = r->given;
  const size_t n = (size_t)p->n;
  stf_point *s = &r->point;
  if (!system->A || !system->linear || !system->filled) return STEIF_OK;
  *s = (stf_point){.ctx = r->ctx,
                   .pool = r->pool,
                   .problem = *p,
                   .system = *system,
                   .n = n,
                   .analytic = stf_analytic(p, system->form),
                   .quick = true,
                   .every = true,
                   .y = y,
                   .yp = y,
                   .r = scratch,
                   .t = p->t0};
  if (p->names) s->equation = p->names->equation, s->unknown = p->names->unknown;
  s->size = stf_pool_array(r->pool, 7 * n, sizeof *s->size);
  if (!s->size) return STEIF_NO_MEMORY;
  s->scratch = s->size + n;
  for (size_t j = 0; j < n; j++) s->size[j] = 1;
  r->view = (stf_view){0};
  int code = stf_view_take(s, s->t, NULL, NULL, &r->view);
  if (!code) code = stf_judge_pencil(r);
  stf_view_factor_close(&r->step);
  stf_view_free(s, &r->view);
  return code;
}
