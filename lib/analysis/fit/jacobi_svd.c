/* jacobi_svd.c: the singular values of a tall matrix by one-sided Jacobi rotations (M. R. Hestenes, J. SIAM
 * 6 (1958) 51-90): columns are turned in pairs until all are orthogonal. Small values are as accurate
 * as scaling by columns allows (J. Demmel, K. Veselic, SIAM J. Matrix Anal. Appl. 13 (1992) 1204-1245).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "jacobi_svd.h"
#include "base.h"
#include <math.h>

enum { SWEEPS = 60 };

static sunrealtype dot(size_t m, const sunrealtype *a, const sunrealtype *b)
{
  sunrealtype sum = 0;
  for (size_t i = 0; i < m; i++) sum += a[i] * b[i];
  return sum;
}

static void turn(size_t m, sunrealtype c, sunrealtype s, sunrealtype *a, sunrealtype *b)
{
  for (size_t i = 0; i < m; i++) {
    const sunrealtype u = a[i], v = b[i];
    a[i] = c * u - s * v, b[i] = s * u + c * v;
  }
}

/* Columns a and b become orthogonal; false where they were. */
static bool rotate(size_t m, size_t P, sunrealtype *a, sunrealtype *b, sunrealtype *va,
                   sunrealtype *vb)
{
  const sunrealtype aa = dot(m, a, a), bb = dot(m, b, b), ab = dot(m, a, b);
  if (fabs(ab) <= 4 * STF_EPS * sqrt(aa) * sqrt(bb)) return false;
  const sunrealtype zeta = (bb - aa) / (2 * ab);
  const sunrealtype t = copysign(1, zeta) / (fabs(zeta) + hypot(1, zeta));
  const sunrealtype c = 1 / hypot(1, t), s = c * t;
  turn(m, c, s, a, b);
  turn(P, c, s, va, vb);
  return true;
}

static void swap(size_t count, sunrealtype *a, sunrealtype *b)
{
  for (size_t i = 0; i < count; i++) {
    const sunrealtype kept = a[i];
    a[i] = b[i], b[i] = kept;
  }
}

/* Descending, by selection. */
static void order(size_t m, size_t P, sunrealtype *A, sunrealtype *sigma, sunrealtype *V)
{
  for (size_t i = 0; i < P; i++) {
    size_t largest = i;
    for (size_t k = i + 1; k < P; k++)
      if (sigma[k] > sigma[largest]) largest = k;
    if (largest == i) continue;
    swap(1, sigma + i, sigma + largest);
    swap(m, A + i * m, A + largest * m);
    swap(P, V + i * P, V + largest * P);
  }
}

void stf_jacobi_svd(size_t m, size_t P, sunrealtype *A, sunrealtype *sigma, sunrealtype *V)
{
  for (size_t i = 0; i < P * P; i++) V[i] = i % (P + 1) == 0;
  bool turned = true;
  for (int sweep = 0; turned && sweep < SWEEPS; sweep++) {
    turned = false;
    for (size_t i = 0; i < P; i++)
      for (size_t k = i + 1; k < P; k++)
        turned |= rotate(m, P, A + i * m, A + k * m, V + i * P, V + k * P);
  }
  for (size_t k = 0; k < P; k++) sigma[k] = sqrt(dot(m, A + k * m, A + k * m));
  order(m, P, A, sigma, V);
}
