/* augmented.c: vectors of size n + p, their products with the augmented matrix, orthogonalisation.
 *
 * Serial vectors are taken in blocks that stay in the first cache, so that the basis is read
 * once per pass. Classical Gram-Schmidt, repeated where it cancelled ("twice is enough": L.
 * Giraud and others, Numer. Math. 101, 2005).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"

enum { BLOCK = 1024, CHUNK = 10 };

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

/* sum x_i y_i of `size` entries, in four partial sums. */
static double dot(sunindextype size, const sunrealtype *x, const sunrealtype *y)
{
  double sum[4] = {0};
  sunindextype i = 0;
  for (; i + 4 <= size; i += 4)
    for (int k = 0; k < 4; k++) sum[k] += x[i + k] * y[i + k];
  for (; i < size; i++) sum[0] += x[i] * y[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

static double square(const stf_space *space, N_Vector x)
{
  if (!space->serial) return N_VDotProd(x, x);
  return dot(space->n, STF_ARRAY(x), STF_ARRAY(x));
}

double stf_vector_norm(const stf_space *space, N_Vector x) { return sqrt(square(space, x)); }

double stf_state_norm(const steif_action *a, const stf_state *x)
{
  return sqrt(square(&a->space, x->v) + dot(a->aux, x->z, x->z));
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

/* out += sum_j c_j basis_j from entry `from` on */
static void add_block(const steif_action *a, int count, const double *c, sunindextype from,
                      sunindextype size, sunrealtype *restrict out)
{
  for (int j = 0; j < count; j++) {
    const sunrealtype *restrict x = STF_ARRAY(a->basis[j].v) + from;
    const double f = c[j];
    for (sunindextype i = 0; i < size; i++) out[i] += f * x[i];
  }
}

/* y += sum_j c_j basis_j */
static void add(const steif_action *a, int count, const double *c, stf_state *y)
{
  const sunindextype n = a->space.n;
  for (int j = 0; j < count; j++)
    for (int i = 0; i < a->aux; i++) y->z[i] += c[j] * a->basis[j].z[i];
  if (!a->space.serial) {
    for (int j = 0; j < count; j++) N_VLinearSum(c[j], a->basis[j].v, 1, y->v, y->v);
    return;
  }
  for (sunindextype from = 0; from < n; from += BLOCK)
    add_block(a, count, c, from, n - from < BLOCK ? n - from : BLOCK, STF_ARRAY(y->v) + from);
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
  const sunindextype n = a->space.n;
  for (int j = 0; j < m; j++) h[j] = dot(a->aux, a->basis[j].z, w->z);
  if (!a->space.serial) {
    for (int j = 0; j < m; j++) h[j] += N_VDotProd(a->basis[j].v, w->v);
    return;
  }
  for (sunindextype from = 0; from < n; from += BLOCK) {
    const sunindextype size = n - from < BLOCK ? n - from : BLOCK;
    const sunrealtype *y = STF_ARRAY(w->v) + from;
    for (int j = 0; j < m; j++) h[j] += dot(size, STF_ARRAY(a->basis[j].v) + from, y);
  }
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
