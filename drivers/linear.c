/* linear.c: descriptor systems from files, or from the collection.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear.h"
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static bool ends(const char *word, const char *ending)
{
  const size_t length = strlen(word), tail = strlen(ending);
  return length > tail && !strcmp(word + length - tail, ending);
}

bool linear_is_file(const char *word)
{
  return ends(word, ".mtx") || ends(word, ".mat") || strchr(word, '/');
}

static int bad_file(const struct call *call)
{
  const int code = fail(call);
  return code == EXIT_USAGE || code == EXIT_FAILED ? EXIT_FILE : code;
}

int linear_fail(const struct call *call)
{
  const int code = steif_status(call->ctx);
  bool file = given(call, "--x0") || given(call, "--forcing");
  for (int i = 0; i < call->words; i++) file = file || linear_is_file(call->word[i]);
  const bool blamed =
    (code == STEIF_BAD_INPUT && !given(call, "--f") && !given(call, "--points")) ||
    code == STEIF_NOT_FINITE;
  return blamed && file ? bad_file(call) : fail(call);
}

/* "equations 3 (current at b), 4, 7, ..." and likewise unknowns, counted from 1. */
static const char *named(char *text, size_t room, const char *what, const char *const *name,
                         long count, const sunindextype *value)
{
  enum { SHOWN = 8 };
  size_t used = (size_t)snprintf(text, room, "%s%s", what, count == 1 ? "" : "s");
  for (long i = 0; i < count && i < SHOWN && used < room; i++) {
    const long k = (long)value[i];
    used += (size_t)snprintf(text + used, room - used, name ? "%s %ld (%.40s)" : "%s %ld",
                             i ? "," : "", k + 1, name ? name[k] : "");
  }
  if (count > SHOWN && used < room) snprintf(text + used, room - used, ", ...");
  return text;
}

int linear_singular(const struct call *call, const struct linear *l, const steif_structure *s)
{
  char one[512], two[512];
  const bool equations = s->equations_count, unknowns = s->unknowns_count;
  const steif_names none = {NULL, NULL}, *names = l->names ? l->names : &none;
  named(one, sizeof one, "equation", names->equation, (long)s->equations_count, s->equations);
  named(two, sizeof two, "unknown", names->unknown, (long)s->unknowns_count, s->unknowns);
  say(call, "%s%s%s%s%s", s->message, equations || unknowns ? "; look at " : "",
      equations ? one : "", equations && unknowns ? " and " : "", unknowns ? two : "");
  return EXIT_SINGULAR;
}

/* ---- matrices ---- */

static bool is_sparse(SUNMatrix M) { return SUNMatGetID(M) == SUNMATRIX_SPARSE; }

static sunindextype rows(SUNMatrix M)
{
  return is_sparse(M) ? SUNSparseMatrix_Rows(M) : SUNDenseMatrix_Rows(M);
}

static void negate(SUNMatrix M)
{
  const sunindextype n = rows(M);
  double *x = is_sparse(M) ? SUNSparseMatrix_Data(M) : SUNDenseMatrix_Data(M);
  const sunindextype count =
    is_sparse(M) ? SUNSparseMatrix_IndexPointers(M)[n] : SUNDenseMatrix_LData(M);
  for (sunindextype i = 0; i < count; i++) x[i] = -x[i];
}

static int from_files(struct call *call, struct linear *l, int from)
{
  const char *first = call->word[from],
             *second = call->words > from + 1 ? call->word[from + 1] : NULL;
  const bool one = ends(first, ".mat");
  if (one && second) return refuse(call, "%s holds both matrices; leave %s out", first, second);
  if (!one && !second)
    return refuse(call, "%s is E, the second file is missing: E.mtx F.mtx", first);
  if (one && given(call, "--state-space"))
    return refuse(call,
                  "--state-space is for two files; a .mat file tells by the name, F or A");
  if (steif_system_read(call->ctx, first, second, &l->system.E, &l->system.F))
    return bad_file(call);
  l->n = rows(l->system.E);
  if (given(call, "--state-space")) negate(l->system.F);
  return EXIT_OK;
}

int linear_no_memory(const struct call *call, const char *what)
{
  say(call, "no memory for the %s; give the process more", what);
  return EXIT_FAILED;
}

static int from_collection(struct call *call, struct linear *l, int from)
{
  const char *name = call->word[from];
  if (call->words > from + 1)
    return refuse(call, "\"%s\" is one word too many after the problem %s",
                  call->word[from + 1], name);
  if (given(call, "--state-space"))
    return refuse(call, "--state-space is for files; leave it out with the problem %s", name);
  if (steif_problem_find(call->ctx, name, &l->problem)) return fail(call);
  if (steif_linear_of(call->ctx, &l->problem, &l->system)) return fail(call);
  l->n = l->problem.n, l->t0 = l->problem.t0;
  l->x0 = malloc((size_t)l->n * sizeof *l->x0);
  if (!l->x0) return linear_no_memory(call, "start values");
  memcpy(l->x0, l->problem.y0, (size_t)l->n * sizeof *l->x0);
  l->names = l->problem.names;
  return EXIT_OK;
}

static int read_names(struct call *call, struct linear *l)
{
  const char *path = word_of(call, "--names", call->word[call->words - 1]);
  if (!given(call, "--names") && !ends(path, ".mat")) return EXIT_OK;
  if (steif_names_read(call->ctx, path, l->n, &l->read)) return bad_file(call);
  if (l->read) l->names = l->read;
  return EXIT_OK;
}

/* ---- x(0-) and f ---- */

