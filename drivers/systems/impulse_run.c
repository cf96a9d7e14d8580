/* impulse_run.c: trajectory, jumps and impulses of a descriptor system.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include "members.h"
#include <nvector/nvector_serial.h>
#include <steif/runs.h>
#include <stdlib.h>

enum { BREAKS = 256, TITLE = 160, KNOWN = 100 };

/* What a run leaves: its start and end on stdout, everything in the sheet of --csv. */
struct record {
  const struct call *call;
  const struct descriptor *linear;
  const char *const *column; /* impulse_columns */
  steif_report *shown, *sheet;
  trajectory path;
  size_t n;
  int verdict;
  long jumps, steps;
  N_Vector view; /* of rows of a run through layers */
  size_t break_count;
  double breaks[BREAKS];
};

/* A row that is complete. */
static void come(struct record *k)
{
  if (k->call->csv) csv_comes(k->call, k->sheet);
}

static int jump(double t, const double *before, const steif_impulse *i, void *user)
{
  struct record *k = user;
  if (k->jumps == 0) report_impulse(k->shown, k->linear, i);
  k->jumps++;
  report_jump(k->shown, "jumps", NULL, t, before, i);
  if (k->call->csv) report_jump(k->sheet, "rows", k->column, t, before, i);
  come(k);
  if (!k->verdict) k->verdict = impulse_verdict(k->call, i);
  return 0;
}

static int step(double t, N_Vector x, void *user)
{
  struct record *k = user;
  const double *value = N_VGetArrayPointer(x);
  k->steps++;
  if (k->call->csv) report_vector(k->sheet, "rows", k->column, "x", t, k->n, value);
  come(k);
  if (t >= k->path.t1) {
    steif_report_real(k->shown, "t", t);
    steif_report_list(k->shown, "x", k->n, value);
    report_output(k->shown, "y", k->linear, t, value);
  }
  if (interrupted()) return 1;
  return k->call->plot || k->n <= KNOWN ? trajectory_keep(&k->path, t, x) : 0;
}

/* The exact smooth solution at the same times, where f has the derivatives for it. */
static void exact(struct record *k)
{
  const struct descriptor *l = k->linear;
  const trajectory *p = &k->path;
  const steif_analysis a = descriptor_analysis(k->call, k->linear);
  steif_linear_truth truth;
  double *x = p->count ? malloc(p->count * k->n * sizeof *x) : NULL;
  if (x && !steif_linear_exact(k->call->ctx, &l->system, l->x0, l->t0, &a, k->break_count,
                               k->breaks, p->count, p->t, p->y, x, &truth)) {
    steif_report_list(k->shown, "exact", k->n, x + (p->count - 1) * k->n);
    steif_report_real(k->shown, "exact_accuracy", truth.accuracy);
    steif_report_real(k->shown, "error", truth.end);
    steif_report_real(k->shown, "error_most", truth.most);
    for (size_t i = 0; i < p->count && k->call->csv; i++)
      report_vector(k->sheet, "rows", k->column, "exact", p->t[i], k->n, x + i * k->n);
  } else {
    steif_report_text(k->shown, "exact", NULL);
  }
  steif_forget(k->call->ctx);
  free(x);
}

static int output(struct record *k, const char *method)
{
  char title[TITLE];
  snprintf(title, sizeof title, "%s by %s", k->call->word[0], method);
  steif_report_whole(k->shown, "steps", k->steps);
  if (k->n <= KNOWN) exact(k);
  if (given(k->call, "--vs"))
    report_beside(k->call, k->linear, word_of(k->call, "--vs"), k->shown);
  int code = show(k->call, k->shown);
  if (!code) code = save_csv(k->call, k->sheet);
  if (!code) code = trajectory_plot(k->call, &k->path, title);
  return code ? code : k->verdict;
}

/* A run that a signal has ended keeps its rows. */
static int ended(struct record *k, const char *method, int code)
{
  if (code && !interrupted()) return descriptor_fail(k->call);
  if (!code) return output(k, method);
  steif_forget(k->call->ctx);
  steif_report_whole(k->shown, "steps", k->steps);
  show(k->call, k->shown);
  save_csv(k->call, k->sheet);
  say(k->call, "interrupted after %ld steps; the rows until then are kept [STEIF_STOPPED]",
      k->steps);
  return interruption_exit();
}

