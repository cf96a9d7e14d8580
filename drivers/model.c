/* model.c: what a model written as text is: form, sizes, parameters, start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "members.h"
#include "problem.h"
#include <steif/model.h>
#include <stdio.h>

struct answer {
  const steif_problem *p;
  steif_model_facts facts;
};

static void parameters(steif_report *r, const steif_problem *p)
{
  const char *name;
  double value;
  for (size_t i = 0; (name = steif_model_parameter(p, i, &value)); i++) {
    steif_report_row(r, "parameter");
    steif_report_text(r, "parameter.name", name);
    steif_report_real(r, "parameter.value", value);
  }
}

static void unknowns(steif_report *r, const steif_problem *p)
{
  const long shown = p->n < 40 ? (long)p->n : 40;
  for (long i = 0; i < shown; i++) {
    steif_report_row(r, "unknown");
    steif_report_text(r, "unknown.name", p->names->unknown[i]);
    steif_report_real(r, "unknown.start", p->y0[i]);
    report_natural(r, "unknown.index", p->index ? p->index[i] : -1);
  }
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  static const struct member members[] = {MEMBER(steif_model_facts, why, A_TEXT),
                                          MEMBER(steif_model_facts, n, A_INDEX),
                                          MEMBER(steif_model_facts, entries, A_INDEX),
                                          MEMBER(steif_model_facts, entries_E, A_INDEX),
                                          MEMBER(steif_model_facts, parameters, A_WHOLE),
                                          MEMBER(steif_model_facts, equations, A_WHOLE),
                                          MEMBER(steif_model_facts, loops, A_WHOLE),
                                          MEMBER(steif_model_facts, relations, A_WHOLE),
                                          MEMBER(steif_model_facts, breaks, A_WHOLE),
                                          MEMBER(steif_model_facts, operations, A_LONG),
                                          MEMBERS_END};
  const struct answer *a = result;
  (void)call;
  steif_report_text(r, "model", a->p->name);
  steif_report_text(r, "about", a->p->about);
  steif_report_text(r, "form", steif_form_name(a->facts.form));
  report_members(r, "", members, &a->facts);
  report_natural(r, "index", a->p->dae_index);
  steif_report_real(r, "t0", a->p->t0);
  steif_report_real(r, "t1", a->p->t1);
  parameters(r, a->p);
  unknowns(r, a->p);
}

static int as_program(struct call *call, const steif_problem *p)
{
  const char *text = steif_model_c(call->ctx, p);
  if (!text) return fail(call);
  return fputs(text, stdout) < 0 ? EXIT_FAILED : EXIT_OK;
}

static int describe(struct call *call, const steif_problem *p)
{
  if (given(call, "--c")) return as_program(call, p);
  struct answer a = {.p = p};
  if (steif_model_describe(call->ctx, p, &a.facts)) return fail(call);
  return present_result(call, fill, &a);
}

static const struct option options[] = {
  {"--c", FLAG, NULL, "the model as a C program, on standard output", NULL}, OPTIONS_END};

static int run(struct call *call) { return with_problem(call, describe); }

const struct verb verb_model = {.name = "model",
                                .about =
                                  "Show form, sizes, parameters and start of a model file",
                                .usage = "FILE.steif[:NAME=VALUE,...] [--c]",
                                .least = 1,
                                .most = 1,
                                .option = options,
                                .run = run};
