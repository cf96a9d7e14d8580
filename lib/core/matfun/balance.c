/* balance.c: permutation and scaling by powers of two (B. N. Parlett and C. Reinsch, Numer.
 * Math. 13, 1969) that bring a matrix nearer to block triangular form and smaller norm.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"
#include "lapack.h"
#include <string.h>

static void exchange(stf_scaling *b, int i)
{
  const int k = (int)b->d[i] - 1, t = b->perm[i];
  b->perm[i] = b->perm[k], b->perm[k] = t;
  b->d[i] = 1;
}

void stf_balance_open(stf_scaling *b, double *A)
{
  int info;
  dgebal_("B", &b->n, A, &b->n, &b->lo, &b->hi, b->d, &info, 1);
  b->lo--;
  for (int i = 0; i < b->n; i++) b->perm[i] = i;
  for (int i = b->n - 1; i >= b->hi; i--) exchange(b, i);
  for (int i = 0; i < b->lo; i++) exchange(b, i);
}

bool stf_balance_trivial(const stf_scaling *b)
{
  for (int i = 0; i < b->n; i++)
    if (b->perm[i] != i || b->d[i] != 1) return false;
  return true;
}

void stf_balance_undo(const stf_scaling *b, const double *B, double *X)
{
  const size_t n = (size_t)b->n;
  if (stf_balance_trivial(b)) {
    memcpy(X, B, n * n * sizeof *X);
    return;
  }
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      X[(size_t)b->perm[i] + n * (size_t)b->perm[j]] = B[i + n * j] * (b->d[i] / b->d[j]);
}

void stf_balance_redo(const stf_scaling *b, const double *E, double *F)
{
  const size_t n = (size_t)b->n;
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      F[i + n * j] = E[(size_t)b->perm[i] + n * (size_t)b->perm[j]] * (b->d[j] / b->d[i]);
}
