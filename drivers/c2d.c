/* c2d.c: x' = A x + B u on a time grid.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* By columns; x is NULL when there is no such matrix. */
struct matrix {
  long rows, columns;
  double *x;
};

static void spread(SUNMatrix S, struct matrix *M)
{
  const sunindextype *start = SUNSparseMatrix_IndexPointers(S);
  const sunindextype *row = SUNSparseMatrix_IndexValues(S);
  const double *value = SUNSparseMatrix_Data(S);
  for (long j = 0; j < M->columns; j++)
    for (sunindextype k = start[j]; k < start[j + 1]; k++)
      M->x[row[k] + j * M->rows] += value[k];
}

/* rows, columns: what they should be, 0: anything. */
static int read(struct call *call, const char *path, long rows, long columns, struct matrix *M)
{
  SUNMatrix S = steif_matrix_read(call->ctx, path);
  if (!S) {
    const int code = fail(call);
    return code == EXIT_USAGE || code == EXIT_FAILED ? EXIT_FILE : code;
  }
  const bool sparse = SUNMatGetID(S) == SUNMATRIX_SPARSE;
  M->rows = (long)(sparse ? SUNSparseMatrix_Rows(S) : SUNDenseMatrix_Rows(S));
  M->columns = (long)(sparse ? SUNSparseMatrix_Columns(S) : SUNDenseMatrix_Columns(S));
  const bool fits = (!rows || rows == M->rows) && (!columns || columns == M->columns);
  const size_t count = (size_t)M->rows * (size_t)M->columns;
  if (fits && M->rows <= 10000 && M->columns <= 10000) M->x = calloc(count + 1, sizeof *M->x);
  if (M->x && sparse) spread(S, M);
  if (M->x && !sparse) memcpy(M->x, SUNDenseMatrix_Data(S), count * sizeof *M->x);
  SUNMatDestroy(S);
  if (M->x) return EXIT_OK;
  if (fits)
    say(call, "'%s' is %ld x %ld, too large for a dense matrix; take fewer states", path,
        M->rows, M->columns);
  else
    say(call, "'%s' is %ld x %ld and should have %ld %s; correct it", path, M->rows, M->columns,
        rows && rows != M->rows ? rows : columns, rows && rows != M->rows ? "rows" : "columns");
  return fits ? EXIT_FAILED : EXIT_FILE;
}

struct files {
  struct matrix A, B, C, D;
};

static int open(struct call *call, struct files *f)
{
  const char *C = word_of(call, "--C", NULL), *D = word_of(call, "--D", NULL);
  if (D && (!C || call->words < 2))
    return refuse(call, "--D needs B.mtx and --C, whose sizes it joins; give them too");
  int code = read(call, call->word[0], 0, 0, &f->A);
  if (!code && f->A.rows != f->A.columns) {
    say(call, "'%s' is %ld x %ld; A of x' = A x + B u must be square", call->word[0], f->A.rows,
        f->A.columns);
    code = EXIT_FILE;
  }
  const long n = f->A.rows;
  if (!code && call->words > 1) code = read(call, call->word[1], n, 0, &f->B);
  if (!code && C) code = read(call, C, 0, n, &f->C);
  if (!code && D) code = read(call, D, f->C.rows, f->B.columns, &f->D);
  return code;
}

static void put(steif_report *r, const char *name, int rows, int columns, const double *x)
{
  const size_t count = (size_t)rows * (size_t)columns;
  double *by_rows = malloc((count + 1) * sizeof *by_rows);
  for (int i = 0; by_rows && i < rows; i++)
    for (int j = 0; j < columns; j++) by_rows[i * columns + j] = x[i + rows * j];
  if (by_rows) steif_report_matrix(r, name, (size_t)rows, (size_t)columns, by_rows);
  free(by_rows);
}

static void fill(steif_report *r, const steif_discrete *d)
{
  const steif_state_space *s = &d->form;
  steif_report_text(r, "scheme", d->scheme);
  steif_report_real(r, "dt", d->dt);
  put(r, "Ad", s->n, s->n, s->A);
  put(r, "Bd", s->n, s->m, s->B);
  put(r, "B1", s->n, s->m, d->B1);
  if (s->p) put(r, "Cd", s->p, s->n, s->C);
  if (s->p) put(r, "Dd", s->p, s->m, s->D);
  put(r, "eigenvalues", s->n, 2, d->re); /* the imaginary parts follow */
  steif_report_real(r, "alias", d->alias);
}

static int tell(struct call *call, const steif_discrete *d)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  fill(r, d);
  const int code = present(call, r);
  steif_report_free(&r);
  if (!code && d->alias >= 1)
    say(call,
        "the largest |Im l| dt is %.4g pi: frequencies alias and cannot be recovered from the "
        "samples; shorten dt",
        d->alias);
  return code;
}

/* The scheme with its parameter; `text` has room for it. */
static int scheme(struct call *call, char *text, size_t room)
{
  const char *name = word_of(call, "--scheme", "zoh");
  const char *W = word_of(call, "--prewarp", NULL), *alpha = word_of(call, "--alpha", NULL);
  if (!given(call, "--dt"))
    return refuse(call, "--dt H, the step, is needed: steif c2d A.mtx B.mtx --dt 0.1");
  const int length = W       ? snprintf(text, room, "%s:w=%s", name, W)
                     : alpha ? snprintf(text, room, "%s:alpha=%s", name, alpha)
                             : snprintf(text, room, "%s", name);
  if (length < 0 || (size_t)length >= room)
    return refuse(
      call, "the scheme \"%.20s...\" is too long; 'steif list schemes' has them all", name);
  return EXIT_OK;
}

static int run(struct call *call)
{
  char text[200];
  struct files f = {{0}, {0}, {0}, {0}};
  steif_discrete d = {0};
  if (call->plot) return refuse(call, "c2d has no picture; leave --plot out");
  int code = scheme(call, text, sizeof text);
  if (!code) code = open(call, &f);
  if (!code) {
    const steif_state_space s = {
      (int)f.A.rows, (int)f.B.columns, (int)f.C.rows, f.A.x, f.B.x, f.C.x, f.D.x};
    if (steif_c2d(call->ctx, &s, text, real_of(call, "--dt", 0), &d)) code = fail(call);
  }
  if (!code) code = tell(call, &d);
  steif_discrete_clear(call->ctx, &d);
  free(f.A.x), free(f.B.x), free(f.C.x), free(f.D.x);
  return code;
}

static const struct option options[] = {
  {"--dt", POSITIVE, "H", "the step"},
  {"--scheme", WORD, "S", "zoh, foh, bilinear, ...: 'steif list schemes' (default zoh)"},
  {"--prewarp", POSITIVE, "W", "frequency at which bilinear is exact"},
  {"--alpha", REAL, "A", "of gbt, from 0 (forward) to 1 (backward)"},
  {"--C", WORD, "C.mtx", "y = C x + D u: gives Cd and Dd as well"},
  {"--D", WORD, "D.mtx", "default 0"},
  {NULL, FLAG, NULL, NULL}};

static const char *const clash[][2] = {{"--prewarp", "--alpha"}, {NULL, NULL}};

const struct verb verb_c2d = {
  "c2d", "Discretise x' = A x + B u", "A.mtx [B.mtx] --dt H [--scheme S]", 1, 2, options, clash,
  run};
