/* diagnosis_answer.c: index, structure and consistent start of a problem as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include <stdlib.h>

static void report_ints(steif_report *r, const char *name, const int *value, size_t n)
{
  sunindextype *x = malloc(n * sizeof *x);
  for (size_t i = 0; x && i < n; i++) x[i] = value[i];
  report_wholes(r, name, x ? n : 0, x);
  free(x);
}

/* Names of the components whose value is at least `least`. */
static void report_from(steif_report *r, const char *name, const char *const *given,
                        char letter, const int *value, int least, size_t n)
{
  sunindextype *component = malloc(n * sizeof *component);
  size_t count = 0;
  for (size_t i = 0; component && i < n; i++)
    if (value[i] >= least) component[count++] = (sunindextype)i;
  report_names(r, name, given, letter, count, component);
  free(component);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct diagnosis_answer *a = result;
  const steif_diagnosis *d = &a->diagnosis;
  const steif_start *s = &a->start;
  const size_t n = (size_t)a->problem->n, there = s->y ? n : 0;
  const steif_names given = a->problem->names ? *a->problem->names : (steif_names){0};
  (void)call;
  steif_report_whole(r, "index", d->index);
  steif_report_text(r, "confidence", steif_confidence_name(d->confidence));
  report_ints(r, "numbers", d->number, n);
  report_from(r, "equations", given.equation, 'e', d->derivatives, 1, n);
  report_from(r, "unknowns", given.unknown, 'y', d->number, 2, n);
  steif_report_whole(r, "freedom", (long)d->freedom);
  steif_report_list(r, "start.y", there, s->y);
  steif_report_list(r, "start.yp", there, s->yp);
  steif_report_list(r, "start.moved", there, s->moved);
  if (a->beside[0]) steif_report_text(r, "start.beside", a->beside);
  steif_report_text(r, "message", d->message);
}

int diagnosis_present(const struct call *call, const struct diagnosis_answer *a)
{
  const steif_diagnosis *d = &a->diagnosis;
  const bool singular = d->verdict == STEIF_NO_SOLUTION || d->verdict == STEIF_NOT_UNIQUE;
  const bool undecided = !singular && d->confidence == STEIF_UNDECIDED;
  const int code = present_result(call, fill, a);
  if (singular)
    say(call, "%s [STEIF_SINGULAR]", d->message);
  else if (undecided)
    say(call, "%s [STEIF_NOT_CERTIFIED]", d->message);
  else if (a->start.y)
    say(call, "start: %s%s%s", a->start.message, a->beside[0] ? "; " : "", a->beside);
  return code ? code : singular ? EXIT_SINGULAR : undecided ? EXIT_UNCERTIFIED : EXIT_OK;
}
