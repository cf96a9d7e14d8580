/* matrices_at.c: E and A at several points of a step at once.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "problem.h"

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int clone(stf_pool *pool, stf_system *s, SUNMatrix like, SUNMatrix *M)
{
  *M = SUNMatClone(like);
  STEIF_CHECK(*M, s->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)s->space.n);
  return stf_pool_adopt(pool, *M, destroy_matrix);
}

int stf_matrices_at_open(stf_pool *pool, stf_system *s, int count, stf_matrices_at *m)
{
  *m = (stf_matrices_at){.system = s, .count = count};
  STEIF_CHECK(
    s->A && !s->krylov, s->ctx, STEIF_UNSUPPORTED,
    "derivatives of steps need matrices, Krylov storage of problem '%s' has none: take "
    "sparse storage",
    s->problem->name);
  m->E = stf_pool_array(pool, (size_t)count, sizeof *m->E);
  m->A = stf_pool_array(pool, (size_t)count, sizeof *m->A);
  if (!m->E || !m->A) return STEIF_NO_MEMORY;
  for (int j = 0; j < count; j++) {
    m->E[j] = s->E, m->A[j] = s->A;
    if (s->linear) continue;
    STEIF_TRY(clone(pool, s, s->A, &m->A[j]));
    if (s->form == STEIF_IMPLICIT) STEIF_TRY(clone(pool, s, s->E, &m->E[j]));
  }
  return STEIF_OK;
}

int stf_matrices_at_fill(stf_matrices_at *m, int j, sunrealtype t, N_Vector y, N_Vector yp)
{
  stf_system *s = m->system, here = *s;
  if (s->linear) return STEIF_OK;
  here.A = m->A[j], here.E = m->E[j], here.central = true;
  const int code = stf_system_matrices(&here, t, y, yp);
  s->nfe = here.nfe;
  m->made++;
  return code;
}

int stf_matrices_at_product(const stf_matrices_at *m, int j, char which, N_Vector x,
                            N_Vector out)
{
  const SUNMatrix M = which == 'E' ? m->E[j] : m->A[j];
  if (!M) return stf_copy(&m->system->space, x, out), STEIF_OK;
  STEIF_CHECK(!SUNMatMatvec(M, x, out), m->system->ctx, STEIF_BAD_INPUT,
              "a product with a matrix of problem '%s' failed", m->system->problem->name);
  return STEIF_OK;
}
