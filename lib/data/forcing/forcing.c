/* forcing.c: forcing functions f = u or f = B u, u by expressions or by samples; the derivative of order j of an
 * expression is j! times a Taylor coefficient.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include "input.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

steif_function *stf_function_new(steif_context *ctx, sunindextype n)
{
  if (n < 1) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT, "a function of %lld components; it needs at least one",
               (long long)n);
    return NULL;
  }
  stf_pool *pool = stf_pool_new(ctx);
  steif_function *f = pool ? stf_pool_array(pool, 1, sizeof *f) : NULL;
  if (!f)
    stf_pool_free(&pool);
  else {
    f->ctx = ctx;
    f->pool = pool;
    f->n = f->inputs = n;
  }
  return f;
}

void steif_function_free(steif_function **f)
{
  if (!f || !*f) return;
  stf_pool *pool = (*f)->pool;
  stf_expressions_free(*f);
  stf_pool_free(&pool);
  *f = NULL;
}

/* ---- breakpoints ----------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b)
{
  const sunrealtype x = *(const sunrealtype *)a, y = *(const sunrealtype *)b;
  return (x > y) - (x < y);
}

static int find_breaks(steif_function *f)
{
  const stf_vector *all = &f->expressions->model->breaks;
  f->breaks = stf_pool_array(f->pool, all->count, sizeof *f->breaks);
  if (!f->breaks) return STEIF_NO_MEMORY;
  if (all->count) memcpy(f->breaks, all->data, all->count * sizeof *f->breaks);
  qsort(f->breaks, all->count, sizeof *f->breaks, ascending);
  for (size_t i = 0; i < all->count; i++)
    if (!i || f->breaks[i] != f->breaks[f->break_count - 1])
      f->breaks[f->break_count++] = f->breaks[i];
  return STEIF_OK;
}

size_t steif_function_breaks(const steif_function *f, sunrealtype t0, sunrealtype t1,
                             size_t room, sunrealtype *times)
{
  size_t count = 0;
  for (size_t i = 0; f && i < f->break_count; i++)
    if (f->breaks[i] > t0 && f->breaks[i] < t1) {
      if (times && count < room) times[count] = f->breaks[i];
      count++;
    }
  return count;
}

/* The first of many places in [t0, t1] before which a root changes its sign; NaN: none. */
static sunrealtype turn(steif_function *f, size_t root, sunrealtype t0, sunrealtype t1)
{
  enum { PLACES = 1000 };
  const sunrealtype *now;
  sunrealtype last = 0;
  for (int i = 0; i <= PLACES; i++) {
    const sunrealtype t = t0 + (t1 - t0) * i / PLACES;
    if (stf_expressions_series(f, root, t, 0, &now)) continue;
    if (*now * last < 0) return t;
    if (*now != 0) last = *now;
  }
  return NAN;
}

int steif_function_smooth(steif_function *f, sunrealtype t0, sunrealtype t1, sunrealtype *where)
{
  if (!f || !where) return false;
  *where = NAN;
  const size_t roots = f->expressions ? f->expressions->roots.count : 0;
  for (size_t k = (size_t)f->inputs; k < roots; k++) {
    const sunrealtype t = turn(f, k, t0, t1);
    if (!isnan(t) && !(*where < t)) *where = t;
  }
  return isnan(*where);
}

/* ---- building -------------------------------------------------------------------------------- */

/* B by columns into the pool: the user's may go. */
int stf_function_input(steif_function *f, SUNMatrix B)
{
  STEIF_TRY(stf_input_check(f->ctx, B, "B"));
  STEIF_CHECK(stf_input_rows(B) == f->n, f->ctx, STEIF_BAD_INPUT,
              "B has %lld rows and f has %lld components; give B the rows of the system",
              (long long)stf_input_rows(B), (long long)f->n);
  const sunindextype m = f->inputs = stf_input_columns(B);
  sunindextype count = 0;
  for (sunindextype j = 0; j < m; j++) count += stf_input_column(B, j);
  f->column = stf_pool_array(f->pool, (size_t)m + 1, sizeof *f->column);
  f->row = stf_pool_array(f->pool, (size_t)count, sizeof *f->row);
  f->entry = stf_pool_array(f->pool, (size_t)count, sizeof *f->entry);
  f->u = stf_pool_array(f->pool, (size_t)m, sizeof *f->u);
  if (!f->column || !f->row || !f->entry || !f->u) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; j < m; j++) {
    const sunindextype size = stf_input_column(B, j), start = f->column[j];
    for (sunindextype k = 0; k < size; k++)
      stf_input_entry(B, j, k, f->row + start + k, f->entry + start + k);
    f->column[j + 1] = start + size;
  }
  return STEIF_OK;
}

