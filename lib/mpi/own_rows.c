/* own_rows.c: own rows of E and A, filled by callbacks, on the union of their patterns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "row_differences.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static int open_owners(rows *r, N_Vector like)
{
  owners *o = &r->own;
  o->n = N_VGetLength(like);
  o->rows = NV_LOCLENGTH_P(like);
  MPI_Comm_rank(NV_COMM_P(like), &o->rank);
  MPI_Comm_size(NV_COMM_P(like), &o->size);
  o->start = steif_allocate(r->ctx, (size_t)o->size + 1, sizeof *o->start);
  MPI_TRY(steif_agree(r->ctx, like, o->start ? STEIF_OK : STEIF_NO_MEMORY));
  MPI_Comm_dup(NV_COMM_P(like), &o->comm);
  const long long own = o->rows;
  long long *all = (long long *)o->start; /* 64 bits both, or unpacked from the end below */
  _Static_assert(sizeof(sunindextype) == sizeof(long long), "64-bit indices");
  MPI_Allgather(&own, 1, MPI_LONG_LONG, all + 1, 1, MPI_LONG_LONG, o->comm);
  for (int k = 0; k < o->size; k++) o->start[k + 1] += o->start[k];
  o->first = o->start[o->rank];
  if (o->start[o->size] != o->n)
    return steif_fail(r->ctx, STEIF_BAD_INPUT,
                      "the rows of %d ranks are %lld together and the vector has %lld", o->size,
                      (long long)o->start[o->size], (long long)o->n);
  return STEIF_OK;
}

static SUNMatrix matrix(rows *r, sunindextype nnz)
{
  const owners *o = &r->own;
  SUNMatrix M =
    SUNSparseMatrix(o->rows ? o->rows : 1, o->n, nnz > 0 ? nnz : 1, CSR_MAT, r->like->sunctx);
  if (!M)
    steif_fail(r->ctx, STEIF_NO_MEMORY, "no memory for %lld entries of rows on rank %d",
               (long long)nnz, o->rank);
  return M;
}

static int open_matrices(rows *r, const steif_problem *p)
{
  const bool differ = differences_needed(p);
  if (differ) MPI_TRY(differences_check(r, p));
  const sunindextype nnz = differ && r->own.rows ? p->pattern->column[r->own.rows] : p->nnz;
  if (!(r->A = matrix(r, nnz))) return STEIF_NO_MEMORY;
  r->identity = !p->E && !(differ && p->F);
  if (!r->identity && !(r->E = matrix(r, p->E && p->nnz_E ? p->nnz_E : nnz)))
    return STEIF_NO_MEMORY;
  return STEIF_OK;
}

int rows_open(rows *r, steif_context *ctx, const steif_problem *p, N_Vector like)
{
  r->ctx = ctx, r->like = like;
  MPI_TRY(open_owners(r, like));
  int code = STEIF_OK;
  if (p->n != r->own.n)
    code = steif_fail(ctx, STEIF_BAD_INPUT,
                      "problem '%s' has n = %lld and the rows of %d ranks are %lld together",
                      p->name, (long long)p->n, r->own.size, (long long)r->own.n);
  else if (!p->A && !differences_needed(p))
    code =
      steif_fail(ctx, STEIF_BAD_INPUT,
                 "problem '%s' has neither .A nor .pattern: steif_mpi_open needs own rows of "
                 "A, in CSR_MAT, or the pattern of own rows",
                 p->name);
  else if (p->n >= INT_MAX || p->nnz >= INT_MAX)
    code =
      steif_fail(ctx, STEIF_UNSUPPORTED,
                 "%lld unknowns, or %lld entries on rank %d, exceed the 32-bit integers of "
                 "hypre and MUMPS",
                 (long long)p->n, (long long)p->nnz, r->own.rank);
  else
    code = open_matrices(r, p);
  return steif_agree(ctx, like, code);
}

/* -- what a callback filled ------------------------------------------------------------------- */

