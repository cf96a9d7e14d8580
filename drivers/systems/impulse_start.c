/* impulse_start.c: the jump of E x' + F x = f at its start, and the spectral projectors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include "two_starts.h"
#include <stdlib.h>

enum { SHOWN = 400 }; /* unknowns up to which projectors are shown as matrices */

/* P in the rows of a report, and I - P after it. */
static int matrices(struct call *call, const struct descriptor *l, steif_report *r)
{
  const size_t n = (size_t)l->n;
  const steif_analysis a = descriptor_analysis(call, l);
  double *P = malloc(2 * n * n * sizeof *P), *rows = P ? P + n * n : NULL;
  if (!P) return no_memory(call, "projectors", "give the process more");
  const int code = steif_projector_find(call->ctx, l->system.E, l->system.F, &a, P);
  for (size_t k = 0; k < n * n; k++) rows[k] = P[k % n * n + k / n];
  if (!code) steif_report_matrix(r, "projectors.slow", n, n, rows);
  for (size_t k = 0; k < n * n; k++) rows[k] = (k % (n + 1) == 0) - rows[k];
  if (!code) steif_report_matrix(r, "projectors.fast", n, n, rows);
  free(P);
  return code ? descriptor_fail(call) : EXIT_OK;
}

static int projected(struct call *call, const struct descriptor *l, const steif_structure *s,
                     steif_report *r)
{
  const size_t n = (size_t)l->n;
  const steif_analysis a = descriptor_analysis(call, l);
  double *x = malloc(n * sizeof *x);
  if (!x) return no_memory(call, "the projected start", "give the process more");
  const int code = steif_projector_apply(call->ctx, l->system.E, l->system.F, &a, s, l->x0, x);
  if (!code) steif_report_list(r, "projectors.slow_x0", n, x);
  for (size_t k = 0; k < n; k++) x[k] = l->x0[k] - x[k];
  if (!code) steif_report_list(r, "projectors.fast_x0", n, x);
  free(x);
  return code ? descriptor_fail(call) : EXIT_OK;
}

int report_projectors(struct call *call, const struct descriptor *l, const steif_structure *s,
                      steif_report *r)
{
  return l->n > SHOWN ? projected(call, l, s, r) : matrices(call, l, r);
}

static int save_rows_of(struct call *call, const struct descriptor *l, const steif_impulse *i)
{
  if (!call->csv) return EXIT_OK;
  steif_report *sheet = steif_report_new(call->ctx);
  if (sheet) report_jump(sheet, "rows", impulse_columns(l), l->t0, l->x0, i);
  const int code = sheet ? save_csv(call, sheet) : fail(call);
  steif_report_free(&sheet);
  return code;
}

static int tell(struct call *call, const struct descriptor *l, const steif_structure *s,
                const steif_impulse *i)
{
  steif_report *r = steif_report_new(call->ctx);
  char beside[TWO_STARTS_TEXT];
  bool undecided = false;
  int code = r ? EXIT_OK : fail(call);
  if (!code) report_impulse(r, l, i);
  if (!code) two_starts_of_system(call, l, i->x_plus, beside);
  if (!code && beside[0]) steif_report_text(r, "nearest", beside);
  if (!code && given(call, "--projectors")) code = report_projectors(call, l, s, r);
  if (!code && given(call, "--slopes")) code = report_slopes(call, l, s, r, &undecided);
  if (!code && given(call, "--vs")) report_beside(call, l, word_of(call, "--vs"), r);
  if (!code) code = show(call, r);
  steif_report_free(&r);
  if (!code) code = save_rows_of(call, l, i);
  if (!code) code = impulse_verdict(call, i);
  return code ? code : undecided ? EXIT_UNCERTIFIED : EXIT_OK;
}

static int start(struct call *call, const struct descriptor *l, const steif_structure *s)
{
  steif_impulse i = {0};
  const steif_linear *q = &l->system;
  const steif_analysis a = descriptor_analysis(call, l);
  if (steif_impulse_find(call->ctx, q->E, q->F, l->x0, l->t0, q->f, q->user, &a, s, &i))
    return descriptor_fail(call);
  const int code = tell(call, l, s, &i);
  steif_impulse_clear(call->ctx, &i);
  return code;
}

int impulse_of_system(struct call *call, struct descriptor *l)
{
  steif_structure s = {0};
  const steif_analysis a = descriptor_analysis(call, l);
  progress(call, "%ld equations", (long)l->n);
  if (steif_structure_find(call->ctx, l->system.E, l->system.F, &a, &s))
    return descriptor_fail(call);
  const int code = !s.regular                ? descriptor_singular(call, l, &s, false)
                   : given(call, "--method") ? impulse_run(call, l)
                                             : start(call, l, &s);
  steif_structure_clear(call->ctx, &s);
  return code;
}

int impulse_on_system(struct call *call, const steif_problem *found)
{
  struct descriptor l;
  int code = descriptor_open_found(call, &l, 0, true, found);
  if (!code) code = descriptor_started(call, &l);
  if (!code && given(call, "--t1") && real_of(call, "--t1") <= l.t0)
    code = bad_usage(call, "--t1 is %s and must be later than the jump at %g",
                     word_of(call, "--t1"), l.t0);
  if (!code) code = impulse_of_system(call, &l);
  descriptor_close(call, &l);
  return code;
}
