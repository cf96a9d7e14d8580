/* matrices_at.c: E and A at several points of a step at once.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int clone(stf_pool *pool, stf_system *s, SUNMatrix like, SUNMatrix *M)
{
  *M = SUNMatClone(like);
  STEIF_CHECK(*M, s->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)s->space.n);
  return stf_pool_adopt(pool, *M, destroy_matrix);
}

static int claim_entries(stf_pool *pool, stf_matrices_at *m)
{
  const size_t n = (size_t)m->system->space.n;
  m->entries = stf_pool_array(pool, 2 * (size_t)m->count, sizeof *m->entries);
  if (!m->entries) return STEIF_NO_MEMORY;
  for (int i = 0; i < 2 * m->count; i++) {
    stf_nonzeros *e = m->entries + i;
    e->column = stf_pool_array(pool, n + 1, sizeof *e->column);
    e->row = stf_pool_array(pool, n * n, sizeof *e->row);
    e->value = stf_pool_array(pool, n * n, sizeof *e->value);
    if (!e->column || !e->row || !e->value) return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

static int claim_points(stf_pool *pool, stf_matrices_at *m)
{
  const int count = m->system->linear ? 1 : m->count;
  m->point = stf_pool_array(pool, (size_t)count, sizeof *m->point);
  if (!m->point) return STEIF_NO_MEMORY;
  for (int j = 0; j < count; j++)
    STEIF_TRY(stf_operator_point_open(pool, m->system, m->point + j));
  return STEIF_OK;
}

int stf_matrices_at_open(stf_pool *pool, stf_system *s, int count, stf_matrices_at *m)
{
  *m = (stf_matrices_at){.system = s, .count = count};
  if (!s->A) return claim_points(pool, m);
  m->E = stf_pool_array(pool, (size_t)count, sizeof *m->E);
  m->A = stf_pool_array(pool, (size_t)count, sizeof *m->A);
  if (!m->E || !m->A) return STEIF_NO_MEMORY;
  for (int j = 0; j < count; j++) {
    m->E[j] = s->E, m->A[j] = s->A;
    if (s->linear) continue;
    STEIF_TRY(clone(pool, s, s->A, &m->A[j]));
    if (s->form == STEIF_IMPLICIT) STEIF_TRY(clone(pool, s, s->E, &m->E[j]));
  }
  const bool dense = SUNMatGetID(s->A) == SUNMATRIX_DENSE && s->space.serial;
  return dense ? claim_entries(pool, m) : STEIF_OK;
}

int stf_matrices_at_fill(stf_matrices_at *m, int j, sunrealtype t, N_Vector y, N_Vector yp)
{
  stf_system *s = m->system, here = *s;
  if (m->point && (j == 0 || !s->linear)) {
    const int code = stf_operator_point_set(s, m->point + j, t, y, yp);
    if (code) return code;
  }
  if (s->linear || m->point) return STEIF_OK;
  here.A = m->A[j], here.E = m->E[j], here.central = true;
  if (m->entries) m->entries[2 * j].known = false;
  if (m->entries && s->form == STEIF_IMPLICIT) m->entries[2 * j + 1].known = false;
  const int code = stf_system_matrices(&here, t, y, yp);
  s->nfe = here.nfe;
  m->made++;
  return code;
}

/* ---- products --------------------------------------------------------------------------------- */

/* Entries of a dense matrix that are not 0, by columns: those of discretisations are few. */
static void compress(SUNMatrix M, stf_nonzeros *e)
{
  const sunindextype n = SM_COLUMNS_D(M);
  sunindextype count = 0;
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype *entry = SM_COLUMN_D(M, i);
    e->column[i] = count;
    for (sunindextype k = 0; k < n; k++)
      if (entry[k] != 0) e->value[count] = entry[k], e->row[count++] = k;
  }
  e->column[n] = count, e->known = true;
}

