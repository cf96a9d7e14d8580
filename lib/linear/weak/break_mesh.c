/* break_mesh.c: constant steps with every break of f on their mesh.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "weak_inside.h"
#include <math.h>

/* A break is a whole number of steps within WHOLE of one; a first choice keeps within these factors of
 * the step wanted and divides the interval, too. */
#define WHOLE 1e-9
#define SHORTER 0.6
#define LONGER 1.7
#define SHORTEST (1.0 / 32) /* of the step wanted */

static bool whole(sunrealtype t, sunrealtype h)
{
  const sunrealtype n = t / h;
  return fabs(n - round(n)) <= WHOLE * fmax(1, n) && round(n) >= 1;
}

size_t stf_break_inside(size_t count, const sunrealtype *breaks, sunrealtype t1, sunrealtype h)
{
  for (size_t b = 0; b < count && breaks[b] < t1; b++)
    if (!whole(breaks[b], h)) return b;
  return count;
}

/* Does h = first break / m serve? */
static bool serves(size_t count, const sunrealtype *breaks, sunrealtype t1, bool divides,
                   sunrealtype h)
{
  return stf_break_inside(count, breaks, t1, h) == count && (!divides || whole(t1, h));
}

sunrealtype stf_break_step(size_t count, const sunrealtype *breaks, sunrealtype t1,
                           sunrealtype h)
{
  if (!count || breaks[0] >= t1) return h;
  for (int divides = 1; divides >= 0; divides--) {
    const sunrealtype m = fmax(1, round(breaks[0] / h));
    for (sunrealtype away = 0; breaks[0] / (m + away) >= SHORTEST * h; away++) {
      const sunrealtype shorter = breaks[0] / (m + away),
                        longer = m > away ? breaks[0] / (m - away) : INFINITY;
      if (divides && shorter < SHORTER * h && longer > LONGER * h) break;
      if (serves(count, breaks, t1, divides, shorter)) return shorter;
      if (longer <= LONGER * h && serves(count, breaks, t1, divides, longer)) return longer;
    }
  }
  return NAN;
}
