/* slope_length.c: over which length a central difference by a parameter can be trusted.
 *
 * The quotients D(d) and D(d/2) of a function that is smooth over d differ by 3/4 of the error of D(d). Where that
 * is more than 1e-7 of them, and more than rounding makes of them, shorter lengths are tried, as long as rounding
 * is small beside what they have changed. Where none is as good, that of the best agreement is taken, to 1e-3.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_length.h"
#include <math.h>

static const sunrealtype close = 1e-7, most = 1e-3, shorter = 0.125, clear = 1e-4;
enum { LENGTHS = 16 };

/* The largest |a - b| / (|a| + |b| + rounding/close) and its component; NaN: not finite. bar NULL: no rounding. */
static sunrealtype apart(const stf_quotients *q, N_Vector a, N_Vector b, bool barred,
                         sunrealtype length, sunindextype *worst)
{
  const sunrealtype *x = stf_array(a), *y = stf_array(b), *bar = stf_array(q->bar);
  const sunindextype n = N_VGetLength(a);
  sunrealtype largest = 0;
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype rounding = barred ? 2 * bar[i] / length : 0;
    const sunrealtype off =
      x[i] == y[i] ? 0 : fabs(x[i] - y[i]) / (fabs(x[i]) + fabs(y[i]) + rounding / close);
    if (off > largest) largest = off, *worst = i;
    if (!isfinite(off)) return NAN;
  }
  return largest;
}

/* Is rounding small in all components that have changed by more than it? */
static bool above_rounding(const stf_quotients *q, N_Vector first, sunrealtype length)
{
  const sunrealtype *x = stf_array(first), *y = stf_array(q->now), *bar = stf_array(q->bar);
  const sunindextype n = N_VGetLength(first);
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype rounding = 2 * bar[i] / length;
    if (fabs(x[i] - y[i]) > rounding && rounding > clear * fabs(y[i])) return false;
  }
  return true;
}

static int search(const stf_quotients *q, N_Vector first, sunrealtype best, stf_trusted *found)
{
  sunrealtype d = q->length * shorter, good = best <= most ? q->length : 0;
  sunindextype ignored;
  for (int i = 0; i < LENGTHS && d >= q->least; i++, d *= shorter) {
    STEIF_TRY(q->quotient(d, q->now, q->user));
    STEIF_TRY(q->quotient(d / 2, q->half, q->user));
    if (!above_rounding(q, first, d)) break;
    const sunrealtype off = apart(q, q->now, q->half, true, d, &ignored);
    if (off < best) best = off, good = off <= most ? d : 0;
    if (off <= close) break;
  }
  found->length = good;
  return 0;
}

int stf_trust(const stf_quotients *q, N_Vector first, stf_trusted *found)
{
  *found = (stf_trusted){.length = q->length};
  STEIF_TRY(q->quotient(q->length / 2, q->half, q->user));
  sunrealtype off = apart(q, first, q->half, false, q->length, &found->component);
  if (!(off > close)) return 0;
  STEIF_TRY(q->noise(q->bar, q->user));
  off = apart(q, first, q->half, true, q->length, &found->component);
  if (!(off > close)) return 0;
  found->quotient[0] = stf_array(first)[found->component];
  found->quotient[1] = stf_array(q->half)[found->component];
  return search(q, first, off, found);
}
