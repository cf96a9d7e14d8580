/* market_scan.c: the scan of a Matrix Market file before it is read: each line against the format, so
 * that a sentence can name the line (R. F. Boisvert, R. Pozo and K. A. Remington, The Matrix Market
 * exchange formats, NISTIR 5935, 1996).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Whole numbers up to here are exact in double precision, through which indices are read. */
#define LARGEST 9007199254740992.0

/* Rows and columns that may be empty, each a number in memory: sizes farther from the entries are wrong. */
#define SPARE 1e7

/* What was expected on this line, and what is there from `found` on. */
static int reject(const stf_lines *l, const char *expected, const char *found)
{
  char shown[STF_SHOWN];
  while (isspace((unsigned char)*found)) found++;
  stf_input_shown(found, shown);
  return STEIF_FAIL(l->ctx, STEIF_BAD_INPUT, "%s, line %ld: expected %s, found %s%s%s", l->path,
                    l->number, expected, *shown ? "'" : "",
                    *shown ? shown : "the end of the line", *shown ? "'" : "");
}

static bool blank(const char *text)
{
  while (isspace((unsigned char)*text)) text++;
  return !*text;
}

/* One of the words of a NULL-terminated list, in any case, at *at; -1 when it is none. */
static int word(const char **at, const char *const *list)
{
  while (isspace((unsigned char)**at)) ++*at;
  size_t length = 0;
  while ((*at)[length] && !isspace((unsigned char)(*at)[length])) length++;
  for (int i = 0; list[i]; i++)
    if (strlen(list[i]) == length && !strncasecmp(*at, list[i], length)) {
      *at += length;
      return i;
    }
  return -1;
}

static int header(stf_lines *l, stf_market *m)
{
  static const char
    *const banners[] = {"%%MatrixMarket", NULL},
           *const things[] = {"matrix", NULL}, *const formats[] = {"coordinate", "array", NULL},
           *const fields[] = {"real", "integer", "pattern", "complex", NULL},
           *const symmetries[] = {"general", "symmetric", "skew-symmetric", "Hermitian", NULL};
  const char *at = l->text;
  if (strncmp(at, banners[0], strlen(banners[0])) || word(&at, banners) < 0)
    return reject(l,
                  "'%%MatrixMarket matrix coordinate|array real|integer|pattern "
                  "general|symmetric|skew-symmetric'",
                  l->text);
  if (word(&at, things) < 0) return reject(l, "the word 'matrix'", at);
  const int format = word(&at, formats);
  if (format < 0) return reject(l, "'coordinate' or 'array'", at);
  const int field = word(&at, fields);
  if (field < 0) return reject(l, "'real', 'integer' or 'pattern'", at);
  const int symmetry = word(&at, symmetries);
  if (symmetry < 0) return reject(l, "'general', 'symmetric' or 'skew-symmetric'", at);
  if (!blank(at)) return reject(l, "the end of the line", at);
  STEIF_CHECK(
    field != 3 && symmetry != 3, l->ctx, STEIF_UNSUPPORTED,
    "%s, line %ld: a complex matrix, and systems here are real; write the real and the "
    "imaginary parts as one real system of twice the size",
    l->path, l->number);
  m->array = format == 1;
  m->integer = field == 1;
  m->pattern = field == 2;
  m->symmetry = (enum stf_symmetry)symmetry;
  if (m->array && m->pattern) return reject(l, "'real' or 'integer' for an array", "pattern");
  if (m->pattern && m->symmetry == STF_SKEW)
    return reject(l, "'general' or 'symmetric' for a pattern", "skew-symmetric");
  return STEIF_OK;
}

/* A whole number of digits only at *at, from lowest to highest. */
static bool whole(const char **at, double lowest, double highest, sunindextype *value)
{
  while (isspace((unsigned char)**at)) ++*at;
  if (**at == '+') ++*at;
  const char *start = *at;
  double x = 0;
  for (; isdigit((unsigned char)**at); ++*at) x = 10 * x + (**at - '0');
  const bool good = *at > start && (!**at || isspace((unsigned char)**at)) && x >= lowest &&
                    x <= highest && x <= LARGEST;
  if (good) *value = (sunindextype)x;
  return good;
}

/* Stored entries of an array. */
static double area(const stf_market *m)
{
  const double rows = (double)m->rows, columns = (double)m->columns;
  if (m->symmetry == STF_GENERAL) return rows * columns;
  return m->symmetry == STF_SYMMETRIC ? rows * (rows + 1) / 2 : rows * (rows - 1) / 2;
}

static int sizes(stf_lines *l, stf_market *m)
{
  const char *at = l->text;
  const char *expected =
    m->array ? "the sizes 'rows columns'" : "the sizes 'rows columns entries'";
  if (!whole(&at, 1, LARGEST, &m->rows) || !whole(&at, 1, LARGEST, &m->columns) ||
      (!m->array && !whole(&at, 0, LARGEST, &m->entries)) || !blank(at))
    return reject(l, expected, l->text);
  STEIF_CHECK(m->symmetry == STF_GENERAL || m->rows == m->columns, l->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: a symmetric matrix of %lld x %lld; make it square, or general",
              l->path, l->number, (long long)m->rows, (long long)m->columns);
  const sunindextype longest = m->rows > m->columns ? m->rows : m->columns;
  STEIF_CHECK(
    m->array || (double)longest <= SPARE + 100 * (double)m->entries, l->ctx, STEIF_BAD_INPUT,
    "%s, line %ld: %lld x %lld with %lld entries in all; are these the sizes?", l->path,
    l->number, (long long)m->rows, (long long)m->columns, (long long)m->entries);
  if (!m->array) return STEIF_OK;
  STEIF_CHECK(area(m) <= LARGEST, l->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: an array of %lld x %lld is too large; write it by coordinates",
              l->path, l->number, (long long)m->rows, (long long)m->columns);
  m->entries = (sunindextype)area(m);
  return STEIF_OK;
}

