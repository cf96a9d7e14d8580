/* results.c: what the analyses of a descriptor system return: allocation, release, and the residuals
 * of an impulse, E c_{k-2} = 0, F c_i + E c_{i-1} = 0, F c_0 + E (x(0+) - x(0-)) = 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear_system.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

int stf_structure_list(steif_context *ctx, sunindextype count, sunindextype **list)
{
  stf_release(ctx, *list);
  *list = count > 0 ? stf_allocate(ctx, (size_t)count, sizeof **list) : NULL;
  return *list || count <= 0 ? STEIF_OK : STEIF_NO_MEMORY;
}

void steif_structure_clear(steif_context *ctx, steif_structure *structure)
{
  if (!structure) return;
  stf_release(ctx, structure->weyr);
  stf_release(ctx, structure->equations);
  stf_release(ctx, structure->unknowns);
  if (structure->kept) structure->kept->free(ctx, structure->kept);
  *structure = (steif_structure){0};
}

/* After x(0+) come the two vectors that the residuals are summed in. */
enum { SCRATCH = 2 };

int stf_impulse_allocate(steif_context *ctx, sunindextype n, int index, steif_impulse *impulse)
{
  const size_t size = sizeof *impulse->x_plus;
  impulse->n = n;
  impulse->index = index;
  impulse->count = index > 1 ? index - 1 : 0;
  impulse->x_plus = stf_allocate(ctx, (size_t)n * (1 + SCRATCH), size);
  if (!impulse->x_plus) return STEIF_NO_MEMORY;
  if (!impulse->count) return STEIF_OK;
  impulse->c = stf_allocate(ctx, (size_t)impulse->count * (size_t)n, size);
  return impulse->c ? STEIF_OK : STEIF_NO_MEMORY;
}

void steif_impulse_clear(steif_context *ctx, steif_impulse *impulse)
{
  if (!impulse) return;
  stf_release(ctx, impulse->x_plus);
  stf_release(ctx, impulse->c);
  *impulse = (steif_impulse){0};
}

/* r += value a, size += |value| b with b = |a| or larger. */
static void entry(sunrealtype value, sunrealtype a, sunrealtype b, sunrealtype *r,
                  sunrealtype *size)
{
  *r += value * a;
  *size += fabs(value) * b;
}

/* r += M (x - y), size += |M| (|x| + |y|); y NULL: 0. */
static void add(SUNMatrix M, const sunrealtype *x, const sunrealtype *y, sunrealtype *r,
                sunrealtype *size)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(M) : SM_NP_S(M);
  for (sunindextype j = 0; j < n; j++) {
    const sunrealtype a = x[j] - (y ? y[j] : 0), b = fabs(x[j]) + (y ? fabs(y[j]) : 0);
    if (dense)
      for (sunindextype i = 0; i < n; i++) entry(SM_ELEMENT_D(M, i, j), a, b, r + i, size + i);
    else
      for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++)
        entry(SM_DATA_S(M)[p], a, b, r + SM_INDEXVALS_S(M)[p], size + SM_INDEXVALS_S(M)[p]);
  }
}

/* ||M x + E (y - z)|| relative to the sizes of its terms; M x or E (y - z) may be missing. */
static sunrealtype relative(SUNMatrix M, const sunrealtype *x, SUNMatrix E,
                            const sunrealtype *y, const sunrealtype *z, steif_impulse *impulse)
{
  sunrealtype *r = impulse->x_plus + impulse->n, *size = r + impulse->n, norm = 0, most = 0;
  for (sunindextype i = 0; i < SCRATCH * impulse->n; i++) r[i] = 0;
  if (x) add(M, x, NULL, r, size);
  if (y) add(E, y, z, r, size);
  for (sunindextype i = 0; i < impulse->n; i++) {
    norm += r[i] * r[i];
    most += size[i] * size[i];
  }
  return most > 0 ? sqrt(norm / most) : 0;
}

static sunrealtype largest(SUNMatrix M)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_NP_S(M)];
  const sunrealtype *x = dense ? SM_DATA_D(M) : SM_DATA_S(M);
  sunrealtype most = 0;
  for (sunindextype i = 0; i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* ||E c|| / max(max |E| ||c||, max |E|^2 / max |F| ||b||) with b of F c + E b = 0: every term of
 * E c may vanish, and c too, so they are no measure here. b = y - z; z NULL: 0. */
static sunrealtype left_over(SUNMatrix E, SUNMatrix F, const sunrealtype *c,
                             const sunrealtype *y, const sunrealtype *z, steif_impulse *impulse)
{
  sunrealtype *r = impulse->x_plus + impulse->n, norm = 0, size = 0, before = 0;
  const sunrealtype e = largest(E), f = largest(F);
  for (sunindextype i = 0; i < SCRATCH * impulse->n; i++) r[i] = 0;
  add(E, c, NULL, r, r + impulse->n);
  for (sunindextype i = 0; i < impulse->n; i++) {
    const sunrealtype b = y[i] - (z ? z[i] : 0);
    norm += r[i] * r[i];
    size += c[i] * c[i];
    before += b * b;
  }
  size = e * fmax(sqrt(size), f > 0 ? e / f * sqrt(before) : 0);
  return size > 0 ? sqrt(norm) / size : 0;
}

void stf_impulse_residuals(SUNMatrix E, SUNMatrix F, const sunrealtype *x0,
                           steif_impulse *impulse)
{
  const int count = impulse->count;
  const sunindextype n = impulse->n;
  const sunrealtype *c = impulse->c;
  const sunrealtype *last = count ? c + (count - 1) * n : NULL;
  impulse->last = count > 1   ? left_over(E, F, last, last - n, NULL, impulse)
                  : count > 0 ? left_over(E, F, last, impulse->x_plus, x0, impulse)
                              : 0;
  impulse->chain = 0;
  for (int i = 1; i < count; i++)
    impulse->chain =
      fmax(impulse->chain, relative(F, c + i * n, E, c + (i - 1) * n, NULL, impulse));
  impulse->first = relative(F, count ? c : NULL, E, impulse->x_plus, x0, impulse);
}
