/* impulse.c: jump and impulses of E x' + F x = f from any x(0-), and the run that follows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <stdlib.h>
#include <string.h>

enum { SHOWN = 400 };

/* Rows of the slow and of the fast projector. */
static int projectors(struct call *call, const struct linear *l, steif_report *r)
{
  const size_t n = (size_t)l->n;
  const steif_analysis a = linear_analysis(call, l);
  double *P = malloc(2 * n * n * sizeof *P), *rows = P ? P + n * n : NULL;
  if (!P) return linear_no_memory(call, "projectors");
  const int code = steif_projector_find(call->ctx, l->system.E, l->system.F, &a, P);
  for (size_t k = 0; k < n * n; k++) rows[k] = P[k % n * n + k / n];
  if (!code) steif_report_matrix(r, "projectors.slow", n, n, rows);
  for (size_t k = 0; k < n * n; k++) rows[k] = (k % (n + 1) == 0) - rows[k];
  if (!code) steif_report_matrix(r, "projectors.fast", n, n, rows);
  free(P);
  return code ? linear_fail(call) : EXIT_OK;
}

/* What they make of x(0-), where they are too large to be shown. */
static int projected(struct call *call, const struct linear *l, const steif_structure *s,
                     steif_report *r)
{
  const size_t n = (size_t)l->n;
  const steif_analysis a = linear_analysis(call, l);
  double *x = malloc(n * sizeof *x);
  if (!x) return linear_no_memory(call, "projected start");
  const int code = steif_projector_apply(call->ctx, l->system.E, l->system.F, &a, s, l->x0, x);
  if (!code) steif_report_list(r, "projectors.slow_x0", n, x);
  for (size_t k = 0; k < n; k++) x[k] = l->x0[k] - x[k];
  if (!code) steif_report_list(r, "projectors.fast_x0", n, x);
  free(x);
  return code ? linear_fail(call) : EXIT_OK;
}

static int tell(struct call *call, const struct linear *l, const steif_structure *s,
                const steif_impulse *i)
{
  steif_report *r = steif_report_new(call->ctx), *sheet = steif_report_new(call->ctx);
  int code = r && sheet ? EXIT_OK : fail(call);
  if (!code) impulse_fill(r, l, i), impulse_accuracy(r, l, i), impulse_outputs(r, l, i);
  if (!code && given(call, "--projectors"))
    code = l->n > SHOWN ? projected(call, l, s, r) : projectors(call, l, r);
  if (!code && given(call, "--vs")) impulse_against(call, l, word_of(call, "--vs", NULL), r);
  if (!code) code = show(call, r);
  if (!code && call->csv) {
    impulse_rows(sheet, "rows", impulse_columns(l), l->t0, l->x0, i);
    code = save_csv(call, sheet);
  }
  steif_report_free(&sheet);
  steif_report_free(&r);
  return code ? code : impulse_verdict(call, i);
}

static int start(struct call *call, const struct linear *l, const steif_structure *s)
{
  steif_impulse i = {0};
  const steif_linear *q = &l->system;
  const steif_analysis a = linear_analysis(call, l);
  if (steif_impulse_find(call->ctx, q->E, q->F, l->x0, l->t0, q->f, q->user, &a, s, &i))
    return linear_fail(call);
  const int code = tell(call, l, s, &i);
  steif_impulse_clear(call->ctx, &i);
  return code;
}

static int analyse(struct call *call, struct linear *l)
{
  steif_structure s = {0};
  const steif_analysis a = linear_analysis(call, l);
  progress(call, "%ld equations", (long)l->n);
  if (steif_structure_find(call->ctx, l->system.E, l->system.F, &a, &s))
    return linear_fail(call);
  const int code = !s.regular                ? linear_singular(call, l, &s)
                   : given(call, "--method") ? impulse_run(call, l)
                                             : start(call, l, &s);
  steif_structure_clear(call->ctx, &s);
  return code;
}

static int run(struct call *call)
{
  struct linear l;
  steif_problem nonlinear;
  if (impulse_is_nonlinear(call, &nonlinear)) return impulse_jump(call, &nonlinear);
  if (given(call, "--restitution") || given(call, "--stages"))
    return refuse(call, "--restitution and --stages are for nonlinear problems; leave them out");
  const bool vs = given(call, "--vs"), ends = given(call, "--t1") || vs;
  if (given(call, "--method") ? !given(call, "--t1") : given(call, "--t1") && !vs)
    return refuse(call, "--method and --t1 go together: the run after the jump and its end");
  if (!given(call, "--method") &&
      (given(call, "--h") || given(call, "--h0") || given(call, "--layers") ||
       (given(call, "--rtol") && !ends) || call->plot))
    return refuse(
      call, "--h, --h0, --rtol, --layers and --plot belong to a run; add --method and --t1");
  if (!strcmp(call->word[0], "all")) return impulse_all(call);
  int code = linear_open(call, &l, 0, true);
  if (!code) code = linear_started(call, &l);
  if (!code && given(call, "--t1") && real_of(call, "--t1", 0) <= l.t0)
    code = refuse(call, "--t1 is %s and must be later than the jump at %g",
                  word_of(call, "--t1", ""), l.t0);
  if (!code) code = analyse(call, &l);
  linear_close(call, &l);
  return code;
}

static const struct option options[] = {
  START_ROWS,
  {"--method", WORD, "METHOD",
   "integrate from x(0+), with a jump at every declared break of f"},
  {"--t1", REAL, "T", "end of that run"},
  {"--layers", FLAG, NULL,
   "from x(0-) itself: chosen steps that stay equal through layers (be, bdf:p=, radau:s=)"},
  {"--h", POSITIVE, "H", "its equal steps (default: chosen)"},
  {"--h0", POSITIVE, "H", "the first of its chosen steps (default: chosen)"},
  {"--rtol", POSITIVE, "R", "its tolerance (default 1e-6)"},
  {"--restitution", REAL, "E", "of an impact of a nonlinear problem (default 0)"},
  {"--stages", FLAG, NULL, "where its jump is not unique: positions first, then velocities"},
  {"--projectors", FLAG, NULL, "show the spectral projectors (n > 400: of x(0-)), too"},
  {"--vs", CHOICE, "ida|cvode|arkode", "run that, too, from the same x(0-) (all: of each system) to --t1"},
  ANALYSIS_ROWS,
  {NULL, FLAG, NULL, NULL},
};

static const char *const clash[][2] = {
  {"--forcing", "--f"},         {"--h", "--rtol"}, {"--h", "--h0"}, {"--h", "--layers"},
  {"--projectors", "--method"}, {NULL, NULL}};

const struct verb verb_impulse = {
  "impulse",
  "Find x(0+) and the impulses of E x' + F x = f or of a nonlinear problem from any x(0-)",
  "E.mtx F.mtx --x0 X.mtx | PROBLEM | all [--forcing FILE] [--method METHOD --t1 T --csv FILE]",
  1,
  2,
  options,
  clash,
  run};
