/* steps_made.c: constant steps of a run, and where they ended, as fields of a report.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integration.h"
#include <math.h>

/* What became of the rest of the interval; "" where there was none. */
static void remark(const struct steps_made *m, size_t room, char *text)
{
  const long steps = m->steps ? m->steps : lround((m->end - m->t0) / m->h);
  const double rounding = 1e-6, over = m->t0 + (double)steps * m->h - m->end,
               whole = m->t0 + (double)(steps - 1) * m->h;
  *text = 0;
  if (m->asked - m->end > rounding * m->h)
    snprintf(text, room, "%ld steps of %.12g to %.12g; %.12g is not a multiple of the step",
             steps, m->h, m->end, m->asked);
  else if (over > rounding * m->h && m->last_h < m->h)
    snprintf(
      text, room,
      "%ld steps of %.12g to %.12g, and a last one of %.6g; %.12g is not a multiple of the "
      "step",
      steps - 1, m->h, whole, m->last_h, m->end);
  else if (over > rounding * m->h)
    snprintf(text, room,
             "%ld steps of %.12g, the last one from %.12g across %.12g, where the solution is "
             "interpolated; it is not a multiple of the step",
             steps, m->h, whole, m->end);
}

void report_steps(steif_report *r, const struct steps_made *m)
{
  char text[240];
  steif_report_real(r, "h", m->h);
  steif_report_real(r, "end", m->end);
  steif_report_real(r, "last_h", m->last_h);
  remark(m, sizeof text, text);
  if (*text) steif_report_text(r, "grid", text);
}
