/* eigenvalues_of.c: the finite eigenvalues that a call asks for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "eigenvalues_of.h"
#include <stdlib.h>

/* "RE" or "RE,IM" */
int read_near(const struct call *call, double point[2])
{
  const char *text = word_of(call, "--near");
  char *end = NULL;
  point[0] = text ? strtod(text, &end) : 0;
  point[1] = 0;
  const bool pair = text && end != text && *end == ',';
  const char *second = pair ? end + 1 : NULL;
  if (pair) point[1] = strtod(second, &end);
  if (!text || (end != text && end != second && !*end)) return EXIT_OK;
  return bad_usage(call, "--near is \"%s\" and must be a number, or two as RE,IM", text);
}

int eigenvalues_of(struct call *call, const struct descriptor *l, struct structure_answer *a)
{
  const steif_linear *q = &l->system;
  const steif_analysis how = descriptor_analysis(call, l);
  const bool asked = given(call, "--count") || given(call, "--near") || call->plot;
  const long count = whole_or(call, "--count", 0);
  if (!a->found.regular || a->found.index < 0) return EXIT_OK;
  const steif_eigenvalue_request near = {
    .count = count < l->n ? count : (long)l->n, .re = a->near[0], .im = a->near[1]};
  a->eigenvalues =
    !steif_eigenvalues_find(call->ctx, q->E, q->F, &how, &a->found, &near, &a->values);
  if (a->eigenvalues) return EXIT_OK;
  if (asked) return fail(call);
  steif_forget(call->ctx);
  return EXIT_OK;
}
