/* model.c: what a model written as text is: form, sizes, parameters, start.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <steif/model.h>
#include <stdio.h>

static int as_program(struct call *call, const steif_problem *p)
{
  const char *text = steif_model_c(call->ctx, p);
  if (!text) return fail(call);
  return model_print(text);
}

static int describe(struct call *call, const steif_problem *p)
{
  if (given(call, "--check")) return model_good(call);
  if (given(call, "--c")) return as_program(call, p);
  struct model_answer a = {.p = p};
  if (steif_model_describe(call->ctx, p, &a.facts)) return fail(call);
  return model_present(call, &a);
}

static const struct option options[] = {
  SET_OPTION,
  {"--check", FLAG, NULL, "nothing but sentences about what is wrong: exit code 0 or 3", NULL},
  {"--c", FLAG, NULL, "the model as a C program, on standard output", NULL},
  OPTIONS_END};

static int run(struct call *call) { return with_problem(call, describe); }

const struct verb verb_model = {.name = "model",
                                .about =
                                  "Show form, sizes, parameters and start of a model file",
                                .usage = "FILE.steif[:NAME=VALUE,...] [--check | --c]",
                                .least = 1,
                                .most = 1,
                                .option = options,
                                .run = run};
