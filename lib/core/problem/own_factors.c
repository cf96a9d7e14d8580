/* own_factors.c: the matrices of a system for those who do not see them: families with factors of their own,
 * the cost of factors, and sums over all entries.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fill_order.h"
#include "problem.h"
#include <math.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

int stf_system_mass(stf_pool *pool, const stf_system *s, sunrealtype **M)
{
  const sunindextype n = s->space.n;
  *M = NULL;
  if (!s->E) return STEIF_OK;
  *M = stf_pool_array(pool, (size_t)(n * n), sizeof **M);
  if (!*M) return STEIF_NO_MEMORY;
  const sunrealtype *E = SM_DATA_D(s->E);
  for (sunindextype i = 0; i < n; i++)
    for (sunindextype j = 0; j < n; j++) (*M)[i * n + j] = E[i + n * j];
  return STEIF_OK;
}

/* STEIF_RETRY with the sentence for factors of s E - A without a pivot in `column`, from 1: entries that
 * are not finite, or a singular matrix. */
static int reject(const stf_system *s, int column, sunrealtype t, sunrealtype h)
{
  const sunrealtype *A = SM_DATA_D(s->A);
  const size_t n = (size_t)s->space.n;
  const bool given = s->problem->jac || s->problem->idajac || s->problem->A;
  char row[STEIF_SPEC_WORD], col[STEIF_SPEC_WORD];
  for (size_t k = 0; k < n * n; k++)
    if (!isfinite(A[k]))
      return STEIF_RECOVER(
        s->ctx, STEIF_NOT_FINITE,
        "the derivative of %s with respect to %s in the Jacobian of problem '%s' is %g in the "
        "step from t = %.12g: %s",
        stf_equation(s->problem, (sunindextype)(k % n), row),
        stf_unknown(s->problem, (sunindextype)(k / n), col), s->problem->name,
        isnan(A[k]) ? fabs(A[k]) : A[k], t,
        given ? "look at the function that fills it"
              : "its differences leave the domain of the equations");
  return STEIF_RECOVER(
    s->ctx, STEIF_SINGULAR,
    "the stage matrix of problem '%s' is singular in the column of %s at "
    "t = %.12g with h = %.6g: check that det(s E - A) is not identically zero",
    s->problem->name, stf_unknown(s->problem, column - 1, col), t, h);
}

int stf_system_interleave(const stf_system *s, stf_interleaved *L, sunrealtype t, sunrealtype h)
{
  const int column = stf_interleaved_factor(L, SM_DATA_D(s->A), h);
  return column ? reject(s, column, t, h) : STEIF_OK;
}

void stf_system_rosenbrock_open(const stf_system *s, stf_rosenbrock *R)
{
  stf_rosenbrock_open(R, (int)s->space.n, s->E ? SM_DATA_D(s->E) : NULL);
}

int stf_system_rosenbrock(const stf_system *s, stf_rosenbrock *R, sunrealtype gamma,
                          sunrealtype t, sunrealtype h)
{
  const int column = stf_rosenbrock_factor(R, SM_DATA_D(s->A), 1 / (gamma * h));
  return column ? reject(s, column, t, h) : STEIF_OK;
}

double stf_system_fill(const stf_system *s, double *entries, double *fill)
{
  const sunindextype n = s->space.n, *column = SM_INDEXPTRS_S(s->A);
  *entries = (double)column[n];
  return stf_fill_work(n, column, SM_INDEXVALS_S(s->A), fill);
}

/* Rows from .. to - 1 of column j. */
static void band_rows(SUNMatrix A, sunindextype j, sunindextype *from, sunindextype *to)
{
  const sunindextype n = SM_COLUMNS_B(A), end = j + SM_LBAND_B(A) + 1;
  *from = j > SM_UBAND_B(A) ? j - SM_UBAND_B(A) : 0;
  *to = end < n ? end : n;
}

void stf_system_add_entries(const stf_system *s, sunrealtype (*weight)(void *data), void *data,
                            const sunrealtype *x, sunrealtype *out)
{
  const SUNMatrix A = s->A;
  const SUNMatrix_ID kind = SUNMatGetID(A);
  for (sunindextype j = 0; j < s->space.n; j++) {
    sunindextype from = 0, to = s->space.n;
    if (kind == SUNMATRIX_SPARSE) {
      for (sunindextype k = SM_INDEXPTRS_S(A)[j]; k < SM_INDEXPTRS_S(A)[j + 1]; k++)
        out[SM_INDEXVALS_S(A)[k]] += weight(data) * SM_DATA_S(A)[k] * x[j];
      continue;
    }
    if (kind == SUNMATRIX_BAND) band_rows(A, j, &from, &to);
    for (sunindextype i = from; i < to; i++) {
      const sunrealtype a =
        kind == SUNMATRIX_BAND ? SM_ELEMENT_B(A, i, j) : SM_ELEMENT_D(A, i, j);
      out[i] += weight(data) * a * x[j];
    }
  }
}