static void column_of(SUNMatrix X, long n, double *x)
{
  for (long i = 0; i < n; i++) x[i] = is_sparse(X) ? 0 : SUNDenseMatrix_Data(X)[i];
  for (sunindextype p = 0; is_sparse(X) && p < SUNSparseMatrix_IndexPointers(X)[1]; p++)
    x[SUNSparseMatrix_IndexValues(X)[p]] += SUNSparseMatrix_Data(X)[p];
}

int linear_read_x0(struct call *call, struct linear *l)
{
  const char *path = word_of(call, "--x0", NULL);
  if (!path) return EXIT_OK;
  SUNMatrix X = steif_matrix_read(call->ctx, path);
  if (!X) return bad_file(call);
  const long height = (long)rows(X);
  const long width =
    (long)(is_sparse(X) ? SUNSparseMatrix_Columns(X) : SUNDenseMatrix_Columns(X));
  free(l->x0);
  l->x0 = malloc((size_t)l->n * sizeof *l->x0);
  const bool good = height == l->n && width == 1;
  if (good && l->x0) column_of(X, l->n, l->x0);
  SUNMatDestroy(X);
  if (!l->x0) return linear_no_memory(call, "start values");
  if (good) return EXIT_OK;
  say(call, "'%s': x(0-) is %ld x %ld and should be %ld x 1, the rows of E; correct it", path,
      height, width, (long)l->n);
  return EXIT_FILE;
}

static int read_input(struct call *call, SUNMatrix *B)
{
  const char *path = word_of(call, "--input", NULL);
  if (path) return (*B = steif_matrix_read(call->ctx, path)) ? EXIT_OK : bad_file(call);
  if (!ends(call->word[call->words - 1], ".mat")) return EXIT_OK;
  return steif_input_read(call->ctx, call->word[call->words - 1], B) ? bad_file(call) : EXIT_OK;
}

static int read_forcing(struct call *call, struct linear *l)
{
  SUNMatrix B = NULL;
  const char *path = word_of(call, "--forcing", NULL), *text = word_of(call, "--f", NULL);
  if (!path && !text)
    return given(call, "--input") ? refuse(call, "--input is B of f = B u; add --forcing or --f")
                                  : EXIT_OK;
  const int code = read_input(call, &B);
  if (code) return code;
  l->function = text                 ? steif_function_parse(call->ctx, text, l->n, B)
                : ends(path, ".csv") ? steif_function_samples(call->ctx, path, l->n, B, 0, NULL)
                                     : steif_function_read(call->ctx, path, l->n, B);
  if (B) SUNMatDestroy(B);
  if (!l->function) return path || given(call, "--input") ? bad_file(call) : fail(call);
  l->system.f = steif_function_value, l->system.user = l->function;
  return EXIT_OK;
}

/* A matrix of an option; NULL without it. */
static int read_matrix(struct call *call, const char *option, SUNMatrix *M)
{
  const char *path = word_of(call, option, NULL);
  if (path && !(*M = steif_matrix_read(call->ctx, path))) return bad_file(call);
  return EXIT_OK;
}

static int read_output(struct call *call, struct linear *l, const char *path)
{
  const bool own = given(call, "--output");
  if (given(call, "--feedthrough") && !own)
    return refuse(call, "--feedthrough is D of y = C x + D u; add --output");
  if (!own && !ends(path, ".mat")) return EXIT_OK;
  if (!own)
    return steif_output_read(call->ctx, path, &l->C, &l->D) ? bad_file(call) : EXIT_OK;
  int code = read_matrix(call, "--output", &l->C);
  if (!code) code = read_matrix(call, "--feedthrough", &l->D);
  const size_t inputs = l->function ? steif_function_count(l->function) : (size_t)l->n;
  if (!code && steif_output_check(call->ctx, l->C, l->D, l->n, (sunindextype)inputs))
    code = bad_file(call);
  return code;
}

int linear_open(struct call *call, struct linear *l, int from, bool start)
{
  *l = (struct linear){0};
  int code = linear_is_file(call->word[from]) ? from_files(call, l, from)
                                              : from_collection(call, l, from);
  if (!code) code = read_names(call, l);
  if (!code && start) code = linear_read_x0(call, l);
  if (!code && start) code = read_forcing(call, l);
  if (!code && start) code = read_output(call, l, call->word[from]);
  l->t0 = real_of(call, "--t0", l->t0);
  return code;
}

int linear_started(const struct call *call, const struct linear *l)
{
  return l->x0 ? EXIT_OK : refuse(call, "--x0 X.mtx is needed: the values x(0-)");
}

bool linear_as_published(const struct call *call, const struct linear *l)
{
  return l->problem.name && !given(call, "--x0") && !l->function;
}

void linear_close(struct call *call, struct linear *l)
{
  if (l->system.E) SUNMatDestroy(l->system.E);
  if (l->system.F) SUNMatDestroy(l->system.F);
  if (l->C) SUNMatDestroy(l->C);
  if (l->D) SUNMatDestroy(l->D);
  steif_function_free(&l->function);
  steif_names_free(&l->read);
  steif_problem_clear(call->ctx, &l->problem);
  free(l->x0);
}

steif_analysis linear_analysis(const struct call *call, const struct linear *l)
{
  static const char *const names[] = {"auto", "staircase", "qz", "contour", "drazin", "array"};
  const char *name = word_of(call, "--algorithm", "auto");
  steif_analysis a = {.radius = real_of(call, "--radius", 0),
                      .points = (int)whole_of(call, "--points", 0),
                      .names = l->names};
  for (int i = 0; i < 6; i++)
    if (!strcmp(name, names[i])) a.algorithm = (enum steif_algorithm)i;
  return a;
}
