/* workprec_report.h: what the benchmark of work against precision keeps and how it is reported.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WORKPREC_REPORT_H
#define WORKPREC_REPORT_H

#include "benchmarks.h"
#include "curves.h"
#include "workprec.h"

enum { PLAN_MOST = 32, DIGITS = 4 };
typedef struct plan_list {
  size_t count;
  char item[PLAN_MOST][STEIF_SPEC_WORD];
} plan_list;
/* Items of a list as it was given, or where `text` is NULL of the usual plan. A parameter "key=value"
 * without ':' belongs to the item before it: "heat:n=400,storage=sparse". */
void work_split(plan_list *l, const char *text, const char *(*usual_at)(size_t i));

typedef struct workprec {
  plan_list problems, methods;
  size_t rtols, runs, matches;
  double rtol[REALS_MOST], longest;
  long short_baselines; /* successes of baselines with fewer digits than due */
  steif_bench_solve run[PLAN_MOST * REALS_MOST]; /* of the problem at hand */
  steif_bench_match match[PLAN_MOST * DIGITS];
} workprec;

void work_header(const workprec *w, const struct call *call, steif_report *r);
/* The runs at hand as matches, failures, runs that promised more digits than they have. */
void work_problem(workprec *w, const struct call *call, steif_report *r);
void work_summary(const workprec *w, steif_report *r);
/* One problem: time against digits of each method; several: the ratios against digits. */
int work_picture(const workprec *w, const struct call *call);

#endif
