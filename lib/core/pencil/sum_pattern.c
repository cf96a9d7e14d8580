/* sum_pattern.c: the union of two sparse patterns, built once, so that s E - A is assembled in one
 * pass over the entries of E and A.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sum_pattern.h"
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static sunindextype count(SUNMatrix M) { return SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)]; }

static int check(steif_pencil *p, const char *name, SUNMatrix M)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M), n = p->n;
  STEIF_CHECK(ptr[0] == 0, p->ctx, STEIF_BAD_INPUT,
              "column 1 of %s starts at entry %lld: column pointers start at 0", name,
              (long long)ptr[0]);
  for (sunindextype j = 0; j < n; j++) {
    STEIF_CHECK(
      ptr[j] <= ptr[j + 1] && ptr[j + 1] <= SM_NNZ_S(M), p->ctx, STEIF_BAD_INPUT,
      "column %lld of %s holds the entries %lld to %lld of %lld: column pointers must "
      "rise and end within the matrix",
      (long long)j + 1, name, (long long)ptr[j], (long long)ptr[j + 1], (long long)SM_NNZ_S(M));
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      STEIF_CHECK(
        row[k] >= 0 && row[k] < n, p->ctx, STEIF_BAD_INPUT,
        "column %lld of %s has an entry with the row index %lld: C indices of rows run "
        "from 0 to %lld",
        (long long)j + 1, name, (long long)row[k], (long long)n - 1);
  }
  return STEIF_OK;
}

static int allocate(steif_pencil *p, stf_pattern *u, sunindextype nE, sunindextype nA)
{
  const size_t n = (size_t)p->n, e = (size_t)nE, a = (size_t)nA;
  u->ptr = stf_allocate(p->ctx, n + 1, sizeof *u->ptr);
  u->row = stf_allocate(p->ctx, e + a, sizeof *u->row);
  u->placeE = stf_allocate(p->ctx, e, sizeof *u->placeE);
  u->placeA = stf_allocate(p->ctx, a, sizeof *u->placeA);
  u->ptrE = stf_allocate(p->ctx, n + 1, sizeof *u->ptrE);
  u->ptrA = stf_allocate(p->ctx, n + 1, sizeof *u->ptrA);
  return u->ptr && u->row && u->placeE && u->placeA && u->ptrE && u->ptrA ? STEIF_OK
                                                                          : STEIF_NO_MEMORY;
}

/* Rows of one column join the union; seen[i] - 1 is where row i is in it, if not before `start`. */
static void join(stf_pattern *u, sunindextype start, const sunindextype *row, sunindextype from,
                 sunindextype to, sunindextype *seen, sunindextype *place)
{
  for (sunindextype k = from; k < to; k++) {
    const sunindextype i = row[k];
    if (seen[i] <= start) {
      u->row[u->nnz] = i;
      seen[i] = ++u->nnz;
    }
    place[k] = seen[i] - 1;
  }
}

static void unite(steif_pencil *p, stf_pattern *u, sunindextype *seen)
{
  const sunindextype *rowE = p->E ? SM_INDEXVALS_S(p->E) : NULL, *rowA = SM_INDEXVALS_S(p->A);
  for (sunindextype j = 0; j < p->n; j++) {
    const sunindextype start = u->nnz;
    u->ptr[j] = start;
    join(u, start, rowA, u->ptrA[j], u->ptrA[j + 1], seen, u->placeA);
    if (rowE)
      join(u, start, rowE, u->ptrE[j], u->ptrE[j + 1], seen, u->placeE);
    else
      join(u, start, &j, 0, 1, seen, &u->placeE[j]);
  }
  u->ptr[p->n] = u->nnz;
  u->straight = u->nnz == u->ptrA[p->n];
  for (sunindextype k = 0; u->straight && k < u->nnz; k++) u->straight = u->placeA[k] == k;
}

/* Room for values on the union, where those of E and A are not there already. */
static int values(steif_pencil *p, stf_pattern *u)
{
  const size_t nnz = (size_t)u->nnz;
  if (p->E && !(u->e = stf_allocate(p->ctx, nnz, sizeof *u->e))) return STEIF_NO_MEMORY;
  if (!u->straight && !(u->a = stf_allocate(p->ctx, nnz, sizeof *u->a))) return STEIF_NO_MEMORY;
  return STEIF_OK;
}

int stf_pattern_build(steif_pencil *p, stf_pattern *u)
{
  const size_t bytes = (size_t)(p->n + 1) * sizeof(sunindextype);
  memset(u, 0, sizeof *u);
  if (p->E) STEIF_TRY(check(p, "E", p->E));
  STEIF_TRY(check(p, "A", p->A));
  u->n = p->n;
  STEIF_TRY(allocate(p, u, p->E ? count(p->E) : p->n, count(p->A)));
  sunindextype *seen = stf_allocate(p->ctx, (size_t)p->n, sizeof *seen);
  if (!seen) return STEIF_NO_MEMORY;
  if (p->E) memcpy(u->ptrE, SM_INDEXPTRS_S(p->E), bytes);
  memcpy(u->ptrA, SM_INDEXPTRS_S(p->A), bytes);
  unite(p, u, seen);
  stf_release(p->ctx, seen);
  return values(p, u);
}

