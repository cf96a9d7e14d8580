/* facts.c: norms and symmetries of a sparse matrix that the choice of a method rests on.
 *
 * Symmetry is tested by A x = +- A^T x for one vector without structure; norms of powers are
 * estimated (N. J. Higham, ACM TOMS 14, 1988).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include "blas.h"
#include <sunmatrix/sunmatrix_sparse.h>

/* y = A x - mu x, or A^T x - mu x */
static void times(SUNMatrix A, double mu, const double *restrict x, double *restrict y)
{
  const sunindextype n = SM_COLUMNS_S(A), *ptr = SM_INDEXPTRS_S(A), *row = SM_INDEXVALS_S(A);
  const double *value = SM_DATA_S(A);
  for (sunindextype i = 0; i < n; i++) y[i] = -mu * x[i];
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) y[row[k]] += value[k] * x[j];
}

static void times_transposed(SUNMatrix A, double mu, const double *restrict x,
                             double *restrict y)
{
  const sunindextype n = SM_COLUMNS_S(A), *ptr = SM_INDEXPTRS_S(A), *row = SM_INDEXVALS_S(A);
  const double *value = SM_DATA_S(A);
  for (sunindextype j = 0; j < n; j++) {
    double sum = -mu * x[j];
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++) sum += value[k] * x[row[k]];
    y[j] = sum;
  }
}

static void norms(SUNMatrix A, stf_facts *f)
{
  const sunindextype n = SM_COLUMNS_S(A), *ptr = SM_INDEXPTRS_S(A), *row = SM_INDEXVALS_S(A);
  const double *value = SM_DATA_S(A);
  f->mu = 0;
  for (sunindextype j = 0; j < n; j++)
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      if (row[k] == j) f->mu += value[k] / (double)n;
  for (sunindextype j = 0; j < n; j++) {
    double sum = 0, diagonal = 0;
    for (sunindextype k = ptr[j]; k < ptr[j + 1]; k++)
      if (row[k] == j)
        diagonal += value[k];
      else
        sum += fabs(value[k]);
    f->norm = fmax(f->norm, sum + fabs(diagonal));
    f->shifted = fmax(f->shifted, sum + fabs(diagonal - f->mu));
  }
}

static double *array(const steif_action *a, int k) { return stf_array(a->basis[k].v); }

static void symmetry(const steif_action *a, stf_facts *f)
{
  double *x = array(a, 0), *y = array(a, 1), *z = array(a, 2), even = 0, odd = 0, size = 0;
  unsigned seed = 20011;
  for (sunindextype i = 0; i < a->space.n; i++) {
    seed = (unsigned)((unsigned long long)seed * 48271u % 2147483647u);
    x[i] = 2 * (double)seed / 2147483647.0 - 1;
  }
  times(a->A, 0, x, y);
  times_transposed(a->A, 0, x, z);
  for (sunindextype i = 0; i < a->space.n; i++) {
    size = fmax(size, fabs(y[i])), even = fmax(even, fabs(y[i] - z[i]));
    odd = fmax(odd, fabs(y[i] + z[i]));
  }
  f->symmetric = even <= 1e-13 * size;
  f->skew = odd <= 1e-13 * size;
}

int stf_facts_find(steif_action *a)
{
  a->facts = (stf_facts){.norm = 0};
  if (!a->A) return STEIF_OK;
  STEIF_TRY(stf_state_grow(a, 3));
  norms(a->A, &a->facts);
  symmetry(a, &a->facts);
  STEIF_CHECK(isfinite(a->facts.norm), a->ctx, STEIF_NOT_FINITE,
              "||A||_1 overflows: scale the equations");
  return STEIF_OK;
}

double stf_facts_root(steif_action *a, bool shift, int k)
{
  double *known = &a->facts.root[shift][k], estimate = 0;
  const int n = (int)a->space.n;
  const double mu = shift ? a->facts.mu : 0, norm = shift ? a->facts.shifted : a->facts.norm;
  if (*known > 0 || norm == 0) return *known;
  double *v = array(a, 0), *x = array(a, 1), *y = array(a, 2);
  int kase = 0, save[3];
  for (;;) {
    dlacn2_(&n, v, x, a->sign, &estimate, &kase, save);
    if (kase == 0) break;
    for (int power = 0; power < k; power++) {
      (kase == 1 ? times : times_transposed)(a->A, mu, x, y);
      for (int i = 0; i < n; i++) x[i] = y[i] / norm;
      a->report.products++;
    }
  }
  *known = norm * pow(estimate, 1.0 / k);
  return *known;
}
