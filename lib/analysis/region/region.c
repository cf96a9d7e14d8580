/* region.c: the constants of a stability region, for every family from the propagator alone.
 * G. Dahlquist, BIT 3 (1963); O. B. Widlund, BIT 7 (1967) for A(alpha).
 *
 * A ray arg(-z) = theta is stable when the largest rho - 1 over |z| does not exceed a
 * tolerance. The maximum is found by a scan in log |z| and a golden section around the highest
 * interior peak; near the tangent ray that peak crosses zero with a nonzero slope in theta, so
 * bisection with a tolerance of rounding gives alpha to about 1e-10 degrees.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "region.h"
#include "region_thresholds.h"
#include <math.h>

/* |z| from 10^LOWEST to 10^HIGHEST: rho - 1 is Re z at the low end for a consistent method. */
enum { LOWEST = -4, HIGHEST = 6, POINTS = (HIGHEST - LOWEST) * STF_SCAN_PER_DECADE };
#define GOLDEN 0.61803398874989484820

typedef struct ray {
  stf_scan *scan;
  sunrealtype re, im; /* direction */
} ray;

static ray at_angle(stf_scan *scan, sunrealtype theta)
{
  return (ray){scan, -cos(theta), sin(theta)};
}

static sunrealtype height(const ray *line, sunrealtype log_r)
{
  const sunrealtype r = pow(10, log_r);
  return stf_scan_excess(line->scan, r * line->re, r * line->im);
}

static sunrealtype grid(int i) { return LOWEST + (sunrealtype)i / STF_SCAN_PER_DECADE; }

/* The maximum of rho - 1 for log |z| in [a, b], one peak inside. */
static sunrealtype peak(const ray *line, sunrealtype a, sunrealtype b)
{
  sunrealtype c = b - GOLDEN * (b - a), d = a + GOLDEN * (b - a);
  sunrealtype at_c = height(line, c), at_d = height(line, d), most = fmax(at_c, at_d);
  while (b - a > STF_PEAK_WIDTH) {
    if (at_c > at_d) {
      b = d;
      d = c;
      at_d = at_c;
      at_c = height(line, c = b - GOLDEN * (b - a));
    } else {
      a = c;
      c = d;
      at_c = at_d;
      at_d = height(line, d = a + GOLDEN * (b - a));
    }
    most = fmax(most, fmax(at_c, at_d));
  }
  return most;
}

/* The largest rho - 1 on the ray; `enough` ends the search early. */
static sunrealtype largest(const ray *line, sunrealtype enough)
{
  sunrealtype before = height(line, grid(0)), here = height(line, grid(1)), best = before;
  sunrealtype top = -INFINITY, where = 0;
  best = fmax(best, here);
  for (int i = 2; i <= POINTS && best <= enough; i++) {
    const sunrealtype next = height(line, grid(i));
    if (here >= before && here >= next && here > top) {
      top = here;
      where = grid(i - 1);
    }
    best = fmax(best, next);
    before = here;
    here = next;
  }
  if (best > enough || top == -INFINITY) return best;
  const sunrealtype step = 1.0 / STF_SCAN_PER_DECADE;
  return fmax(best, peak(line, where - step, where + step));
}

static bool stable(stf_scan *scan, sunrealtype theta, sunrealtype tolerance)
{
  const ray line = at_angle(scan, theta);
  return largest(&line, tolerance) <= tolerance;
}

/* alpha in radians; the first unstable ray of a coarse fan bounds it from above. */
static sunrealtype sector(stf_scan *scan)
{
  const sunrealtype right = acos(0.0), spacing = right / 36;
  if (!stable(scan, 0, STF_RHO_NOISE)) return 0;
  int i = 1;
  while (i < 36 && stable(scan, i * spacing, STF_RHO_NOISE)) i++;
  if (i == 36 && stable(scan, right, STF_RHO_TOUCHES)) return right;
  sunrealtype low = (i - 1) * spacing, high = i * spacing;
  while (high - low > STF_ANGLE_WIDTH) {
    const sunrealtype middle = (low + high) / 2;
    *(stable(scan, middle, STF_RHO_NOISE) ? &low : &high) = middle;
  }
  return low;
}

/* The first point of the ray where rho - 1 becomes positive beyond rounding, INFINITY if none.
 * A scan that begins at the origin (rho - 1 still positive at a quarter of the crossing of
 * STF_RHO_TOUCHES) leaves no interval: 0. */
static sunrealtype reach(stf_scan *scan, sunrealtype theta)
{
  const ray line = at_angle(scan, theta);
  int i = 0;
  while (i <= POINTS && height(&line, grid(i)) <= STF_RHO_TOUCHES) i++;
  if (i > POINTS) return INFINITY;
  if (i == 0) return 0;
  sunrealtype low = grid(i - 1), high = grid(i);
  if (height(&line, low + log10(0.25)) > STF_RHO_NOISE) return 0;
  while (high - low > 4 * STF_EPS * fmax(1, fabs(high))) {
    const sunrealtype middle = (low + high) / 2;
    *(height(&line, middle) <= 8 * STF_EPS ? &low : &high) = middle;
  }
  return pow(10, low);
}

/* Every eigenvalue of M(0) within the circle, those on it simple. */
static int zero_stability(stf_scan *scan, int *zero_stable)
{
  STEIF_TRY(stf_scan_eigenvalues(scan, 0, 0));
  const sunrealtype *w = scan->work;
  *zero_stable = 1;
  for (int i = 0; i < scan->r; i++) {
    const sunrealtype size = hypot(w[2 * i], w[2 * i + 1]);
    if (size > 1 + STF_RHO_TOUCHES) *zero_stable = 0;
    for (int j = 0; j < i && size > 1 - STF_ROOT_DISTANCE; j++)
      if (hypot(w[2 * i] - w[2 * j], w[2 * i + 1] - w[2 * j + 1]) < STF_ROOT_DISTANCE)
        *zero_stable = 0;
  }
  return STEIF_OK;
}

static int find(stf_scan *scan, steif_region *region)
{
  const sunrealtype right = acos(0.0);
  STEIF_TRY(zero_stability(scan, &region->zero_stable));
  const sunrealtype alpha = region->zero_stable ? sector(scan) : 0;
  region->a_stable = alpha == right;
  region->alpha_deg = region->a_stable ? 90 : alpha * 90 / right;
  region->r_inf = stf_scan_excess(scan, -INFINITY, 0) + 1;
  if (region->r_inf < pow(STF_RHO_DAMPED, 1.0 / scan->r))
    region->r_inf = 0; /* nilpotent, rounded */
  region->l_stable = region->a_stable && region->r_inf == 0;
  region->real_limit = alpha > 0 ? INFINITY : reach(scan, 0);
  region->imag_limit = region->a_stable ? INFINITY : reach(scan, right);
  return scan->code;
}

int steif_region_find(steif_context *ctx, const char *method, steif_region *region)
{
  stf_scan scan;
  STEIF_CHECK(method && region, ctx, STEIF_BAD_INPUT,
              "a method and a place for its region are needed, got NULL");
  *region = (steif_region){0};
  STEIF_TRY(stf_scan_open(&scan, ctx, method));
  const int code = find(&scan, region);
  stf_scan_close(&scan);
  return code;
}