static bool same(const stf_pattern *u, SUNMatrix M, const sunindextype *ptr,
                 const sunindextype *place)
{
  const sunindextype *row = SM_INDEXVALS_S(M);
  if (memcmp(SM_INDEXPTRS_S(M), ptr, (size_t)(u->n + 1) * sizeof *ptr)) return false;
  SuiteSparse_long differ = 0;
  for (sunindextype k = 0; k < ptr[u->n]; k++) differ |= row[k] ^ u->row[place[k]];
  return !differ;
}

static bool unchanged(const steif_pencil *p, const stf_pattern *u)
{
  return (!p->E || same(u, p->E, u->ptrE, u->placeE)) && same(u, p->A, u->ptrA, u->placeA);
}

void stf_pattern_free(steif_pencil *p, stf_pattern *u)
{
  stf_release(p->ctx, u->ptr);
  stf_release(p->ctx, u->row);
  stf_release(p->ctx, u->placeE);
  stf_release(p->ctx, u->placeA);
  stf_release(p->ctx, u->ptrE);
  stf_release(p->ctx, u->ptrA);
  stf_release(p->ctx, u->e);
  stf_release(p->ctx, u->a);
  memset(u, 0, sizeof *u);
}

static void gather(double *restrict to, sunindextype nnz, const double *restrict from,
                   const sunindextype *restrict place, sunindextype count)
{
  memset(to, 0, (size_t)nnz * sizeof *to);
  for (sunindextype k = 0; k < count; k++) to[place[k]] += from[k];
}

static double largest(const double *restrict a, sunindextype count)
{
  double most = 0;
  for (sunindextype k = 0; k < count; k++) most = fabs(a[k]) > most ? fabs(a[k]) : most;
  return most;
}

static void fill(const steif_pencil *p, stf_pattern *u)
{
  if (u->e) gather(u->e, u->nnz, SM_DATA_S(p->E), u->placeE, u->ptrE[u->n]);
  if (u->a) gather(u->a, u->nnz, SM_DATA_S(p->A), u->placeA, u->ptrA[u->n]);
  u->most_e = u->e ? largest(u->e, u->nnz) : 1;
  u->most_a = largest(stf_pattern_A(p, u), u->nnz);
}

bool stf_pattern_moderate(const stf_pattern *u, steif_shift s)
{
  return isfinite(fmax(fabs(s.re), fabs(s.im)) * u->most_e + u->most_a);
}

const double *stf_pattern_A(const steif_pencil *p, const stf_pattern *u)
{
  return u->a ? u->a : SM_DATA_S(p->A);
}

/* The identity has few places, E as many as A or nearly. */
static void shift_identity(const stf_pattern *u, steif_shift s, bool complex,
                           double *restrict v)
{
  const sunindextype *restrict place = u->placeE;
  for (sunindextype k = 0; k < u->n; k++)
    if (complex)
      v[2 * place[k]] += s.re, v[2 * place[k] + 1] = s.im;
    else
      v[place[k]] += s.re;
}

void stf_pattern_assemble(const steif_pencil *p, const stf_pattern *u, steif_shift s,
                          double *restrict v)
{
  const bool complex = stf_is_complex(s);
  const double *restrict e = u->e, *restrict a = stf_pattern_A(p, u);
  const sunindextype nnz = u->nnz;
  if (e && complex)
    for (sunindextype k = 0; k < nnz; k++)
      v[2 * k] = s.re * e[k] - a[k], v[2 * k + 1] = s.im * e[k];
  else if (e)
    for (sunindextype k = 0; k < nnz; k++) v[k] = s.re * e[k] - a[k];
  else if (complex)
    for (sunindextype k = 0; k < nnz; k++) v[2 * k] = -a[k], v[2 * k + 1] = 0;
  else
    for (sunindextype k = 0; k < nnz; k++) v[k] = -a[k];
  if (!e) shift_identity(u, s, complex, v);
}

/* The first entry of M that is NaN or infinite. */
static int finite(steif_pencil *p, const char *name, SUNMatrix M)
{
  const sunindextype *ptr = SM_INDEXPTRS_S(M);
  const double *x = SM_DATA_S(M);
  if (stf_all_finite(x, (size_t)ptr[p->n])) return STEIF_OK;
  sunindextype k = 0, j = 0;
  while (stf_all_finite(x + k, 1)) k++;
  while (ptr[j + 1] <= k) j++;
  return STEIF_FAIL(p->ctx, STEIF_NOT_FINITE,
                    "entry (%lld, %lld) of %s is %g: look at the function that fills it, "
                    "or whose differences do",
                    (long long)SM_INDEXVALS_S(M)[k] + 1, (long long)j + 1, name, x[k]);
}

int stf_pattern_update(steif_pencil *p, stf_pattern *u, bool analysed,
                       int (*analyse)(steif_pencil *), void (*forget)(steif_pencil *))
{
  if (!analysed || !unchanged(p, u)) {
    const int code = analyse(p);
    if (code) forget(p);
    STEIF_TRY(code);
  }
  if (p->E) STEIF_TRY(finite(p, "E", p->E));
  STEIF_TRY(finite(p, "A", p->A));
  fill(p, u);
  return STEIF_OK;
}
