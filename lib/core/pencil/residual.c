/* residual.c: residuals of sparse pencils beside the sizes of their terms, row by row.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sparse.h"
#include <math.h>

static inline double modulus(const double z[2]) { return fabs(z[0]) + fabs(z[1]); }

static void subtract_real(const stf_pattern *u, const double *restrict m,
                          const double *restrict x, double *restrict r, double *restrict size)
{
  for (sunindextype j = 0; j < u->n; j++)
    for (SuiteSparse_long k = u->ptr[j]; k < u->ptr[j + 1]; k++) {
      const double term = m[k] * x[j];
      r[u->row[k]] -= term;
      size[u->row[k]] += fabs(term);
    }
}

static void subtract_complex(const stf_pattern *u, const double *restrict m,
                             const double *restrict x, double *restrict r,
                             double *restrict size)
{
  for (sunindextype j = 0; j < u->n; j++) {
    const double re = x[2 * j], im = x[2 * j + 1], most = modulus(x + 2 * j);
    for (SuiteSparse_long k = u->ptr[j]; k < u->ptr[j + 1]; k++) {
      const SuiteSparse_long i = u->row[k];
      r[2 * i] -= m[2 * k] * re - m[2 * k + 1] * im;
      r[2 * i + 1] -= m[2 * k] * im + m[2 * k + 1] * re;
      size[i] += modulus(m + 2 * k) * most;
    }
  }
}

/* A row without error may be without terms. */
static double squared(double r, double size) { return r == 0 ? 0 : (r / size) * (r / size); }

double stf_sparse_residual(const steif_pencil *p, int slot, const double *x, double *r,
                           double *size)
{
  const stf_pattern *u = stf_sparse_pattern(p);
  const bool complex = stf_is_complex(p->shift[slot]);
  double sum = 0;
  for (sunindextype i = 0; i < u->n; i++) size[i] = complex ? modulus(r + 2 * i) : fabs(r[i]);
  (complex ? subtract_complex : subtract_real)(u, stf_sparse_values(p, slot), x, r, size);
  for (sunindextype i = 0; i < u->n; i++)
    sum += squared(complex ? modulus(r + 2 * i) : fabs(r[i]), size[i]);
  return sqrt(sum / (double)u->n);
}
