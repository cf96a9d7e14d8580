/* weak_query.c: weak convergence from the words of a call to the measure and its picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "output.h"
#include "weak.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const name[] = {"P", "R", "C", "stage"}; /* enum steif_convention */

const char *convention_name(enum steif_convention convention) { return name[convention]; }

struct weak weak_asked(struct call *call)
{
  struct weak w = {.call = call,
                   .k = whole_of(call, "--index"),
                   .kind = word_of(call, "--case"),
                   .convention = word_of(call, "--convention"),
                   .query = {.method = call->word[0],
                             .start = word_of(call, "--start"),
                             .h = real_of(call, "--h"),
                             .exact = given(call, "--exact"),
                             .restart = given(call, "--restart"),
                             .component = (int)whole_or(call, "--component", 1) - 1}};
  w.query.rows = (size_t)whole_or(call, "--halvings", given(call, "--h") ? 0 : 4) + 1;
  return w;
}

int weak_prepare(steif_context *ctx, struct weak *w)
{
  if (w->k) {
    snprintf(w->problem, sizeof w->problem, "jordan:k=%ld,case=%s", w->k, w->kind);
    w->query.problem = w->problem;
  }
  const int code =
    steif_convention_usual(ctx, w->query.method, w->query.start, &w->query.convention);
  if (code) return code;
  for (int i = 0; w->convention && i < 4; i++)
    if (!strcmp(w->convention, name[i])) w->query.convention = (enum steif_convention)i;
  return STEIF_OK;
}

int weak_measure(steif_context *ctx, struct weak *w)
{
  int code = weak_prepare(ctx, w);
  if (code || (code = steif_weak_measure(ctx, &w->query, w->row, &w->result))) return code;
  speak(w->result.verdict, sizeof w->result.verdict);
  return STEIF_OK;
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

/* Steps and errors of the rows, for files of arrays. */
static void arrays(steif_report *r, const struct weak *w)
{
  double h[HALVINGS], error[HALVINGS];
  const size_t rows = w->query.rows;
  for (size_t i = 0; i < rows; i++) h[i] = w->row[i].h, error[i] = w->row[i].error;
  steif_report_list(r, "h", rows, h);
  steif_report_list(r, "error", rows, error);
}

void weak_verdict(steif_report *r, const struct weak *w)
{
  if (wants_arrays(w->call)) arrays(r, w);
  if (w->query.g) steif_report_text(r, "g", w->g.text);
  if (w->query.g) steif_report_real(r, "t1", w->query.g->t1);
  if (*w->result.mesh) steif_report_text(r, "mesh", w->result.mesh);
  if (*w->result.note) steif_report_text(r, "note", w->result.note);
  steif_report_text(r, "verdict", w->result.verdict);
}

bool weak_is_open(int converges, const char *verdict)
{
  return converges < 0 && strncmp(verdict, "none", 4) != 0;
}

/* The picture; EXIT_UNCERTIFIED where the verdict is open. */
static int end(const struct call *call, const struct weak *w)
{
  error_curves errors = {.title = call->word[0], .y_label = "weak error"};
  errors_open(&errors, call->word[0]);
  for (size_t i = 0; i < w->query.rows; i++) errors_add(&errors, w->row[i].h, w->row[i].error);
  const int code = errors_plot(call, &errors, call->plot);
  if (code || !weak_is_open(w->result.converges, w->result.verdict)) return code;
  say(call, "%s [STEIF_NOT_CERTIFIED]", w->result.verdict);
  return EXIT_UNCERTIFIED;
}

/* A norm: --ball M, --g ball:m=M or bspline:m=M,cells=N. */
struct norm {
  bool asked;
  int m, cells;
};

static int whole_parameter(const steif_spec *spec, const char *key)
{
  for (int i = 0; i < spec->count; i++) {
    char *end = NULL;
    const char *value = spec->param[i].value;
    if (strcmp(spec->param[i].key, key)) continue;
    const double number = strtod(value, &end);
    return *value && !*end && number >= 1 && number < 1e9 && number == floor(number)
             ? (int)number
             : -1;
  }
  return 0;
}

static int find_norm(struct call *call, struct norm *norm)
{
  const char *words = word_of(call, "--g");
  steif_spec spec;
  *norm = (struct norm){given(call, "--ball"), (int)whole_of(call, "--ball"), 0};
  const bool ball = words && (!strncmp(words, "ball:", 5) || !strcmp(words, "ball")),
             splines = words && (!strncmp(words, "bspline:", 8) || !strcmp(words, "bspline"));
  if (!ball && !splines) return EXIT_OK;
  if (steif_spec_parse(call->ctx, words, &spec)) return fail(call);
  norm->asked = true;
  norm->m = whole_parameter(&spec, "m");
  norm->cells = splines ? whole_parameter(&spec, "cells") : 0;
  if (norm->m < 1 || spec.count != (splines ? 2 : 1) || (splines && norm->cells < 1))
    return bad_usage(call, "--g %s: %s", words,
                     splines ? "bspline takes m, the degree, and cells, 1 or more each"
                             : "ball takes m, 1 or more, as in ball:m=4");
  return EXIT_OK;
}

/* --g, or the usual one on the interval of --t1. */
static int find_test(struct call *call, struct weak *w, bool norm)
{
  const char *g = word_of(call, "--g");
  if (!given(call, "--g") && !given(call, "--t1")) return EXIT_OK;
  const int code =
    test_function_open(call, g && !norm ? g : "power", real_of(call, "--t1"), &w->g);
  w->query.g = &w->g.weight;
  return code;
}

/* The callback of the measure. */
static int told(size_t i, void *user)
{
  const struct weak *w = user;
  if (i == 0) w->form->head(w->report, w);
  w->form->row(w->report, w, i);
  rows_come(w->call, w->report);
  return 0;
}

/* One test function. */
static int single(struct call *call, struct weak *w)
{
  w->report = steif_report_new(call->ctx);
  w->query.tell = told, w->query.told = w;
  int code = w->report && !weak_measure(call->ctx, w) ? EXIT_OK : descriptor_fail(call);
  if (!code) {
    w->form->tail(w->report, w);
    code = present(call, w->report);
  }
  steif_report_free(&w->report);
  return code ? code : end(call, w);
}

int weak_answer(struct call *call, struct weak *w, const struct weak_form *form)
{
  const char *words = word_of(call, "--g");
  struct norm norm;
  w->form = form;
  if (words && strchr(words, ';')) return weak_family(call, w, words);
  int code = find_norm(call, &norm);
  if (code) return code;
  code = find_test(call, w, norm.asked);
  if (!code && norm.asked) {
    w->query.cells = norm.cells;
    code = weak_ball(call, w, norm.m);
    test_function_close(&w->g);
    return code;
  }
  if (!code) code = single(call, w);
  test_function_close(&w->g);
  return code;
}
