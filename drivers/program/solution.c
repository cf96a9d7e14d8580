/* solution.c: what one integration shows: the solution, digits, costs, events.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "solution.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What the invariants of the problem have lost or gained. */
static void fill_drift(steif_report *r, steif_solver *s)
{
  enum { SHOWN = 16 };
  sunrealtype drift[SHOWN];
  int count = SHOWN;
  if (s && steif_drift_now(s, &count, drift) == STEIF_OK && count > 0)
    steif_report_list(r, "drift", (size_t)count, drift);
}

/* What the model puts out at the end. */
static void fill_outputs(steif_report *r, const outcome *o, steif_solver *s,
                         const trajectory *tr)
{
  double *value = s && tr->outputs ? malloc(tr->outputs * sizeof *value) : NULL;
  if (value && !steif_model_outputs(tr->problem, o->t, steif_solution(s), value))
    for (size_t i = 0; i < tr->outputs; i++) {
      char name[128];
      snprintf(name, sizeof name, "outputs.%s", steif_model_output(tr->problem, i));
      steif_report_real(r, name, value[i]);
    }
  free(value);
}

/* What it took to put the last solution on all constraints, where unknowns of index 2 and 3 were less accurate by
 * themselves. */
static void fill_constrained(steif_report *r, const outcome *o, steif_solver *s)
{
  sunrealtype drift, corrected;
  if (o->code != STEIF_OK || !s || steif_recomputed(s, &drift, &corrected) || isnan(drift))
    return;
  steif_report_real(r, "recomputed.drift", drift);
  steif_report_real(r, "recomputed.corrected", corrected);
}

/* Constant steps that reached the end, with nothing on the way that begins steps of its own. */
static void fill_steps(steif_report *r, const outcome *o, const trajectory *tr)
{
  const steif_problem *p = tr->problem;
  if (!(tr->h > 0) || o->code != STEIF_OK || p->handle_event) return;
  const struct steps_made made = {.t0 = p->t0,
                                  .h = tr->h,
                                  .end = o->t,
                                  .asked = o->t,
                                  .last_h = o->stats.h_last,
                                  .steps = o->stats.steps};
  steif_report_whole(r, "steps", made.steps);
  report_steps(r, &made);
}

/* Adaptive steps of steif's own, which control such components through h^(index - 1). */
static bool controls_levels(const struct call *call, steif_solver *s, const trajectory *tr)
{
  steif_method_info m;
  char spec[STEIF_SPEC_WORD];
  const bool high = steif_initial_used(s)->index > 1 || tr->problem->dae_index > 1;
  snprintf(spec, sizeof spec, "%.*s", (int)strcspn(steif_method_used(s), " "),
           steif_method_used(s));
  return high && !(tr->h > 0) && !steif_method_find(call->ctx, spec, &m) &&
         strcmp(m.family, "baseline") != 0 && strcmp(m.family, "descriptor") != 0;
}

/* What "ok" does not promise. */
static void fill_hidden(steif_report *r, const struct call *call, const outcome *o,
                        steif_solver *s, const trajectory *tr)
{
  const double promised = 10;
  sunrealtype error;
  char text[200];
  if (!s || o->code != STEIF_OK || !controls_levels(call, s, tr)) return;
  const bool known = !steif_hidden_error(s, &error) && isfinite(error);
  if (known) steif_report_real(r, "hidden_error", error);
  if (known && error <= promised) return;
  snprintf(text, sizeof text,
           "components of index 2 and 3, controlled through h^(index - 1), %s",
           known ? "" : "may be off by more than 10 tolerances: by how much is not known");
  if (known)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "are off by about %.2g tolerances", error);
  steif_report_text(r, "hidden", text);
}

const char *solution_method(const struct call *call) { return call->word[call->words - 1]; }

/* Behind events and breaks. */
static void fill_jumps(steif_report *r, const steif_repair *used)
{
  if (!used->jumps) return;
  steif_report_text(r, "jumped", used->jumped);
  if (used->jumps > 1) steif_report_whole(r, "jumps", used->jumps);
}

static void fill(steif_report *r, const struct call *call, const outcome *o, steif_solver *s,
                 const trajectory *tr)
{
  const char *method = solution_method(call);
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", method);
  if (s && strcmp(method, steif_method_used(s)))
    steif_report_text(r, "used", steif_method_used(s));
  report_status(r, "", o);
  if (s && steif_model_start(tr->problem)[0])
    steif_report_text(r, "guesses", steif_model_start(tr->problem));
  if (s && steif_initial_used(s)->message[0])
    steif_report_text(r, "initial", steif_initial_used(s)->message);
  if (s && steif_initial_used(s)->index > 1)
    steif_report_whole(r, "index_found", steif_initial_used(s)->index);
  if (s) fill_jumps(r, steif_initial_used(s));
  if (o->why[0]) steif_report_text(r, "failure", o->why);
  steif_report_real(r, "t", o->t);
  fill_steps(r, o, tr);
  steif_report_list(r, "y", s ? tr->n : 0, s ? N_VGetArrayPointer(steif_solution(s)) : NULL);
  fill_outputs(r, o, s, tr);
  report_digits(r, "", o);
  report_stats(r, "stats.", o);
  if (o->stats.rounding > 0) steif_report_real(r, "stats.rounding", o->stats.rounding);
  fill_hidden(r, call, o, s, tr);
  fill_drift(r, s);
  fill_constrained(r, o, s);
  trajectory_fill(r, tr);
}

int solution_present(struct call *call, const outcome *o, steif_solver *s, trajectory *tr)
{
  char title[128];
  snprintf(title, sizeof title, "%s by %s", call->word[0], solution_method(call));
  const bool rounded = o->code == STEIF_OK && o->stats.rounding > 1;
  const int code = rounded               ? EXIT_UNCERTIFIED
                   : o->code == STEIF_OK ? EXIT_OK
                                         : exit_of_run(call, o->code, o->message);
  if (s) trajectory_end(tr, o->t, steif_solution(s));
  if (tr->shown_rows) putchar('\n');
  fill(tr->report, call, o, s, tr);
  int output = call->json || s ? show(call, tr->report) : EXIT_OK;
  if (tr->short_of_memory)
    no_memory(call, "the trajectory",
              "leave out --csv, --npz and --plot, or ask for fewer --points");
  else if (o->code != STEIF_OK || rounded)
    say(call, "%s", o->message);
  if (o->why[0]) say(call, "%s", o->why);
  if (s && output == EXIT_OK) output = trajectory_save(call, tr);
  if (s && output == EXIT_OK) output = trajectory_plot(call, tr, title);
  return code ? code : output;
}
