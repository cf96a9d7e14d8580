/* list.c: what methods, problems and discretisation schemes there are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "members.h"
#include "program.h"

static void claims(steif_report *r, unsigned claim)
{
  static const char *const name[] = {"A-stable", "L-stable", "stiffly accurate", "symplectic",
                                     "symmetric"}; /* bits of enum steif_claim */
  const char *word[sizeof name / sizeof *name];
  size_t count = 0;
  for (size_t i = 0; i < sizeof name / sizeof *name; i++)
    if (claim & 1u << i) word[count++] = name[i];
  steif_report_texts(r, "methods.claims", count, word);
}

static void methods(struct call *call, steif_report *r)
{
  static const struct member members[] = {
    MEMBER(steif_method_info, name, A_WORD), MEMBER(steif_method_info, family, A_TEXT),
    MEMBER(steif_method_info, order, A_WHOLE), MEMBER(steif_method_info, stages, A_WHOLE),
    MEMBERS_END};
  steif_method_info m;
  for (size_t i = 0; steif_method_at(call->ctx, i, &m) == STEIF_OK; i++) {
    steif_report_row(r, "methods");
    report_members(r, "methods.", members, &m);
    claims(r, m.claims);
    steif_report_text(r, "methods.about", m.about);
  }
}

static void problems(struct call *call, steif_report *r)
{
  const char *name;
  steif_problem p;
  for (size_t i = 0; (name = steif_problem_name(i)); i++) {
    if (steif_problem_find(call->ctx, name, &p) != STEIF_OK) return;
    steif_report_row(r, "problems");
    steif_report_text(r, "problems.name", name);
    steif_report_whole(r, "problems.n", (long)p.n);
    steif_report_text(r, "problems.form", steif_form_name(steif_problem_form(call->ctx, &p)));
    report_natural(r, "problems.index", p.dae_index);
    steif_report_text(r, "problems.about", p.about);
    steif_problem_clear(call->ctx, &p);
  }
}

static void schemes(steif_report *r)
{
  static const struct member members[] = {MEMBER(steif_scheme, name, A_TEXT),
                                          MEMBER(steif_scheme, order, A_WHOLE),
                                          MEMBER(steif_scheme, about, A_TEXT), MEMBERS_END};
  const steif_scheme *s;
  for (size_t i = 0; (s = steif_scheme_at(i)); i++) {
    steif_report_row(r, "schemes");
    report_members(r, "schemes.", members, s);
  }
}

static int run(struct call *call)
{
  const int what = call->words ? word_place("methods|problems|schemes", call->word[0]) : 3;
  if (what < 0)
    return bad_usage(call, "\"%s\" is not listed; ask for methods, problems or schemes",
                     call->word[0]);
  steif_report *r = steif_report_new(call->ctx);
  if (r && what % 3 == 0) methods(call, r);
  if (r && what % 2 == 1) problems(call, r);
  if (r && what == 2) schemes(r);
  const int code = r && !steif_status(call->ctx) ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

const struct verb verb_list = {.name = "list",
                               .about = "Show the methods, problems and discretisation schemes",
                               .usage = "[methods|problems|schemes]",
                               .most = 1,
                               .run = run};
