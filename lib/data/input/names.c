/* names.c: what equations and unknowns are called: lines of a text file, or the arrays `unknowns` and
 * `equations` of a MATLAB file. The system of first order made of a mechanical one,
 *   q' - v = 0,   M v' + D v + K q + G^T l = f,   G q = g,
 * calls its parts after the coordinates q.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

typedef struct named {
  steif_names names; /* first: what users see */
  steif_context *ctx;
  stf_pool *pool;
} named;

void steif_names_free(steif_names **names)
{
  if (!names || !*names) return;
  stf_pool *pool = ((named *)*names)->pool;
  stf_pool_free(&pool);
  *names = NULL;
}

static named *open(steif_context *ctx)
{
  stf_pool *pool = stf_pool_new(ctx);
  named *d = pool ? stf_pool_array(pool, 1, sizeof *d) : NULL;
  if (!d)
    stf_pool_free(&pool);
  else {
    d->ctx = ctx;
    d->pool = pool;
  }
  return d;
}

static int by_text(const void *a, const void *b)
{
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Tables are headed by the names of unknowns: no two are the same. */
static int distinct(named *d, const char *path, sunindextype n, const char *const *name)
{
  const char **sorted = stf_pool_array(d->pool, (size_t)n, sizeof *sorted);
  if (!sorted) return STEIF_NO_MEMORY;
  memcpy(sorted, name, (size_t)n * sizeof *sorted);
  qsort(sorted, (size_t)n, sizeof *sorted, by_text);
  for (sunindextype i = 1; i < n; i++)
    STEIF_CHECK(strcmp(sorted[i], sorted[i - 1]), d->ctx, STEIF_BAD_INPUT,
                "'%s' calls two unknowns '%.60s'; give each a name of its own", path,
                sorted[i]);
  return STEIF_OK;
}

/* ---- text files ------------------------------------------------------------------------------ */

/* What stands between first and end without the blanks around it, kept. */
static char *keep(named *d, const char *first, const char *end)
{
  while (first < end && isspace((unsigned char)*first)) first++;
  while (end > first && isspace((unsigned char)end[-1])) end--;
  const size_t length = (size_t)(end - first);
  char *text = stf_pool_array(d->pool, length + 1, 1);
  if (text) {
    memcpy(text, first, length);
    text[length] = 0;
  }
  return text;
}

/* UNKNOWN [, EQUATION] of one line without its comment; *blank: nothing there. */
static int line(named *d, const char *first, const char *end, const char **unknown,
                const char **equation, bool *blank)
{
  const char *comment = memchr(first, '#', (size_t)(end - first)),
             *last = comment ? comment : end,
             *comma = memchr(first, ',', (size_t)(last - first));
  *unknown = keep(d, first, comma ? comma : last);
  *equation = comma ? keep(d, comma + 1, last) : NULL;
  *blank = *unknown && !**unknown && !comma;
  return *unknown && (*equation || !comma) ? STEIF_OK : STEIF_NO_MEMORY;
}

static int lines(named *d, const char *path, const char *text, sunindextype n,
                 const char **unknown, const char **equation)
{
  sunindextype k = 0, equations = 0;
  long number = 1;
  for (const char *at = text, *end; *at; at = *end ? end + 1 : end, number++) {
    const char *one, *two;
    bool blank;
    end = at + strcspn(at, "\n");
    STEIF_TRY(line(d, at, end, &one, &two, &blank));
    if (blank) continue;
    STEIF_CHECK(k < n, d->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: more than %lld names; give one for each unknown", path, number,
                (long long)n);
    STEIF_CHECK(*one && (!two || *two), d->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: expected UNKNOWN or UNKNOWN, EQUATION, found no name for the %s",
                path, number, *one ? "equation" : "unknown");
    STEIF_CHECK(k == 0 || !two == !equations, d->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: %s where the lines before %s; name all equations or none", path,
                number, two ? "an equation" : "no equation", two ? "have none" : "have one");
    unknown[k] = one;
    equation[k++] = two;
    equations += two != NULL;
  }
  STEIF_CHECK(k == n, d->ctx, STEIF_BAD_INPUT,
              "%s ends at line %ld after %lld of %lld names; give one for each unknown", path,
              number - 1, (long long)k, (long long)n);
  d->names.unknown = unknown;
  d->names.equation = equations ? equation : NULL;
  return STEIF_OK;
}

static int of_text(named *d, const char *path, sunindextype n)
{
  const char **unknown = stf_pool_array(d->pool, (size_t)n, sizeof *unknown),
             **equation = stf_pool_array(d->pool, (size_t)n, sizeof *equation);
  char *text = unknown && equation ? stf_input_text(d->ctx, path) : NULL;
  if (!text) return steif_status(d->ctx);
  const int code = lines(d, path, text, n, unknown, equation);
  stf_release(d->ctx, text);
  return code;
}

/* ---- MATLAB files ---------------------------------------------------------------------------- */

/* "q' of x", "l3": a format of one text or number for each part of a list. */
static int put(named *d, const char **at, const char *format, const char *name,
               long long number)
{
  char text[STF_LINE];
  if (name)
    snprintf(text, sizeof text, format, name);
  else
    snprintf(text, sizeof text, format, number);
  *at = keep(d, text, text + strlen(text));
  return *at ? STEIF_OK : STEIF_NO_MEMORY;
}

/* All of (q, v, l) and their equations from what the coordinates are called; name NULL: q1, ... */
static int mechanical(named *d, sunindextype n, sunindextype m, const char *const *name)
{
  const size_t all = 2 * (size_t)n + (size_t)m;
  const char **unknown = stf_pool_array(d->pool, all, sizeof *unknown),
             **equation = stf_pool_array(d->pool, all, sizeof *equation);
  if (!unknown || !equation) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < n; i++) {
    const char *q = name ? name[i] : NULL;
    STEIF_TRY(put(d, unknown + i, q ? "%s" : "q%lld", q, i + 1));
    STEIF_TRY(put(d, unknown + n + i, q ? "%s'" : "v%lld", q, i + 1));
    STEIF_TRY(put(d, equation + i, q ? "velocity of %s" : "velocity %lld", q, i + 1));
    STEIF_TRY(put(d, equation + n + i, q ? "motion of %s" : "motion %lld", q, i + 1));
  }
  for (sunindextype i = 0; i < m; i++) {
    STEIF_TRY(put(d, unknown + 2 * n + i, "l%lld", NULL, i + 1));
    STEIF_TRY(put(d, equation + 2 * n + i, "constraint %lld", NULL, i + 1));
  }
  d->names.unknown = unknown;
  d->names.equation = equation;
  return STEIF_OK;
}

