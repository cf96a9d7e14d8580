/* made.c: problems made around a solution that is written down first.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "made.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

/* ---- the solution ---- */

/* Derivative d = 0, 1, 2 of g_i. */
static sunrealtype wave(const made *m, int i, int d, sunrealtype t)
{
  sunrealtype sum = d == 0 ? m->mean[i] : 0;
  for (int k = 0; k < MADE_WAVES; k++) {
    const sunrealtype angle = m->rate[i][k] * t + m->phase[i][k];
    sum += m->size[i][k] * pow(m->rate[i][k], d) *
           (d == 1   ? cos(angle)
            : d == 0 ? sin(angle)
                     : -sin(angle));
  }
  return sum;
}

static int exact(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  const made *m = user;
  const int half = m->n / 2;
  for (int i = 0; i < m->n; i++) {
    const bool speed = m->kind == MADE_MECHANICAL && i >= half && i < 2 * half;
    NV_Ith_S(y, i) = wave(m, speed ? i - half : i, speed, t);
    if (yp) NV_Ith_S(yp, i) = wave(m, speed ? i - half : i, 1 + speed, t);
  }
  return 0;
}

/* ---- relaxation, algebraic, constrained ---- */

/* phi(y) = H y + bend y_1^2 over `count` components, and its gradient. */
static sunrealtype constraint(const made *m, int count, const sunrealtype *y)
{
  sunrealtype sum = m->bend * y[0] * y[0];
  for (int j = 0; j < count; j++) sum += m->H[j] * y[j];
  return sum;
}

static sunrealtype gradient(const made *m, int j, const sunrealtype *y)
{
  return m->H[j] + (j == 0 ? 2 * m->bend * y[0] : 0);
}

static int relax(sunrealtype t, N_Vector y_, N_Vector out_, void *user)
{
  const made *m = user;
  const int free = m->kind == MADE_CONSTRAINED ? m->n - 1 : m->n;
  const sunrealtype *y = NV_DATA_S(y_);
  sunrealtype *out = NV_DATA_S(out_), g[MADE_MOST] = {0};
  for (int i = 0; i < m->n; i++) g[i] = wave(m, i, 0, t);
  for (int i = 0; i < free; i++) {
    const int next = (i + 1) % free;
    out[i] = m->c[i] * (y[i] * y[next] - g[i] * g[next]);
    if (i < m->differential) out[i] += wave(m, i, 1, t);
    for (int j = 0; j < free; j++) out[i] += m->A[i][j] * (y[j] - g[j]);
    if (free < m->n) out[i] += m->G[i] * (y[free] - g[free]);
  }
  if (free < m->n) out[free] = constraint(m, free, y) - constraint(m, free, g);
  return 0;
}

static int relax_jacobian(sunrealtype t, N_Vector y_, N_Vector fy, SUNMatrix J, void *user,
                          N_Vector a, N_Vector b, N_Vector c)
{
  const made *m = user;
  const int free = m->kind == MADE_CONSTRAINED ? m->n - 1 : m->n;
  const sunrealtype *y = NV_DATA_S(y_);
  (void)t, (void)fy, (void)a, (void)b, (void)c;
  for (int i = 0; i < free; i++) {
    const int next = (i + 1) % free;
    for (int j = 0; j < free; j++) SM_ELEMENT_D(J, i, j) = m->A[i][j];
    SM_ELEMENT_D(J, i, i) += m->c[i] * y[next];
    SM_ELEMENT_D(J, i, next) += m->c[i] * y[i];
    if (free == m->n) continue;
    SM_ELEMENT_D(J, i, free) = m->G[i];
    SM_ELEMENT_D(J, free, i) = gradient(m, i, y);
  }
  return 0;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  const made *m = user;
  (void)t, (void)y, (void)yp;
  for (int i = 0; i < m->differential; i++) SM_ELEMENT_D(E, i, i) = 1;
  return 0;
}

/* ---- mechanical: q, q', one multiplier ---- */

static int move(sunrealtype t, N_Vector y_, N_Vector out_, void *user)
{
  const made *m = user;
  const int d = m->n / 2;
  const sunrealtype *y = NV_DATA_S(y_), force = y[2 * d] - wave(m, 2 * d, 0, t);
  sunrealtype *out = NV_DATA_S(out_), g[MADE_MOST] = {0};
  for (int i = 0; i < d; i++) g[i] = wave(m, i, 0, t);
  for (int i = 0; i < d; i++) {
    out[i] = y[d + i];
    out[d + i] =
      wave(m, i, 2, t) - m->c[i] * (y[d + i] - wave(m, i, 1, t)) + gradient(m, i, y) * force;
    for (int j = 0; j < d; j++) out[d + i] += m->A[i][j] * (y[j] - g[j]);
  }
  out[2 * d] = constraint(m, d, y) - constraint(m, d, g);
  return 0;
}

static int move_jacobian(sunrealtype t, N_Vector y_, N_Vector fy, SUNMatrix J, void *user,
                         N_Vector a, N_Vector b, N_Vector c)
{
  const made *m = user;
  const int d = m->n / 2;
  const sunrealtype *y = NV_DATA_S(y_);
  (void)fy, (void)a, (void)b, (void)c;
  for (int i = 0; i < d; i++) {
    SM_ELEMENT_D(J, i, d + i) = 1;
    SM_ELEMENT_D(J, d + i, d + i) = -m->c[i];
    for (int j = 0; j < d; j++) SM_ELEMENT_D(J, d + i, j) = m->A[i][j];
    SM_ELEMENT_D(J, d + i, 2 * d) = SM_ELEMENT_D(J, 2 * d, i) = gradient(m, i, y);
  }
  SM_ELEMENT_D(J, d, 0) += 2 * m->bend * (y[2 * d] - wave(m, 2 * d, 0, t));
  return 0;
}