static int check(const rows *r, SUNMatrix M, char which)
{
  const sunindextype *at = SM_INDEXPTRS_S(M), *column = SM_INDEXVALS_S(M);
  const sunrealtype *value = SM_DATA_S(M);
  const sunindextype rows_here = r->own.rows;
  if (rows_here && (at[0] != 0 || at[rows_here] > SM_NNZ_S(M)))
    return steif_fail(r->ctx, STEIF_BAD_INPUT,
                      "%c has %lld entries on rank %d, and room for %lld (.nnz)", which,
                      (long long)at[rows_here], r->own.rank, (long long)SM_NNZ_S(M));
  for (sunindextype i = 0; i < rows_here; i++) /* all of them, before one is followed */
    if (at[i + 1] < at[i])
      return steif_fail(r->ctx, STEIF_BAD_INPUT,
                        "the index pointers of %c decrease at row %lld (rank %d)", which,
                        (long long)(r->own.first + i), r->own.rank);
  for (sunindextype i = 0; i < rows_here; i++) {
    const long long row = (long long)(r->own.first + i);
    for (sunindextype k = at[i]; k < at[i + 1]; k++) {
      if (column[k] < 0 || column[k] >= r->own.n)
        return steif_fail(r->ctx, STEIF_BAD_INPUT,
                          "column %lld in row %lld of %c is outside 0 .. %lld (rank %d)",
                          (long long)column[k], row, which, (long long)r->own.n - 1,
                          r->own.rank);
      if (!isfinite(value[k]))
        return steif_fail(r->ctx, STEIF_NOT_FINITE, "%c(%lld, %lld) is %g (rank %d)", which,
                          row, (long long)column[k], value[k], r->own.rank);
    }
  }
  return STEIF_OK;
}

/* A callback that cannot: its number, and what it means. */
static int filled(rows *r, const steif_problem *p, steif_matrix_fill fill, char which,
                  sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M)
{
  SUNMatZero(M);
  const int returned = fill(t, y, yp, M, p->user);
  if (!returned) return check(r, M, which);
  return steif_fail(r->ctx, STEIF_CALLBACK,
                    "%c of problem '%s' returned %d at t = %g on rank %d", which, p->name,
                    returned, t, r->own.rank);
}

/* -- the union of the patterns ---------------------------------------------------------------- */

typedef struct place {
  sunindextype column, at; /* at >= 0: of A; -1: the diagonal; <= -2: of E */
} place;

static int by_column(const void *a, const void *b)
{
  const place *x = a, *y = b;
  if (x->column != y->column) return x->column < y->column ? -1 : 1;
  return (x->at < y->at) - (x->at > y->at);
}

static sunindextype count_of(SUNMatrix M, sunindextype rows_here)
{
  return M && rows_here ? SM_INDEXPTRS_S(M)[rows_here] : 0;
}

static bool same_pattern(const rows *r)
{
  const sunindextype entries = count_of(r->A, r->own.rows);
  if (!r->row_at || !r->seen_pointer) return false;
  return !memcmp(r->seen_pointer, SM_INDEXPTRS_S(r->A),
                 (size_t)(r->own.rows + 1) * sizeof(sunindextype)) &&
         !memcmp(r->seen_column, SM_INDEXVALS_S(r->A), (size_t)entries * sizeof(sunindextype));
}

static void forget(rows *r)
{
  halo_close(r);
  void *const all[] = {r->seen_pointer, r->seen_column, r->row_at, r->column, r->local,
                       r->at_A,         r->at_E,        r->e,      r->a};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(r->ctx, all[i]);
  r->seen_pointer = r->seen_column = r->row_at = r->column = r->local = r->at_A = r->at_E =
    NULL;
  r->e = r->a = NULL;
  r->entries = r->room = 0;
}

bool rows_united(const rows *r) { return r->row_at != NULL; }

static int claim(rows *r)
{
  const size_t of_A = (size_t)count_of(r->A, r->own.rows);
  r->room = count_of(r->A, r->own.rows) + count_of(r->E, r->own.rows) + r->own.rows;
  const size_t room = (size_t)r->room + 1, index = sizeof(sunindextype);
  r->seen_pointer = steif_allocate(r->ctx, (size_t)r->own.rows + 1, index);
  r->seen_column = steif_allocate(r->ctx, of_A + 1, index);
  r->row_at = steif_allocate(r->ctx, (size_t)r->own.rows + 1, index);
  sunindextype **const each[] = {&r->column, &r->local, &r->at_A, &r->at_E};
  for (int i = 0; i < 4; i++)
    if (!(*each[i] = steif_allocate(r->ctx, room, index))) return STEIF_NO_MEMORY;
  r->e = steif_allocate(r->ctx, room, sizeof *r->e);
  r->a = steif_allocate(r->ctx, room, sizeof *r->a);
  return r->seen_pointer && r->seen_column && r->row_at && r->e && r->a ? STEIF_OK
                                                                        : STEIF_NO_MEMORY;
}

