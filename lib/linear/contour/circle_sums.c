/* circle_sums.c: what solutions at the nodes of a circle contribute to the Laurent coefficients.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle_parts.h"
#include <math.h>

/* Sums of powers -1 .. STF_INDEX_MOST. */
enum { SUMS = STF_INDEX_MOST + 2 };

/* Unknowns that are summed over together, in the first cache. */
enum { BLOCK = 128 };

static const sunrealtype pi = 3.14159265358979323846;

/* Nodes are visited in pairs that mirror each other in the imaginary axis, theta and pi -
 * theta: e^{-i k theta} of both differ by signs alone. Without a partner: i R. */
sunrealtype stf_circle_angle(const stf_circle *c, int visit)
{
  const int half = c->points / 2, j = visit % 2 ? half - 1 - visit / 2 : visit / 2;
  return 2 * pi * (j + 0.5) / c->points;
}

/* Of solutions a, b at a pair of nodes, for even and odd powers of s: real parts a +- b and
 * imaginary parts a -+ b; without a partner b = 0. */
typedef struct fold {
  sunrealtype re[2][BLOCK], im[2][BLOCK];
} fold;

static void fold_lanes(const stf_multishift *batch, int lane, bool pair, sunindextype at, int n,
                       fold *restrict f)
{
  enum { WIDE = STF_LANES };
  const sunrealtype *restrict a = batch->x + 2 * WIDE * at + lane;
  for (int i = 0; i < n; i++, a += 2 * WIDE) {
    const sunrealtype re = pair ? a[1] : 0, im = pair ? a[WIDE + 1] : 0;
    f->re[0][i] = a[0] + re;
    f->im[0][i] = a[WIDE] - im;
    f->re[1][i] = a[0] - re;
    f->im[1][i] = a[WIDE] + im;
  }
}

/* What folds contribute to the sum of one power. */
typedef struct weights {
  int folds;
  bool odd, first;
  sunrealtype c[STF_LANES], s[STF_LANES];
} weights;

/* visit[k]: a node of fold k; first: there is no sum yet. */
static weights weights_of(const stf_circle *c, int folds, const int *visit, bool first,
                          int power)
{
  weights w = {.folds = folds, .odd = power & 1, .first = first};
  for (int k = 0; k < folds; k++) {
    const sunrealtype turn = power * stf_circle_angle(c, visit[k]), weight = 2.0 / c->points;
    w.c[k] = weight * cos(turn);
    w.s[k] = weight * sin(turn);
  }
  return w;
}

static void add_power(const weights *w, const fold *f, int n, sunrealtype *restrict sum)
{
  for (int i = 0; w->first && i < n; i++) sum[i] = 0;
  for (int k = 0; k < w->folds; k++) {
    const sunrealtype *restrict re = f[k].re[w->odd], *restrict im = f[k].im[w->odd];
    const sunrealtype cosine = w->c[k], sine = w->s[k];
    for (int i = 0; i < n; i++) sum[i] += cosine * re[i] + sine * im[i];
  }
}

/* The good lanes of a batch at `visits` join the sums; partners together. */
void stf_circle_add(stf_circle *c, const stf_multishift *b, const int *visits, int count,
                    bool first)
{
  const sunindextype n = c->scaled.n;
  fold f[STF_LANES];
  weights w[SUMS];
  int folds = 0, lane[STF_LANES], visit[STF_LANES];
  bool pair[STF_LANES];
  for (int q = 0; q < count; q++) {
    if (!b->good[q]) continue;
    lane[folds] = q;
    visit[folds] = visits[q];
    pair[folds] =
      visits[q] % 2 == 0 && q + 1 < count && b->good[q + 1] && visits[q + 1] == visits[q] + 1;
    q += pair[folds]; /* a partner is in this fold already */
    folds++;
  }
  for (int k = 0; k < c->count; k++) w[k] = weights_of(c, folds, visit, first, k - 1);
  for (sunindextype at = 0; at < n; at += BLOCK) {
    const int now = n - at < BLOCK ? (int)(n - at) : BLOCK;
    for (int k = 0; k < folds; k++) fold_lanes(b, lane[k], pair[k], at, now, &f[k]);
    for (int k = 0; k < c->count; k++) add_power(&w[k], f, now, c->sum + k * n + at);
  }
}

void stf_circle_measure(stf_circle *c)
{
  const sunindextype n = c->scaled.n;
  for (int k = 0; k < c->count; k++) {
    const sunrealtype *sum = c->sum + k * n;
    sunrealtype square[4] = {0};
    sunindextype i = 0;
    for (; i + 4 <= n; i += 4)
      for (int m = 0; m < 4; m++) square[m] += sum[i + m] * sum[i + m];
    for (; i < n; i++) square[0] += sum[i] * sum[i];
    c->square[k] = square[0] + square[1] + square[2] + square[3];
  }
}
