/* forcing.c: forcing functions from expressions: one program for each component of u, and f = u or
 * f = B u; the derivative of order j is j! times a Taylor coefficient.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 1000000 }; /* characters of an expression */

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
  stf_pool_free(&pool);
  *f = NULL;
}

/* ---- pieces of text: one expression each ----------------------------------------------------- */

typedef struct piece {
  const char *text;
  size_t length;
  long number; /* of the line, or of the expression */
} piece;

static bool blank(const piece *p)
{
  for (size_t i = 0; i < p->length; i++)
    if (!isspace((unsigned char)p->text[i])) return false;
  return true;
}

/* The next piece from *at on: a line without its comment, or what stands before a ';'. Blank lines
 * are passed over, and so is what is blank after the last ';'. */
static bool take(const char **at, bool lines, piece *p)
{
  while (**at) {
    const char *start = *at, *end = start + strcspn(start, lines ? "\n" : ";");
    *at = *end ? end + 1 : end;
    p->text = start;
    p->length = (size_t)(end - start);
    p->number++;
    const char *comment = lines ? memchr(start, '#', p->length) : NULL;
    if (comment) p->length = (size_t)(comment - start);
    if (!blank(p) || (!lines && **at)) return true;
  }
  return false;
}

static size_t longest(const char *text, bool lines)
{
  piece p = {0};
  size_t most = 0;
  while (take(&text, lines, &p))
    if (p.length > most) most = p.length;
  return most;
}

/* Parse a piece in `scratch` and keep it as program k. */
static int keep(steif_function *f, const piece *p, sunindextype k, const char *path,
                stf_instruction *scratch)
{
  stf_program *program = f->program + k;
  f->source[k] = (stf_source){path, p->number};
  program->code = scratch;
  STEIF_TRY(stf_program_parse(f->ctx, f->source + k, p->text, p->length, program));
  program->code = stf_pool_array(f->pool, (size_t)program->length, sizeof *scratch);
  if (!program->code) return STEIF_NO_MEMORY;
  memcpy(program->code, scratch, (size_t)program->length * sizeof *scratch);
  return STEIF_OK;
}

static int programs(steif_function *f, const char *path, const char *text,
                    stf_instruction *scratch)
{
  const char *name = path ? path : "the text";
  const long long wanted = (long long)f->inputs;
  piece p = {0};
  sunindextype k = 0;
  for (; take(&text, path != NULL, &p); k++) {
    STEIF_CHECK(k < f->inputs, f->ctx, STEIF_BAD_INPUT,
                "%s, %s %ld: more than %lld expressions; give one for each component", name,
                path ? "line" : "expression", p.number, wanted);
    STEIF_TRY(keep(f, &p, k, path, scratch));
  }
  STEIF_CHECK(k == f->inputs, f->ctx, STEIF_BAD_INPUT,
              "%s ends at %s %ld after %lld of %lld expressions; give one for each component",
              name, path ? "line" : "expression", p.number, (long long)k, wanted);
  return STEIF_OK;
}

/* ---- breakpoints ----------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b)
{
  const sunrealtype x = *(const sunrealtype *)a, y = *(const sunrealtype *)b;
  return (x > y) - (x < y);
}

static bool turns(enum stf_operation o) { return o == STF_ABS || o == STF_MIN || o == STF_MAX; }

/* The breakpoints of all programs into list (NULL: count only). */
static size_t collect(const steif_function *f, sunrealtype *list)
{
  size_t count = 0;
  for (sunindextype i = 0; i < f->inputs; i++)
    for (int k = 0; k < f->program[i].length; k++) {
      const stf_instruction *c = f->program[i].code + k;
      const bool breaks = c->operation == STF_STEP || c->operation == STF_RAMP ||
                          (turns(c->operation) && isfinite(c->number));
      if (!breaks) continue;
      if (list) list[count] = c->number;
      count++;
    }
  return count;
}

