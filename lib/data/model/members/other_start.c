/* other_start.c: guesses between two solutions, as z ~ 0 of 0 = z^2 - x, are no choice between them. Sought is
 * the start from the mirror image of the one found: a second solution on the other side of the guess, about as
 * far from it, says so. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <steif/consistent.h>
#include <steif/model.h>
#include <stdio.h>
#include <string.h>

/* Distances within this ratio are no choice. */
static const sunrealtype alike = 1.25;

static bool moved(const stf_model *m, int32_t i, sunrealtype y)
{
  return m->start[i] != '=' && fabs(y - m->y0[i]) > 1e-6 * fabs(m->y0[i]) + 1e-9;
}

/* That on the other side of its guess in the second solution which is farthest from the first; -1: none. */
static int32_t opposite(const stf_model *m, const sunrealtype *a, const sunrealtype *b)
{
  int32_t at = -1;
  sunrealtype most = 0;
  for (int32_t i = 0; i < m->n; i++) {
    const sunrealtype one = a[i] - m->y0[i], two = b[i] - m->y0[i];
    const sunrealtype part = fabs(a[i] - b[i]) / (fabs(a[i]) + fabs(b[i]) + 1e-300);
    const bool sides = moved(m, i, a[i]) && moved(m, i, b[i]) && one * two < 0;
    const bool near = fabs(one) <= alike * fabs(two) && fabs(two) <= alike * fabs(one);
    if (sides && near && part > most) most = part, at = i;
  }
  return at;
}

static int tell(stf_model *m, const steif_problem *p, const sunrealtype *a,
                const sunrealtype *b)
{
  const int32_t i = opposite(m, a, b);
  if (i < 0) return STEIF_OK;
  STEIF_CHECK(
    m->start[i] != '~', m->ctx, STEIF_BAD_INPUT,
    "%s: the guess %s ~ %.6g lies between two solutions of the equations about as near, "
    "%.10g and %.10g: give a guess nearer to the one that is meant",
    p->name, m->unknown[i], m->y0[i], a[i], b[i]);
  const size_t end = strlen(m->moved);
  snprintf(m->moved + end, sizeof m->moved - end,
           "%s%.60s may be %.10g or %.10g, the first was taken: a guess after '~' chooses",
           end ? "; " : "", m->unknown[i], a[i], b[i]);
  return STEIF_OK;
}

int stf_other_start(stf_model *m, const steif_problem *p, const steif_request *request,
                    const sunrealtype *y)
{
  const steif_request few = {.attribute = request->attribute, .iterations = 20};
  bool any = false;
  sunrealtype *mirror = stf_allocate(m->ctx, (size_t)m->n, sizeof *mirror);
  if (!mirror) return STEIF_NO_MEMORY;
  for (int32_t i = 0; i < m->n; i++) {
    const bool other = moved(m, i, y[i]);
    mirror[i] = other ? 2 * m->y0[i] - y[i] : m->y0[i];
    any = any || other;
  }
  steif_start start = {0};
  int code = any ? stf_start_near(m, p, &few, mirror, &start) : STEIF_OK;
  if (!code && any)
    code = tell(m, p, y, start.y);
  else if (code && code != STEIF_NO_MEMORY)
    steif_forget(m->ctx), code = STEIF_OK;
  steif_start_clear(&start);
  stf_release(m->ctx, mirror);
  return code;
}
