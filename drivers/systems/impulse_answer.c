/* impulse_answer.c: a jump with its impulses as fields of a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include "members.h"
#include <string.h>

/* What samples leave of the derivatives that the index asks for: orders 1, 2, ... */
static void derivatives(steif_report *r, const struct descriptor *l, const steif_impulse *i)
{
  enum { LEVELS = 16 };
  double accuracy[LEVELS];
  int count = 0;
  for (; l->function && count < i->count && count < LEVELS; count++)
    if (steif_function_accuracy(l->function, l->t0, count + 1, accuracy + count)) return;
  if (count && accuracy[count - 1] > 0)
    steif_report_list(r, "derivatives_accuracy", (size_t)count, accuracy);
}

void report_impulse(steif_report *r, const struct descriptor *l, const steif_impulse *i)
{
  static const struct member residuals[] = {MEMBER(steif_impulse, last, A_REAL),
                                            MEMBER(steif_impulse, chain, A_REAL),
                                            MEMBER(steif_impulse, first, A_REAL), MEMBERS_END};
  static const struct member facts[] = {
    MEMBER(steif_impulse, estimate, A_REAL),   MEMBER(steif_impulse, resolution, A_REAL),
    MEMBER(steif_impulse, certified, A_TRUTH), MEMBER(steif_impulse, method, A_TEXT),
    MEMBER(steif_impulse, message, A_WORD),    MEMBERS_END};
  const size_t n = (size_t)i->n;
  steif_report_whole(r, "index", i->index);
  if (l->names && l->names->unknown) steif_report_texts(r, "unknowns", n, l->names->unknown);
  steif_report_list(r, "x_plus", n, i->x_plus);
  steif_report_matrix(r, "impulses", (size_t)i->count, n, i->c);
  report_members(r, "residuals.", residuals, i);
  report_members(r, "", facts, i);
  derivatives(r, l, i);
  report_output_jump(r, l, i);
}

const char *const *impulse_columns(const struct descriptor *l)
{
  const char *const *name = l->names ? l->names->unknown : NULL;
  for (sunindextype i = 0; name && i < l->n; i++)
    if (!strcmp(name[i], "t") || !strcmp(name[i], "kind")) return NULL;
  return name;
}

int impulse_verdict(const struct call *call, const steif_impulse *i)
{
  if (!i->certified) say(call, "%s [STEIF_NOT_CERTIFIED]", i->message);
  return i->certified ? EXIT_OK : EXIT_UNCERTIFIED;
}
