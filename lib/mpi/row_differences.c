/* row_differences.c: own rows of A = df/dy, or of A = -dF/dy and E = dF/dy', by differences. All columns of a colour
 * move at once; a row finds the increments of columns that other ranks own in the halo.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "row_differences.h"
#include <float.h>
#include <math.h>
#include <string.h>

bool differences_needed(const steif_problem *p)
{
  return !p->A && p->pattern && (p->f || p->F);
}

int differences_check(const rows *r, const steif_problem *p)
{
  const sunindextype *at = p->pattern->column, *column = p->pattern->row;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    const long long row = (long long)(r->own.first + i);
    if (at[0] != 0 || at[i + 1] < at[i])
      return steif_fail(r->ctx, STEIF_BAD_INPUT,
                        "the pattern of problem '%s' is that of own rows here: pointers rise "
                        "from 0, and do not at row %lld (rank %d)",
                        p->name, row, r->own.rank);
    for (sunindextype k = at[i]; k < at[i + 1]; k++)
      if (column[k] < 0 || column[k] >= r->own.n || (k > at[i] && column[k] <= column[k - 1]))
        return steif_fail(r->ctx, STEIF_BAD_INPUT,
                          "columns in row %lld of the pattern of problem '%s' must ascend "
                          "within 0 .. %lld, and %lld does not (rank %d)",
                          row, p->name, (long long)r->own.n - 1, (long long)column[k],
                          r->own.rank);
  }
  return STEIF_OK;
}

void differences_pattern(const rows *r, const steif_problem *p)
{
  SUNMatrix const all[] = {r->A, p->F && !p->E ? r->E : NULL};
  const size_t rows_here = (size_t)r->own.rows;
  for (int i = 0; i < 2; i++) {
    if (!all[i]) continue;
    SUNMatZero(all[i]);
    if (!rows_here) continue;
    memcpy(SM_INDEXPTRS_S(all[i]), p->pattern->column, (rows_here + 1) * sizeof(sunindextype));
    memcpy(SM_INDEXVALS_S(all[i]), p->pattern->row,
           (size_t)p->pattern->column[rows_here] * sizeof(sunindextype));
  }
}

/* -- opening ---------------------------------------------------------------------------------- */

static int claim(rows *r, row_differences *d)
{
  const size_t entries = (size_t)r->entries + 1, all = (size_t)(r->own.rows + r->halo.count);
  d->entry = steif_allocate(r->ctx, entries, sizeof *d->entry);
  d->row = steif_allocate(r->ctx, entries, sizeof *d->row);
  d->colour = steif_allocate(r->ctx, all + 1, sizeof *d->colour);
  d->step = steif_allocate(r->ctx, all + 1, sizeof *d->step);
  N_Vector *const vector[] = {&d->base, &d->moved, &d->changed, &d->zero};
  for (int i = 0; i < 4; i++) {
    if (!(*vector[i] = N_VClone(r->like))) return STEIF_NO_MEMORY;
    N_VConst(0, *vector[i]);
  }
  return d->entry && d->row && d->colour && d->step ? STEIF_OK : STEIF_NO_MEMORY;
}

/* What own columns have, for those of the halo too. */
static void pass(rows *r, sunrealtype *of)
{
  const sunrealtype *own = of;
  halo_exchange(r, 1, &own);
  memcpy(of, r->one, (size_t)(r->own.rows + r->halo.count) * sizeof *of);
}

static int sort(rows *r, row_differences *d)
{
  d->start = steif_allocate(r->ctx, (size_t)d->colours + 2, sizeof *d->start);
  if (!d->start) return STEIF_NO_MEMORY;
  for (sunindextype k = 0; k < r->entries; k++) d->start[(int)d->colour[r->local[k]] + 2]++;
  for (int c = 2; c < d->colours + 2; c++) d->start[c] += d->start[c - 1];
  for (sunindextype i = 0; i < r->own.rows; i++)
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunindextype at = d->start[(int)d->colour[r->local[k]] + 1]++;
      d->entry[at] = k, d->row[at] = i;
    }
  return STEIF_OK;
}

static int prepare(rows *r, row_differences *d)
{
  MPI_TRY(steif_agree(r->ctx, r->like, d ? claim(r, d) : STEIF_NO_MEMORY));
  MPI_TRY(rows_colour(r, &d->colours, d->colour));
  r->stats.colours = d->colours;
  pass(r, d->colour);
  return steif_agree(r->ctx, r->like, sort(r, d));
}

int differences_open(rows *r, const steif_problem *p)
{
  row_differences *d = r->differences = steif_allocate(r->ctx, 1, sizeof *d);
  if (d) d->implicit = p->F != NULL, d->of_E = p->F && !p->E;
  const int code = prepare(r, d);
  if (code) differences_close(r);
  return code;
}

void differences_close(rows *r)
{
  row_differences *d = r->differences;
  if (!d) return;
  N_Vector const vector[] = {d->base, d->moved, d->changed, d->zero};
  for (int i = 0; i < 4; i++)
    if (vector[i]) N_VDestroy(vector[i]);
  void *const all[] = {d->start, d->entry, d->row, d->colour, d->step, d};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(r->ctx, all[i]);
  r->differences = NULL;
}

/* -- values ----------------------------------------------------------------------------------- */

typedef struct point {
  const steif_problem *p;
  sunrealtype t;
  N_Vector y, yp;
  int code; /* the first failure of f here */
} point;

