/* weak.h: weak convergence of a method: what is asked, the measure, the picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef WEAK_H
#define WEAK_H

#include "curves.h"
#include "descriptor.h"
#include "test_function.h"

struct weak;

/* A report: what comes before its rows, a row of them, what comes after. */
struct weak_form {
  void (*head)(steif_report *r, const struct weak *w);
  void (*row)(steif_report *r, const struct weak *w, size_t i);
  void (*tail)(steif_report *r, const struct weak *w);
};

/* About a Jordan block, or a system. */
struct weak {
  struct call *call;
  const struct weak_form *form;
  steif_report *report;   /* rows stand in it as they come */
  size_t n;               /* unknowns of the system */
  long k;                 /* index of the block; 0: query has problem or linear */
  const char *kind;       /* "N-inc" */
  const char *convention; /* "P", "R", "C", "stage"; NULL: the usual one of the method */
  steif_weak_query query; /* method, start, h and rows are given, the rest is filled in */
  char problem[96];       /* of the Jordan block */
  double breaks[REALS_MOST];
  struct test_function g; /* of --g and --t1 */
  steif_weak_row row[HALVINGS];
  steif_weak_result result;
};

/* The convention and the name of the problem, then the measure. */
int weak_prepare(steif_context *ctx, struct weak *w);
int weak_measure(steif_context *ctx, struct weak *w);
/* Norms in H^-m; m 0: the usual one. */
int weak_ball(struct call *call, struct weak *w, int m);
/* With what asks for the problem filled in: one test function and its rows in this form, or a family. Its exit
 * code. */
int weak_answer(struct call *call, struct weak *w, const struct weak_form *form);
/* Each of several test functions, in words separated by ';'. */
int weak_family(struct call *call, struct weak *w, const char *words);
/* Where the test functions end: the last of them. */
int weak_end_of_test(struct call *call, double *t1);
/* What a call asks for. */
struct weak weak_asked(struct call *call);
/* A row of the report: what comes before its values, and after. */
void weak_row_begin(steif_report *r, const steif_weak_row *row);
void weak_row_end(steif_report *r, const steif_weak_row *row);
/* Is the verdict open that was asked for? Not by one row of sensible steps, which shows no order. */
bool weak_is_open(int converges, const char *verdict);
/* The test function and the verdict. */
void weak_verdict(steif_report *r, const struct weak *w);
/* `steif weak METHOD --index K`; an exit code. */
int weak_block(struct call *call);
/* `steif weak METHOD E.mtx F.mtx` or PROBLEM: one component, or all; an exit code. */
int weak_system(struct call *call);
const char *convention_name(enum steif_convention convention);

#endif
