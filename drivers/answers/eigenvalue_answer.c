/* eigenvalue_answer.c: finite eigenvalues as rows of a report and as a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include <stdlib.h>

void report_eigenvalues(steif_report *r, const steif_eigenvalues *e)
{
  for (long k = 0; k < e->count; k++) {
    const steif_eigenvalue *v = e->value + k;
    steif_report_row(r, "eigenvalues");
    steif_report_real(r, "eigenvalues.re", v->re);
    steif_report_real(r, "eigenvalues.im", v->im);
    steif_report_real(r, "eigenvalues.damping", v->damping);
    steif_report_real(r, "eigenvalues.frequency", v->frequency);
    steif_report_real(r, "eigenvalues.residual", v->residual);
  }
}

/* The eigenvalues as points, the point S as another where it is not 0. */
int eigenvalues_plot(const struct call *call, const steif_eigenvalues *e, const double near[2])
{
  char title[160];
  const size_t count = (size_t)e->count;
  double *re = malloc((2 * count + 1) * sizeof *re), *im = re ? re + count : NULL;
  if (!re) return no_memory(call, "a picture", "give the process more");
  for (size_t k = 0; k < count; k++) {
    re[k] = e->value[k].re;
    im[k] = e->value[k].im;
  }
  snprintf(title, sizeof title, "Finite eigenvalues of %s", call->word[0]);
  const steif_curve curve[] = {{"eigenvalues", count, re, im, 2}, {"S", 1, near, near + 1, 2}};
  const bool point = near[0] != 0 || near[1] != 0;
  const steif_plot plot = {.title = title,
                           .x_label = "Re s",
                           .y_label = "Im s",
                           .count = point ? 2 : 1,
                           .curve = curve};
  const int code = save_plot(call, &plot, call->plot);
  free(re);
  return code;
}