static void evaluate(rows *r, point *at, N_Vector y, N_Vector yp, N_Vector out)
{
  const steif_problem *p = at->p;
  const int code = p->F ? p->F(at->t, y, yp, out, p->user) : p->f(at->t, y, out, p->user);
  r->stats.evaluations++;
  if (code && !at->code)
    at->code =
      steif_fail(r->ctx, STEIF_CALLBACK,
                 "%s of problem '%s' returned %d at t = %g on rank %d, for differences",
                 p->F ? "F" : "f", p->name, code, at->t, r->own.rank);
}

/* Increments that doubles represent exactly; of linear problems, whose differences are exact, 1 from 0. */
static void choose_steps(const rows *r, row_differences *d, const point *at, N_Vector from)
{
  const sunrealtype *y = N_VGetArrayPointer(from);
  const sunrealtype least = at->p->rtol_scale > 0 ? at->p->rtol_scale : 1;
  for (sunindextype j = 0; j < r->own.rows; j++) {
    const sunrealtype wanted = sqrt(DBL_EPSILON) * fmax(fabs(y[j]), least);
    const volatile sunrealtype moved = y[j] + (y[j] < 0 ? -wanted : wanted);
    d->step[j] = at->p->linear ? 1 : moved - y[j];
  }
}

/* Values of M, each at its place in `place`, from moves of y (A) or y' (E). */
static void differ(rows *r, point *at, SUNMatrix M, const sunindextype *place, bool of_y)
{
  row_differences *d = r->differences;
  N_Vector from = of_y ? at->y : at->yp;
  const sunrealtype sign = of_y && d->implicit ? -1 : 1;
  choose_steps(r, d, at, from);
  pass(r, d->step);
  N_VScale(1, from, d->moved);
  const sunrealtype *y = N_VGetArrayPointer(from), *base = N_VGetArrayPointer(d->base),
                    *f = N_VGetArrayPointer(d->changed);
  sunrealtype *moved = N_VGetArrayPointer(d->moved), *value = SM_DATA_S(M);
  for (int c = 0; c < d->colours; c++) {
    for (sunindextype j = 0; j < r->own.rows; j++)
      moved[j] = (int)d->colour[j] == c ? y[j] + d->step[j] : y[j];
    evaluate(r, at, of_y ? d->moved : at->y, of_y ? at->yp : d->moved, d->changed);
    for (sunindextype k = d->start[c]; k < d->start[c + 1]; k++) {
      const sunindextype e = d->entry[k], i = d->row[k];
      if (place[e] >= 0) value[place[e]] = sign * (f[i] - base[i]) / d->step[r->local[e]];
    }
  }
}

int differences_fill(rows *r, const steif_problem *p, sunrealtype t, N_Vector y, N_Vector yp)
{
  row_differences *d = r->differences;
  if (p->linear) y = yp = d->zero;
  point at = {.p = p, .t = t, .y = y, .yp = yp};
  evaluate(r, &at, y, yp, d->base);
  differ(r, &at, r->A, r->at_A, true);
  if (d->of_E) differ(r, &at, r->E, r->at_E, false);
  return at.code;
}

/* Numbers of size 1/2 to 1 that belong to the unknown, not to the rank. */
static void scatter(const rows *r, N_Vector to)
{
  sunrealtype *v = N_VGetArrayPointer(to);
  for (sunindextype j = 0; j < r->own.rows; j++) {
    const sunrealtype s = sin(12.9898 * (double)(r->own.first + j + 1));
    v[j] = s < 0 ? -0.75 + 0.25 * s : 0.75 + 0.25 * s;
  }
}

/* f(v) - f(0) = A v, or F(v, 0) - F(0, 0) = -A v, F(0, v) - F(0, 0) = E v: row by row. */
static int compare(rows *r, const steif_problem *p, const sunrealtype *value, char which)
{
  row_differences *d = r->differences;
  const sunrealtype *v = N_VGetArrayPointer(d->moved), *f = N_VGetArrayPointer(d->changed),
                    *base = N_VGetArrayPointer(d->base);
  const sunrealtype sign = which == 'A' && d->implicit ? -1 : 1;
  halo_exchange(r, 1, &v);
  for (sunindextype i = 0; i < r->own.rows; i++) {
    sunrealtype sum = 0, size = 0;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      const sunrealtype part = sign * value[k] * r->one[r->local[k]];
      sum += part, size += fabs(part);
    }
    const sunrealtype rounding = 1e-9 * size + 1e-11 * (fabs(base[i]) + fabs(f[i]));
    if (!(fabs(f[i] - base[i] - sum) <= rounding))
      return steif_fail(r->ctx, STEIF_BAD_INPUT,
                        "row %lld of %c depends on unknowns that the pattern of problem '%s' "
                        "does not have there (rank %d): it changes by %g where its entries "
                        "give %g",
                        (long long)(r->own.first + i), which, p->name, r->own.rank,
                        f[i] - base[i], sum);
  }
  return STEIF_OK;
}

int differences_verify(rows *r, const steif_problem *p, sunrealtype t)
{
  row_differences *d = r->differences;
  point at = {.p = p, .t = t, .y = d->zero, .yp = d->zero};
  scatter(r, d->moved);
  evaluate(r, &at, d->moved, d->zero, d->changed);
  int code = compare(r, p, r->a, 'A');
  if (d->of_E) {
    evaluate(r, &at, d->zero, d->moved, d->changed);
    const int of_E = compare(r, p, r->e, 'E');
    code = code ? code : of_E;
  }
  return steif_agree(r->ctx, r->like, at.code ? at.code : code);
}