static int integrate_on(struct call *call, const struct descriptor *l, struct record *k)
{
  steif_options o = steif_defaults();
  o.t1 = k->path.t1;
  o.h = real_of(call, "--h");
  o.h0 = real_of(call, "--h0");
  o.rtol = real_or(call, "--rtol", o.rtol);
  o.atol = real_of(call, "--atol");
  const char *method = word_of(call, "--method");
  const size_t count =
    l->function ? steif_function_breaks(l->function, l->t0, o.t1, BREAKS, k->breaks) : 0;
  k->break_count = count;
  if (count > BREAKS)
    return bad_usage(call, "f has %zu breaks up to t = %g, %d are the most; end earlier", count,
                     o.t1, BREAKS);
  const steif_analysis a = descriptor_analysis(call, l);
  const steif_linear_output out = {jump, step, k};
  interruption_poll();
  progress(call, "%s to t = %g", method, o.t1);
  return ended(k, method,
               steif_linear_run(call->ctx, &l->system, l->x0, l->t0, method, &o, &a, count,
                                k->breaks, &out));
}

static int row(double t, const double *x, int layer, void *user)
{
  struct record *k = user;
  if (!layer) {
    N_VSetArrayPointer((double *)x, k->view);
    return step(t, k->view, k);
  }
  if (k->call->csv) report_vector(k->sheet, "rows", k->column, "layer", t, k->n, x);
  come(k);
  return 0;
}

static void lengths(steif_report *r, const steif_layers_stats *stats)
{
  static const struct member part[] = {
    {"layer_first", A_WHOLE, offsetof(steif_layers_stats, opening)},
    {"layer", A_WHOLE, offsetof(steif_layers_stats, width)},
    MEMBER(steif_layers_stats, changes, A_LONG),
    MEMBER(steif_layers_stats, again, A_LONG),
    {"re"
     "fused",
     A_LONG, offsetof(steif_layers_stats, rejected)}, /* JSON keys keep their names */
    {"h_least", A_REAL, offsetof(steif_layers_stats, shortest)},
    {"h_most", A_REAL, offsetof(steif_layers_stats, longest)},
    MEMBERS_END};
  report_members(r, "", part, stats);
}

/* From x(0-) itself. */
static int through_layers(struct call *call, const struct descriptor *l, struct record *k)
{
  steif_options o = steif_defaults();
  steif_layers_stats stats;
  const char *method = word_of(call, "--method");
  const steif_analysis a = descriptor_analysis(call, l);
  o.t1 = k->path.t1;
  o.h0 = real_of(call, "--h0");
  o.rtol = real_or(call, "--rtol", o.rtol);
  o.atol = real_of(call, "--atol");
  if (l->function && steif_function_breaks(l->function, l->t0, o.t1, BREAKS, k->breaks))
    return bad_usage(
      call,
      "--layers takes no breaks of f, and the first is at %g: end there, or leave "
      "--layers out",
      k->breaks[0]);
  k->view = N_VMake_Serial((sunindextype)k->n, l->x0, steif_sundials(call->ctx));
  if (!k->view) return no_memory(call, "values", "give the process more");
  interruption_poll();
  const int code =
    steif_layers_run(call->ctx, &l->system, l->x0, l->t0, method, &o, &a, row, k, &stats);
  N_VDestroy(k->view);
  if (!code) lengths(k->shown, &stats);
  return ended(k, method, code);
}

int impulse_run(struct call *call, const struct descriptor *l)
{
  struct record k = {
    .call = call,
    .linear = l,
    .column = impulse_columns(l),
    .shown = steif_report_new(call->ctx),
    .sheet = steif_report_new(call->ctx),
    .n = (size_t)l->n,
    .path = {.call = call, .names = l->names, .n = (size_t)l->n, .t1 = real_of(call, "--t1")}};
  const int code = !k.shown || !k.sheet      ? fail(call)
                   : given(call, "--layers") ? through_layers(call, l, &k)
                                             : integrate_on(call, l, &k);
  trajectory_free(&k.path);
  steif_report_free(&k.sheet);
  steif_report_free(&k.shown);
  return code;
}
