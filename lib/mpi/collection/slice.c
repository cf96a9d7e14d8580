/* slice.c: linear systems E x' + F x = f(t) of the collection, or of files and models, over ranks. Every rank builds
 * the whole system and keeps its own rows of E and F, numbered along the graph; f is evaluated whole by all.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "parallel_problem.h"
#include "slice_start.h"
#include <nvector/nvector_serial.h>
#include <steif/data.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Own rows of a matrix, columns in the new numbers. */
typedef struct band {
  sunindextype *at, *column;
  sunrealtype *value;
} band;

typedef struct slice {
  parallel_problem public;
  steif_problem whole;
  steif_context *ctx;
  N_Vector wide,
    at; /* of all unknowns in the numbers of the whole; at: where callbacks read or write the state */
  int most; /* index */
  bool settles;
  slice_kept kept; /* of rank 0 */
  sunindextype n, first, rows;
  sunindextype *own; /* numbers of own rows in the whole */
  band E, A;
  sunrealtype *start, *slope;
  int *index, *sign;
  const char **unknown; /* names of own ones, where they are numbered anew ... */
  char *text;           /* ... and letters of those that have none */
  steif_names names;
} slice;

enum { LETTERS = 24 }; /* of such a name */

/* -- callbacks -------------------------------------------------------------------------------- */

static int copy(const slice *s, const band *from, SUNMatrix M)
{
  const size_t rows = (size_t)s->rows, entries = (size_t)from->at[s->rows];
  memcpy(SM_INDEXPTRS_S(M), from->at, (rows + 1) * sizeof *from->at);
  if (!entries) return 0;
  memcpy(SM_INDEXVALS_S(M), from->column, entries * sizeof *from->column);
  memcpy(SM_DATA_S(M), from->value, entries * sizeof *from->value);
  return 0;
}

static int E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const slice *s = user;
  (void)t, (void)y, (void)yp;
  return copy(s, &s->E, M);
}

static int A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const slice *s = user;
  (void)t, (void)y, (void)yp;
  return copy(s, &s->A, M);
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  const slice *s = user;
  const int code = s->whole.g(t, derivative, s->wide, s->whole.user);
  const sunrealtype *all = N_VGetArrayPointer(s->wide);
  sunrealtype *here = N_VGetArrayPointer(out);
  for (sunindextype k = 0; k < s->rows; k++) here[k] = all[s->own[k]];
  return code;
}

/* The state in s->at: own rows of y, and of other ranks. */
static void gather(slice *s, N_Vector y)
{
  const sunrealtype *here = N_VGetArrayPointer(y);
  sunrealtype *all = N_VGetArrayPointer(s->at);
  const sunindextype most = 1 << 20;
  N_VConst(0, s->at);
  for (sunindextype k = 0; k < s->rows; k++) all[s->own[k]] = here[k];
  for (sunindextype i = 0; i < s->n; i += most)
    MPI_Allreduce(MPI_IN_PLACE, all + i, (int)(s->n - i < most ? s->n - i : most), MPI_DOUBLE,
                  MPI_SUM, NV_COMM_P(y));
}

static void take_own(const slice *s, N_Vector y)
{
  const sunrealtype *all = N_VGetArrayPointer(s->at);
  sunrealtype *here = N_VGetArrayPointer(y);
  for (sunindextype k = 0; k < s->rows; k++) here[k] = all[s->own[k]];
}

static int project(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  slice *s = user;
  (void)yp;
  gather(s, y);
  const int code =
    slice_settle(s->ctx, &s->whole, s->most, t, y, &s->kept, N_VGetArrayPointer(s->at));
  if (!code) take_own(s, y);
  return code;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  slice *s = user;
  const int code = s->whole.exact(t, s->at, yp ? s->wide : NULL, s->whole.user);
  const sunrealtype *slope = N_VGetArrayPointer(s->wide);
  sunrealtype *here = yp ? N_VGetArrayPointer(yp) : NULL;
  take_own(s, y);
  for (sunindextype k = 0; here && k < s->rows; k++) here[k] = slope[s->own[k]];
  return code;
}

