/* list.c: what methods, problems, discretisation schemes and codes there are.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

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

static void codes(steif_report *r)
{
  char cure[160];
  for (int code = STEIF_EVENT; code >= STEIF_INFEASIBLE; code--) {
    steif_report_row(r, "codes");
    steif_report_whole(r, "codes.code", code);
    steif_report_text(r, "codes.name", steif_code_symbol(code));
    steif_report_text(r, "codes.meaning", steif_code_name(code));
    snprintf(cure, sizeof cure, "%s", steif_code_remedy(code));
    speak(cure, sizeof cure);
    steif_report_text(r, "codes.cure", cure);
  }
}

static int run(struct call *call)
{
  const int what =
    call->words ? word_place("methods|problems|schemes|codes", call->word[0]) : 4;
  if (what < 0) return problem_shown(call);
  steif_report *r = steif_report_new(call->ctx);
  if (r && what % 4 == 0) report_methods(r, call);
  if (r && (what == 1 || what == 4)) problems(call, r);
  if (r && what == 2) schemes(r);
  if (r && what == 3) codes(r);
  const int code = r && !steif_status(call->ctx) ? present(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

const struct verb verb_list = {.name = "list",
                               .about =
                                 "Show the methods, problems, discretisation schemes and "
                                 "codes, or the equations and sizes of one problem",
                               .usage = "[methods|problems|schemes|codes|PROBLEM]",
                               .most = 1,
                               .run = run};