/* Rows of M and of G where there is no E; 0 and 0 with E. */
static int coordinates(steif_context *ctx, const char *path, sunindextype *n, sunindextype *m)
{
  SUNMatrix E = NULL, M = NULL, G = NULL;
  int code = stf_input_variable(ctx, path, "E", &E);
  if (!code && !E) code = stf_input_variable(ctx, path, "M", &M);
  if (!code && M) code = stf_input_variable(ctx, path, "G", &G);
  *n = M ? stf_input_rows(M) : 0;
  *m = G ? stf_input_rows(G) : 0;
  if (E) SUNMatDestroy(E);
  if (M) SUNMatDestroy(M);
  if (G) SUNMatDestroy(G);
  return code;
}

static int counted(const named *d, const char *path, const char *which, size_t count,
                   sunindextype n)
{
  STEIF_CHECK(count == (size_t)n, d->ctx, STEIF_BAD_INPUT,
              "'%s': %s has %zu names for %lld %s; give one for each", path, which, count,
              (long long)n, which);
  return STEIF_OK;
}

static int of_mat(named *d, const char *path, sunindextype n)
{
  const char **unknown = NULL, **equation = NULL;
  size_t unknowns = 0, equations = 0;
  sunindextype q, l;
  STEIF_TRY(coordinates(d->ctx, path, &q, &l));
  STEIF_TRY(stf_input_texts(d->ctx, d->pool, path, "unknowns", &unknowns, &unknown));
  STEIF_TRY(stf_input_texts(d->ctx, d->pool, path, "equations", &equations, &equation));
  const bool short_list = q && (!unknown || unknowns == (size_t)q);
  if (short_list) STEIF_TRY(mechanical(d, q, l, unknown));
  if (unknown && !short_list) {
    STEIF_TRY(counted(d, path, "unknowns", unknowns, n));
    d->names.unknown = unknown;
  }
  if (!equation) return STEIF_OK;
  d->names.equation = equation;
  return counted(d, path, "equations", equations, n);
}

int steif_names_read(steif_context *ctx, const char *path, sunindextype n, steif_names **names)
{
  STEIF_CHECK(names && path && n > 0, ctx, STEIF_BAD_INPUT,
              "a path, the number of unknowns and room for their names are needed");
  const size_t length = strlen(path);
  const bool mat = (length > 4 && !strcmp(path + length - 4, ".mat")) ||
                   (length > 3 && !strcmp(path + length - 3, ".h5"));
  *names = NULL;
  steif_forget(ctx);
  named *d = open(ctx);
  if (!d) return STEIF_NO_MEMORY;
  *names = &d->names;
  int code = mat ? of_mat(d, path, n) : of_text(d, path, n);
  if (!code && d->names.unknown) code = distinct(d, path, n, d->names.unknown);
  if (code || (!d->names.unknown && !d->names.equation)) steif_names_free(names);
  return code;
}
