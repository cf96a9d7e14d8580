/* impulse_answer.c: a jump with its impulses, as fields of a report and as rows of a sheet.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse.h"
#include <string.h>

enum { LEVELS = 16 };

void impulse_fill(steif_report *r, const struct linear *l, const steif_impulse *i)
{
  steif_report_whole(r, "index", i->index);
  if (l->names && l->names->unknown)
    steif_report_texts(r, "unknowns", (size_t)i->n, l->names->unknown);
  steif_report_list(r, "x_plus", (size_t)i->n, i->x_plus);
  steif_report_matrix(r, "impulses", (size_t)i->count, (size_t)i->n, i->c);
  steif_report_real(r, "residuals.last", i->last);
  steif_report_real(r, "residuals.chain", i->chain);
  steif_report_real(r, "residuals.first", i->first);
  steif_report_real(r, "estimate", i->estimate);
  steif_report_real(r, "resolution", i->resolution);
  steif_report_truth(r, "certified", i->certified);
  steif_report_text(r, "method", i->method);
  steif_report_text(r, "message", i->message);
}

const char *const *impulse_columns(const struct linear *l)
{
  const char *const *name = l->names ? l->names->unknown : NULL;
  for (sunindextype i = 0; name && i < l->n; i++)
    if (!strcmp(name[i], "t") || !strcmp(name[i], "kind")) return NULL;
  return name;
}

void impulse_row(steif_report *r, const char *sheet, const char *const *name, const char *kind,
                 double t, size_t n, const double *x)
{
  char cell[256];
  steif_report_row(r, sheet);
  snprintf(cell, sizeof cell, "%s.t", sheet), steif_report_real(r, cell, t);
  snprintf(cell, sizeof cell, "%s.kind", sheet), steif_report_text(r, cell, kind);
  snprintf(cell, sizeof cell, "%s.x", sheet);
  if (!name) steif_report_list(r, cell, n, x);
  for (size_t i = 0; name && i < n; i++) {
    snprintf(cell, sizeof cell, "%s.%s", sheet, name[i]);
    steif_report_real(r, cell, x[i]);
  }
}

void impulse_rows(steif_report *r, const char *sheet, const char *const *name, double t,
                  const double *before, const steif_impulse *i)
{
  const size_t n = (size_t)i->n;
  char kind[16];
  impulse_row(r, sheet, name, "x-", t, n, before);
  for (int q = 0; q < i->count; q++) {
    snprintf(kind, sizeof kind, "c%d", q);
    impulse_row(r, sheet, name, kind, t, n, i->c + (size_t)q * n);
  }
  impulse_row(r, sheet, name, "x+", t, n, i->x_plus);
}

int impulse_verdict(const struct call *call, const steif_impulse *i)
{
  if (!i->certified) say(call, "%s", i->message);
  return i->certified ? EXIT_OK : EXIT_UNCERTIFIED;
}

/* What samples leave of the derivatives that the index asks for. */
void impulse_accuracy(steif_report *r, const struct linear *l, const steif_impulse *i)
{
  double accuracy[LEVELS];
  int count = 0;
  for (; l->function && count < i->count && count < LEVELS; count++)
    if (steif_function_accuracy(l->function, l->t0, count + 1, accuracy + count)) return;
  if (count && accuracy[count - 1] > 0)
    steif_report_list(r, "derivatives_accuracy", (size_t)count, accuracy);
}