static int find_breaks(steif_function *f)
{
  const size_t count = collect(f, NULL);
  f->breaks = stf_pool_array(f->pool, count, sizeof *f->breaks);
  if (!f->breaks) return STEIF_NO_MEMORY;
  collect(f, f->breaks);
  qsort(f->breaks, count, sizeof *f->breaks, ascending);
  for (size_t i = 0; i < count; i++)
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

/* The first of many places in [t0, t1] before which instruction k turns; NaN: none. */
static sunrealtype turn(const stf_program *program, int k, sunrealtype t0, sunrealtype t1,
                        stf_series *stack)
{
  enum { PLACES = 1000 };
  sunrealtype last = 0;
  for (int i = 0; i <= PLACES; i++) {
    const sunrealtype t = t0 + (t1 - t0) * i / PLACES,
                      now = stf_program_switch(program, k, t, stack);
    if (now * last < 0) return t;
    if (now != 0) last = now;
  }
  return NAN;
}

int steif_function_smooth(steif_function *f, sunrealtype t0, sunrealtype t1, sunrealtype *where)
{
  if (!f || !where) return false;
  *where = NAN;
  for (sunindextype i = 0; f->program && i < f->inputs; i++)
    for (int k = 0; k < f->program[i].length; k++) {
      const stf_instruction *c = f->program[i].code + k;
      if (!turns(c->operation) || isfinite(c->number)) continue;
      const sunrealtype t = turn(f->program + i, k, t0, t1, f->stack);
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
  const size_t length = longest(text, path != NULL);
  STEIF_CHECK(length <= LONGEST, f->ctx, STEIF_BAD_INPUT,
              "%s has an expression of %zu characters, and %d are the most; break it up",
              path ? path : "the text", length, LONGEST);
  char *kept = path ? stf_pool_array(f->pool, strlen(path) + 1, 1) : NULL;
  if (path && !kept) return STEIF_NO_MEMORY;
  if (path) strcpy(kept, path);
  f->program = stf_pool_array(f->pool, (size_t)f->inputs, sizeof *f->program);
  f->source = stf_pool_array(f->pool, (size_t)f->inputs, sizeof *f->source);
  if (!f->program || !f->source) return STEIF_NO_MEMORY;
  stf_instruction *scratch = stf_allocate(f->ctx, length + 1, sizeof *scratch);
  if (!scratch) return STEIF_NO_MEMORY;
  const int code = programs(f, kept, text, scratch);
  stf_release(f->ctx, scratch);
  STEIF_TRY(code);
  int depth = 0;
  for (sunindextype i = 0; i < f->inputs; i++)
    if (f->program[i].depth > depth) depth = f->program[i].depth;
  f->stack = stf_pool_array(f->pool, (size_t)depth + STF_SCRATCH, sizeof *f->stack);
  return f->stack ? find_breaks(f) : STEIF_NO_MEMORY;
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
  int place = 0;
  sunrealtype scale = 1;
  const char *wrong = stf_program_run(f->program + i, t, derivative, f->stack, &place);
  for (int k = 2; k <= derivative; k++) scale *= k;
  if (!wrong) *u = scale * f->stack->c[derivative];
  if (!wrong && isfinite(*u)) return STEIF_OK;
  const stf_source *s = f->source + i;
  return STEIF_RECOVER(
    f->ctx, STEIF_NOT_FINITE,
    "%s%s%s %ld, position %d: %s at t = %g, derivative %d; keep t out of there",
    s->name ? s->name : "", s->name ? ", " : "", s->name ? "line" : "expression", s->line,
    place + 1, wrong ? wrong : "a result that is not finite", t, derivative);
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
  int place;
  if (!f || order < 0 || order > STF_ORDER || f->samples.points) return STEIF_UNSUPPORTED;
  if (stf_program_run(f->program, (sunrealtype)t, order, f->stack, &place))
    return STEIF_NOT_FINITE;
  for (int j = 0; j <= order; j++) c[j] = f->stack->c[j];
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
