/* real_matrix.c: dense elimination with partial pivoting in many digits; zeros cost nothing.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "real.h"
#include <math.h>

static void swap(stf_real *a, stf_real *b, int n)
{
  for (int j = 0; j < n; j++) {
    const stf_real kept = a[j];
    a[j] = b[j];
    b[j] = kept;
  }
}

/* Column k below the pivot in row k. */
static void eliminate(int limbs, stf_real_matrix *m, size_t k)
{
  const size_t n = (size_t)m->n;
  const stf_real *top = m->a + k * n;
  for (size_t i = k + 1; i < n; i++) {
    stf_real *row = m->a + i * n;
    if (!row[k].sign) continue;
    stf_real_divide(limbs, row + k, top + k, row + k);
    for (size_t j = k + 1; j < n; j++) stf_real_gather(limbs, -1, row + k, top + j, row + j);
  }
}

bool stf_real_factor(int limbs, stf_real_matrix *m)
{
  const size_t n = (size_t)m->n;
  for (size_t k = 0; k < n; k++) {
    size_t best = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabsl(stf_real_value(m->a + i * n + k)) > fabsl(stf_real_value(m->a + best * n + k)))
        best = i;
    m->pivot[k] = (int)best;
    if (best != k) swap(m->a + k * n, m->a + best * n, m->n);
    if (!m->a[k * n + k].sign) return false;
    eliminate(limbs, m, k);
  }
  for (size_t k = 0; k < n; k++) { /* inverse pivots: solutions divide by nothing */
    const stf_real one = stf_real_of(1);
    stf_real_divide(limbs, &one, m->a + k * n + k, m->a + k * n + k);
  }
  return true;
}

void stf_real_solve(int limbs, const stf_real_matrix *m, stf_real *x)
{
  const int n = m->n;
  const stf_real *row = m->a;
  for (int k = 0; k < n; k++) swap(x + k, x + m->pivot[k], 1);
  for (int i = 0; i < n; i++, row += n)
    for (int j = 0; j < i; j++) stf_real_gather(limbs, -1, row + j, x + j, x + i);
  for (int i = n - 1; i >= 0; i--) {
    row -= n;
    for (int j = i + 1; j < n; j++) stf_real_gather(limbs, -1, row + j, x + j, x + i);
    stf_real_multiply(limbs, x + i, row + i, x + i);
  }
}

void stf_real_apply(int limbs, int n, const stf_real *a, const stf_real *factor,
                    const stf_real *x, stf_real *y)
{
  for (int i = 0; i < n; i++) {
    stf_real sum = {0};
    for (int j = 0; j < n; j++)
      stf_real_gather(limbs, 1, a + (size_t)i * (size_t)n + (size_t)j, x + j, &sum);
    stf_real_gather(limbs, 1, factor, &sum, y + i);
  }
}
