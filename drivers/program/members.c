/* members.c: members of a result under the keys of a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "members.h"
#include <stdlib.h>

enum { KEY = 96 };

void report_maybe(steif_report *r, const char *prefix, const char *key, bool there,
                  double value)
{
  char name[KEY];
  snprintf(name, sizeof name, "%s%s", prefix, key);
  if (there)
    steif_report_real(r, name, value);
  else
    steif_report_text(r, name, NULL);
}

void report_natural(steif_report *r, const char *name, long value)
{
  if (value >= 0)
    steif_report_whole(r, name, value);
  else
    steif_report_text(r, name, NULL);
}

static void report_member(steif_report *r, const char *prefix, const struct member *m,
                          const void *at)
{
  char name[KEY];
  snprintf(name, sizeof name, "%s%s", prefix, m->key);
  const sunrealtype *real = at;
  switch (m->kind) {
  case A_REAL: steif_report_real(r, name, *real); break;
  case A_NUMBER: report_maybe(r, prefix, m->key, *real == *real, *real); break;
  case A_WHOLE: steif_report_whole(r, name, *(const int *)at); break;
  case A_NATURAL: report_natural(r, name, *(const int *)at); break;
  case A_LONG: steif_report_whole(r, name, *(const long *)at); break;
  case A_INDEX: report_natural(r, name, (long)*(const sunindextype *)at); break;
  case A_TRUTH: steif_report_truth(r, name, *(const int *)at); break;
  case A_TEXT: steif_report_text(r, name, *(const char *const *)at); break;
  case A_WORD: steif_report_text(r, name, at); break;
  }
}

void report_members(steif_report *r, const char *prefix, const struct member *member,
                    const void *of)
{
  for (const struct member *m = member; m->key; m++)
    report_member(r, prefix, m, (const char *)of + m->at);
}

void report_names(steif_report *r, const char *name, const char *const *given, char letter,
                  size_t count, const sunindextype *component)
{
  enum { LONGEST = 24 };
  char *text = malloc(count * LONGEST + 1);
  const char **list = malloc((count + 1) * sizeof *list);
  for (size_t i = 0; text && list && i < count; i++) {
    char *own = text + i * LONGEST;
    snprintf(own, LONGEST, "%c%lld", letter, (long long)component[i] + 1);
    list[i] = given ? given[component[i]] : own;
  }
  steif_report_texts(r, name, text && list ? count : 0, list);
  free(text);
  free(list);
}

void report_wholes(steif_report *r, const char *name, size_t count, const sunindextype *value)
{
  double *x = malloc((count + 1) * sizeof *x);
  for (size_t i = 0; x && i < count; i++) x[i] = (double)value[i];
  if (x) steif_report_list(r, name, count, x);
  free(x);
}

void report_dense(steif_report *r, const char *name, int rows, int columns, const double *x)
{
  const size_t count = (size_t)rows * (size_t)columns;
  double *by_rows = malloc((count + 1) * sizeof *by_rows);
  for (int i = 0; by_rows && i < rows; i++)
    for (int j = 0; j < columns; j++) by_rows[i * columns + j] = x[i + rows * j];
  if (by_rows) steif_report_matrix(r, name, (size_t)rows, (size_t)columns, by_rows);
  free(by_rows);
}
