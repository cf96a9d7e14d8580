/* sentences.c: equations and unknowns by name, and the sentence on a pencil that is singular by its
 * pattern: equations and unknowns without entries, or the first of those that share too few of the
 * others.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sentences.h"
#include <stdio.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const char *name(const char *what, const char *const *names, sunindextype i,
                        char text[STF_NAME])
{
  if (names)
    snprintf(text, STF_NAME, "%s %lld (%.60s)", what, (long long)i + 1, names[i]);
  else
    snprintf(text, STF_NAME, "%s %lld", what, (long long)i + 1);
  return text;
}

const char *stf_name_equation(const steif_names *names, sunindextype i, char text[STF_NAME])
{
  return name("equation", names ? names->equation : NULL, i, text);
}

static const char *name_unknown(const steif_names *names, sunindextype j, char text[STF_NAME])
{
  return name("unknown", names ? names->unknown : NULL, j, text);
}

/* Rows and, after them, columns that have an entry. */
static void mark(SUNMatrix M, sunindextype n, unsigned char *met)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  for (sunindextype j = 0; j < n; j++) {
    const sunindextype first = dense ? j * n : SM_INDEXPTRS_S(M)[j],
                       end = dense ? first + n : SM_INDEXPTRS_S(M)[j + 1];
    const sunrealtype *x = dense ? SM_DATA_D(M) : SM_DATA_S(M);
    for (sunindextype p = first; p < end; p++)
      if (x[p] != 0) {
        met[dense ? p - first : SM_INDEXVALS_S(M)[p]] = 1;
        met[n + j] = 1;
      }
  }
}

/* The list of those without an entry, where there are any; *count: how many. */
static int list_empty(steif_context *ctx, sunindextype n, const unsigned char *met,
                      sunindextype *count, sunindextype *listed, sunindextype **list)
{
  *count = 0;
  for (sunindextype i = 0; i < n; i++) *count += !met[i];
  if (!*count) return STEIF_OK;
  STEIF_TRY(stf_structure_list(ctx, *count, list));
  *listed = *count;
  for (sunindextype i = 0, k = 0; i < n; i++)
    if (!met[i]) (*list)[k++] = i;
  return STEIF_OK;
}

/* ", and so are 2 more" */
static const char *more(sunindextype count, char text[STF_NAME])
{
  *text = 0;
  if (count > 1) snprintf(text, STF_NAME, ", and so are %lld more", (long long)count - 1);
  return text;
}

static void say_empty(const steif_names *names, sunindextype equations, sunindextype unknowns,
                      steif_structure *s)
{
  char one[STF_NAME], two[STF_NAME], others[2][STF_NAME], rows[256] = "", columns[256] = "";
  if (equations)
    snprintf(rows, sizeof rows, "%s is empty, without an entry in E and F%s",
             stf_name_equation(names, s->equations[0], one), more(equations, others[0]));
  if (unknowns)
    snprintf(columns, sizeof columns, "%s%s is in no equation%s", equations ? "; " : "",
             name_unknown(names, s->unknowns[0], two), more(unknowns, others[1]));
  snprintf(s->message, sizeof s->message, "singular pencil: %s%s", rows, columns);
}

static void say_rank(const steif_names *names, sunindextype rank, steif_structure *s)
{
  char one[STF_NAME], two[STF_NAME];
  snprintf(s->message, sizeof s->message,
           "singular pencil: the patterns of E and F allow rank %lld of %lld; %lld equations "
           "share too few unknowns (the first is %s) and %lld unknowns too few equations (the "
           "first is %s)",
           (long long)rank, (long long)s->n, (long long)s->equations_count,
           stf_name_equation(names, s->equations[0], one), (long long)s->unknowns_count,
           name_unknown(names, s->unknowns[0], two));
}

int stf_say_singular_pattern(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                             const steif_names *names, sunindextype rank, steif_structure *s)
{
  const sunindextype n = s->n;
  sunindextype equations, unknowns = 0;
  unsigned char *met = stf_allocate(ctx, 2 * (size_t)n, 1);
  if (!met) return STEIF_NO_MEMORY;
  s->regular = 0;
  s->index = -1;
  s->finite = s->infinite = s->degree = -1;
  mark(E, n, met);
  mark(F, n, met);
  int code = list_empty(ctx, n, met, &equations, &s->equations_count, &s->equations);
  if (!code) code = list_empty(ctx, n, met + n, &unknowns, &s->unknowns_count, &s->unknowns);
  stf_release(ctx, met);
  if (code) return code;
  if (equations || unknowns)
    say_empty(names, equations, unknowns, s);
  else
    say_rank(names, rank, s);
  return STEIF_OK;
}
