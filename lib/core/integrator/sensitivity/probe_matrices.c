/* probe_matrices.c: dF/dy and dF/dy' as they are given, times a direction, against differences of F along it.
 *
 * Newton's iteration forgives matrices that are not quite right: derivatives of the solution do not. A direction without a
 * pattern sees all entries at once; a row that it finds wrong, as in probe_slopes.c, is looked through column by column, and
 * one entry has to be wrong by itself.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "probe.h"
#include <math.h>

enum { LARGEST = 20000 }; /* columns of a row that are looked through */
static const sunrealtype golden = 0.6180339887498949;

/* Is it given, and no difference? */
static bool given(const stf_slope_probe *q, char which)
{
  const stf_system *s = q->at.system;
  const steif_problem *p = s->problem;
  if (s->form == STEIF_DESCRIPTOR || (which == 'E' && s->form != STEIF_IMPLICIT)) return false;
  if (q->at.point) return which == 'E' ? p->Ev != NULL : p->Av != NULL;
  return p->idajac || (which == 'E' ? p->E != NULL : p->jac || p->A);
}

/* out = (F at `high` less F at `low`) / their distance, lengths in units of d along q->along. */
static int difference(stf_slope_probe *q, char which, sunrealtype d, int low, int high,
                      N_Vector out)
{
  const N_Vector from = which == 'E' ? q->yp : q->y;
  const int end[] = {high, low};
  const sunrealtype sign[] = {1, -1};
  N_VConst(0, out);
  for (int k = 0; k < 2; k++) {
    N_VLinearSum(1, from, end[k] * d, q->along, q->moved);
    STEIF_TRY(stf_system_residual(q->at.system, q->t, which == 'E' ? q->y : q->moved,
                                  which == 'E' ? q->moved : q->yp, q->F));
    N_VLinearSum(1, out, sign[k] / ((high - low) * d), q->F, out);
  }
  return STEIF_OK;
}

/* What the matrices themselves say counts where it is for good. */
static int counts(const stf_slope_probe *q, int code)
{
  if (code > 0) steif_forget(q->s->ctx);
  return code < 0 ? code : STEIF_OK;
}

/* *row of the product with q->along that is wrong, -1: none, or it cannot be evaluated. */
static int wrong_row(stf_slope_probe *q, char which, sunrealtype d, sunindextype *row,
                     sunrealtype *bar)
{
  int code = stf_matrices_at_product(&q->at, 0, which, q->along, q->given);
  *row = -1;
  if (code) return counts(q, code);
  if (which == 'A') N_VScale(-1, q->given, q->given);
  const bool before = stf_silence(q->s->ctx, true);
  code = difference(q, which, d, -2, 2, q->wide);
  if (!code) code = difference(q, which, d, 0, 1, q->half);
  if (!code) code = difference(q, which, d, -1, 1, q->found);
  stf_silence(q->s->ctx, before);
  if (!code) *row = stf_probe_worst(q, d, NULL, bar);
  return STEIF_OK;
}

/* Lengths of about the size of each component, of both signs. */
static sunrealtype length(const stf_slope_probe *q, char which, sunindextype i)
{
  const sunrealtype share = fmod(golden * (sunrealtype)(i + 1), 1), *at = stf_array(q->y),
                    *slope = stf_array(q->yp);
  const sunrealtype floor = stf_floor(q->at.system, i),
                    size = which == 'E'
                             ? fmax(fabs(slope[i]), floor / (q->s->t1 - q->s->problem->t0))
                             : fmax(fabs(at[i]), floor);
  return (i % 3 == 1 ? -1 : 1) * (0.5 + share) * size;
}

static int say(const stf_slope_probe *q, char which, sunindextype row, sunindextype column,
               sunrealtype by, sunrealtype bar)
{
  const steif_problem *p = q->s->problem;
  char equation[STEIF_SPEC_WORD], unknown[STEIF_SPEC_WORD];
  const sunrealtype given = stf_array(q->given)[row] / by,
                    found = stf_array(q->found)[row] / by;
  const bool turned = which == 'A' && q->at.system->form != STEIF_IMPLICIT; /* of f, or of -F */
  return STEIF_FAIL(
    q->s->ctx, STEIF_BAD_INPUT,
    "the matrix d%c/dy%s of problem '%s' is wrong: it has %.6g in equation %s by %s at t = "
    "%.6g, where differences are %.6g, to about %.1g; derivatives of the solution would be "
    "wrong too: correct this entry of .%s, or leave the matrix out",
    turned ? 'f' : 'F', which == 'E' ? "'" : "", p->name, turned ? -given : given,
    stf_equation(p, row, equation), stf_unknown(p, column, unknown), q->t,
    turned ? -found : found, fabs(bar / by),
    q->at.point    ? (which == 'E' ? "Ev" : "Av")
    : p->idajac    ? "idajac"
    : which == 'E' ? "E"
    : p->A         ? "A"
                   : "jac");
}