/* The value of entry (i, j), or of the i-th of an array when j = 0, up to the end of the line. */
static int number(const stf_lines *l, const stf_market *m, const char *at, sunindextype i,
                  sunindextype j)
{
  char *end, entry[64];
  const double x = strtod(at, &end);
  if (end == at || !blank(end) || strpbrk(at, "xX"))
    return reject(l, "one number and the end of the line", end == at ? at : end);
  if (!isfinite(x)) {
    const char *form = j ? "entry (%lld, %lld)" : "entry number %lld";
    snprintf(entry, sizeof entry, form, (long long)i, (long long)j);
    return STEIF_FAIL(l->ctx, STEIF_NOT_FINITE, "%s, line %ld: %s is %g; make it finite",
                      l->path, l->number, entry, x);
  }
  if (m->integer && x != floor(x)) return reject(l, "an integer, as the first line says", at);
  return STEIF_OK;
}

/* Which triangles a symmetric file has used so far. */
typedef struct triangles {
  long lower, upper; /* line of the first entry, 0: none */
} triangles;

static int between(const stf_lines *l, const char *what, sunindextype highest,
                   const char *found)
{
  char expected[96];
  snprintf(expected, sizeof expected, "a %s from 1 to %lld", what, (long long)highest);
  return reject(l, expected, found);
}

static int coordinate(const stf_lines *l, const stf_market *m, triangles *seen)
{
  const char *at = l->text, *rest;
  sunindextype i, j;
  if (!whole(&at, 1, (double)m->rows, &i)) return between(l, "row", m->rows, l->text);
  rest = at;
  if (!whole(&at, 1, (double)m->columns, &j)) return between(l, "column", m->columns, rest);
  STEIF_CHECK(m->symmetry != STF_SKEW || i != j, l->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: entry (%lld, %lld) of a skew-symmetric matrix is zero; leave the "
              "diagonal out",
              l->path, l->number, (long long)i, (long long)j);
  if (i > j && !seen->lower) seen->lower = l->number;
  if (i < j && !seen->upper) seen->upper = l->number;
  STEIF_CHECK(
    m->symmetry == STF_GENERAL || !seen->lower || !seen->upper, l->ctx, STEIF_BAD_INPUT,
    "%s, line %ld: entry (%lld, %lld) is in the other triangle than that of line %ld; "
    "give one triangle of a symmetric matrix, or make it general",
    l->path, l->number, (long long)i, (long long)j, i > j ? seen->upper : seen->lower);
  if (!m->pattern) return number(l, m, at, i, j);
  return blank(at) ? STEIF_OK : reject(l, "the end of the line", at);
}

/* The k-th value of an array, from 1. */
static int value(const stf_lines *l, const stf_market *m, sunindextype k)
{
  if (m->symmetry != STF_GENERAL) return number(l, m, l->text, k, 0);
  return number(l, m, l->text, (k - 1) % m->rows + 1, (k - 1) / m->rows + 1);
}

/* The next line that is not blank and, before the sizes, not a comment. */
static int advance(stf_lines *l, bool comments, int *more)
{
  do STEIF_TRY(stf_line_next(l, more));
  while (*more && (blank(l->text) || (comments && l->text[0] == '%')));
  return STEIF_OK;
}

static int scan(stf_lines *l, stf_market *m)
{
  int more;
  triangles seen = {0, 0};
  STEIF_TRY(stf_line_next(l, &more));
  STEIF_CHECK(more, l->ctx, STEIF_BAD_INPUT, "%s is empty; give a Matrix Market file", l->path);
  STEIF_TRY(header(l, m));
  STEIF_TRY(advance(l, true, &more));
  STEIF_CHECK(more, l->ctx, STEIF_BAD_INPUT,
              "%s, line %ld: the file ends before its sizes; is it complete?", l->path,
              l->number);
  STEIF_TRY(sizes(l, m));
  for (sunindextype k = 1; k <= m->entries; k++) {
    STEIF_TRY(advance(l, false, &more));
    STEIF_CHECK(more, l->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: the file ends after %lld of %lld entries; is it complete?",
                l->path, l->number, (long long)(k - 1), (long long)m->entries);
    STEIF_TRY(m->array ? value(l, m, k) : coordinate(l, m, &seen));
  }
  STEIF_TRY(advance(l, false, &more));
  return more ? reject(l, "the end of the file after the last entry", l->text) : STEIF_OK;
}

int stf_market_scan(steif_context *ctx, const char *path, FILE *file, stf_market *market)
{
  *market = (stf_market){0};
  stf_lines *l = stf_allocate(ctx, 1, sizeof *l);
  if (!l) return STEIF_NO_MEMORY;
  l->ctx = ctx;
  l->path = path;
  l->file = file;
  const int code = scan(l, market);
  stf_release(ctx, l);
  return code;
}
