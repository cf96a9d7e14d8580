/* diagnose.c: index, structure and consistent start of a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

/* Names of those with flag[i] >= least: given ones, or "e3" or "y2"; none when memory is short. */
static void names(steif_report *r, const char *key, const char *const *given, char letter,
                  const int *flag, int least, size_t n)
{
  enum { LONGEST = 24 };
  char *text = malloc(n * LONGEST);
  const char **list = malloc(n * sizeof *list);
  size_t count = 0;
  for (size_t i = 0; text && list && i < n; i++) {
    if (flag[i] < least) continue;
    snprintf(text + count * LONGEST, LONGEST, "%c%zu", letter, i + 1);
    list[count] = given ? given[i] : text + count * LONGEST;
    count++;
  }
  steif_report_texts(r, key, count, list);
  free(text), free(list);
}

static void numbers(steif_report *r, const char *key, const int *value, size_t n)
{
  double *x = malloc(n * sizeof *x);
  for (size_t j = 0; x && j < n; j++) x[j] = value[j];
  steif_report_list(r, key, x ? n : 0, x);
  free(x);
}

static void fill(steif_report *r, const steif_problem *p, const steif_diagnosis *d,
                 const steif_start *s)
{
  const size_t n = (size_t)p->n, there = s->y ? n : 0;
  const steif_names given = p->names ? *p->names : (steif_names){0};
  steif_report_whole(r, "index", d->index);
  steif_report_text(r, "confidence", steif_confidence_name(d->confidence));
  numbers(r, "numbers", d->number, n);
  names(r, "equations", given.equation, 'e', d->derivatives, 1, n);
  names(r, "unknowns", given.unknown, 'y', d->number, 2, n);
  steif_report_whole(r, "freedom", (long)d->freedom);
  steif_report_list(r, "start.y", there, s->y);
  steif_report_list(r, "start.yp", there, s->yp);
  steif_report_list(r, "start.moved", there, s->moved);
  steif_report_text(r, "message", d->message);
}

static int exit_for(const steif_diagnosis *d)
{
  const bool singular = d->verdict == STEIF_NO_SOLUTION || d->verdict == STEIF_NOT_UNIQUE;
  return singular                           ? EXIT_SINGULAR
         : d->confidence == STEIF_UNDECIDED ? EXIT_UNCERTIFIED
                                            : EXIT_OK;
}

/* What was found at the point; a start is looked for where there can be one. */
static int look(struct call *call, const steif_problem *p, const steif_inquiry *q)
{
  steif_diagnosis d = {.index = -1};
  steif_start s = {0};
  if (steif_diagnose(call->ctx, p, q, &d) != STEIF_OK) return fail(call);
  const int verdict = exit_for(&d);
  if (verdict == EXIT_OK && p->n <= STEIF_DIAGNOSE_LARGEST &&
      steif_consistent(call->ctx, p, q, NULL, &s) != STEIF_OK)
    say(call, "%s", steif_message(call->ctx));
  steif_report *r = steif_report_new(call->ctx);
  fill(r, p, &d, &s);
  const int code = r ? present(call, r) : fail(call);
  steif_report_free(&r);
  if (verdict != EXIT_OK)
    say(call, "%s", d.message);
  else if (s.y)
    say(call, "start: %s", s.message);
  steif_start_clear(&s);
  steif_diagnosis_clear(&d);
  return code ? code : verdict;
}

/* The state at T: the exact solution, else a run by radau. */
static int look_at(struct call *call, const steif_problem *p, double t)
{
  steif_options o = steif_defaults();
  o.rtol = 1e-8, o.t1 = t;
  N_Vector y = NULL, yp = NULL;
  steif_solver *s = NULL;
  int code = EXIT_OK;
  if (p->exact) {
    y = N_VNew_Serial(p->n, steif_sundials(call->ctx));
    yp = N_VNew_Serial(p->n, steif_sundials(call->ctx));
    if (!y || !yp || p->exact(t, y, yp, p->user)) code = EXIT_FAILED;
    if (code) say(call, "the exact solution of '%s' is not known at t = %g", p->name, t);
  } else {
    s = steif_solver_new(call->ctx, p, "radau:s=3", &o);
    if (!s || steif_solve_to(s, t) != STEIF_OK) code = fail(call);
  }
  if (!code) {
    const steif_inquiry q = {.t = t,
                             .y = N_VGetArrayPointer(s ? steif_solution(s) : y),
                             .yp = s ? NULL : N_VGetArrayPointer(yp)};
    code = look(call, p, &q);
  }
  N_VDestroy(y), N_VDestroy(yp);
  steif_solver_free(&s);
  return code;
}

static int run(struct call *call)
{
  steif_problem p;
  if (steif_problem_find(call->ctx, call->word[0], &p) != STEIF_OK) return fail(call);
  const double t = real_of(call, "--at", p.t0);
  const int code = t > p.t0 ? look_at(call, &p, t) : look(call, &p, NULL);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static const struct option options[] = {
  {"--at", REAL, "T", "time on the solution instead of the start"},
  {NULL, FLAG, NULL, NULL},
};

const struct verb verb_diagnose = {"diagnose",
                                   "Index, structure and consistent start of a problem",
                                   "PROBLEM [--at T]",
                                   1,
                                   1,
                                   options,
                                   NULL,
                                   run};
