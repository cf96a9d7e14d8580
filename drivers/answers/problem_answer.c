/* problem_answer.c: what a problem is: equations, sizes, index, source.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include "problem.h"
#include <steif/model.h>
#include <stdlib.h>
#include <string.h>

enum { LARGEST = 4000 }; /* unknowns of which the pattern is looked for */

/* Entries of dF/dy and dF/dy' near the start; null where nobody has looked. */
static void entries(steif_report *r, const struct call *call, const steif_problem *p)
{
  steif_pattern *found = NULL;
  long count = -1;
  if (p->pattern)
    count = (long)p->pattern->column[p->n];
  else if (p->n <= LARGEST && (p->f || p->F) && !steif_pattern_find(call->ctx, p, &found))
    count = (long)found->column[p->n];
  steif_pattern_free(call->ctx, &found);
  steif_forget(call->ctx);
  report_natural(r, "entries", count);
}

static void events(steif_report *r, const steif_problem *p)
{
  for (int i = 0; i < p->events; i++) {
    const steif_event *e = p->event_list ? p->event_list + i : NULL;
    const int direction = e ? e->direction : 0;
    steif_report_row(r, "events");
    steif_report_whole(r, "events.event", i + 1);
    steif_report_text(r, "events.name", e ? e->name : NULL);
    steif_report_text(r, "events.direction",
                      direction > 0   ? "rising"
                      : direction < 0 ? "falling"
                                      : "both");
    steif_report_truth(r, "events.ends the run", e && e->terminal);
  }
}

/* The numbers that :name=value and --vary change. */
static void parameters(steif_report *r, const steif_problem *p)
{
  const steif_parameters *of = p->parameters;
  char number[24];
  for (int k = 0; of && k < of->count; k++) {
    steif_report_row(r, "parameters");
    snprintf(number, sizeof number, "p%d", k + 1);
    steif_report_text(r, "parameters.parameter", of->name ? of->name[k] : number);
    steif_report_real(r, "parameters.value", of->value[k]);
  }
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const char *const storage[] = {"dense", "band", "sparse", "krylov"};
  const struct problem_answer *a = result;
  const steif_problem *p = a->problem;
  const steif_reference *known = p->reference;
  steif_report_text(r, "problem", p->name);
  steif_report_text(r, "about", p->about);
  steif_report_whole(r, "n", (long)p->n);
  if (p->names && p->names->unknown)
    steif_report_texts(r, "unknowns", (size_t)p->n, p->names->unknown);
  steif_report_text(r, "form", steif_form_name(steif_problem_form(call->ctx, p)));
  report_natural(r, "index", p->dae_index);
  if (p->t1 > p->t0)
    steif_report_list(r, "interval", 2, (const double[]){p->t0, p->t1});
  else
    steif_report_text(r, "interval", NULL);
  steif_report_text(r, "storage", storage[p->storage]);
  entries(r, call, p);
  steif_report_whole(r, "invariants", p->invariants);
  steif_report_text(r, "known",
                    p->exact ? "the exact solution"
                    : known  ? "end values"
                             : "nothing");
  report_natural(r, "digits", known && known->digits ? known->digits : -1);
  steif_report_text(r, "source", known ? known->source : NULL);
  parameters(r, p);
  events(r, p);
  if (call->json) steif_report_text(r, "equations", a->text);
}

/* The text of a model file, which is what its equations are. */
static char *model_text(const char *path)
{
  FILE *file = fopen(path, "r");
  long size = -1;
  if (file && !fseek(file, 0, SEEK_END)) size = ftell(file);
  char *text = size >= 0 ? calloc((size_t)size + 1, 1) : NULL;
  if (text) rewind(file);
  if (text && fread(text, 1, (size_t)size, file) != (size_t)size) *text = '\0';
  if (file) fclose(file);
  return text;
}

/* "heat:n=50" is heat. */
static const char *collection_text(const char *spec)
{
  const char *name;
  for (size_t i = 0; (name = steif_problem_name(i)); i++) {
    const size_t length = strlen(name);
    if (!strncmp(spec, name, length) && (!spec[length] || spec[length] == ':'))
      return steif_problem_text(i);
  }
  return NULL;
}

static int problem_present(struct call *call, const steif_problem *p)
{
  steif_model_facts facts;
  const bool model = !steif_model_describe(call->ctx, p, &facts);
  steif_forget(call->ctx);
  char *own = model ? model_text(p->name) : NULL;
  const struct problem_answer a = {p, model ? own : collection_text(p->name)};
  const int code = present_result(call, fill, &a);
  if (!call->json && a.text) printf("\n%s", a.text);
  free(own);
  return code;
}

static const char *name_at(const void *list, size_t i)
{
  (void)list;
  return steif_problem_name(i);
}

int problem_shown(struct call *call)
{
  const char *word = call->word[0];
  steif_problem p;
  char near[GUESS];
  const int found = steif_problem_find(call->ctx, word, &p);
  if (found == STEIF_UNKNOWN_NAME && !strpbrk(word, ".:"))
    return unknown_name(call,
                        "\"%s\" is neither methods, problems, schemes or codes nor a problem%s "
                        "'steif list problems' shows those",
                        word, guess(word, name_at, NULL, near));
  if (found) return fail(call);
  const int code = problem_present(call, &p);
  steif_problem_clear(call->ctx, &p);
  return code;
}
