/* nearest.c: the nearest point on r(z) = 0: Gauss-Newton on
 *
 *   minimise ||W (z - target)||  subject to  J dz = -r,
 *
 * each step by the singular value decomposition of the row-scaled J W^{-1} (sparse: by
 * nearest_sparse.c), damped while r does not fall. P. Deuflhard, Newton Methods for Nonlinear Problems, Springer (2004),
 * 4.4.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "nearest.h"
#include "singular_values.h"
#include <math.h>
#include <string.h>

static const sunrealtype dependent = 1e-10; /* singular values below are zero */
/* Steps that no longer shrink below this are rounding of r and J. */
static const sunrealtype rounding = 1e-6, noise = 1e-3;
/* Whole steps of this length leave r at rounding. */
static const sunrealtype second_order = 1e-9;
/* Large systems stop early where neither steps nor residuals fall. */
enum { HALVINGS = 12, IDLE = 8 };
/* Fewer iterations are a look whether there is a solution near: what has not converged in them is none. */
enum { PATIENT = 60 };

static int claim(stf_pool *pool, stf_nearest_point *m)
{
  const size_t rows = m->rows, columns = m->columns;
  m->z = stf_pool_array(pool, 4 * columns, sizeof *m->z);
  m->r = stf_pool_array(pool, 4 * rows + 4 * columns + 1, sizeof *m->r);
  if (!m->z || !m->r) return STEIF_NO_MEMORY;
  m->target = m->z + columns, m->weight = m->z + 2 * columns, m->unit = m->z + 3 * columns;
  m->left = m->r + rows, m->s = m->r + 2 * rows, m->work = m->s + columns + 1;
  return m->solver->open(pool, m);
}

static int open_dense(stf_pool *pool, stf_nearest_point *m)
{
  const size_t rows = m->rows, columns = m->columns;
  m->J = stf_pool_array(pool, 2 * rows * columns + 1, sizeof *m->J);
  m->U = stf_pool_array(pool, rows * rows + 1, sizeof *m->U);
  m->VT = stf_pool_array(pool, columns * columns + 1, sizeof *m->VT);
  return m->J && m->U && m->VT ? STEIF_OK : STEIF_NO_MEMORY;
}

/* Rows of J W^{-1} scaled to largest entry 1; its decomposition and rank. */
static int decompose(stf_nearest_point *m)
{
  const size_t rows = m->rows, columns = m->columns, least = rows < columns ? rows : columns;
  sunrealtype *A = m->J + rows * columns;
  for (size_t i = 0; i < rows; i++) {
    sunrealtype top = 0;
    for (size_t j = 0; j < columns; j++)
      top = fmax(top, fabs(m->J[j * rows + i]) / m->weight[j]);
    m->left[i] = top > 0 ? 1 / top : 1;
  }
  for (size_t j = 0; j < columns; j++)
    for (size_t i = 0; i < rows; i++)
      A[j * rows + i] = m->left[i] * m->J[j * rows + i] / m->weight[j];
  STEIF_TRY(stf_point_svd(m->ctx, rows, columns, A, m->s, m->U, m->VT));
  m->rank = 0;
  while (m->rank < least && m->s[m->rank] > dependent * m->s[0]) m->rank++;
  m->rcond = least && m->s[0] > 0 ? m->s[least - 1] / m->s[0] : least ? 0 : 1;
  return STEIF_OK;
}

static sunrealtype pull(const stf_nearest_point *m, size_t j)
{
  return m->unpulled || isnan(m->target[j]) ? 0 : m->target[j] - m->z[j];
}

/* dz = W^{-1} (V S^{-1} U^T (-r) + V0 V0^T W (target - z)), V0 the null space of J W^{-1}. */
static int direction(stf_nearest_point *m, sunrealtype *dz)
{
  const size_t rows = m->rows, columns = m->columns;
  for (size_t j = 0; j < columns; j++) dz[j] = 0;
  for (size_t k = 0; k < columns; k++) {
    sunrealtype along = 0;
    for (size_t i = 0; i < rows && k < m->rank; i++)
      along -= m->U[k * rows + i] * m->left[i] * m->r[i] / m->s[k];
    for (size_t j = 0; j < columns && k >= m->rank; j++)
      along += m->VT[j * columns + k] * m->weight[j] * pull(m, j);
    for (size_t j = 0; j < columns; j++) dz[j] += along * m->VT[j * columns + k] / m->weight[j];
  }
  return STEIF_OK;
}

/* The part of r that J can reach. */
static sunrealtype merit(const stf_nearest_point *m, const sunrealtype *r)
{
  sunrealtype sum = 0;
  for (size_t k = 0; k < m->rank; k++) {
    sunrealtype along = 0;
    for (size_t i = 0; i < m->rows; i++) along += m->U[k * m->rows + i] * m->left[i] * r[i];
    sum += along * along;
  }
  return sqrt(sum);
}

const stf_nearest_solver stf_nearest_dense = {open_dense, decompose, direction, merit};

static sunrealtype length(const stf_nearest_point *m, const sunrealtype *dz, bool weighted)
{
  sunrealtype largest = 0, sum = 0;
  for (size_t j = 0; j < m->columns; j++) {
    largest = fmax(largest, fabs(dz[j]) / fmax(fabs(m->z[j]), m->unit[j]));
    sum += m->weight[j] * dz[j] * m->weight[j] * dz[j];
  }
  return weighted ? sqrt(sum) : largest;
}

