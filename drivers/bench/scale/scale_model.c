/* scale_model.c: T(P).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "scale.h"
#include <math.h>

enum { NEIGHBOURS = 6 };

/* Exchanges of one cycle on a grid that is neither the finest nor the coarsest, as counted: grids that the run had
 * not get as many. */
static double inner_exchanges(const scale_run *run)
{
  const int inner = run->levels > 2 ? 1 : 0;
  return (double)run->network.exchange[inner];
}

static double exchange(const scale_machine *m, int level)
{
  const double rows = fmax(1, m->rows / pow(8, level));
  return NEIGHBOURS * (m->latency + 8 * pow(rows, 2. / 3) / m->bandwidth);
}

scale_price scale_price_of(const scale_run *run, const scale_machine *m, double ranks)
{
  scale_price p = {.work = run->cpu_s / (double)run->n * m->rows};
  if (!(ranks > 1)) return p.efficiency = 1, p;
  const double side = cbrt(m->rows * ranks);
  const int levels = (int)fmax(1, ceil(log2(side + 1) - 1e-9));
  p.sums = (double)(run->network.sums + run->steps) * ceil(log2(ranks)) * m->latency;
  p.fine = (double)run->network.exchange[0] * exchange(m, 0);
  for (int l = 1; l < levels - 1; l++) p.coarse += inner_exchanges(run) * exchange(m, l);
  if (levels > 1) p.coarse += (double)run->network.cycles * exchange(m, levels - 1);
  p.efficiency = p.work / (p.work + p.sums + p.fine + p.coarse);
  return p;
}
