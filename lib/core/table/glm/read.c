/* read.c: a general linear method from a text file, in the format of steif/glm.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "general.h"
#include "text.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum part { XI, C, D, U, V, ALPHA, BETA, PARTS, NAME = PARTS };
enum { ROOM = STEIF_STAGES * STEIF_STAGES };

/* Every part may be called by the letters of Burrage and Butcher or of Runge-Kutta tables too.
 * */
static const struct {
  const char *word;
  enum part part;
} words[] = {{"xi", XI}, {"c", XI}, {"C", C}, {"A", C},         {"D", D},       {"B", D},
             {"b", D},   {"U", U},  {"V", V}, {"alpha", ALPHA}, {"beta", BETA}, {"name", NAME}};

typedef struct block {
  int rows, columns, count;
  sunrealtype value[ROOM];
} block;

typedef struct reader {
  steif_context *ctx;
  const char *path;
  long line;
  enum part part; /* where numbers go */
  bool begun;
  steif_glm *glm;
  block *block;
} reader;

static const char *word_of(enum part part)
{
  size_t i = 0;
  while (words[i].part != part) i++;
  return words[i].word;
}

static int find_part(reader *r, const char *word, size_t length)
{
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i].word) == length && !strncmp(words[i].word, word, length)) {
      r->part = words[i].part, r->begun = true;
      STEIF_CHECK(r->part == NAME || r->block[r->part].count == 0, r->ctx, STEIF_BAD_INPUT,
                  "%s, line %ld: '%s' is given a second time; leave one of them out", r->path,
                  r->line, words[i].word);
      return STEIF_OK;
    }
  char shown[STF_SHOWN];
  return STEIF_FAIL(
    r->ctx, STEIF_BAD_INPUT,
    "%s, line %ld: '%s' is no part of a tableau; there are name, xi, C, D, U, V, "
    "and alpha, beta",
    r->path, r->line, stf_input_shown(word, shown));
}

/* A number or a quotient of two. */
static int number(reader *r, const char **at, sunrealtype *value)
{
  char *end, shown[STF_SHOWN];
  *value = strtod(*at, &end);
  bool good = end != *at;
  if (good && *end == '/') {
    const char *below = end + 1;
    *value /= strtod(below, &end);
    good = end != below;
  }
  STEIF_CHECK(
    good && isfinite(*value) && (!*end || isspace((unsigned char)*end)), r->ctx,
    STEIF_BAD_INPUT,
    "%s, line %ld: '%s' is no finite number; write decimals or quotients such as -1/8", r->path,
    r->line, stf_input_shown(*at, shown));
  *at = end;
  return STEIF_OK;
}

static const char *after_blanks(const char *at)
{
  while (isspace((unsigned char)*at)) at++;
  return at;
}

static int numbers(reader *r, const char *at)
{
  block *b = r->block + r->part;
  int columns = 0;
  for (at = after_blanks(at); *at; at = after_blanks(at), columns++) {
    STEIF_CHECK(b->count < ROOM, r->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: more than %d numbers in '%s'", r->path, r->line, ROOM,
                word_of(r->part));
    STEIF_TRY(number(r, &at, b->value + b->count++));
  }
  if (!columns) return STEIF_OK;
  const bool list = r->part == XI || r->part == ALPHA || r->part == BETA;
  STEIF_CHECK(list || b->rows == 0 || b->columns == columns, r->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: a row of %d numbers in '%s', whose rows before have %d", r->path,
              r->line, columns, word_of(r->part), b->columns);
  b->rows = list ? 1 : b->rows + 1;
  b->columns = list ? b->count : columns;
  return STEIF_OK;
}

static int name(reader *r, const char *at)
{
  at = after_blanks(at);
  size_t length = strlen(at);
  while (length && isspace((unsigned char)at[length - 1])) length--;
  STEIF_CHECK(length > 0 && length < sizeof r->glm->name, r->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: a name has 1 to %zu letters", r->path, r->line,
              sizeof r->glm->name - 1);
  memcpy(r->glm->name, at, length), r->glm->name[length] = 0;
  r->begun = false;
  return STEIF_OK;
}

static int read_line(reader *r, char *text)
{
  text[strcspn(text, "#")] = 0;
  const char *at = after_blanks(text);
  if (isalpha((unsigned char)*at)) {
    size_t length = 0;
    while (at[length] && !isspace((unsigned char)at[length])) length++;
    STEIF_TRY(find_part(r, at, length));
    at += length;
    if (r->part == NAME) return name(r, at);
  }
  STEIF_CHECK(
    !*at || r->begun, r->ctx, STEIF_BAD_INPUT,
    "%s, line %ld: numbers before the name of their matrix; begin with xi, C, D, U, V, "
    "alpha or beta",
    r->path, r->line);
  return *at ? numbers(r, at) : STEIF_OK;
}

