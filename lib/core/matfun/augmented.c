/* augmented.c: vectors of size n + p, their products with the augmented matrix, orthogonalisation.
 *
 * Classical Gram-Schmidt, repeated where it cancelled ("twice is enough": L.
 * Giraud and others, Numer. Math. 101, 2005).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"

enum { CHUNK = 10 };

int stf_state_grow(steif_action *a, int count)
{
  if (count <= a->states) return STEIF_OK;
  int upto = (count + CHUNK - 1) / CHUNK * CHUNK;
  if (upto > a->dimension + 2) upto = a->dimension + 2;
  while (a->states < upto) {
    if (!(a->basis[a->states].v = stf_pool_vector(a->pool, a->space.like)))
      return STEIF_NO_MEMORY;
    a->states++;
  }
  return STEIF_OK;
}

int stf_state_product(steif_action *a, const stf_state *x, stf_state *out)
{
  STEIF_TRY(steif_pencil_product(a->pencil, 'A', x->v, out->v));
  a->report.products++;
  stf_sum(&a->space, a->t, out->v, -a->mu, x->v, out->v);
  for (int j = 0; j < a->aux; j++)
    if (a->b[a->p - j]) stf_axpy(&a->space, a->eta * x->z[j], a->b[a->p - j], out->v);
  for (int j = 0; j < a->aux; j++)
    out->z[j] = (j + 1 < a->aux ? x->z[j + 1] : 0) - a->mu * x->z[j];
  return STEIF_OK;
}

void stf_state_start(steif_action *a, stf_state *x)
{
  if (a->b[0])
    stf_copy(&a->space, a->b[0], x->v);
  else
    stf_zero(&a->space, x->v);
  for (int j = 0; j < a->aux; j++) x->z[j] = j + 1 == a->aux ? 1 / a->eta : 0;
}

double stf_vector_norm(const stf_space *space, N_Vector x)
{
  double square;
  stf_dots(space, 1, x, &x, &square);
  return sqrt(square);
}

/* Of the p further entries. */
static double dot(int size, const double *x, const double *y)
{
  double sum = 0;
  for (int i = 0; i < size; i++) sum += x[i] * y[i];
  return sum;
}

double stf_state_norm(const steif_action *a, const stf_state *x)
{
  return hypot(stf_vector_norm(&a->space, x->v), sqrt(dot(a->aux, x->z, x->z)));
}

void stf_state_scale(const steif_action *a, double c, stf_state *x)
{
  stf_scale(&a->space, c, x->v, x->v);
  for (int j = 0; j < a->aux; j++) x->z[j] *= c;
}

void stf_state_add(const steif_action *a, double c, const stf_state *x, stf_state *y)
{
  stf_axpy(&a->space, c, x->v, y->v);
  for (int j = 0; j < a->aux; j++) y->z[j] += c * x->z[j];
}

/* The vectors of the first m of the basis. */
static void vectors(const steif_action *a, int m, N_Vector *v)
{
  for (int j = 0; j < m; j++) v[j] = a->basis[j].v;
}

/* y += sum_j c_j basis_j */
static void add(const steif_action *a, int count, const double *c, stf_state *y)
{
  N_Vector v[STF_DIMENSION + 2];
  vectors(a, count, v);
  for (int j = 0; j < count; j++)
    for (int i = 0; i < a->aux; i++) y->z[i] += c[j] * a->basis[j].z[i];
  stf_mix_add(&a->space, 1, count, c, v, &y->v);
}

void stf_state_combine(const steif_action *a, int count, const double *c, stf_state *y)
{
  stf_zero(&a->space, y->v);
  for (int i = 0; i < a->aux; i++) y->z[i] = 0;
  add(a, count, c, y);
}

/* h_j = <basis_j, w> for j < m */
static void project(const steif_action *a, int m, const stf_state *w, double *h)
{
  N_Vector v[STF_DIMENSION + 2];
  vectors(a, m, v);
  stf_dots(&a->space, m, w->v, v, h);
  for (int j = 0; j < m; j++) h[j] += dot(a->aux, a->basis[j].z, w->z);
}

void stf_state_orthogonalise(const steif_action *a, int m, double *h)
{
  stf_state *w = a->basis + m;
  const double before = stf_state_norm(a, w);
  double now = before, last, g[STF_DIMENSION + 1];
  for (int j = 0; j <= m; j++) h[j] = 0;
  for (int pass = 0; pass < 3; pass++) {
    last = now;
    project(a, m, w, g);
    for (int j = 0; j < m; j++) h[j] += g[j], g[j] = -g[j];
    add(a, m, g, w);
    now = stf_state_norm(a, w);
    if (!(now < 0.7 * last)) break;
  }
  if (!(now > 8 * STF_EPS * before)) return;
  h[m] = now;
  stf_state_scale(a, 1 / now, w);
}