static int fill(steif_function *f, const char *path, const char *text, SUNMatrix B)
{
  if (B) STEIF_TRY(stf_function_input(f, B));
  char *kept = path ? stf_pool_array(f->pool, strlen(path) + 1, 1) : NULL;
  if (path && !kept) return STEIF_NO_MEMORY;
  if (path) strcpy(kept, path);
  STEIF_TRY(stf_expressions_read(f, kept, text));
  return find_breaks(f);
}

static steif_function *build(steif_context *ctx, const char *path, const char *text,
                             sunindextype n, SUNMatrix B)
{
  stf_plain plain;
  steif_function *f = stf_function_new(ctx, n);
  if (!f) return NULL;
  int code = stf_plain_begin(ctx, &plain);
  if (code == STEIF_OK) {
    code = fill(f, path, text, B);
    stf_plain_end(&plain);
  }
  if (code != STEIF_OK) steif_function_free(&f);
  return f;
}

steif_function *steif_function_parse(steif_context *ctx, const char *text, sunindextype n,
                                     SUNMatrix B)
{
  if (text) return build(ctx, NULL, text, n, B);
  STEIF_FAIL(ctx, STEIF_BAD_INPUT, "the text of the expressions is NULL; give a text");
  return NULL;
}

steif_function *steif_function_read(steif_context *ctx, const char *path, sunindextype n,
                                    SUNMatrix B)
{
  char *text = stf_input_text(ctx, path);
  steif_function *f = text ? build(ctx, path, text, n, B) : NULL;
  if (text) stf_release(ctx, text);
  return f;
}

/* ---- evaluation ------------------------------------------------------------------------------ */

/* The derivative of input i at t. */
static int input(steif_function *f, sunindextype i, sunrealtype t, int derivative,
                 sunrealtype *u)
{
  const sunrealtype *c;
  sunrealtype scale = 1;
  STEIF_TRY(stf_expressions_series(f, (size_t)i, t, derivative, &c));
  for (int k = 2; k <= derivative; k++) scale *= k;
  *u = scale * c[derivative];
  return isfinite(*u)
           ? STEIF_OK
           : STEIF_RECOVER(f->ctx, STEIF_NOT_FINITE,
                           "derivative %d of expression %lld is beyond 1.8e308 at t = %g",
                           derivative, (long long)i + 1, t);
}

static int expressions(steif_function *f, sunrealtype t, int derivative, sunrealtype *u)
{
  if (derivative > STF_ORDER)
    return STEIF_RECOVER(f->ctx, STEIF_UNSUPPORTED,
                         "derivative %d of an expression; %d is the highest", derivative,
                         STF_ORDER);
  int wrong = STEIF_OK;
  sunindextype known = 0;
  for (sunindextype i = 0; i < f->inputs; i++) {
    const int code = input(f, i, t, derivative, u + i);
    if (code) {
      wrong = code;
      u[i] = NAN;
    }
    known += !code;
  }
  return derivative && known ? STEIF_OK : wrong;
}

int steif_function_taylor(long double t, int order, long double *c, void *function)
{
  steif_function *f = function;
  const sunrealtype *series;
  if (!f || order < 0 || order > STF_ORDER || !f->expressions) return STEIF_UNSUPPORTED;
  if (stf_expressions_series(f, 0, (sunrealtype)t, order, &series)) return STEIF_NOT_FINITE;
  for (int j = 0; j <= order; j++) c[j] = series[j];
  return STEIF_OK;
}

/* g = B u. */
static void multiply(const steif_function *f, const sunrealtype *u, sunrealtype *g)
{
  memset(g, 0, (size_t)f->n * sizeof *g);
  for (sunindextype j = 0; j < f->inputs; j++)
    for (sunindextype k = f->column[j]; k < f->column[j + 1]; k++)
      g[f->row[k]] += f->entry[k] * u[j];
}

int steif_function_inputs(sunrealtype t, steif_function *f, sunrealtype *u)
{
  if (!f || !u) return STEIF_BAD_INPUT;
  return f->samples.points ? stf_samples_value(f, t, 0, u) : expressions(f, t, 0, u);
}

size_t steif_function_count(const steif_function *f) { return f ? (size_t)f->inputs : 0; }

int steif_function_value(sunrealtype t, int derivative, N_Vector g, void *function)
{
  steif_function *f = function;
  if (!f || !g) return STEIF_BAD_INPUT;
  sunrealtype *values = N_VGetArrayPointer(g);
  STEIF_CHECK(derivative >= 0, f->ctx, STEIF_BAD_INPUT, "derivative %d; ask for 0 or more",
              derivative);
  STEIF_CHECK(values && N_VGetLength(g) == f->n, f->ctx, STEIF_BAD_INPUT,
              "a vector of %lld components in host memory is needed, got %lld%s",
              (long long)f->n, (long long)N_VGetLength(g), values ? "" : " elsewhere");
  sunrealtype *u = f->u ? f->u : values;
  STEIF_TRY(f->samples.points ? stf_samples_value(f, t, derivative, u)
                              : expressions(f, t, derivative, u));
  if (f->u) multiply(f, u, values);
  return STEIF_OK;
}
