/* series_answer.c: --series and the picture of lyapunov: |x| and the local error of one solution of x' = A(t) x,
 * step by step; where none is followed, the averages of the exponents as the run goes on.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <stdlib.h>

enum { AVERAGES = 2100, CURVES = 16 };

static bool wanted(const struct call *call) { return call->plot || given(call, "--series"); }

int series_open(struct call *call, struct lyapunov_answer *a, double steps)
{
  if (!wanted(call)) return EXIT_OK;
  if (steps > 1e8)
    return bad_usage(call, "%.3g steps are too many for --series and --plot, which keep 1e8",
                     steps);
  const size_t room = (size_t)steps;
  a->t = malloc(3 * room * sizeof *a->t);
  a->average = malloc(AVERAGES * (a->count + 1) * sizeof *a->average);
  if (!a->t || !a->average)
    return no_memory(call, "the steps", "leave --series and --plot out");
  a->norm = a->t + room, a->lte = a->norm + room, a->room = room;
  a->series = word_of(call, "--series"), a->ctx = call->ctx;
  return EXIT_OK;
}

void series_close(struct lyapunov_answer *a)
{
  (void)steif_rows_close(&a->file);
  free(a->average);
  free(a->t);
}

/* The file is made by the first step: where no solution is followed, there is none. One that cannot be written is
 * left to series_save, which says why. */
static void to_file(struct lyapunov_answer *a, const double row[3])
{
  static const char *const name[] = {"t", "norm", "lte"};
  if (!a->file) a->file = steif_rows_new(a->ctx, a->series, 3, name);
  if (a->file && !steif_rows_add(a->file, row)) return;
  a->series = NULL;
  steif_forget(a->ctx);
}

int series_tell(double t, double norm, double lte, void *answer)
{
  struct lyapunov_answer *a = answer;
  if (a->steps >= a->room) return 1;
  a->t[a->steps] = t;
  a->norm[a->steps] = norm;
  a->lte[a->steps++] = lte;
  if (a->series) to_file(a, (const double[]){t, norm, lte});
  return 0;
}

int series_average(double t, int count, const double *mean, void *answer)
{
  struct lyapunov_answer *a = answer;
  a->count = (size_t)count; /* at most what there is room for */
  if (a->averages >= AVERAGES) return 0;
  double *row = a->average + a->averages++ * (a->count + 1);
  row[0] = t;
  for (int i = 0; i < count; i++) row[i + 1] = mean[i];
  return 0;
}

/* Row i of what is kept. */
static void row(steif_report *r, const struct lyapunov_answer *a, size_t i)
{
  steif_report_row(r, "rows");
  if (a->steps) {
    steif_report_real(r, "rows.t", a->t[i]);
    steif_report_real(r, "rows.norm", a->norm[i]);
    steif_report_real(r, "rows.lte", a->lte[i]);
    return;
  }
  const double *average = a->average + i * (a->count + 1);
  steif_report_real(r, "rows.t", average[0]);
  for (size_t k = 1; k <= a->count; k++) {
    char name[40];
    snprintf(name, sizeof name, "rows.exponent%zu", k);
    steif_report_real(r, name, average[k]);
  }
}

static int save(const struct call *call, const struct lyapunov_answer *a)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  for (size_t i = 0; i < (a->steps ? a->steps : a->averages); i++) row(r, a, i);
  const int code =
    steif_report_save(r, STEIF_CSV, word_of(call, "--series")) ? fail(call) : EXIT_OK;
  steif_report_free(&r);
  return code;
}

static int draw_solution(const struct call *call, const struct lyapunov_answer *a)
{
  char title[160];
  snprintf(title, sizeof title, "Size and local error: %s, %s", call->word[0], call->word[1]);
  const steif_curve curve[] = {{"|x|", a->steps, a->t, a->norm, 0},
                               {"local error", a->steps, a->t, a->lte, 0}};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "", .log_y = 1, .count = 2, .curve = curve};
  return save_plot(call, &plot, call->plot);
}

/* The leading exponents, column by column. */
static int draw_averages(const struct call *call, const struct lyapunov_answer *a)
{
  char title[160], label[CURVES][24];
  const size_t n = a->averages, count = a->count < CURVES ? a->count : CURVES;
  steif_curve curve[CURVES];
  double *column = malloc((count + 1) * n * sizeof *column);
  if (!column) return no_memory(call, "the picture", "leave --plot out");
  for (size_t k = 0; k <= count; k++)
    for (size_t i = 0; i < n; i++) column[k * n + i] = a->average[i * (a->count + 1) + k];
  for (size_t k = 0; k < count; k++) {
    snprintf(label[k], sizeof label[k], "exponent %zu", k + 1);
    curve[k] = (steif_curve){label[k], n, column, column + (k + 1) * n, 0};
  }
  snprintf(title, sizeof title, "Averages of the exponents: %s, %s", call->word[0],
           call->word[1]);
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "", .count = count, .curve = curve};
  const int code = save_plot(call, &plot, call->plot);
  free(column);
  return code;
}

int series_save(const struct call *call, const struct lyapunov_answer *a)
{
  if (!a->t) return EXIT_OK;
  if (!a->steps && !a->averages) {
    say(call, "nothing was averaged: --series and --plot have nothing to show");
    return EXIT_FAILED;
  }
  const bool unsaved = given(call, "--series") && (!a->steps || !a->series);
  const int code = unsaved ? save(call, a) : EXIT_OK;
  if (code || !call->plot) return code;
  return a->steps ? draw_solution(call, a) : draw_averages(call, a);
}
