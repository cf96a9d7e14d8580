/* interleaved_predict.c: the collocation polynomial of the last step as a start for the next one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "irk_interleaved.h"
#include <math.h>

/* Coefficients of x^1 .. x^s of the Lagrange basis on 0, c_1 .. c_s at 1 + x, and its slope at 0,
 * or at 1 when the end is not a stage. */
void stf_irk_interleaved_basis(stf_irk_interleaved *e, int j)
{
  const sunrealtype *c = e->table->c;
  long double p[STF_EIGEN_STAGES + 2] = {1}, slope = 0;
  int degree = 0;
  for (int m = -1; m < e->s; m++) {
    if (m == j) continue;
    const long double node = m < 0 ? 0 : c[m], scale = 1 / ((long double)c[j] - node);
    p[degree + 1] = 0;
    for (int k = ++degree; k >= 0; k--)
      p[k] = ((k ? p[k - 1] : 0) + (k < degree ? p[k] * (1 - node) : 0)) * scale;
  }
  for (int k = 0; k < e->s; k++) e->K[j][k] = (double)p[k + 1];
  for (int k = degree; k >= 1; k--) slope = slope * -1 + p[k] * k;
  e->d[j] = e->accurate ? -(double)slope : -e->K[j][0];
  e->end[j] = (double)p[0];
}

/* Where to cut: the term after the last one kept should be the smallest. */
static int terms(const stf_step *s, const stf_irk_interleaved *e, double q)
{
  const double *w = STF_ARRAY(s->weights);
  double m[STF_EIGEN_STAGES], power = q;
  if (q <= 1.2) return e->s;
  for (int k = 0; k < e->s; k++, power *= q) {
    double sum = 0;
    for (int i = 0; i < e->n; i++) {
      const double x = e->a[i * e->L->wide + k] * w[i];
      sum += x * x;
    }
    m[k] = sqrt(sum) * power;
  }
  int best = e->s;
  double least =
    e->s > 1 && m[e->s - 2] > 0 ? m[e->s - 1] * (m[e->s - 1] / m[e->s - 2]) : m[e->s - 1];
  for (int k = e->s - 1; k >= 0; k--)
    if (m[k] < least) least = m[k], best = k;
  return best;
}

void stf_irk_interleaved_predict(const stf_step *s, stf_irk_interleaved *e, double h)
{
  const bool start = !e->history || s->restart || e->fails > 2;
  const double q = start ? 0 : h / s->h;
  const int count = start ? 0 : terms(s, e, q);
  double x[STF_INTERLEAVED_STAGES] = {0};
  for (int j = 0; j < e->s; j++) x[j] = q * e->table->c[j];
  stf_interleaved_begin(e->L, count, e->a, x, STF_ARRAY(s->y));
}
