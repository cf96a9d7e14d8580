/* methods_answer.c: the methods there are, and what is claimed of them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

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

void report_methods(steif_report *r, const struct call *call)
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