/* The entries of row i, with the diagonal for E = I. Returns how many. */
static sunindextype gather(const rows *r, sunindextype i, place *all)
{
  sunindextype used = 0;
  for (sunindextype k = SM_INDEXPTRS_S(r->A)[i]; k < SM_INDEXPTRS_S(r->A)[i + 1]; k++)
    all[used++] = (place){SM_INDEXVALS_S(r->A)[k], k};
  if (r->identity) all[used++] = (place){r->own.first + i, -1};
  if (r->E)
    for (sunindextype k = SM_INDEXPTRS_S(r->E)[i]; k < SM_INDEXPTRS_S(r->E)[i + 1]; k++)
      all[used++] = (place){SM_INDEXVALS_S(r->E)[k], -2 - k};
  qsort(all, (size_t)used, sizeof *all, by_column);
  return used;
}

static int unite(rows *r)
{
  place *all = steif_allocate(r->ctx, (size_t)r->room + 1, sizeof *all);
  if (!all) return STEIF_NO_MEMORY;
  sunindextype used = 0;
  int code = STEIF_OK;
  for (sunindextype i = 0; i < r->own.rows && !code; i++) {
    const sunindextype count = gather(r, i, all);
    r->row_at[i] = used;
    for (sunindextype k = 0; k < count; k++) {
      const bool fresh = k == 0 || all[k].column != all[k - 1].column;
      if (!fresh && (all[k].at >= 0) == (all[k - 1].at >= 0))
        code = steif_fail(r->ctx, STEIF_BAD_INPUT,
                          "row %lld has column %lld twice (rank %d): add the entries up",
                          (long long)(r->own.first + i), (long long)all[k].column, r->own.rank);
      if (fresh) r->at_A[used] = r->at_E[used] = -1, r->column[used++] = all[k].column;
      if (all[k].at >= 0) r->at_A[used - 1] = all[k].at;
      if (all[k].at < -1) r->at_E[used - 1] = -2 - all[k].at;
      r->e[used - 1] = all[k].at == -1 ? 1 : fresh ? 0 : r->e[used - 1];
    }
    r->row_at[i + 1] = used;
  }
  r->entries = used;
  steif_release(r->ctx, all);
  return code;
}

static int remember(rows *r)
{
  const sunindextype rows_here = r->own.rows;
  forget(r);
  MPI_TRY(claim(r));
  memcpy(r->seen_pointer, SM_INDEXPTRS_S(r->A), (size_t)(rows_here + 1) * sizeof(sunindextype));
  memcpy(r->seen_column, SM_INDEXVALS_S(r->A),
         (size_t)count_of(r->A, rows_here) * sizeof(sunindextype));
  return unite(r);
}

/* A union that lacks something on one rank is none on all of them. */
static int renew_pattern(rows *r)
{
  int changed = !same_pattern(r);
  MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPI_INT, MPI_MAX, r->own.comm);
  if (!changed) return STEIF_OK;
  int code = steif_agree(r->ctx, r->like, remember(r));
  if (!code) code = halo_open(r);
  if (code)
    forget(r);
  else
    r->revision++;
  return code;
}

/* The colours once, then the values, which are to be finite. */
static int differ(rows *r, const steif_problem *p, sunrealtype t, N_Vector y, N_Vector yp)
{
  if (!r->differences) MPI_TRY(differences_open(r, p));
  int code = differences_fill(r, p, t, y, yp);
  if (!code) code = check(r, r->A, 'A');
  if (!code && r->E) code = check(r, r->E, 'E');
  return steif_agree(r->ctx, r->like, code);
}

int rows_fill(rows *r, const steif_problem *p, sunrealtype t, N_Vector y, N_Vector yp)
{
  const bool differs = differences_needed(p);
  int code = STEIF_OK;
  if (!differs)
    code = filled(r, p, p->A, 'A', t, y, yp, r->A);
  else if (!r->revision)
    differences_pattern(r, p);
  if (!code && p->E && !r->revision) code = filled(r, p, p->E, 'E', t, y, yp, r->E);
  MPI_TRY(steif_agree(r->ctx, r->like, code));
  r->stats.fills++;
  MPI_TRY(renew_pattern(r));
  if (differs) MPI_TRY(differ(r, p, t, y, yp));
  for (sunindextype k = 0; k < r->entries; k++) {
    r->a[k] = r->at_A[k] < 0 ? 0 : SM_DATA_S(r->A)[r->at_A[k]];
    if (r->at_E[k] >= 0) r->e[k] = SM_DATA_S(r->E)[r->at_E[k]];
  }
  return differs && p->linear ? differences_verify(r, p, t) : STEIF_OK;
}

void rows_close(rows *r)
{
  differences_close(r);
  forget(r);
  if (r->A) SUNMatDestroy(r->A);
  if (r->E) SUNMatDestroy(r->E);
  if (r->own.comm && r->own.comm != MPI_COMM_NULL) MPI_Comm_free(&r->own.comm);
  steif_release(r->ctx, r->own.start);
  *r = (rows){0};
}