/* ---- making ---- */

/* T = unit lower times unit upper triangular, both with small entries: A = -L U diag(lambda) U^{-1} L^{-1},
 * made by similarity transformations of one entry each. */
void made_matrix(made *m, stf_random *r, int n, sunrealtype decades)
{
  for (int i = 0; i < n; i++)
    m->A[i][i] = -pow(10, i == 0 ? 0 : i == 1 ? decades : stf_random_in(r, 0, decades));
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        const int to = pass ? i : j, from = pass ? j : i;
        const sunrealtype x = stf_random_in(r, -0.4, 0.4);
        for (int k = 0; k < n; k++) m->A[to][k] += x * m->A[from][k];
        for (int k = 0; k < n; k++) m->A[k][from] -= x * m->A[k][to];
      }
}

static void waves(made *m, stf_random *r)
{
  for (int i = 0; i < m->n; i++) {
    m->mean[i] = stf_random_in(r, -1, 1);
    for (int k = 0; k < MADE_WAVES; k++) {
      m->size[i][k] = stf_random_in(r, 0.1, 0.6);
      m->rate[i][k] = pow(10, stf_random_in(r, -0.7, 0.5));
      m->phase[i][k] = stf_random_in(r, 0, 6.28);
    }
  }
}

/* A = (S + B D^{-1} C, B; C, D) of order n, S in the leading rows as it is, D lower triangular: what is left without
 * the algebraic unknowns is S. */
static void add_algebraic(made *m, stf_random *r)
{
  const int from = m->differential, n = m->n;
  for (int i = from; i < n; i++) {
    for (int j = 0; j < i; j++) m->A[i][j] = stf_random_in(r, -0.5, 0.5);
    for (int j = 0; j < from; j++) m->A[j][i] = stf_random_in(r, -0.5, 0.5);
    m->A[i][i] = -stf_random_in(r, 1.5, 3);
  }
  for (int k = 0; k < from; k++) {
    sunrealtype x[MADE_MOST]; /* D^{-1} times column k of C */
    for (int i = from; i < n; i++) {
      x[i] = m->A[i][k];
      for (int j = from; j < i; j++) x[i] -= m->A[i][j] * x[j];
      x[i] /= m->A[i][i];
      for (int row = 0; row < from; row++) m->A[row][k] += m->A[row][i] * x[i];
    }
  }
}

static void relaxation(made *m, stf_random *r)
{
  const int free = m->kind == MADE_CONSTRAINED ? m->n - 1 : m->n;
  m->differential = m->kind == MADE_ALGEBRAIC ? m->n - 1 - m->n / 5 : free;
  made_matrix(m, r, m->differential, stf_random_in(r, 0, 6));
  if (m->kind == MADE_ALGEBRAIC) add_algebraic(m, r);
  for (int i = 0; i < free; i++) {
    m->c[i] = m->kind == MADE_LINEAR ? 0 : stf_random_in(r, -0.3, 0.3);
    m->H[i] = stf_random_in(r, -0.5, 0.5) + (i == 0);
    m->G[i] = m->H[i] + stf_random_in(r, -0.1, 0.1);
    m->index[i] = 1;
  }
  m->bend = 0.05;
  m->index[free] = 2;
  m->problem.f = relax;
  m->problem.jac = relax_jacobian;
  if (m->differential < m->n) m->problem.E = mass;
  m->problem.dae_index = m->kind == MADE_CONSTRAINED ? 2 : m->kind == MADE_ALGEBRAIC;
}

static void mechanism(made *m, stf_random *r)
{
  const int d = 2;
  m->n = 2 * d + 1;
  m->differential = 2 * d;
  made_matrix(m, r, d, stf_random_in(r, 0, 3));
  for (int i = 0; i < d; i++) {
    m->c[i] = stf_random_in(r, 0.5, 2);
    m->H[i] = stf_random_in(r, -0.5, 0.5) + (i == 0);
    m->index[i] = 1;
    m->index[d + i] = 2;
  }
  m->bend = 0.05;
  m->index[2 * d] = 3;
  m->problem.f = move;
  m->problem.jac = move_jacobian;
  m->problem.E = mass;
  m->problem.dae_index = 3;
}

const char *made_kind_name(enum made_kind kind)
{
  static const char *const name[] = {"linear",     "relaxation", "algebraic", "constrained",
                                     "mechanical", "flow",       "bent"};
  return name[kind];
}

void made_new(made *m, enum made_kind kind, long seed)
{
  memset(m, 0, sizeof *m);
  stf_random r = {(uint64_t)seed * MADE_KINDS + (uint64_t)kind};
  m->kind = kind;
  m->n = 2 + (int)stf_random_below(&r, MADE_MOST - 3) + (kind == MADE_CONSTRAINED);
  m->problem.t1 = pow(10, stf_random_in(&r, 0, 1.3));
  m->problem.start = m->problem.exact = exact;
  if (kind == MADE_MECHANICAL)
    mechanism(m, &r);
  else if (kind == MADE_FLOW || kind == MADE_BENT)
    made_flow(m, &r);
  else
    relaxation(m, &r);
  waves(m, &r);
  snprintf(m->name, sizeof m->name, "%s,seed=%ld", made_kind_name(kind), seed);
  m->problem.name = m->name;
  m->problem.n = m->n;
  m->problem.user = m;
  if (m->problem.dae_index > 1) m->problem.index = m->index;
}
