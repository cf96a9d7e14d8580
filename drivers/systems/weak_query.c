/* weak_query.c: weak convergence from the words of a call to the measure and its picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak.h"
#include <math.h>
#include <string.h>

static const char *const name[] = {"P", "R", "C", "stage"}; /* enum steif_convention */

const char *convention_name(enum steif_convention convention) { return name[convention]; }

struct weak weak_asked(const struct call *call)
{
  struct weak w = {.k = whole_of(call, "--index"),
                   .kind = word_of(call, "--case"),
                   .convention = word_of(call, "--convention"),
                   .query = {.method = call->word[0],
                             .start = word_of(call, "--start"),
                             .h = real_of(call, "--h"),
                             .component = (int)whole_or(call, "--component", 1) - 1}};
  w.query.rows = (size_t)whole_or(call, "--halvings", given(call, "--h") ? 0 : 4) + 1;
  return w;
}

/* Stages for Runge-Kutta methods but backward Euler, the comb for convolution quadrature. */
static enum steif_convention usual(const char *method, const char *start,
                                   const steif_method_info *m)
{
  if (strstr(method, "start=cq") || (start && !strcmp(start, "cq"))) return STEIF_C;
  const bool table = !strcmp(m->family, "irk") || !strcmp(m->family, "dirk");
  return m->stages > 1 || (table && strncmp(method, "radau:s=1", 9)) ? STEIF_STAGE : STEIF_R;
}

int weak_measure(steif_context *ctx, struct weak *w)
{
  steif_method_info m;
  const int code = steif_method_find(ctx, w->query.method, &m);
  if (code != STEIF_OK) return code;
  if (w->k) {
    snprintf(w->problem, sizeof w->problem, "jordan:k=%ld,case=%s", w->k, w->kind);
    w->query.problem = w->problem;
  }
  w->query.convention = usual(w->query.method, w->query.start, &m);
  for (int i = 0; w->convention && i < 4; i++)
    if (!strcmp(w->convention, name[i])) w->query.convention = (enum steif_convention)i;
  return steif_weak_measure(ctx, &w->query, w->row, &w->result);
}

void weak_row_begin(steif_report *r, const steif_weak_row *row)
{
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", row->h);
}

/* An order that rounding decides is none. */
void weak_row_end(steif_report *r, const steif_weak_row *row)
{
  steif_report_real(r, "rows.error", row->error);
  steif_report_real(r, "rows.rounding", row->rounding);
  steif_report_real(r, "rows.order", row->usable ? row->order : NAN);
}

int weak_end(const struct call *call, const struct weak *w)
{
  error_curves errors = {.title = call->word[0], .y_label = "weak error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < w->query.rows; i++) errors_add(&errors, w->row[i].h, w->row[i].error);
  const int code = errors_plot(call, &errors, call->plot);
  const bool open =
    w->query.rows > 1 && w->result.converges < 0; /* one row asks for no verdict */
  if (code || !open) return code;
  say(call, "%s [STEIF_NOT_CERTIFIED]", w->result.verdict);
  return EXIT_UNCERTIFIED;
}