/* -- own rows --------------------------------------------------------------------------------- */

/* A visit to entry (i, j) of the whole matrix. */
typedef void visit(slice *s, band *b, const sunindextype *place, sunindextype i, sunindextype j,
                   sunrealtype value);

static void count(slice *s, band *b, const sunindextype *place, sunindextype i, sunindextype j,
                  sunrealtype value)
{
  const sunindextype k = place[i] - s->first;
  (void)j, (void)value;
  if (k >= 0 && k < s->rows) b->at[k + 2]++;
}

static void enter(slice *s, band *b, const sunindextype *place, sunindextype i, sunindextype j,
                  sunrealtype value)
{
  const sunindextype k = place[i] - s->first;
  if (k < 0 || k >= s->rows) return;
  const sunindextype at = b->at[k + 1]++;
  b->column[at] = place[j], b->value[at] = value;
}

static void each(slice *s, band *b, const sunindextype *place, SUNMatrix M, visit *what)
{
  const bool sparse = SUNMatGetID(M) == SUNMATRIX_SPARSE;
  for (sunindextype j = 0; j < s->n; j++)
    if (sparse)
      for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
        what(s, b, place, SM_INDEXVALS_S(M)[k], j, SM_DATA_S(M)[k]);
    else
      for (sunindextype i = 0; i < s->n; i++)
        if (SM_ELEMENT_D(M, i, j) != 0) what(s, b, place, i, j, SM_ELEMENT_D(M, i, j));
}

/* at[k + 1] is where row k begins until its entries have come, and then where it ends. */
static int keep(steif_context *ctx, slice *s, band *b, const sunindextype *place, SUNMatrix M)
{
  b->at = steif_allocate(ctx, (size_t)s->rows + 2, sizeof *b->at);
  if (!b->at) return STEIF_NO_MEMORY;
  each(s, b, place, M, count);
  for (sunindextype k = 1; k <= s->rows; k++) b->at[k + 1] += b->at[k];
  const size_t entries = (size_t)b->at[s->rows + 1] + 1;
  b->column = steif_allocate(ctx, entries, sizeof *b->column);
  b->value = steif_allocate(ctx, entries, sizeof *b->value);
  if (!b->column || !b->value) return STEIF_NO_MEMORY;
  each(s, b, place, M, enter);
  return STEIF_OK;
}

/* Of row k, which is unknown i of the whole. */
static void name(slice *s, sunindextype k, sunindextype i)
{
  const steif_names *names = s->whole.names;
  char *text = s->text + k * LETTERS;
  snprintf(text, LETTERS, "x%lld", (long long)i + 1);
  s->unknown[k] = names && names->unknown ? names->unknown[i] : text;
}

static int own_constraints(steif_context *ctx, slice *s)
{
  const size_t rows = (size_t)s->rows + 1;
  if (!s->whole.constraint) return STEIF_OK;
  s->sign = steif_allocate(ctx, rows, sizeof *s->sign);
  s->unknown = steif_allocate(ctx, rows, sizeof *s->unknown);
  s->text = steif_allocate(ctx, rows, LETTERS);
  if (!s->sign || !s->unknown || !s->text) return STEIF_NO_MEMORY;
  for (sunindextype k = 0; k < s->rows; k++)
    s->sign[k] = s->whole.constraint[s->own[k]], name(s, k, s->own[k]);
  s->names.unknown = s->unknown;
  return STEIF_OK;
}

static int own_numbers(steif_context *ctx, slice *s, const sunindextype *place,
                       const slice_start *all)
{
  const steif_problem *p = &s->whole;
  const size_t rows = (size_t)s->rows + 1;
  s->own = steif_allocate(ctx, rows, sizeof *s->own);
  s->start = steif_allocate(ctx, rows, sizeof *s->start);
  if (p->yp0) s->slope = steif_allocate(ctx, rows, sizeof *s->slope);
  s->index = steif_allocate(ctx, rows, sizeof *s->index);
  if (!s->own || !s->start || (p->yp0 && !s->slope) || !s->index) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < s->n; i++) {
    const sunindextype k = place[i] - s->first;
    if (k < 0 || k >= s->rows) continue;
    s->own[k] = i;
    s->start[k] = all->y[i], s->index[k] = all->index[i];
    if (p->yp0) s->slope[k] = p->yp0[i];
  }
  return own_constraints(ctx, s);
}

