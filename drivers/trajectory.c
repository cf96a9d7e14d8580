/* trajectory.c: the accepted steps of a run as CSV and as a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"
#include <stdlib.h>
#include <string.h>

enum { CURVES = 8 };

static bool grow(trajectory *tr)
{
  const size_t room = tr->room ? 2 * tr->room : 256;
  double *t = realloc(tr->t, room * sizeof *t);
  if (t) tr->t = t;
  double *y = t ? realloc(tr->y, room * tr->n * sizeof *y) : NULL;
  if (y) tr->y = y, tr->room = room;
  return y;
}

int trajectory_add(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  trajectory *tr = user;
  const sunrealtype *value = N_VGetArrayPointer(y);
  if (tr->count % 512 == 511 || (tr->t1 > 0 && s && steif_statistics(s)->steps % 4096 == 0))
    progress(tr->call, "t = %.4g of %.4g", t, tr->t1);
  if (!tr->call->csv && !tr->call->plot) return 0;
  if (tr->count == tr->room && !grow(tr)) {
    tr->short_of_memory = true;
    return -1;
  }
  tr->t[tr->count] = t;
  memcpy(tr->y + tr->count++ * tr->n, value, tr->n * sizeof *value);
  return 0;
}

void trajectory_free(trajectory *tr)
{
  free(tr->t);
  free(tr->y);
}

int trajectory_save(const struct call *call, const trajectory *tr)
{
  if (!call->csv) return EXIT_OK;
  steif_report *r = steif_report_new(call->ctx);
  for (size_t i = 0; i < tr->count; i++) {
    steif_report_row(r, "steps");
    steif_report_real(r, "steps.t", tr->t[i]);
    steif_report_list(r, "steps.y", tr->n, tr->y + i * tr->n);
  }
  const int code = r ? save_csv(call, r) : fail(call);
  steif_report_free(&r);
  return code;
}

/* Component k by steps; the largest finite |y_k|. */
static double component(const trajectory *tr, size_t k, double *y)
{
  double most = 0;
  for (size_t i = 0; i < tr->count; i++) {
    y[i] = tr->y[i * tr->n + k];
    const double size = y[i] < 0 ? -y[i] : y[i];
    if (size > most && size - size == 0) most = size;
  }
  return most;
}

/* Components of very different size are drawn as parts of their largest value. */
static bool uneven(const double *most, size_t count)
{
  double low = 0, high = 0;
  for (size_t k = 0; k < count; k++) {
    if (most[k] > high) high = most[k];
    if (most[k] > 0 && (low <= 0 || most[k] < low)) low = most[k];
  }
  return high > 100 * low;
}

/* The first components over time; long intervals on a logarithmic axis. */
int trajectory_plot(const struct call *call, const trajectory *tr, const char *title)
{
  const size_t curves = tr->n < CURVES ? tr->n : CURVES;
  double *y = call->plot ? malloc((tr->count * curves + 1) * sizeof *y) : NULL, most[CURVES];
  char label[CURVES][32];
  steif_curve curve[CURVES];
  for (size_t k = 0; y && k < curves; k++) most[k] = component(tr, k, y + k * tr->count);
  const bool scaled = y && uneven(most, curves);
  for (size_t k = 0; y && k < curves; k++) {
    const bool divide = scaled && most[k] > 0;
    for (size_t i = 0; divide && i < tr->count; i++) y[k * tr->count + i] /= most[k];
    snprintf(label[k], sizeof label[k], divide ? "y%zu / %.3g" : "y%zu", k + 1, most[k]);
    curve[k] = (steif_curve){label[k], tr->count, tr->t, y + k * tr->count, 0};
  }
  const steif_plot plot = {.title = title,
                           .x_label = "t",
                           .y_label = curves < tr->n ? "the first components of y" : "y",
                           .log_x = tr->t1 >= 1e4,
                           .count = curves,
                           .curve = curve};
  if (!y && call->plot) say(call, "no memory for the picture; leave --plot out");
  const int code = !call->plot ? EXIT_OK : y ? save_plot(call, &plot, call->plot) : EXIT_FAILED;
  free(y);
  return code;
}
