/* two_starts.c: the nearest consistent values beside x(0+).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "two_starts.h"
#include <math.h>

/* Values this near, relative to the largest, are equal; systems up to this order are looked at. */
#define SAME 1e-6
enum { SMALL = 40 };

void two_starts_compare(const char *const *name, size_t n, const double *nearest,
                        const double *plus, char text[TWO_STARTS_TEXT])
{
  double most = 0, size = 0;
  size_t worst = 0;
  char unknown[80];
  for (size_t i = 0; i < n; i++) {
    size = fmax(size, fmax(fabs(plus[i]), fabs(nearest[i])));
    if (!(fabs(plus[i] - nearest[i]) > (1 + SAME) * most)) continue; /* the first of equals */
    most = fabs(plus[i] - nearest[i]);
    worst = i;
  }
  if (name)
    snprintf(unknown, sizeof unknown, "%.60s", name[worst]);
  else
    snprintf(unknown, sizeof unknown, "unknown %zu", worst + 1);
  if (most <= SAME * size)
    snprintf(text, TWO_STARTS_TEXT,
             "the nearest consistent values (steif diagnose) and x(0+) (steif impulse) agree");
  else
    snprintf(
      text, TWO_STARTS_TEXT,
      "the nearest consistent values (steif diagnose) and x(0+) (steif impulse) differ, %s "
      "is %.6g in the first, %.6g in the second: the first move all unknowns as little as "
      "possible, whatever they "
      "are; x(0+) is where the equations lead, and keeps E x but for what the impulses take "
      "(charge, momentum)",
      unknown, nearest[worst], plus[worst]);
}

void two_starts_of_problem(struct call *call, const steif_problem *p, const double *nearest,
                           char text[TWO_STARTS_TEXT])
{
  steif_jump jump = {0};
  const char *const *name = p->names ? p->names->unknown : NULL;
  const steif_point at = {.y = p->y0, .t = p->t0};
  text[0] = 0;
  if (!steif_jump_find(call->ctx, p, &at, NULL, &jump) && jump.unique)
    two_starts_compare(name, (size_t)p->n, nearest, jump.y, text);
  steif_jump_clear(&jump);
  steif_forget(call->ctx);
}

void two_starts_of_system(struct call *call, const struct descriptor *l, const double *plus,
                          char text[TWO_STARTS_TEXT])
{
  steif_problem p;
  steif_start start = {0};
  const char *const *name = l->names ? l->names->unknown : NULL;
  text[0] = 0;
  if (l->n > SMALL) return;
  if (!steif_linear_problem(call->ctx, &l->system, l->x0, l->t0, l->t0 + 1, &p) &&
      !steif_consistent(call->ctx, &p, NULL, NULL, &start))
    two_starts_compare(name, (size_t)l->n, start.y, plus, text);
  steif_start_clear(&start);
  steif_forget(call->ctx);
}