/* -- the whole system ------------------------------------------------------------------------- */

static SUNMatrix room(steif_context *ctx, const slice *s, sunindextype nnz)
{
  SUNContext sun = steif_sundials(ctx);
  SUNMatrix M = s->whole.storage == STEIF_SPARSE
                  ? SUNSparseMatrix(s->n, s->n, nnz > 0 ? nnz : s->n, CSC_MAT, sun)
                  : SUNDenseMatrix(s->n, s->n, sun);
  if (!M) steif_fail(ctx, STEIF_NO_MEMORY, "no memory for the matrices of '%s'", s->whole.name);
  return M;
}

static int filled(steif_context *ctx, slice *s, steif_matrix_fill fill, SUNMatrix M)
{
  const steif_problem *p = &s->whole;
  const int returned = fill(p->t0, s->wide, s->wide, M, p->user);
  if (!returned) return STEIF_OK;
  return steif_fail(ctx, STEIF_CALLBACK, "a matrix of '%s' could not be filled: %d", p->name,
                    returned);
}

static int numbered(steif_context *ctx, const slice *s, SUNMatrix M, sunindextype *place)
{
  if (s->whole.storage == STEIF_SPARSE)
    return number_by_levels(ctx, s->n, SM_INDEXPTRS_S(M), SM_INDEXVALS_S(M), place);
  for (sunindextype i = 0; i < s->n; i++) place[i] = i;
  return STEIF_OK;
}

static int cut(steif_context *ctx, slice *s, const slice_start *all)
{
  SUNMatrix e = room(ctx, s, s->whole.nnz_E > 0 ? s->whole.nnz_E : s->whole.nnz);
  SUNMatrix a = room(ctx, s, s->whole.nnz);
  sunindextype *place = steif_allocate(ctx, (size_t)s->n, sizeof *place);
  int code = e && a && place ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) code = filled(ctx, s, s->whole.E, e);
  if (!code) code = filled(ctx, s, s->whole.A, a);
  if (!code) code = numbered(ctx, s, a, place);
  if (!code) code = own_numbers(ctx, s, place, all);
  if (!code) code = keep(ctx, s, &s->E, place, e);
  if (!code) code = keep(ctx, s, &s->A, place, a);
  steif_release(ctx, place);
  if (e) SUNMatDestroy(e);
  if (a) SUNMatDestroy(a);
  return code;
}

/* -- building --------------------------------------------------------------------------------- */

static void describe(slice *s, int index)
{
  const steif_problem *p = &s->whole;
  s->public.problem = (steif_problem){.name = p->name,
                                      .about = p->about,
                                      .n = s->n,
                                      .t0 = p->t0,
                                      .t1 = p->t1,
                                      .y0 = s->start,
                                      .yp0 = s->slope,
                                      .index = s->index,
                                      .constraint = s->sign,
                                      .names = s->sign ? &s->names : NULL,
                                      .dae_index = index,
                                      .E = E,
                                      .A = A,
                                      .g = g,
                                      .storage = STEIF_SPARSE,
                                      .nnz = s->A.at[s->rows],
                                      .nnz_E = s->E.at[s->rows],
                                      .linear = 1,
                                      .breaks = p->breaks,
                                      .break_count = p->break_count,
                                      .project = s->settles ? project : NULL,
                                      .exact = p->exact ? exact : NULL,
                                      .rtol_scale = p->rtol_scale,
                                      .user = s};
}

static sunindextype number(const parallel_problem *public, sunindextype k)
{
  return ((const slice *)public)->own[k];
}

