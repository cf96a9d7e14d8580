/* problem.c: is a problem complete and consistent, and which form is it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <math.h>

const char *steif_form_name(int form)
{
  switch (form) {
  case STEIF_ODE: return "ode";
  case STEIF_MASS: return "mass";
  case STEIF_IMPLICIT: return "implicit";
  case STEIF_DESCRIPTOR: return "descriptor";
  default: return "none";
  }
}

static int form_of(const steif_problem *p)
{
  const bool E = p->E || p->Ev;
  if (p->F) return p->f || p->g ? 0 : STEIF_IMPLICIT;
  if (p->f) return p->g ? 0 : E ? STEIF_MASS : STEIF_ODE;
  return E && (p->A || p->Av) ? STEIF_DESCRIPTOR : 0;
}

static int check_values(steif_context *ctx, const steif_problem *p, sunindextype rows)
{
  STEIF_CHECK(p->y0 || p->start, ctx, STEIF_BAD_INPUT,
              "problem '%s' has no start values: set .y0 or .start", p->name);
  for (sunindextype i = 0; i < rows; i++) {
    STEIF_CHECK(!p->y0 || isfinite(p->y0[i]), ctx, STEIF_NOT_FINITE,
                "start value y0[%lld] = %g of problem '%s' is not finite", (long long)i,
                p->y0[i], p->name);
    STEIF_CHECK(!p->yp0 || isfinite(p->yp0[i]), ctx, STEIF_NOT_FINITE,
                "start slope yp0[%lld] = %g of problem '%s' is not finite", (long long)i,
                p->yp0[i], p->name);
    STEIF_CHECK(!p->index || (p->index[i] >= 1 && p->index[i] <= 3), ctx, STEIF_BAD_INPUT,
                "index[%lld] = %d of problem '%s' must be 1, 2 or 3", (long long)i, p->index[i],
                p->name);
    STEIF_CHECK(!p->constraint || (p->constraint[i] >= -2 && p->constraint[i] <= 2), ctx,
                STEIF_BAD_INPUT,
                "constraint[%lld] = %d of problem '%s' must be 0 (none), 1 (y >= 0), 2 (> 0), "
                "-1 (<= 0) or -2 (< 0)",
                (long long)i, p->constraint[i], p->name);
  }
  return STEIF_OK;
}

static int check_breaks(steif_context *ctx, const steif_problem *p)
{
  STEIF_CHECK(p->break_count == 0 || (p->break_count > 0 && p->breaks), ctx, STEIF_BAD_INPUT,
              "problem '%s' announces %d breaks: set .breaks to as many times, or neither",
              p->name, p->break_count);
  for (int i = 0; i < p->break_count; i++)
    STEIF_CHECK(isfinite(p->breaks[i]) && (i == 0 || p->breaks[i] > p->breaks[i - 1]), ctx,
                STEIF_BAD_INPUT, "breaks[%d] = %.17g of problem '%s' must be finite and ascend",
                i, p->breaks[i], p->name);
  return STEIF_OK;
}

int stf_storage_check(steif_context *ctx, const steif_problem *p, enum steif_storage storage)
{
  STEIF_CHECK(
    (unsigned)storage <= STEIF_KRYLOV, ctx, STEIF_BAD_INPUT,
    "storage %d of problem '%s' must be 0 (dense), 1 (band), 2 (sparse) or 3 (Krylov)",
    (int)storage, p->name);
  if (storage == STEIF_BAND)
    STEIF_CHECK(p->lower >= 0 && p->upper >= 0 && p->lower < p->n && p->upper < p->n, ctx,
                STEIF_BAD_INPUT,
                "bandwidths lower = %lld, upper = %lld of problem '%s' must lie "
                "in 0 .. %lld",
                (long long)p->lower, (long long)p->upper, p->name, (long long)p->n - 1);
  if (storage == STEIF_BAND && p->storage != STEIF_BAND)
    STEIF_CHECK(p->n == 1 || p->lower || p->upper, ctx, STEIF_BAD_INPUT,
                "problem '%s' has no bandwidths: set .lower and .upper for a band", p->name);
  if (storage == STEIF_SPARSE)
    STEIF_CHECK(p->pattern || p->nnz > 0, ctx, STEIF_BAD_INPUT,
                "problem '%s' is stored sparse: set .nnz for its Jacobian or a .pattern (which "
                "steif_pattern_find finds) for "
                "differences",
                p->name);
  return STEIF_OK;
}

const steif_problem *stf_with_name(const steif_problem *p, steif_problem *room)
{
  if (!p || p->name) return p;
  *room = *p;
  room->name = "unnamed";
  return room;
}

int steif_problem_form(steif_context *ctx, const steif_problem *p)
{
  return stf_problem_form(ctx, p, p ? p->n : 0);
}

int stf_problem_form(steif_context *ctx, const steif_problem *p, sunindextype rows)
{
  STF_NAMED(p);
  if (!p) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT, "a problem is needed, got NULL");
    return 0;
  }
  const int form = form_of(p);
  if (!form)
    STEIF_FAIL(ctx, STEIF_BAD_INPUT,
               "problem '%s' has no form: set .f (y' = f), .f and .E (M y' = f), .F "
               "(F(t,y,y') = 0) or .E and .A with .g (E x' = A x + g), and nothing besides",
               p->name);
  else if (p->n < 1)
    STEIF_FAIL(ctx, STEIF_BAD_INPUT,
               "problem '%s' has n = %lld components, at least 1 is needed", p->name,
               (long long)p->n);
  else if (!(isfinite(p->t0) && isfinite(p->t1) && p->t1 >= p->t0))
    STEIF_FAIL(ctx, STEIF_BAD_INPUT,
               "interval [%g, %g] of problem '%s' must be finite and "
               "ascending",
               p->t0, p->t1, p->name);
  else if (!check_values(ctx, p, rows) && !check_breaks(ctx, p) &&
           !stf_storage_check(ctx, p, p->storage))
    return form;
  return 0;
}

sunindextype stf_not_finite(N_Vector v)
{
  const sunrealtype *a = stf_array(v);
  const sunindextype n = a ? N_VGetLength(v) : 0;
  for (sunindextype i = 0; i < n; i++)
    if (!isfinite(a[i])) return i;
  return -1;
}

const char *stf_number_not_finite(N_Vector v, char room[STEIF_SPEC_WORD])
{
  sunindextype rows, i = 0;
  const sunrealtype *a = stf_own_rows(v, &rows);
  if (!a) return "(not known which)";
  while (i < rows && isfinite(a[i])) i++;
  int rank = -1;
  long long number = (long long)i + 1, first;
  const bool mine = stf_agree_lowest(v, i < rows, rows, &rank, &first);
  number = stf_agree_total(v, mine ? number : 0);
  if (rank < 0)
    snprintf(room, STEIF_SPEC_WORD, stf_spread(v) ? "%lld of a rank" : "%lld", number);
  else
    snprintf(room, STEIF_SPEC_WORD, "%lld (on rank %d)", first + number, rank);
  return room;
}
