/* settings.c: runs of a baseline in all its settings, judged by their errors.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "settings.h"
#include "members.h"
#include <math.h>
#include <string.h>

enum { STEPS_LONGEST = 300000, SECONDS_LONGEST = 60 };
static const double far = 100; /* tolerances */

static const char *const words[] = {"right",
                                    "late right",
                                    "less than asked",
                                    "success with a wrong jump",
                                    "success with no right digit",
                                    "stops"};
enum word { RIGHT, LATE, LESS, WRONG, NONE, STOPS };

/* In the order of what they ask of the user. */
static const char *const of_ida[] = {"ida",
                                     "ida:suppress=1",
                                     "ida:suppress=1,ic=1",
                                     "ida:suppress=1,ic=2",
                                     "ida:suppress=1,id=index",
                                     "ida:suppress=1,id=index,ic=2"};

const char *settings_at(size_t i) { return i < SETTINGS_MOST ? of_ida[i] : NULL; }

bool settings_many(const char *method, const steif_problem *p)
{
  return !strcmp(method, "ida") && (p->F || p->E || p->Ev);
}

static size_t count_of(const char *method, const steif_problem *p, int index)
{
  enum { BY_COLUMNS = 4 }; /* at index 1 all components are of index 1 */
  if (!settings_many(method, p)) return 1;
  return index == 1 ? BY_COLUMNS : SETTINGS_MOST;
}

/* --- errors --- */

static double apart(size_t n, const double *x, const double *y)
{
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = fabs(x[i] - y[i]);
    if (!(d <= most)) most = d; /* NaN stays */
  }
  return most;
}

static double slow_part(steif_context *ctx, const known_solution *k, const double *x)
{
  double *error = k->slow, *slow = k->slow + k->n, most = 0;
  for (size_t i = 0; i < k->n; i++) error[i] = x[i] - k->plus[i];
  if (steif_projector_apply(ctx, k->system.E, k->system.F, NULL, &k->structure, error, slow))
    return NAN;
  for (size_t i = 0; i < k->n; i++) most = fmax(most, fabs(slow[i]));
  return most;
}

typedef struct at_start {
  steif_context *ctx;
  const known_solution *known;
  setting_run *run;
  double least; /* errors below are none */
} at_start;

static void see_start(steif_solver *s, void *user)
{
  const at_start *a = user;
  const known_solution *k = a->known;
  const double *x = N_VGetArrayPointer(steif_solution(s));
  if (!k->plus || !x) return;
  a->run->start = apart(k->n, x, k->plus);
  if (k->pencil && a->run->start > a->least) a->run->slow = slow_part(a->ctx, k, x);
}

/* The name of the flag that stands in the sentence of the baseline, else that of the code. */
static void own_word(setting_run *run)
{
  static const char *const prefix[] = {"IDA_", "CV_", "ARK_"};
  const char *at = NULL;
  size_t used = 0;
  for (int i = 0; run->out.code && !at && i < 3; i++) at = strstr(run->out.message, prefix[i]);
  if (!at) {
    snprintf(run->word, sizeof run->word, "%s",
             run->out.code ? steif_code_name(run->out.code) : "success");
    return;
  }
  for (; (*at == '_' || (*at >= 'A' && *at <= 'Z')) && used < sizeof run->word - 1; at++)
    run->word[used++] = *at;
  run->word[used] = 0;
}

static enum word judge(const setting_run *run, const known_solution *k, const settings *s)
{
  const double from = far * fmax(s->rtol * k->size_plus, s->atol);
  const double to = far * fmax(s->rtol * k->size_end, s->atol);
  const bool start = run->start > from, slow = run->slow > from;
  const bool end = !(run->end <= to);
  if (run->out.code) return STOPS;
  if (isnan(run->slow) ? start && end : slow) return WRONG;
  if (end) return run->end < fmax(k->size_end, to) ? LESS : NONE;
  return start ? LATE : RIGHT;
}

/* --- runs --- */