static void release(steif_context *ctx, parallel_problem *public)
{
  slice *s = (slice *)public; /* its first member */
  void *const all[] = {s->own,      s->start,   s->slope, s->index,    s->E.at,
                       s->E.column, s->E.value, s->A.at,  s->A.column, s->A.value,
                       s->sign,     s->unknown, s->text};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) steif_release(ctx, all[i]);
  slice_settle_close(ctx, &s->kept);
  if (s->wide) N_VDestroy(s->wide);
  if (s->at) N_VDestroy(s->at);
  steif_problem_clear(ctx, &s->whole);
  steif_release(ctx, s);
}

static int check(steif_context *ctx, const char *text, const steif_problem *p)
{
  const int form = steif_problem_form(ctx, p);
  if (!form) return steif_status(ctx);
  if (form == STEIF_DESCRIPTOR && p->E && p->A && p->g && !p->events &&
      (p->storage == STEIF_SPARSE || p->storage == STEIF_DENSE)) {
    return STEIF_OK;
  }
  return steif_fail(
    ctx, STEIF_UNSUPPORTED,
    "problem '%s' is not built over ranks: there are heat2d, heat3d, bruss2d, bruss3d, and "
    "linear systems E x' + F x = f such as ladder; write own callbacks for own rows "
    "(steif/mpi.h)",
    text);
}

static int check_index(steif_context *ctx, const char *text, const slice *s, int index)
{
  if (index > 2)
    return steif_fail(
      ctx, STEIF_UNSUPPORTED,
      "'%s' has index %d: over ranks linear systems are solved by iteration, which is not "
      "accurate enough for more than 2; solve it in one process",
      text, index);
  if (index == 2 && s->whole.break_count > 0 && !s->settles)
    return steif_fail(
      ctx, STEIF_UNSUPPORTED,
      "'%s' has index 2 and f a break at t = %g, where unknowns may jump, and its structure is "
      "not certified, by which they would be found over ranks; solve it in one process",
      text, s->whole.breaks[0]);
  return STEIF_OK;
}

static int build(steif_context *ctx, const char *text, slice *s)
{
  if (steif_problem_find(ctx, text, &s->whole)) return steif_status(ctx);
  if (check(ctx, text, &s->whole)) return steif_status(ctx);
  s->n = s->whole.n;
  s->wide = N_VNew_Serial(s->n, steif_sundials(ctx));
  s->at = N_VNew_Serial(s->n, steif_sundials(ctx));
  if (!s->wide || !s->at) return steif_fail(ctx, STEIF_NO_MEMORY, "no memory for '%s'", text);
  N_VConst(0, s->wide);
  return STEIF_OK;
}

static int start_and_rows(steif_context *ctx, const char *text, N_Vector one, slice *s,
                          slice_start *all)
{
  int code = slice_start_find(ctx, &s->whole, one, all);
  if (!code) code = slice_settle_open(ctx, &s->whole, all->most, one, &s->kept, &s->settles);
  if (!code) code = check_index(ctx, text, s, all->most);
  if (!code) code = cut(ctx, s, all);
  memcpy(s->public.message, all->message, sizeof s->public.message);
  s->ctx = ctx, s->most = all->most;
  if (!code) describe(s, all->most);
  return code;
}

int slice_build(steif_context *ctx, const char *text, N_Vector one, parallel_problem **out)
{
  int rank, size;
  slice_start all = {.most = 0};
  MPI_Comm_rank(NV_COMM_P(one), &rank), MPI_Comm_size(NV_COMM_P(one), &size);
  slice *s = steif_allocate(ctx, 1, sizeof *s);
  int code = steif_agree(ctx, one, s ? build(ctx, text, s) : STEIF_NO_MEMORY);
  if (!s) return code;
  *out = &s->public;
  s->public.number = number, s->public.release = release;
  if (code) return code;
  s->first = s->n * rank / size, s->rows = s->n * (rank + 1) / size - s->first;
  s->public.rows = s->rows;
  code = start_and_rows(ctx, text, one, s, &all);
  slice_start_clear(ctx, &all);
  return code;
}
