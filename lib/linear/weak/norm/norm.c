/* norm.c: the norm of a distribution e on [0, T] dual to |g|_m = T^(m - 1/2) ||g^(m)||_L2 over all g with
 * g, .., g^(m-1) = 0 at T:  sup <e, g> / |g|_m = T^(1/2 - m) ||I^m e||_L2, I^m e the m-fold integral from
 * 0-, since <e, g> = (-1)^m int (I^m e) g^(m) and g -> g^(m) is onto L2.
 *
 * State z_j = I^j e: an impulse c_i delta^(i) is a jump of z_{i+1}, a mass one of z_1, and between events
 * z_1' = density - smooth part (a polynomial through its values at Gauss's points of the step),
 * z_j' = z_{j-1}: polynomials, too, whose squares Gauss's rule integrates exactly.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "norm.h"
#include "table.h"
#include <math.h>
#include <string.h>

enum { DEGREE = STF_NODES + STF_SPACES, SQUARES = DEGREE + 1 };

typedef struct walk {
  int most;
  long double t1, h, at;              /* at: in time */
  long double z[STF_SPACES + 1];      /* z_1, ... at `at` */
  long double square[STF_SPACES + 1]; /* integrals so far */
  long double node[STF_NODES],
    value[STF_NODES];                    /* of the smooth part in this step, nodes in [0, 1] */
  long double fit[STF_NODES][STF_NODES]; /* coefficients of u^q from values at nodes */
  long double point[SQUARES], weight[SQUARES];
} walk;

/* Lagrange's polynomials of the nodes in powers of u. */
static void prepare(walk *w)
{
  long double unused[STF_NODES];
  stf_gauss(STF_NODES, w->node, unused);
  stf_gauss(SQUARES, w->point, w->weight);
  for (int k = 0; k < STF_NODES; k++) {
    long double c[STF_NODES] = {1};
    for (int j = 0, degree = 0; j < STF_NODES; j++) {
      if (j == k) continue;
      const long double by = w->node[k] - w->node[j];
      for (int q = ++degree; q >= 0; q--)
        c[q] = ((q ? c[q - 1] : 0) - w->node[j] * (q < degree ? c[q] : 0)) / by;
    }
    for (int q = 0; q < STF_NODES; q++) w->fit[q][k] = c[q];
  }
}

static long double evaluate(const long double *c, int degree, long double u)
{
  long double sum = c[degree];
  for (int q = degree - 1; q >= 0; q--) sum = sum * u + c[q];
  return sum;
}

/* The smooth part on the piece [a, b] of the step, in powers of the piece's own u. */
static void local(const walk *w, long double a, long double b, long double *c)
{
  long double whole[STF_NODES] = {0}, at[STF_NODES];
  for (int q = 0; q < STF_NODES; q++)
    for (int k = 0; k < STF_NODES; k++) whole[q] += w->fit[q][k] * w->value[k];
  for (int k = 0; k < STF_NODES; k++)
    at[k] = evaluate(whole, STF_NODES - 1, a + (b - a) * w->node[k]);
  for (int q = 0; q < STF_NODES; q++) {
    c[q] = 0;
    for (int k = 0; k < STF_NODES; k++) c[q] += w->fit[q][k] * at[k];
  }
}

/* From a to b, in parts of step i, with a constant density. */
static void piece(walk *w, size_t i, long double a, long double b, long double density)
{
  long double c[DEGREE + 1] = {0}, length = (b - a) * w->h;
  const long double end = ((long double)i + b) * w->h;
  if (end > w->t1) length -= end - w->t1;
  if (!(length > 0)) return;
  local(w, a, a + length / w->h, c);
  for (int q = 0; q < STF_NODES; q++) c[q] = -c[q];
  c[0] += density;
  for (int m = 1, degree = STF_NODES - 1; m <= w->most; m++) {
    for (int q = degree++; q >= 0; q--) c[q + 1] = length * c[q] / (q + 1);
    c[0] = w->z[m];
    for (int k = 0; k < SQUARES; k++) {
      const long double z = evaluate(c, degree, w->point[k]);
      w->square[m] += length * w->weight[k] * z * z;
    }
    w->z[m] = evaluate(c, degree, 1);
  }
}

/* One step: its density, or its masses from event `e` on; the next event. */
static size_t step(walk *w, const stf_events *events, size_t n, size_t j, size_t i, size_t e)
{
  if (!events->masses) {
    piece(w, i, 0, 1, e < events->count ? events->value[e * n + j] : 0);
    return e + 1;
  }
  long double a = 0;
  for (; e < events->count && events->at[e] < (long double)i + 1; e++) {
    const long double b = events->at[e] - (long double)i;
    piece(w, i, a, b, 0);
    w->z[1] += events->value[e * n + j];
    a = b;
  }
  piece(w, i, a, 1, 0);
  return e;
}

void stf_dual_norm(const stf_events *events, int n, int j, const stf_limit *limit,
                   long double h, size_t steps, long double t1, int most, long double *norm)
{
  walk w = {.most = most, .t1 = t1, .h = h};
  size_t e = 0;
  prepare(&w);
  for (int i = 0; limit && i < limit->impulses && i < most; i++)
    w.z[i + 1] = -limit->c[(size_t)i * (size_t)n + (size_t)j];
  for (size_t i = 0; i < steps; i++) {
    for (size_t k = 0; limit && k < STF_NODES; k++)
      w.value[k] = limit->x[(i * STF_NODES + k) * (size_t)n + (size_t)j];
    e = step(&w, events, (size_t)n, (size_t)j, i, e);
  }
  for (int m = 1; m <= most; m++) norm[m - 1] = powl(t1, 0.5L - m) * sqrtl(w.square[m]);
}
