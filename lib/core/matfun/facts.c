/* facts.c: norms and symmetries of a matrix that the choice of a method rests on.
 *
 * Symmetry is tested by A x = +- A^T x for one vector without structure; norms of powers are
 * estimated (N. J. Higham, ACM TOMS 14, 1988).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "action.h"
#include "lapack.h"
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Column j of a matrix in any storage: `count` values in the rows row[k], or first + k. */
typedef struct column {
  sunindextype count, first;
  const sunindextype *row;
  const double *value;
} column;

static column column_of(SUNMatrix A, sunindextype j)
{
  const SUNMatrix_ID kind = SUNMatGetID(A);
  if (kind == SUNMATRIX_SPARSE) {
    const sunindextype from = SM_INDEXPTRS_S(A)[j];
    return (column){SM_INDEXPTRS_S(A)[j + 1] - from, 0, SM_INDEXVALS_S(A) + from,
                    SM_DATA_S(A) + from};
  }
  if (kind == SUNMATRIX_DENSE)
    return (column){SM_ROWS_D(A), 0, NULL, SM_DATA_D(A) + j * SM_ROWS_D(A)};
  const sunindextype n = SM_COLUMNS_B(A), up = SM_UBAND_B(A), low = SM_LBAND_B(A);
  const sunindextype first = j > up ? j - up : 0, end = j + low + 1 < n ? j + low + 1 : n;
  return (column){end - first, first, NULL, SM_COLUMN_B(A, j) + (first - j)};
}

static inline sunindextype row_of(const column *c, sunindextype k)
{
  return c->row ? c->row[k] : c->first + k;
}

/* y = A x - mu x, or A^T x - mu x */
static void times(const steif_action *a, double mu, const double *restrict x,
                  double *restrict y)
{
  for (sunindextype i = 0; i < a->space.n; i++) y[i] = -mu * x[i];
  for (sunindextype j = 0; j < a->space.n; j++) {
    const column c = column_of(a->A, j);
    for (sunindextype k = 0; k < c.count; k++) y[row_of(&c, k)] += c.value[k] * x[j];
  }
}

static void times_transposed(const steif_action *a, double mu, const double *restrict x,
                             double *restrict y)
{
  for (sunindextype j = 0; j < a->space.n; j++) {
    const column c = column_of(a->A, j);
    double sum = -mu * x[j];
    for (sunindextype k = 0; k < c.count; k++) sum += c.value[k] * x[row_of(&c, k)];
    y[j] = sum;
  }
}

static void norms(const steif_action *a, stf_facts *f)
{
  const sunindextype n = a->space.n;
  for (sunindextype j = 0; j < n; j++) {
    const column c = column_of(a->A, j);
    for (sunindextype k = 0; k < c.count; k++)
      if (row_of(&c, k) == j) f->mu += c.value[k] / (double)n;
  }
  for (sunindextype j = 0; j < n; j++) {
    const column c = column_of(a->A, j);
    double sum = 0, diagonal = 0;
    for (sunindextype k = 0; k < c.count; k++)
      if (row_of(&c, k) == j)
        diagonal += c.value[k];
      else
        sum += fabs(c.value[k]);
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
  times(a, 0, x, y);
  times_transposed(a, 0, x, z);
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
  norms(a, &a->facts);
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
      (kase == 1 ? times : times_transposed)(a, mu, x, y);
      for (int i = 0; i < n; i++) x[i] = y[i] / norm;
      a->report.products++;
    }
  }
  *known = norm * pow(estimate, 1.0 / k);
  return *known;
}
