/* component_index.c: the index of each unknown of a descriptor system.
 *
 * Steps of an integrator are judged by h^(index-1) of an unknown, which for unknown j is one more
 * than the last power of s with which it answers to forcing: the last i with (Phi_i v)_j != 0 for
 * a generic v. From x(0-) = 0 with f = v constant, x(0+) = Phi_0 v and c_i = Phi_{i+1} v.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "component_index.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { INDEX_MOST = 3 }; /* of problem->index */

static int constant(sunrealtype t, int derivative, N_Vector g, void *v)
{
  sunrealtype *out = N_VGetArrayPointer(g);
  const sunindextype n = N_VGetLength(g);
  (void)t;
  for (sunindextype i = 0; i < n; i++) out[i] = derivative ? 0 : ((const sunrealtype *)v)[i];
  return 0;
}

static sunrealtype largest(SUNMatrix M)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_NP_S(M)];
  const sunrealtype *a = dense ? SM_DATA_D(M) : SM_DATA_S(M);
  sunrealtype most = 0;
  for (sunindextype i = 0; i < count; i++) most = fmax(most, fabs(a[i]));
  return most;
}

/* Powers of s are compared at |s| = R, where the finite eigenvalues end. */
static sunrealtype scale(const steif_linear *l, const steif_structure *structure)
{
  const sunrealtype e = largest(l->E), f = largest(l->F);
  return structure->radius > 0 ? structure->radius : e > 0 && f > 0 ? f / e : 1;
}

static void read_off(sunrealtype R, const steif_impulse *answer, int *index)
{
  const sunrealtype noise = 1e-8;
  for (sunindextype j = 0; j < answer->n; j++) {
    sunrealtype most = fabs(answer->x_plus[j]), power = 1;
    for (int i = 0; i < answer->count; i++)
      power *= R, most = fmax(most, power * fabs(answer->c[i * answer->n + j]));
    index[j] = 1, power = 1;
    for (int i = 0; i < answer->count; i++) {
      power *= R;
      if (power * fabs(answer->c[i * answer->n + j]) > noise * most) index[j] = i + 2;
    }
    if (index[j] > INDEX_MOST) index[j] = INDEX_MOST;
  }
}

int stf_component_index(steif_context *ctx, const steif_linear *l,
                        const steif_analysis *analysis, const steif_structure *structure,
                        int **index)
{
  const sunindextype n = structure->n;
  *index = NULL;
  if (!structure->regular || structure->index == 0 || structure->index == 1) return STEIF_OK;
  steif_impulse answer = {0};
  sunrealtype *work = stf_allocate(ctx, 2 * (size_t)n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  sunrealtype *v = work + n;
  for (sunindextype i = 0; i < n; i++)
    work[i] = 0, v[i] = 1 + 0.5 * sin(1 + 2.399963 * (sunrealtype)i); /* the golden angle */
  int code =
    steif_impulse_find(ctx, l->E, l->F, work, 0, constant, v, analysis, structure, &answer);
  if (!code && !(*index = stf_allocate(ctx, (size_t)n, sizeof **index))) code = STEIF_NO_MEMORY;
  if (!code) read_off(scale(l, structure), &answer, *index);
  steif_impulse_clear(ctx, &answer);
  stf_release(ctx, work);
  return code;
}