static void by_columns(sunindextype n, const sunindextype *column, const sunindextype *row,
                       const sunrealtype *value, const sunrealtype *x, sunrealtype *out)
{
  for (sunindextype i = 0; i < n; i++) out[i] = 0;
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype factor = x[i];
    for (sunindextype k = column[i]; k < column[i + 1]; k++) out[row[k]] += value[k] * factor;
  }
}

static int by_point(const stf_matrices_at *m, int j, char which, bool transposed, N_Vector x,
                    N_Vector out)
{
  stf_system *s = m->system;
  stf_operator_point *at = m->point + (s->linear ? 0 : j);
  if (which == 'E' && s->form == STEIF_ODE) return stf_copy(&s->space, x, out), STEIF_OK;
  const int answer =
    (transposed ? stf_operator_transposed : stf_operator_product)(s, at, which, x, out);
  if (!answer) return STEIF_OK;
  return (answer > 0 && !transposed ? stf_recover : stf_fail)(
    s->ctx, STEIF_CALLBACK, "the product with %s%c of problem '%s' returned %d at t = %.12g",
    transposed ? "the transposed " : "", which, s->problem->name, answer, at->t);
}

int stf_matrices_at_transposed(const stf_matrices_at *m, int j, char which, sunrealtype c,
                               N_Vector x, N_Vector out, N_Vector scratch)
{
  STEIF_TRY(by_point(m, j, which, true, x, scratch));
  stf_axpy(&m->system->space, c, scratch, out);
  return STEIF_OK;
}

int stf_matrices_at_product(const stf_matrices_at *m, int j, char which, N_Vector x,
                            N_Vector out)
{
  if (m->point) return by_point(m, j, which, false, x, out);
  const SUNMatrix M = which == 'E' ? m->E[j] : m->A[j];
  const sunindextype n = m->system->space.n;
  stf_nonzeros *e = m->entries ? m->entries + 2 * j + (which == 'E') : NULL;
  if (!M) return stf_copy(&m->system->space, x, out), STEIF_OK;
  if (e) {
    if (!e->known) compress(M, e);
    by_columns(n, e->column, e->row, e->value, STF_ARRAY(x), STF_ARRAY(out));
  } else if (m->system->space.serial && SUNMatGetID(M) == SUNMATRIX_SPARSE)
    by_columns(n, SM_INDEXPTRS_S(M), SM_INDEXVALS_S(M), SM_DATA_S(M), STF_ARRAY(x),
               STF_ARRAY(out));
  else
    STEIF_CHECK(!SUNMatMatvec(M, x, out), m->system->ctx, STEIF_BAD_INPUT,
                "a product with a matrix of problem '%s' failed", m->system->problem->name);
  return STEIF_OK;
}

/* ---- a dense matrix of stages ------------------------------------------------------------------ */

void stf_matrices_at_add(const stf_matrices_at *m, int j, char which, sunrealtype factor,
                         sunrealtype *block, size_t width)
{
  const SUNMatrix M = which == 'E' ? m->E[j] : m->A[j];
  const size_t n = (size_t)m->system->space.n;
  stf_nonzeros *e = m->entries ? m->entries + 2 * j + (which == 'E') : NULL;
  for (size_t i = 0; !M && i < n; i++) block[i * width + i] += factor;
  if (!M) return;
  if (e && !e->known) compress(M, e);
  const sunindextype *column = e ? e->column : SM_INDEXPTRS_S(M);
  const sunindextype *row = e ? e->row : SM_INDEXVALS_S(M);
  const sunrealtype *value = e ? e->value : SM_DATA_S(M);
  for (size_t i = 0; i < n; i++)
    for (sunindextype k = column[i]; k < column[i + 1]; k++)
      block[(size_t)row[k] * width + i] += factor * value[k];
}

bool stf_matrices_at_adds(const stf_matrices_at *m)
{
  return m->system->space.serial && !m->point &&
         (m->entries || SUNMatGetID(m->system->A) == SUNMATRIX_SPARSE);
}
