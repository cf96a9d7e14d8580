/* integral_separation.c: are consecutive exponents integrally separated? Means of ln R_ii - ln R_jj, j = i + 1, over
 * windows of several lengths.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integral_separation.h"
#include <math.h>

enum { POINTS = 2048, PARTS = 16, SHORTEST = 64, LONGEST = 4 };

int stf_gaps_open(stf_pool *pool, long steps, int m, stf_gaps *s)
{
  *s = (stf_gaps){.m = m, .stride = steps / POINTS > 1 ? steps / POINTS : 1};
  const size_t room = (size_t)(steps / s->stride) + 1;
  s->sum = stf_pool_array(pool, room * (size_t)m, sizeof *s->sum);
  return s->sum ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_gaps_record(stf_gaps *s, long n, const sunrealtype *now)
{
  if (n % s->stride) return;
  s->count = n / s->stride;
  for (int i = 0; i < s->m; i++) s->sum[s->count * s->m + i] = now[i];
}

/* Growth of the pair apart from point a to point b. */
static sunrealtype apart(const stf_gaps *s, int i, long a, long b)
{
  const sunrealtype *from = s->sum + a * s->m + i, *to = s->sum + b * s->m + i;
  return (to[0] - to[1]) - (from[0] - from[1]);
}

/* Windows of w points: the extremes, and how far the smallest of 16 parts of the run scatter. */
static void look(const stf_gaps *s, int i, long w, sunrealtype span, steif_separation *out)
{
  const long starts = s->count - w + 1;
  sunrealtype mean = 0, square = 0;
  *out = (steif_separation){.window = span, .low = INFINITY, .high = -INFINITY};
  for (int part = 0; part < PARTS; part++) {
    sunrealtype low = INFINITY;
    for (long a = part * starts / PARTS; a < (part + 1) * starts / PARTS; a++) {
      const sunrealtype rate = apart(s, i, a, a + w) / span;
      low = fmin(low, rate);
      out->high = fmax(out->high, rate);
    }
    out->low = fmin(out->low, low);
    const sunrealtype off = low - mean;
    mean += off / (part + 1);
    square += off * (low - mean);
  }
  out->spread = sqrt(square / (PARTS - 1));
  out->separated = out->low - 2 * out->spread > 0;
}

void stf_gaps_judge(const stf_gaps *s, sunrealtype h, steif_separation *pair)
{
  const sunrealtype point = (sunrealtype)s->stride * h;
  for (int i = 0; i + 1 < s->m; i++) {
    pair[i] = (steif_separation){NAN, NAN, NAN, NAN, 0};
    for (long part = SHORTEST; part >= LONGEST && !pair[i].separated; part /= 2) {
      const long w = s->count / part;
      if (w >= 1 && s->count - w + 1 >= PARTS) look(s, i, w, (sunrealtype)w * point, &pair[i]);
    }
  }
}