/* One entry that is wrong by itself. */
static int find_entry(stf_slope_probe *q, char which, sunrealtype d)
{
  const sunindextype n = q->s->problem->n;
  for (sunindextype j = 0; n <= LARGEST && j < n; j++) {
    sunrealtype bar = 0, by = length(q, which, j);
    sunindextype row;
    N_VConst(0, q->along);
    stf_array(q->along)[j] = by;
    STEIF_TRY(wrong_row(q, which, d, &row, &bar));
    if (row >= 0) return say(q, which, row, j, by, bar);
  }
  return STEIF_OK;
}

static int look(stf_slope_probe *q, char which)
{
  const sunrealtype d = cbrt(STF_EPS);
  sunrealtype bar = 0;
  sunindextype row;
  if (!given(q, which)) return STEIF_OK;
  for (sunindextype i = 0; i < q->s->problem->n; i++)
    stf_array(q->along)[i] = length(q, which, i);
  STEIF_TRY(wrong_row(q, which, d, &row, &bar));
  return row < 0 ? STEIF_OK : find_entry(q, which, d);
}

static int look_at_matrices(stf_slope_probe *q)
{
  if (!given(q, 'A') && !given(q, 'E')) return STEIF_OK;
  const int code = stf_matrices_at_fill(&q->at, 0, q->t, q->y, q->yp);
  if (code) return counts(q, code);
  STEIF_TRY(look(q, 'A'));
  return look(q, 'E');
}

/* ---- both, at two points ------------------------------------------------------------------------- */

static int look_at_all(stf_slope_probe *q)
{
  const bool before = stf_silence(q->s->ctx, true);
  const int code = stf_probe_rounding(q);
  stf_silence(q->s->ctx, before);
  if (code) return STEIF_OK;
  STEIF_TRY(stf_probe_slopes(q));
  return look_at_matrices(q);
}

/* Components above where they were, by amounts without a pattern. */
static void move(stf_slope_probe *q)
{
  const steif_solver *s = q->s;
  const sunrealtype part = 1e-3, *from = stf_array(q->y);
  sunrealtype *y = stf_array(q->near);
  for (sunindextype i = 0; i < s->problem->n; i++) {
    const sunrealtype share = fmod(golden * (sunrealtype)(i + 1), 1);
    y[i] = from[i] + part * (0.5 + share) * fmax(fabs(from[i]), stf_floor(q->at.system, i));
  }
  q->t += part * (s->t1 - q->t);
  q->y = q->near;
}

int stf_probe_open(stf_pool *pool, stf_system *system, stf_slopes *slopes, const int *parameter,
                   int count, stf_slope_probe **probe)
{
  stf_slope_probe *q = *probe = stf_pool_array(pool, 1, sizeof *q);
  if (!q) return STEIF_NO_MEMORY;
  *q = (stf_slope_probe){.slopes = slopes, .parameter = parameter, .count = count};
  N_Vector *all[] = {&q->given, &q->rounding, &q->found, &q->wide, &q->half,
                     &q->F,     &q->along,    &q->moved, &q->near};
  for (size_t i = 0; i < STF_COUNT(all); i++)
    if (!(*all[i] = stf_pool_vector(pool, system->space.like))) return STEIF_NO_MEMORY;
  return stf_matrices_at_open(pool, system, 1, &q->at);
}

int stf_probe_look(stf_slope_probe *q, steif_solver *s)
{
  const stf_step *step = &s->step;
  const long calls = q->at.system->nfe;
  q->s = s, q->t = step->t, q->y = step->y, q->yp = step->yp;
  int code = look_at_all(q);
  move(q);
  if (!code) code = look_at_all(q);
  q->at.system->nfe = calls;
  return code;
}

/* Entries that are 0 at the start, and all that depends on what the run does. */
int stf_probe_later(steif_solver *s)
{
  stf_carry *T = s->step.carry;
  if (!T || !T->probe || s->step.t - s->problem->t0 < (s->t1 - s->problem->t0) / 2)
    return STEIF_OK;
  stf_slope_probe *q = T->probe;
  T->probe = NULL;
  return stf_probe_look(q, s);
}
