/* used_index.c: the numbers of the components that a run uses, where nobody has declared them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "array_start.h"
#include "index_thresholds.h"
#include "repair.h"

/* The structure with all entries that are not 0; STEIF_RETRY where its Jacobian is not regular. */
static int find_structure(stf_repair *r, stf_view *all, stf_offsets *with)
{
  stf_point *s = &r->point;
  stf_factor *f = NULL;
  sunrealtype rcond = 0;
  s->every = true;
  int code = stf_view_take(s, s->t, s->y0, s->yp0, all);
  s->every = false;
  STEIF_TRY(code);
  STEIF_TRY(stf_offsets_find(r->ctx, r->pool, s->n, all->column, all->row, all->has, with));
  if (!with->matched) return STEIF_RETRY;
  code = stf_factor_open(s, all, &f);
  if (!code) code = stf_factor_jacobian(f, all, with->c, with->d);
  if (!code) code = stf_factor_rcond(f, &rcond);
  stf_factor_free(&f);
  if (code == STEIF_NO_MEMORY) return code;
  return code || rcond < stf_evidence_regular_rcond(s) ? STEIF_RETRY : STEIF_OK;
}

/* Entries taken as rounding may become large as the run goes on, as the conductance of a diode. Where the structure with
 * them is certified and has lower numbers than without, these are used: they ask for smaller errors. One-sided differences,
 * of large systems, do not show them. */
static int lower(stf_repair *r, const stf_evidence *e, int *number, bool *lowered)
{
  stf_point *s = &r->point;
  stf_view all = {0};
  stf_offsets with = {0};
  const int *without = e->offsets.component_index;
  if (s->system.linear || !e->offsets.matched ||
      (!s->analytic && s->n > STEIF_DIAGNOSE_LARGEST))
    return STEIF_OK;
  int code = stf_view_copy(s, &e->view, &all);
  if (!code) code = find_structure(r, &all, &with);
  for (size_t j = 0; !code && j < s->n; j++) {
    const int least = with.component_index[j] < 1 ? 1 : with.component_index[j];
    if (least < without[j] && least < number[j]) number[j] = least, *lowered = true;
  }
  stf_view_free(s, &all);
  return code < 0 && code != STEIF_SINGULAR ? code : STEIF_OK;
}

int stf_use_index(stf_repair *r, const stf_evidence *e, const steif_diagnosis *d)
{
  const size_t n = r->point.n;
  if (d->index < 0 || d->confidence == STEIF_UNDECIDED || d->index > 3) return STEIF_OK;
  int *number = stf_pool_array(r->pool, n, sizeof *number), high = 1;
  bool lowered = false;
  if (!number) return STEIF_NO_MEMORY;
  for (size_t j = 0; j < n; j++)
    number[j] = d->number[j] < 1 ? 1 : d->number[j] > 3 ? 3 : d->number[j];
  STEIF_TRY(lower(r, e, number, &lowered));
  for (size_t j = 0; j < n; j++) high = number[j] > high ? number[j] : high;
  r->report.number = number;
  r->report.index = r->problem.dae_index = lowered ? high : d->index;
  if (high > 1) r->problem.index = number;
  return STEIF_OK;
}