static void copy(const block *b, sunrealtype *to)
{
  memcpy(to, b->value, (size_t)b->count * sizeof *to);
}

/* Without U and V: U = 1, V = 1; without xi too: row sums of C. */
static void complete_runge_kutta(block *b)
{
  const int s = b[C].rows;
  if (b[XI].count == 0 && b[C].columns == s) {
    b[XI].rows = 1, b[XI].columns = b[XI].count = s;
    for (int i = 0; i < s * s; i++) b[XI].value[i / s] += b[C].value[i];
  }
  b[U].rows = b[XI].count, b[U].columns = b[V].rows = b[V].columns = b[V].count = 1;
  b[U].count = b[U].rows;
  b[V].value[0] = 1;
  for (int i = 0; i < b[U].rows && i < STEIF_STAGES; i++) b[U].value[i] = 1;
}

static int general(reader *r)
{
  block *b = r->block;
  steif_glm *g = r->glm;
  if (b[U].count == 0 && b[V].count == 0) complete_runge_kutta(b);
  const int stages = b[XI].count, k = b[V].rows;
  const bool fits = b[C].rows == stages && b[C].columns == stages && b[U].rows == stages &&
                    b[U].columns == k && b[V].columns == k && b[D].rows == k &&
                    b[D].columns == stages;
  STEIF_CHECK(
    fits, r->ctx, STEIF_BAD_INPUT,
    "%s: xi has %d entries, C is %d x %d, D %d x %d, U %d x %d, V %d x %d; with r stages "
    "and k values C is r x r, D k x r, U r x k and V k x k",
    r->path, stages, b[C].rows, b[C].columns, b[D].rows, b[D].columns, b[U].rows, b[U].columns,
    b[V].rows, b[V].columns);
  STEIF_CHECK(stages >= 1 && stages <= STEIF_STAGES && k <= STEIF_PAST, r->ctx, STEIF_BAD_INPUT,
              "%s: %d stages and %d values; 1 to %d and 1 to %d are possible", r->path, stages,
              k, STEIF_STAGES, STEIF_PAST);
  g->k = k, g->r = stages;
  copy(b + XI, g->xi), copy(b + C, g->C), copy(b + D, g->D), copy(b + U, g->U);
  copy(b + V, g->V);
  return STEIF_OK;
}

static int multistep(reader *r)
{
  const block *b = r->block;
  char kept[STEIF_SPEC_VALUE];
  const int others = b[XI].count + b[C].count + b[D].count + b[U].count + b[V].count;
  STEIF_CHECK(
    b[ALPHA].count == b[BETA].count && b[ALPHA].count >= 2 && others == 0, r->ctx,
    STEIF_BAD_INPUT,
    "%s: alpha has %d entries and beta %d; a multistep method has as many of both, two "
    "at least, and nothing else",
    r->path, b[ALPHA].count, b[BETA].count);
  strcpy(kept, r->glm->name);
  return steif_glm_multistep(r->ctx, kept, b[ALPHA].count - 1, b[ALPHA].value, b[BETA].value,
                             r->glm);
}

static int parse(reader *r, const char *text)
{
  char line[STF_LINE + 1];
  while (*text) {
    const size_t length = strcspn(text, "\n");
    r->line++;
    STEIF_CHECK(length <= STF_LINE, r->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: longer than %d characters; break it up", r->path, r->line,
                STF_LINE);
    memcpy(line, text, length), line[length] = 0;
    STEIF_TRY(read_line(r, line));
    text += length + (text[length] == '\n');
  }
  return r->block[ALPHA].count + r->block[BETA].count > 0 ? multistep(r) : general(r);
}

int stf_table_parse(steif_context *ctx, const char *path, const char *text, steif_glm *glm)
{
  memset(glm, 0, sizeof *glm);
  reader r = {.ctx = ctx, .path = path, .glm = glm};
  const size_t length = strlen(path), room = sizeof glm->name - 1;
  strcpy(glm->name, path + (length > room ? length - room : 0));
  r.block = stf_allocate(ctx, PARTS, sizeof *r.block);
  if (!r.block) return STEIF_NO_MEMORY;
  stf_plain plain;
  int code = stf_plain_begin(ctx, &plain);
  if (code == STEIF_OK) {
    code = parse(&r, text);
    stf_plain_end(&plain);
  }
  stf_release(ctx, r.block);
  return code;
}

int stf_table_read(steif_context *ctx, const char *path, steif_glm *glm)
{
  char *text = stf_input_text(ctx, path);
  if (!text) return steif_status(ctx);
  const int code = stf_table_parse(ctx, path, text, glm);
  stf_release(ctx, text);
  return code;
}
