/* pairing.c: a run read as a function (conventions P, R, C, stage) and paired with the test function, in
 * long double. Box averages come from Gauss's rule on each step: differencing an antiderivative of g
 * would lose a factor 1/h of accuracy to cancellation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pairing.h"
#include "spline.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Of a weight, in units of long double: a power and a sum of eight. */
#define ROUNDING 4

/* width: of what the weight is from, values of the test function about t. */
static void add(stf_pairing *p, long double weight, long double width, long double t,
                const long double *x)
{
  for (int m = 0; m < p->n && weight != 0; m++) p->sum[m] += weight * x[m];
  if (!p->square) return;
  const long double size =
    p->g->smooth ? fabsl(width) * stf_spline_size(p->g->smooth, t) : fabsl(weight);
  for (int m = 0; m < p->n; m++) p->square[m] += size * x[m] * (size * x[m]);
}

long double stf_gregory(int p, size_t i)
{
  static const long double w[][STF_GREGORY] = {
    {1, 1, 1, 1, 1},
    {0, 1, 1, 1, 1},
    {1.L / 2, 1, 1, 1, 1},
    {5.L / 12, 13.L / 12, 1, 1, 1},
    {3.L / 8, 7.L / 6, 23.L / 24, 1, 1},
    {251.L / 720, 299.L / 240, 211.L / 240, 739.L / 720, 1},
    {95.L / 288, 317.L / 240, 23.L / 30, 793.L / 720, 157.L / 160}};
  return i < STF_GREGORY ? w[p][i] : 1;
}

/* Of mass i of the comb, over h. */
static long double comb(const stf_pairing *p, size_t i)
{
  return p->ends ? stf_gregory(p->ends, p->steps - i) : 1;
}

/* What is given is a bound; the deviation of such errors is a quarter of it. */
long double stf_weight_noise(const stf_weight *g, long double square)
{
  const long double part = g->given && !g->smooth ? (long double)g->given->rounding : 0;
  return 2 * (part + ROUNDING * LDBL_EPSILON) / 4 * sqrtl(square);
}

/* At step `at`, in order of time: nodes of a table need not ascend. */
static void keep(stf_pairing *p, long double at, long double weight, const long double *x)
{
  stf_events *e = p->events;
  at = p->h == p->unit && p->from == 0 ? at : (p->from + at * p->h) / p->unit;
  const size_t n = (size_t)p->n;
  size_t k = e->count;
  if (e->count == e->room) return;
  e->count++;
  for (; k > 0 && e->at[k - 1] > at; k--) {
    e->at[k] = e->at[k - 1];
    memcpy(e->value + k * n, e->value + (k - 1) * n, n * sizeof *x);
  }
  e->at[k] = at;
  for (size_t m = 0; m < n; m++) e->value[k * n + m] = weight * x[m];
}

/* The event of node i in convention P, R or C. */
static void keep_node(stf_pairing *p, size_t i, const long double *x)
{
  const bool masses = p->convention == STEIF_C, left = p->convention == STEIF_P;
  if (left ? i < p->steps : i > 0 || (masses && p->solved))
    keep(p, (long double)(left ? i + 1 : i), masses ? p->h * comb(p, i) : 1, x);
}

int stf_pairing_node(stf_pairing *p, size_t i, const long double *x)
{
  const long double t = p->from + (long double)i * p->h;
  long double w = 0, about = t;
  switch (p->convention) {
  case STEIF_P:
    about = t + p->h / 2;
    if (i < p->steps)
      STEIF_TRY(stf_weight_box(p->g, t, p->from + (long double)(i + 1) * p->h, &w));
    break;
  case STEIF_R:
    about = t - p->h / 2;
    if (i > 0) STEIF_TRY(stf_weight_box(p->g, p->from + (long double)(i - 1) * p->h, t, &w));
    break;
  case STEIF_C:
    if (i > 0 || p->solved) STEIF_TRY(stf_weight_at(p->g, t, 0, &w));
    w *= p->h * comb(p, i);
    break;
  default: return STEIF_OK;
  }
  if (w != 0) add(p, w, p->h, about, x);
  if (p->events) keep_node(p, i, x);
  return STEIF_OK;
}

int stf_pairing_stage(stf_pairing *p, size_t i, long double c, long double b,
                      const long double *X)
{
  long double w;
  if (p->convention != STEIF_STAGE) return STEIF_OK;
  const long double t = p->from + ((long double)i + c) * p->h;
  STEIF_TRY(stf_weight_at(p->g, t, 0, &w));
  add(p, p->h * b * w, p->h * b, t, X);
  if (p->events) keep(p, (long double)i + c, p->h * b, X);
  return STEIF_OK;
}
