/* stage_message.c: whether a stage of a consistent start has been solved, and the sentence where not.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stagewise.h"
#include <math.h>
#include <string.h>

/* -- what went wrong --------------------------------------------------------------------- */

/* Is unknown j in one of the equations `in`? */
static bool occurs(const stf_stage *w, const int *in, size_t j)
{
  const stf_view *v = &w->view;
  for (sunindextype k = v->column[j]; k < v->column[j + 1]; k++)
    if (in[v->row[k]] && (v->e[k] != 0 || v->b[k] != 0)) return true;
  return false;
}

/* Rows with a part in a combination that no unknown of the stage can change and that is not zero: what is
 * left at the nearest point lies in these combinations. */
static void mark_conflict(const stf_stage *w, const stf_nearest_point *m, int *in)
{
  sunrealtype top = 0;
  memset(in, 0, w->n * sizeof *in);
  for (size_t i = 0; m->sparse && i < m->rows; i++)
    top = fmax(top, fabs(m->r[i]) / w->task->scale[w->equation[i]]);
  for (size_t i = 0; m->sparse && i < m->rows; i++)
    in[w->equation[i]] = fabs(m->r[i]) / w->task->scale[w->equation[i]] > 1e-3 * top;
  for (size_t k = m->rank; !m->sparse && k < m->rows; k++) {
    sunrealtype along = 0;
    for (size_t i = 0; i < m->rows; i++) along += m->U[k * m->rows + i] * m->left[i] * m->r[i];
    for (size_t i = 0; i < m->rows && fabs(along) > 1e-9; i++)
      if (fabs(m->U[k * m->rows + i]) > 1e-6) in[w->equation[i]] = 1;
  }
}

static int conflict(stf_stage *w, const stf_nearest_point *m, sunrealtype size)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", room[STEIF_SPEC_WORD];
  enum { SHOWN = 8 };
  size_t fixed = 0, last = 0;
  int *in = w->order; /* done with */
  mark_conflict(w, m, in);
  stf_point_say(text, "fixed values contradict each other: equations {");
  stf_point_list(point, text, true, in, 1, false);
  stf_point_say(text, "} contain only fixed unknowns {");
  for (size_t j = 0; j < w->n; j++) {
    if (stf_stage_order(w, j) != 0 || stf_start_attribute(w->task, j) != STEIF_FIXED) continue;
    if (!occurs(w, in, j)) continue;
    last = j;
    if (++fixed > SHOWN) continue;
    stf_point_say(text, "%s%s", fixed > 1 ? ", " : "", stf_point_unknown(point, j, room));
  }
  if (fixed > SHOWN) stf_point_say(text, " and %zu more", fixed - SHOWN);
  stf_point_say(text, "}; residual %.4g.", size);
  if (fixed == 1)
    stf_point_say(text, " The equations determine %s: it can never be prescribed.",
                  stf_point_unknown(point, last, room));
  else
    stf_point_say(text, " Leave at least one of them free.");
  return STEIF_FAIL(point->ctx, STEIF_BAD_INPUT, "%s", text);
}

static int stalled(stf_stage *w, const stf_nearest_point *m, size_t worst, sunrealtype size)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  for (size_t k = 0; k < w->columns && k < 3; k++)
    stf_point_say(text, "%s%s", k ? ", " : "",
                  stf_point_unknown(point, w->unknown[w->columns - 1 - k], y));
  return STEIF_FAIL(
    point->ctx, STEIF_NO_CONVERGENCE,
    "no consistent point found within %d iterations; residual %.3g in %s; stage "
    "%d stalled; last unknowns %s: give better values for them",
    m->iterations, size, stf_point_equation(point, w->equation[worst], e), w->stage, text);
}

/* The part of unknown k in what J leaves undetermined. */
static sunrealtype undetermined(const stf_nearest_point *m, const sunrealtype *null_vector,
                                size_t k)
{
  const size_t least = m->rows < m->columns ? m->rows : m->columns;
  sunrealtype part = 0;
  if (m->sparse) return fabs(null_vector[k]);
  for (size_t q = m->rank; q < least; q++) part = fmax(part, fabs(m->VT[k * m->columns + q]));
  return part;
}

