/* recomputed_columns.c: S as it is shown. Unknowns of index 2 and 3 are computed from those of index 1 for output
 * (recomputed.c), by a map C(t, y, p) to all constraints; their derivatives are those of C along (S, e_k), by
 * differences, and have the order of S in components of index 1.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include "array_start.h"
#include <math.h>
#include <string.h>

int stf_recomputed(steif_solver *s, sunrealtype t, N_Vector y, N_Vector out)
{
  steif_start start;
  const steif_point at = {.y = stf_array(y), .t = t};
  const int code = stf_start_beside(s->ctx, s->problem, &at, &s->nodes, &start, NULL);
  if (!code) memcpy(stf_array(out), start.y, (size_t)s->problem->n * sizeof *start.y);
  steif_start_clear(&start);
  return code == STEIF_NO_MEMORY || !code ? code : STEIF_RETRY;
}

/* found = dC; v: five more vectors. */
static int along(steif_solver *s, sunrealtype t, int k, N_Vector S, N_Vector found, N_Vector *v)
{
  stf_saltation here = {.y = v[0], .point = v[1], .t = stf_side(s, t)}, *const own =
                                                                          s->saltation;
  const stf_line line = {.dy = S, .k = k};
  if (t == s->t_shown)
    N_VScale(1, s->shown, v[0]);
  else
    STEIF_TRY(steif_dense(s, t, v[0]));
  const bool before = stf_silence(s->ctx, true);
  s->saltation = &here;
  const int code = stf_along(s, stf_recomputed, &line, found, v + 2);
  s->saltation = own;
  stf_silence(s->ctx, before);
  return code;
}

/* Where C has no derivative S stays as the method has it. */
int steif_sensitivity_output(steif_solver *s, sunrealtype t, int k, N_Vector dy)
{
  STEIF_TRY(steif_sensitivity(s, t, k, dy));
  if (!stf_recomputes_at(s, t)) return STEIF_OK;
  stf_pool *pool = stf_pool_new(s->ctx);
  N_Vector *v = pool ? stf_pool_vectors(pool, 6, dy) : NULL;
  int code = v ? along(s, t, k, dy, v[5], v) : STEIF_NO_MEMORY;
  const sunrealtype *found = code ? NULL : stf_array(v[5]);
  for (sunindextype i = 0; found && i < s->problem->n; i++)
    if (s->problem->index[i] > 1) stf_array(dy)[i] = found[i];
  if (code == STEIF_RETRY) steif_forget(s->ctx);
  stf_pool_free(&pool);
  return code == STEIF_RETRY ? STEIF_OK : code;
}