/* Move along dz as far as r falls, or is of second order in the step; r at the new point. */
static int damp(stf_nearest_point *m, const sunrealtype *dz, sunrealtype *factor)
{
  const size_t rows = m->rows, columns = m->columns;
  sunrealtype *trial = m->work, *r = m->work + columns;
  const sunrealtype before = m->solver->merit(m, m->r), step = length(m, dz, true);
  int code = STEIF_OK;
  *factor = 1;
  for (int k = 0; k < HALVINGS; k++, *factor /= 2) {
    for (size_t j = 0; j < columns; j++) trial[j] = m->z[j] + *factor * dz[j];
    code = m->residual(m->data, trial, r);
    if (code < 0) return code;
    const sunrealtype after = code ? INFINITY : m->solver->merit(m, r);
    if (after <= fmax((1 - *factor / 4) * before, 0.2 * *factor * step)) break;
  }
  if (code) return code;
  memcpy(m->z, trial, columns * sizeof *trial);
  memcpy(m->r, r, rows * sizeof *r);
  return STEIF_OK;
}

/* One of Newton's steps to r = 0, the shortest; *ratio: of r after it and before, 1 where none was made. */
static int newton(stf_nearest_point *m, sunrealtype *ratio)
{
  const size_t rows = m->rows, columns = m->columns;
  sunrealtype *trial = m->work, *r = m->work + columns, *dz = r + rows;
  *ratio = 1;
  STEIF_TRY(m->jacobian(m->data, m));
  STEIF_TRY(m->residual(m->data, m->z, m->r));
  STEIF_TRY(m->solver->factor(m));
  STEIF_TRY(m->solver->direction(m, dz));
  if (!(length(m, dz, false) <= noise)) return STEIF_OK;
  for (size_t j = 0; j < columns; j++) trial[j] = m->z[j] + dz[j];
  const int code = m->residual(m->data, trial, r);
  if (code) return code < 0 ? code : STEIF_OK;
  const sunrealtype before = m->solver->merit(m, m->r), after = m->solver->merit(m, r);
  if (!(after < 0.5 * before)) return STEIF_OK;
  *ratio = after / before;
  memcpy(m->z, trial, columns * sizeof *trial);
  memcpy(m->r, r, rows * sizeof *r);
  return STEIF_OK;
}

/* Steps that converge linearly to the nearest point leave r of second order in their length: Newton's follow, as long
 * as r falls. Where it never falls much, J is singular at the end of them, and they are not taken. */
static int fulfil(stf_nearest_point *m)
{
  enum { STEPS = 8 };
  const size_t rows = m->rows, columns = m->columns;
  sunrealtype *z = m->work + 2 * columns + rows, *r = z + columns, ratio = 0;
  bool regular = false;
  memcpy(z, m->z, columns * sizeof *z);
  memcpy(r, m->r, rows * sizeof *r);
  for (int k = 0; k < STEPS && ratio < 1; k++) {
    STEIF_TRY(newton(m, &ratio));
    regular = regular || ratio < 0.1;
  }
  if (regular) return STEIF_OK;
  memcpy(m->z, z, columns * sizeof *z);
  memcpy(m->r, r, rows * sizeof *r);
  return STEIF_OK;
}

static int solve(stf_nearest_point *m)
{
  const size_t columns = m->columns;
  sunrealtype *dz = m->work + columns + m->rows, before = INFINITY, factor = 1,
              least = INFINITY;
  int stagnant = 0, idle = 0; /* iterations whose steps, whose residuals do not fall */
  m->converged = false, m->iterations = 0;
  while (m->iterations < m->most && !m->converged &&
         (!m->sparse || stagnant < IDLE || idle < IDLE)) {
    STEIF_TRY(m->jacobian(m->data, m));
    STEIF_TRY(m->residual(m->data, m->z, m->r)); /* the jacobian chooses nodes */
    STEIF_TRY(m->solver->factor(m));
    STEIF_TRY(m->solver->direction(m, dz));
    STEIF_TRY(damp(m, dz, &factor));
    m->iterations++;
    const sunrealtype left = m->solver->merit(m, m->r);
    idle = left > 0.5 * least ? idle + 1 : 0;
    least = fmin(least, left);
    const sunrealtype now = length(m, dz, false);
    stagnant = factor < 0.1 || now >= 0.5 * before ? stagnant + 1 : 0;
    m->converged =
      now <= 1e-14 || (now <= rounding && stagnant >= 2) || (now <= noise && stagnant >= 4);
    before = now;
  }
  if (before <= second_order && factor >= 1) return STEIF_OK;
  if (!m->converged && m->most < PATIENT) return STEIF_OK;
  m->unpulled = true;
  const int code = fulfil(m);
  m->unpulled = false;
  return code;
}

int stf_nearest_point_find(stf_point *point, stf_nearest_point *m)
{
  stf_pool *pool = stf_pool_new(point->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  m->ctx = point->ctx;
  if (!m->solver) m->solver = &stf_nearest_dense;
  int code = claim(pool, m);
  if (!code) m->prepare(m->data, m);
  if (!code) code = solve(m);
  if (!code) code = m->accept(m->data, m);
  stf_pool_free(&pool);
  if (code > 0)
    code =
      STEIF_FAIL(point->ctx, STEIF_CALLBACK,
                 "'%s' could not be evaluated near its start at t = %g: give a guess inside "
                 "the domain of its functions",
                 point->problem.name, point->t);
  return code;
}
