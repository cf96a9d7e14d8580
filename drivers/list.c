/* list.c: what methods and problems there are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "face.h"
#include <string.h>

static void claims(steif_report *r, unsigned claim)
{
  static const struct {
    unsigned bit;
    const char *name;
  } known[] = {{STEIF_A_STABLE, "A-stable"},
               {STEIF_L_STABLE, "L-stable"},
               {STEIF_STIFFLY_ACCURATE, "stiffly accurate"},
               {STEIF_SYMPLECTIC, "symplectic"},
               {STEIF_SYMMETRIC, "symmetric"}};
  const char *word[5];
  size_t count = 0;
  for (size_t i = 0; i < 5; i++)
    if (claim & known[i].bit) word[count++] = known[i].name;
  steif_report_texts(r, "methods.claims", count, word);
}

static void methods(struct call *call, steif_report *r)
{
  steif_method_info m;
  for (size_t i = 0; steif_method_at(call->ctx, i, &m) == STEIF_OK; i++) {
    steif_report_row(r, "methods");
    steif_report_text(r, "methods.name", m.name);
    steif_report_text(r, "methods.family", m.family);
    steif_report_whole(r, "methods.order", m.order);
    steif_report_whole(r, "methods.stages", m.stages);
    claims(r, m.claims);
    steif_report_text(r, "methods.about", m.about);
  }
}

static int problems(struct call *call, steif_report *r)
{
  const char *name;
  for (size_t i = 0; (name = steif_problem_name(i)); i++) {
    steif_problem p;
    if (steif_problem_find(call->ctx, name, &p) != STEIF_OK) return fail(call);
    steif_report_row(r, "problems");
    steif_report_text(r, "problems.name", name);
    steif_report_whole(r, "problems.n", (long)p.n);
    steif_report_text(r, "problems.form", steif_form_name(steif_problem_form(call->ctx, &p)));
    if (p.dae_index < 0)
      steif_report_text(r, "problems.index", NULL);
    else
      steif_report_whole(r, "problems.index", p.dae_index);
    steif_report_text(r, "problems.about", p.about);
    steif_problem_clear(call->ctx, &p);
  }
  return EXIT_OK;
}

static void schemes(steif_report *r)
{
  const steif_scheme *s;
  for (size_t i = 0; (s = steif_scheme_at(i)); i++) {
    steif_report_row(r, "schemes");
    steif_report_text(r, "schemes.name", s->name);
    steif_report_whole(r, "schemes.order", s->order);
    steif_report_text(r, "schemes.about", s->about);
  }
}

static int run(struct call *call)
{
  const char *what = call->words ? call->word[0] : "";
  const bool only_schemes = !strcmp(what, "schemes");
  if (*what && strcmp(what, "methods") && strcmp(what, "problems") && !only_schemes)
    return refuse(call, "\"%s\" is not listed; ask for methods, problems or schemes", what);
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  int code = EXIT_OK;
  if (only_schemes) schemes(r);
  if (!only_schemes && strcmp(what, "problems")) methods(call, r);
  if (!only_schemes && strcmp(what, "methods")) code = problems(call, r);
  if (code == EXIT_OK) code = present(call, r);
  steif_report_free(&r);
  return code;
}

const struct verb verb_list = {"list",
                               "What methods, problems and discretisation schemes there are",
                               "[methods|problems|schemes]",
                               0,
                               1,
                               NULL,
                               NULL,
                               run};
