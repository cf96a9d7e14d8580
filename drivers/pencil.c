/* pencil.c: regularity, index and structure of a pencil s E + F.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear.h"
#include "run.h"
#include <math.h>
#include <stdlib.h>

static void numbers(steif_report *r, const char *name, long count, const sunindextype *value)
{
  double *x = malloc(((size_t)count + 1) * sizeof *x);
  for (long i = 0; x && i < count; i++) x[i] = (double)value[i];
  if (x) steif_report_list(r, name, (size_t)count, x);
  free(x);
}

/* null where the analysis leaves it open. */
static void count(steif_report *r, const char *name, long value)
{
  if (value >= 0)
    steif_report_whole(r, name, value);
  else
    steif_report_text(r, name, NULL);
}

/* By their names, or "e3" and "x2" counted from 1. */
static void names(steif_report *r, const char *key, char letter, const char *const *name,
                  size_t count, const sunindextype *value)
{
  enum { LONGEST = 24 };
  char *text = malloc(count * LONGEST + 1);
  const char **list = malloc((count + 1) * sizeof *list);
  for (size_t i = 0; text && list && i < count; i++) {
    snprintf(text + i * LONGEST, LONGEST, "%c%lld", letter, (long long)value[i] + 1);
    list[i] = name ? name[value[i]] : text + i * LONGEST;
  }
  steif_report_texts(r, key, text && list ? count : 0, list);
  free(text), free(list);
}

static void fill(steif_report *r, const steif_names *called, const steif_structure *s)
{
  const steif_names none = {NULL, NULL}, *by = called ? called : &none;
  count(r, "n", (long)s->n);
  count(r, "rank_E", (long)s->rank_E);
  steif_report_truth(r, "regular", s->regular);
  count(r, "index", s->index);
  if (s->index < 0 && s->regular) count(r, "index_least", s->index_least);
  count(r, "finite", (long)s->finite);
  count(r, "infinite", (long)s->infinite);
  count(r, "degree_bound", (long)s->degree);
  report_maybe(r, "", "count", !isnan(s->count), s->count);
  numbers(r, "weyr", s->weyr_count, s->weyr);
  steif_report_real(r, "gap", s->gap);
  steif_report_real(r, "rcond", s->rcond);
  steif_report_real(r, "radius", s->radius);
  steif_report_real(r, "resolution", s->resolution);
  names(r, "equations", 'e', by->equation, (size_t)s->equations_count, s->equations);
  names(r, "unknowns", 'x', by->unknown, (size_t)s->unknowns_count, s->unknowns);
  steif_report_truth(r, "certified", s->certified);
  steif_report_text(r, "method", s->method);
  steif_report_text(r, "message", s->message);
}

static int tell(struct call *call, const struct linear *l, const steif_structure *s)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  fill(r, l->names, s);
  const int code = present(call, r);
  steif_report_free(&r);
  if (code) return code;
  if (!s->regular) return linear_singular(call, l, s);
  if (!s->certified) say(call, "%s", s->message);
  return s->certified ? EXIT_OK : EXIT_UNCERTIFIED;
}

static int find(struct call *call, const struct linear *l)
{
  steif_structure s = {0};
  const steif_analysis a = linear_analysis(call, l);
  progress(call, "%ld equations", (long)l->n);
  if (steif_structure_find(call->ctx, l->system.E, l->system.F, &a, &s))
    return linear_fail(call);
  const int code = steif_structure_ranks(call->ctx, l->system.E, l->system.F, &s)
                     ? linear_fail(call)
                     : tell(call, l, &s);
  steif_structure_clear(call->ctx, &s);
  return code;
}

static int run(struct call *call)
{
  struct linear l;
  if (call->plot) return refuse(call, "a pencil has no picture; leave --plot out");
  int code = linear_open(call, &l, 0, false);
  if (!code) code = find(call, &l);
  linear_close(call, &l);
  return code;
}

static const struct option options[] = {ANALYSIS_ROWS, {NULL, FLAG, NULL, NULL}};

const struct verb verb_pencil = {
  "pencil",
  "Tell regularity, index and structure of a pencil s E + F",
  "E.mtx F.mtx | FILE.mat | PROBLEM [--algorithm A] [--radius R]",
  1,
  2,
  options,
  NULL,
  run};
