/* norm.c: the norm of a distribution e on [0, T] dual to |g|_m = T^(m - 1/2) ||g^(m)||_L2 over all g with
 * g, .., g^(m-1) = 0 at T:  sup <e, g> / |g|_m = T^(1/2 - m) ||I^m e||_L2, I^m e the m-fold integral from
 * 0-, since <e, g> = (-1)^m int (I^m e) g^(m) and g -> g^(m) is onto L2.
 *
 * State z_j = I^j e: an impulse c_i delta^(i) is a jump of z_{i+1}, a mass one of z_1, and between events
 * z_1' = density - smooth part (a polynomial through its values at Gauss's points of the step),
 * z_j' = z_{j-1}: polynomials, too, whose squares Gauss's rule integrates exactly.
 *
 * Of B-splines of degree m on N equal cells, with g, .., g^(m-1) = 0 at T, the g^(m) are all step functions:
 * their supremum is the norm of the projection of I^m e on these, T^(1/2 - m) (sum over cells of
 * N/T (int I^m e)^2)^(1/2).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "norm.h"
#include "table.h"
#include <math.h>
#include <string.h>

enum { DEGREE = STF_NODES + STF_SPACES, SQUARES = DEGREE + 1 };

typedef struct walk {
  int most;
  bool known;                         /* z of the run, behind each event */
  size_t n, j;                        /* component j of n */
  long double t1, h, end;             /* end of all, like `at` in steps */
  long double at, z[STF_SPACES + 1];  /* z_1, ... there, */
  long double less[STF_SPACES + 1];   /* and the part of panels alone */
  long double square[STF_SPACES + 1]; /* integrals so far */
  const stf_panel *panel;
  long double node[STF_NODES],
    value[STF_NODES];                    /* of the smooth part in this panel, nodes in [0, 1] */
  long double fit[STF_NODES][STF_NODES]; /* coefficients of u^q from values at nodes */
  long double point[SQUARES], weight[SQUARES];
  stf_cells *cells;
  int cell;         /* this one, and */
  long double mean; /* its integral of z_m so far */
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

/* The smooth part on [from, to] of the panel, in powers of the part's own u. */
static void local(const walk *w, long double from, long double to, long double *c)
{
  long double whole[STF_NODES] = {0}, at[STF_NODES];
  const long double length = w->panel->to - w->panel->from,
                    a = (from - w->panel->from) / length, b = (to - w->panel->from) / length;
  for (int q = 0; q < STF_NODES; q++)
    for (int k = 0; k < STF_NODES; k++) whole[q] += w->fit[q][k] * w->value[k];
  for (int k = 0; k < STF_NODES; k++)
    at[k] = evaluate(whole, STF_NODES - 1, a + (b - a) * w->node[k]);
  for (int q = 0; q < STF_NODES; q++) {
    c[q] = 0;
    for (int k = 0; k < STF_NODES; k++) c[q] -= w->fit[q][k] * at[k];
  }
}

/* z_1, ... from the values at the beginning, with a density given in powers of u, to the end. */
static void pass(int most, long double length, long double *c, long double *z)
{
  for (int m = 1, degree = STF_NODES - 1; m <= most; m++) {
    for (int q = degree++; q >= 0; q--) c[q + 1] = length * c[q] / (q + 1);
    c[0] = z[m];
    z[m] = evaluate(c, degree, 1);
  }
}

/* Over a part of a panel and of a cell, of this length, with a constant density. */
static void part(walk *w, long double to, long double density)
{
  long double c[DEGREE + 1] = {0}, alone[DEGREE + 1];
  const long double length = (to - w->at) * w->h;
  if (w->panel && w->panel->x) local(w, w->at, to, c);
  if (w->known) {
    memcpy(alone, c, sizeof c);
    pass(w->most, length, alone, w->less);
  }
  c[0] += density;
  for (int m = 1, degree = STF_NODES - 1; m <= w->most; m++) {
    for (int q = degree++; q >= 0; q--) c[q + 1] = length * c[q] / (q + 1);
    c[0] = w->z[m];
    for (int k = 0; k < SQUARES; k++) {
      const long double z = evaluate(c, degree, w->point[k]);
      w->square[m] += length * w->weight[k] * z * z;
      if (w->cells && w->cells->m == m) w->mean += length * w->weight[k] * z;
    }
    w->z[m] = evaluate(c, degree, 1);
  }
  w->at = to;
}

/* Into a panel, with what happens at its beginning. */
static void enter(walk *w, const stf_panel *panel)
{
  w->panel = panel;
  for (int i = 0; i < panel->impulses && i < w->most; i++) {
    w->z[i + 1] -= panel->c[(size_t)i * w->n + w->j];
    w->less[i + 1] -= panel->c[(size_t)i * w->n + w->j];
  }
  for (size_t k = 0; k < STF_NODES; k++) w->value[k] = panel->x[k * w->n + w->j];
}

/* Out of a cell: its share of the square of the projection on step functions. */
static void leave_cell(walk *w)
{
  w->cells->square += w->mean * w->mean * w->cells->count / w->t1;
  w->mean = 0;
  w->cell++;
}

/* To this place, in steps, or to t1, through panels and cells, with a constant density. */
static void go(walk *w, long double to, long double density)
{
  to = fminl(to, w->end);
  while (w->at < to) {
    const long double panel = w->panel ? w->panel->to : to,
                      cell = w->cells ? w->end * (w->cell + 1) / w->cells->count : to,
                      next = fminl(to, fminl(panel, cell));
    part(w, next, density);
    if (w->panel && next >= panel && next < w->end) enter(w, w->panel + 1);
    if (w->cells && next >= cell) leave_cell(w);
  }
}

/* z behind event e: what the run has there, known to more digits than its terms, less the panels. */
static void recall(walk *w, const stf_events *events, size_t e)
{
  const size_t most = (size_t)events->most;
  for (int m = 1; m <= w->most; m++)
    w->z[m] = events->state[(e * w->n + w->j) * most + (size_t)m - 1] + w->less[m];
}

void stf_dual_norm(const stf_events *events, int n, int j, const stf_panel *panel,
                   long double h, size_t steps, long double t1, int most, stf_cells *cells,
                   long double *norm)
{
  walk w = {.most = most, .n = (size_t)n, .j = (size_t)j, .t1 = t1, .h = h, .cells = cells};
  w.known = events->state != NULL;
  w.end = fminl(t1 / h, (long double)steps);
  prepare(&w);
  if (panel) enter(&w, panel);
  for (size_t e = 0; e < events->count; e++) {
    const long double value = events->value[e * w.n + w.j];
    go(&w, events->at[e], events->masses ? 0 : value);
    if (events->masses) w.z[1] += value;
    if (w.known) recall(&w, events, e);
  }
  go(&w, w.end, 0);
  if (cells && w.cell < cells->count) leave_cell(&w);
  for (int m = 1; m <= most; m++) norm[m - 1] = powl(t1, 0.5L - m) * sqrtl(w.square[m]);
}