/* Of largest part 1; all 0 where there is none. */
static int find_null_vector(stf_nearest_point *m, sunrealtype *v)
{
  sunrealtype top = 0;
  if (!m->sparse) return STEIF_OK;
  STEIF_TRY(stf_nearest_null_vector(m, v));
  for (size_t k = 0; k < m->columns; k++) top = fmax(top, fabs(v[k]));
  for (size_t k = 0; k < m->columns && top > 0; k++) v[k] /= top;
  return STEIF_OK;
}

static int singular(stf_stage *w, stf_nearest_point *m, size_t worst)
{
  stf_point *point = w->task->point;
  char text[STEIF_SENTENCE] = "", y[STEIF_SPEC_WORD], e[STEIF_SPEC_WORD];
  sunrealtype *v = point->scratch;
  int shown = 0;
  STEIF_TRY(find_null_vector(m, v));
  for (size_t k = 0; k < m->columns && shown < 5; k++)
    if (undetermined(m, v, k) > 0.3)
      stf_point_say(text, "%s%s", shown++ ? ", " : "",
                    stf_point_unknown(point, w->unknown[k], y));
  return STEIF_FAIL(
    point->ctx, STEIF_SINGULAR,
    "%s %s more than one consistent value near the guess, or none (Jacobian of "
    "stage %d nearly singular, rcond %.1e; equation %s is off by %.3g): give %s, or "
    "move the guess",
    shown ? text : "the start", shown > 1 ? "have" : "has", w->stage, m->rcond,
    stf_point_equation(point, w->equation[worst], e), fabs(m->r[worst]),
    shown ? text : "more values");
}

/* -- the verdict ------------------------------------------------------------------------- */

/* What the lower derivatives of an unknown, known from earlier stages, let its next one be where that is 0 by
 * chance, as every jerk of a body that starts from rest: size (|y^(k)| / size)^(order / k). */
static sunrealtype expected(const stf_stage *w, size_t j)
{
  const int order = stf_stage_order(w, j);
  const sunrealtype size = fmax(fabs(w->u[j]), w->task->point->floor[j]);
  sunrealtype most = 0, factorial = 1;
  for (int k = 1; k < order && size > 0; k++) {
    factorial *= k;
    const sunrealtype part = factorial * fabs(w->u[(size_t)k * w->n + j]) / size;
    most = fmax(most, size * pow(part, (sunrealtype)order / k));
  }
  return most;
}

/* Largest residual against the terms of its equation; *worst names the row. */
static sunrealtype leftover(const stf_stage *w, const stf_nearest_point *m, size_t *worst)
{
  sunrealtype most = 0, value, *size = w->task->point->scratch;
  *worst = 0;
  for (size_t k = 0; k < m->rows; k++) size[k] = w->task->scale[w->equation[k]];
  for (size_t l = 0; l < m->columns; l++) {
    const size_t j = w->unknown[l];
    const sunrealtype z = fmax(fmax(fabs(m->z[l]), m->unit[l]), expected(w, j));
    for (sunindextype k = w->view.column[j]; k < w->view.column[j + 1]; k++) {
      if (!stf_stage_entry(w, j, k, &value)) continue;
      sunrealtype *at = &size[w->row[w->view.row[k]]];
      *at = fmax(*at, fabs(value) * z);
    }
  }
  for (size_t k = 0; k < m->rows; k++) {
    const sunrealtype part = fabs(m->r[k]) / (size[k] > 0 ? size[k] : 1);
    if (!(part <= most)) most = part, *worst = k;
  }
  return most;
}

/* Parts between breaks too short for accurate derivatives leave residuals of this size at most. */
static const sunrealtype narrow_part = 1e-3;

int stf_stage_judge(stf_stage *w, stf_nearest_point *m)
{
  size_t fixed = 0, worst;
  for (size_t j = 0; j < w->n; j++)
    fixed += stf_stage_order(w, j) == 0 && stf_start_attribute(w->task, j) == STEIF_FIXED;
  const sunrealtype part = leftover(w, m, &worst);
  const sunrealtype noise = fmin(10 * w->derivatives.noise, narrow_part);
  w->task->start->residual = fmax(w->task->start->residual, part);
  if (part > STF_VIOLATED && m->rank < m->rows && fixed)
    return conflict(w, m, fabs(m->r[worst]));
  if (m->rank < m->rows && !fixed) return singular(w, m, worst);
  if (part > fmax(m->converged ? STF_VIOLATED : STF_FULFILLED, noise))
    return stalled(w, m, worst, fabs(m->r[worst]));
  return STEIF_OK;
}