static void one(const struct call *call, const steif_problem *p, const steif_options *o,
                const known_solution *k, const settings *set, setting_run *run)
{
  steif_solver *s = NULL;
  at_start a = {call->ctx, k, run, far * fmax(set->rtol * k->size_plus, set->atol)};
  run->start = run->slow = run->end = NAN;
  progress(call, "%s, rtol %.3g", run->spec, o->rtol);
  run->out = integrate_from(call->ctx, p, run->spec, o, &s, see_start, &a);
  const double *x = s ? N_VGetArrayPointer(steif_solution(s)) : NULL;
  if (k->end && x && !run->out.code) run->end = apart(k->n, x, k->end);
  steif_solver_free(&s);
  own_word(run);
  const bool known = run->out.code || k->end;
  run->verdict = known ? words[judge(run, k, set)] : "";
}

/* By the word, then by the error at t1, then at 0+; what stops by how far it came. */
static bool better(const setting_run *x, const setting_run *y)
{
  size_t at[2] = {0, 0};
  while (at[0] < STOPS && strcmp(words[at[0]], x->verdict)) at[0]++;
  while (at[1] < STOPS && strcmp(words[at[1]], y->verdict)) at[1]++;
  if (!*x->verdict || !*y->verdict) return !x->out.code && (y->out.code || x->start < y->start);
  if (at[0] != at[1]) return at[0] < at[1];
  if (at[0] == STOPS) return x->out.t > y->out.t;
  return x->end != y->end ? x->end < y->end : x->start < y->start;
}

/* The best first; equals stay in their order. */
static void rank(settings *s)
{
  for (size_t i = 1; i < s->count; i++) {
    const setting_run run = s->run[i];
    size_t k = i;
    for (; k > 0 && better(&run, &s->run[k - 1]); k--) s->run[k] = s->run[k - 1];
    s->run[k] = run;
  }
}

void settings_run(const struct call *call, const steif_problem *p, const char *method,
                  const steif_options *given, const known_solution *k, settings *s)
{
  steif_options o = *given;
  o.stop = interruption_poll();
  memset(s, 0, sizeof *s);
  s->rtol = o.rtol;
  s->atol = o.rtol * tolerance_ratio(p, &o);
  const size_t count = count_of(method, p, k->index);
  if (count > 1) {
    o.max_steps = o.max_steps < STEPS_LONGEST ? o.max_steps : STEPS_LONGEST;
    o.max_seconds = o.max_seconds > 0 ? fmin(o.max_seconds, SECONDS_LONGEST) : SECONDS_LONGEST;
  }
  for (size_t i = 0; i < count && (i == 0 || !interrupted()); i++) {
    setting_run *run = &s->run[s->count++];
    snprintf(run->spec, sizeof run->spec, "%s", count > 1 ? of_ida[i] : method);
    one(call, p, &o, k, s, run);
  }
  rank(s);
}

/* --- reports --- */

static void cell(steif_report *r, const char *sheet, const char *key, double value)
{
  char prefix[64];
  snprintf(prefix, sizeof prefix, "%s.", sheet);
  report_maybe(r, prefix, key, isfinite(value), value);
}

static void text(steif_report *r, const char *sheet, const char *key, const char *value)
{
  char name[96];
  snprintf(name, sizeof name, "%s.%s", sheet, key);
  steif_report_text(r, name, *value ? value : NULL);
}

void report_settings(steif_report *r, const char *sheet, const char *problem, const settings *s)
{
  for (size_t i = 0; i < s->count; i++) {
    const setting_run *run = &s->run[i];
    char name[96];
    steif_report_row(r, sheet);
    if (problem) text(r, sheet, "problem", problem);
    text(r, sheet, "setting", run->spec);
    text(r, sheet, "word", run->word);
    snprintf(name, sizeof name, "%s.steps", sheet);
    steif_report_whole(r, name, run->out.stats.steps);
    cell(r, sheet, "t", run->out.t);
    cell(r, sheet, "error_plus", run->start);
    cell(r, sheet, "error_end", run->end);
    cell(r, sheet, "asked", -log10(s->rtol));
    text(r, sheet, "verdict", run->verdict);
  }
}

void report_best(steif_report *r, const char *object, const settings *s)
{
  const setting_run *best = &s->run[0];
  text(r, object, "settings", best->spec);
  text(r, object, "word", best->word);
  cell(r, object, "error_plus", best->start);
  cell(r, object, "error_end", best->end);
}
