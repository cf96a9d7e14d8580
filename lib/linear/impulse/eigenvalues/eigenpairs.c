/* eigenpairs.c: residuals, and eigenvalues in order.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "eigenpairs.h"
#include <math.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const sunrealtype pi = 3.14159265358979323846;

/* y += times M v. */
static void add(SUNMatrix M, double complex times, const double complex *v, double complex *y)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype n = dense ? SM_COLUMNS_D(M) : SM_COLUMNS_S(M);
  for (sunindextype j = 0; j < n; j++) {
    const double complex x = times * v[j];
    if (dense)
      for (sunindextype i = 0; i < n; i++) y[i] += SM_ELEMENT_D(M, i, j) * x;
    else
      for (sunindextype k = SM_INDEXPTRS_S(M)[j]; k < SM_INDEXPTRS_S(M)[j + 1]; k++)
        y[SM_INDEXVALS_S(M)[k]] += SM_DATA_S(M)[k] * x;
  }
}

void stf_eigenpairs_product(const stf_eigenpairs *p, char which, const double complex *v,
                            double complex *y)
{
  for (int i = 0; i < p->n; i++) y[i] = 0;
  add(which == 'E' ? p->E : p->F, 1, v, y);
}

steif_eigenvalue stf_eigenpairs_measure(const stf_eigenpairs *p, double complex s,
                                        const double complex *v)
{
  const sunrealtype size = cabs(s), unit = size < STF_NOTHING * p->largest ? p->largest : size;
  sunrealtype most = 0, off = 0;
  stf_eigenpairs_product(p, 'F', v, p->r);
  add(p->E, s, v, p->r);
  for (int i = 0; i < p->n; i++) most = fmax(most, cabs(v[i]) / (p->unit ? p->unit[i] : 1));
  for (int i = 0; i < p->n; i++) {
    const sunrealtype row = unit * p->norm[0][i] + p->norm[1][i],
                      residual = cabs(p->r[i]) * (p->row ? p->row[i] : 1);
    if (row > 0) off = fmax(off, residual / row);
  }
  return (steif_eigenvalue){.re = creal(s),
                            .im = cimag(s),
                            .damping = size > 0 ? -creal(s) / size : 0,
                            .frequency = fabs(cimag(s)) / (2 * pi),
                            .residual = most > 0 ? off / most : INFINITY};
}

/* -- order -------------------------------------------------------------------------------- */

/* Conjugates are as near to a real S but for rounding. */
static bool before(const stf_eigenpairs *p, const steif_eigenvalue *a,
                   const steif_eigenvalue *b)
{
  static const sunrealtype equal = 1e-10;
  const sunrealtype x = cabs(a->re + I * a->im - p->near),
                    y = cabs(b->re + I * b->im - p->near);
  return fabs(x - y) > equal * (x + y) ? x < y : a->im < b->im;
}

static void sift(const stf_eigenpairs *p, long from, long count)
{
  steif_eigenvalue *v = p->value;
  for (long at = from, child; (child = 2 * at + 1) < count; at = child) {
    if (child + 1 < count && before(p, v + child, v + child + 1)) child++;
    if (!before(p, v + at, v + child)) return;
    const steif_eigenvalue keep = v[at];
    v[at] = v[child];
    v[child] = keep;
  }
}

void stf_eigenpairs_sort(stf_eigenpairs *p)
{
  for (long k = p->count / 2 - 1; k >= 0; k--) sift(p, k, p->count);
  for (long end = p->count - 1; end > 0; end--) {
    const steif_eigenvalue keep = p->value[0];
    p->value[0] = p->value[end];
    p->value[end] = keep;
    sift(p, 0, end);
  }
}
