/* jump_rows.c: a jump of x with its impulses as rows of a sheet.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "trajectory.h"

void report_vector(steif_report *r, const char *sheet, const char *const *name,
                   const char *kind, double t, size_t n, const double *x)
{
  char cell[256];
  steif_report_row(r, sheet);
  snprintf(cell, sizeof cell, "%s.t", sheet);
  steif_report_real(r, cell, t);
  snprintf(cell, sizeof cell, "%s.kind", sheet);
  steif_report_text(r, cell, kind);
  snprintf(cell, sizeof cell, "%s.x", sheet);
  if (!name) steif_report_list(r, cell, n, x);
  for (size_t i = 0; name && i < n; i++) {
    snprintf(cell, sizeof cell, "%s.%s", sheet, name[i]);
    steif_report_real(r, cell, x[i]);
  }
}

void report_jump(steif_report *r, const char *sheet, const char *const *name, double t,
                 const double *before, const steif_impulse *i)
{
  const size_t n = (size_t)i->n;
  char kind[16];
  report_vector(r, sheet, name, "x-", t, n, before);
  for (int q = 0; q < i->count; q++) {
    snprintf(kind, sizeof kind, "c%d", q);
    report_vector(r, sheet, name, kind, t, n, i->c + (size_t)q * n);
  }
  report_vector(r, sheet, name, "x+", t, n, i->x_plus);
}
