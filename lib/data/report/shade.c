/* shade.c: the parts of a horizontal line where a plot is shaded, found by samples and halving.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"

enum { SAMPLES = 96, HALVINGS = 10 };

/* Where between a and b, of which one is inside, the edge is. */
static double edge(const steif_plot *plot, double a, double b, double y)
{
  const int first = plot->inside(a, y, plot->user);
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = (a + b) / 2;
    if (plot->inside(middle, y, plot->user) == first)
      a = middle;
    else
      b = middle;
  }
  return (a + b) / 2;
}

size_t stf_shade_row(const steif_plot *plot, double y, double lo, double hi,
                     double piece[STF_PIECES][2])
{
  size_t count = 0;
  int before = 0;
  for (int i = 0; i <= SAMPLES; i++) {
    const double x = lo + (hi - lo) * i / SAMPLES, last = lo + (hi - lo) * (i - 1) / SAMPLES;
    const int now = plot->inside(x, y, plot->user) == 1;
    if (now && !before) {
      if (count == STF_PIECES) break;
      piece[count][0] = i ? edge(plot, last, x, y) : lo;
      piece[count++][1] = hi; /* unless it ends before */
    } else if (!now && before) {
      piece[count - 1][1] = edge(plot, last, x, y);
    }
    before = now;
  }
  return count;
}
