/* workprec_run.c: the cheapest solves of steif against the cheapest of CVODE, IDA and ARKODE.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "workprec_report.h"
#include <string.h>

void work_split(plan_list *l, const char *text, const char *(*usual_at)(size_t i))
{
  for (size_t i = 0; !text && l->count < PLAN_MOST && usual_at(i); i++)
    snprintf(l->item[l->count++], STEIF_SPEC_WORD, "%s", usual_at(i));
  while (text && *text && l->count <= PLAN_MOST) {
    const size_t length = strcspn(text, ",");
    const char *equal = memchr(text, '=', length), *colon = memchr(text, ':', length);
    const bool more = equal && (!colon || equal < colon) && l->count > 0;
    if (!more && l->count == PLAN_MOST) return;
    char *item = l->item[more ? l->count - 1 : l->count++];
    const size_t used = more ? strlen(item) : 0;
    snprintf(item + used, STEIF_SPEC_WORD - used, more ? ",%.*s" : "%.*s", (int)length, text);
    text += length + (text[length] == ',');
  }
}

static int open(struct call *call, workprec *w)
{
  steif_method_info m;
  work_split(&w->problems, word_of(call, "--problems"), steif_bench_problem);
  work_split(&w->methods, word_of(call, "--methods"), steif_bench_method);
  w->rtols = reals_of(call, "--rtols", w->rtol);
  w->longest = real_or(call, "--longest", 2);
  for (size_t k = 0; k < w->methods.count; k++)
    if (steif_method_find(call->ctx, w->methods.item[k], &m)) return fail(call);
  for (size_t i = 0; i < w->problems.count; i++) {
    steif_problem p;
    if (steif_problem_find(call->ctx, w->problems.item[i], &p)) return fail(call);
    steif_problem_clear(call->ctx, &p);
  }
  return EXIT_OK;
}

/* Tolerances in the order given; after one that ended for its time none is tried. */
static void one_method(struct call *call, workprec *w, const char *problem, const char *method)
{
  for (size_t k = 0; k < w->rtols && !interrupted(); k++) {
    steif_bench_solve *run = &w->run[w->runs];
    progress(call, "%s, %s, rtol %.0e", problem, method, w->rtol[k]);
    const int code =
      steif_bench_measure(call->ctx, problem, method, w->rtol[k], w->longest, run);
    steif_forget(call->ctx);
    if (code) return;
    w->runs++;
    if (run->late) return;
  }
}

int bench_workprec(struct call *call)
{
  static workprec w;
  int code = open(call, &w);
  if (code) return code;
  steif_report *r = steif_report_new(call->ctx);
  work_header(&w, call, r);
  for (size_t i = 0; i < w.problems.count && !interrupted(); i++) {
    w.runs = 0;
    for (size_t k = 0; k < w.methods.count; k++)
      one_method(call, &w, w.problems.item[i], w.methods.item[k]);
    work_problem(&w, call, r);
    rows_come(call, r);
  }
  work_summary(&w, r);
  code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  if (!code && !interrupted()) code = work_picture(&w, call);
  return bench_end(call, code);
}
