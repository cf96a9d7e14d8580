/* series_answer.c: |x| and the local error of one solution of x' = A(t) x, step by step: a file and a
 * picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <stdlib.h>

int series_open(struct call *call, struct lyapunov_answer *a, size_t room)
{
  if (!call->plot && !given(call, "--series")) return EXIT_OK;
  a->t = malloc(3 * room * sizeof *a->t);
  if (!a->t) return no_memory(call, "the steps", "leave --series and --plot out");
  a->norm = a->t + room, a->lte = a->norm + room, a->room = room;
  a->series = word_of(call, "--series"), a->ctx = call->ctx;
  return EXIT_OK;
}

void series_close(struct lyapunov_answer *a)
{
  (void)steif_rows_close(&a->file);
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

static int save(const struct call *call, const struct lyapunov_answer *a)
{
  steif_report *r = steif_report_new(call->ctx);
  if (!r) return fail(call);
  for (size_t i = 0; i < a->steps; i++) {
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.t", a->t[i]);
    steif_report_real(r, "rows.norm", a->norm[i]);
    steif_report_real(r, "rows.lte", a->lte[i]);
  }
  const int code =
    steif_report_save(r, STEIF_CSV, word_of(call, "--series")) ? fail(call) : EXIT_OK;
  steif_report_free(&r);
  return code;
}

int series_save(const struct call *call, const struct lyapunov_answer *a)
{
  char title[160];
  if (!a->t) return EXIT_OK;
  if (!a->steps) {
    say(call,
        "no solution of x' = A(t) x was followed: --series and --plot have nothing to show");
    return EXIT_FAILED;
  }
  const int code = given(call, "--series") && !a->series ? save(call, a) : EXIT_OK;
  snprintf(title, sizeof title, "Size and local error: %s, %s", call->word[0], call->word[1]);
  const steif_curve curve[] = {{"|x|", a->steps, a->t, a->norm, 0},
                               {"local error", a->steps, a->t, a->lte, 0}};
  const steif_plot plot = {
    .title = title, .x_label = "t", .y_label = "", .log_y = 1, .count = 2, .curve = curve};
  return code ? code : save_plot(call, &plot, call->plot);
}
