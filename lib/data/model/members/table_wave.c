/* table_wave.c: where an argument passes the nodes of a table, and the steps that are kept between.
 *
 * The wave of nodes x_0 < ... < x_{n-1} is linear in pieces: 0 at the nodes, half the distance to the next one between two
 * of them, with alternating signs, negative below x_0, and not 0 outside. Its sign changes at each node, with slope 1 or -1.
 *
 * A table of steps or lines is v_k(x) on part k, from x_k to x_{k+1}; part -1 lies below x_0, v_{-1} = v_0(x_0). While the wave
 * is negative it is that of an odd part: two tables, of odd and of even parts, go on with v_k up to the middle of the next part,
 * so that what a step computes beyond an event is smooth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"

static int wave(stf_model *m, const stf_lookup *of, stf_lookup *to)
{
  const size_t n = of->count, count = 2 * n + 1;
  double *x = stf_pool_array(m->pool, 2 * count, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  double *y = x + count;
  double sign = -1;
  for (size_t k = 0; k <= n; k++, sign = -sign) {
    const size_t gap = k == 0 ? 0 : k == n ? n - 2 : k - 1;
    const double half = (of->x[gap + 1] - of->x[gap]) / 2;
    x[2 * k] = k == 0 ? of->x[0] - half : of->x[k - 1] + half;
    y[2 * k] = sign * half;
    if (k < n) x[2 * k + 1] = of->x[k], y[2 * k + 1] = 0;
  }
  *to = (stf_lookup){.count = count, .x = x, .y = y};
  return STEIF_OK;
}

/* The slope of part k. */
static double slope_of(const stf_lookup *of, size_t k)
{
  if (of->kind == STF_STEPS_TABLE || k + 1 >= of->count) return 0;
  return (of->y[k + 1] - of->y[k]) / (of->x[k + 1] - of->x[k]);
}

/* Parts `first`, first + 2, ...; first is -1 or 0. */
static int every_other(stf_model *m, const stf_lookup *of, int first, stf_lookup *to)
{
  const size_t n = of->count, room = n + 2;
  double *x = stf_pool_array(m->pool, 3 * room, sizeof *x);
  if (!x) return STEIF_NO_MEMORY;
  double *y = x + room, *slope = y + room;
  size_t count = 1;
  x[0] = of->x[0], y[0] = of->y[0], slope[0] = first < 0 ? 0 : slope_of(of, 0);
  for (size_t k = (size_t)(first + 1); k + 1 < n; k += 2) { /* part k is another's */
    const double half = (of->x[k + 1] - of->x[k]) / 2;
    x[count] = of->x[k] + half;
    slope[count] = slope_of(of, k + 1);
    y[count] = of->y[k + 1] - half * slope[count];
    count++;
  }
  const size_t last = count - 1;
  x[count] = of->x[n - 1] + (of->error ? 0 : of->x[n - 1] - of->x[n - 2]);
  y[count] = y[last] + slope[last] * (x[count] - x[last]), slope[count++] = 0;
  *to = (stf_lookup){STF_LINES_TABLE, of->error, count, x, y, slope};
  return STEIF_OK;
}

int stf_table_wave(stf_model *m, int32_t which)
{
  const stf_lookup *of = m->lookups + which;
  stf_lookup *to = m->lookups + m->tables + which;
  if (to->count) return STEIF_OK;
  STEIF_TRY(wave(m, of, to));
  STEIF_TRY(every_other(m, of, -1, to + m->tables));
  return every_other(m, of, 0, to + 2 * m->tables);
}
