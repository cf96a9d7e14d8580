/* structure_answer.c: regularity, index and structure of a pencil as a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"

static void fill_fields(steif_report *r, const struct call *call, const void *result)
{
  static const struct member sizes[] = {MEMBER(steif_structure, n, A_INDEX),
                                        MEMBER(steif_structure, rank_E, A_INDEX),
                                        MEMBER(steif_structure, regular, A_TRUTH),
                                        MEMBER(steif_structure, index, A_NATURAL), MEMBERS_END};
  static const struct member eigenvalues[] = {
    MEMBER(steif_structure, finite, A_INDEX),
    MEMBER(steif_structure, infinite, A_INDEX),
    {"degree_bound", A_INDEX, offsetof(steif_structure, degree)},
    {"degree_exact", A_INDEX, offsetof(steif_structure, exact)},
    MEMBER(steif_structure, count, A_NUMBER),
    MEMBERS_END};
  static const struct member ranks[] = {
    {"degree_doubt", A_REAL, offsetof(steif_structure, doubt)}, MEMBERS_END};
  static const struct member accuracy[] = {
    MEMBER(steif_structure, gap, A_REAL), MEMBER(steif_structure, rcond, A_REAL),
    MEMBER(steif_structure, radius, A_REAL), MEMBER(steif_structure, resolution, A_REAL),
    MEMBERS_END};
  static const struct member verdict[] = {
    MEMBER(steif_structure, certified, A_TRUTH), MEMBER(steif_structure, method, A_TEXT),
    MEMBER(steif_structure, message, A_WORD), MEMBERS_END};
  const struct structure_answer *a = result;
  const steif_structure *s = &a->found;
  const steif_names none = {NULL, NULL}, *by = a->names ? a->names : &none;
  (void)call;
  report_members(r, "", sizes, s);
  if (s->index < 0 && s->regular) report_natural(r, "index_least", s->index_least);
  report_members(r, "", eigenvalues, s);
  if (s->exact >= 0) report_members(r, "", ranks, s);
  report_wholes(r, "weyr", (size_t)s->weyr_count, s->weyr);
  report_members(r, "", accuracy, s);
  report_names(r, "equations", by->equation, 'e', (size_t)s->equations_count, s->equations);
  report_names(r, "unknowns", by->unknown, 'x', (size_t)s->unknowns_count, s->unknowns);
  report_members(r, "", verdict, s);
  if (a->eigenvalues) steif_report_text(r, "eigenvalues_message", a->values.message);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct structure_answer *a = result;
  fill_fields(r, call, a);
  if (a->eigenvalues) report_eigenvalues(r, &a->values);
}

static void fill_rows(steif_report *r, const struct call *call, const void *result)
{
  (void)call;
  report_eigenvalues(r, &((const struct structure_answer *)result)->values);
}

int structure_present(const struct call *call, const struct structure_answer *a)
{
  const bool rows = a->eigenvalues && (given(call, "--count") || given(call, "--near"));
  int code = show_result(call, fill, a);
  if (!code) code = save_rows(call, rows ? fill_rows : fill_fields, a);
  if (code || !call->plot) return code;
  if (a->eigenvalues) return eigenvalues_plot(call, &a->values, a->near);
  return bad_usage(call, "--plot shows eigenvalues, and which are finite is undecided");
}
