/* planted_dense.c: U diag(s I + J, s N + I) V with U and V between two orthogonal matrices.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted.h"
#include <math.h>
#include <string.h>

enum { FINITE = 10, BLOCKS = 3, LONGEST = 3 };

/* In longer arithmetic, so that what is planted is off by the rounding of the entries alone. */
typedef long double wide;

/* A <- Q A or A Q of n x n A by columns, Q a product of n reflections given by w. */
static void reflect(int n, const wide *w, bool left, wide *A)
{
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++) {
      const wide *v = w + k * n;
      wide dot = 0;
      for (int i = 0; i < n; i++) dot += v[i] * (left ? A[j * n + i] : A[i * n + j]);
      for (int i = 0; i < n; i++) A[left ? j * n + i : i * n + j] -= 2 * dot * v[i];
    }
}

/* Q^{-1} x of A Q: the reflection next to A comes first. */
static void reflect_back(int n, const wide *w, wide *x)
{
  for (int k = 0; k < n; k++) {
    const wide *v = w + k * n;
    wide dot = 0;
    for (int i = 0; i < n; i++) dot += v[i] * x[i];
    for (int i = 0; i < n; i++) x[i] -= 2 * dot * v[i];
  }
}

static void draw_reflections(stf_random *r, int n, wide *w)
{
  for (int k = 0; k < n; k++) {
    wide square = 0;
    for (int i = 0; i < n; i++) {
      w[k * n + i] = stf_random_normal(r);
      square += w[k * n + i] * w[k * n + i];
    }
    for (int i = 0; i < n; i++) w[k * n + i] /= sqrtl(square);
  }
}

static void put_blocks(planted *p, int f, int blocks, const int *size, sunrealtype rho)
{
  const bool real = stf_random_below(&p->random, 2);
  const int n = p->n;
  for (int i = 0; i < n; i++) (i < f ? p->E : p->F)[i * n + i] = 1;
  for (int i = 0; i < f; i += real ? 1 : 2) {
    const sunrealtype w = 0.1 * pow(10 * rho, stf_random_in(&p->random, 0, 1));
    p->F[i * n + i] = real ? w : 0.05 * w;
    if (real) continue;
    p->F[(i + 1) * n + i + 1] = 0.05 * w;
    p->F[(i + 1) * n + i] = w;
    p->F[i * n + i + 1] = -w;
  }
  for (int b = 0, at = f; b < blocks; at += size[b++])
    for (int i = 0; i + 1 < size[b]; i++) p->E[(at + i + 1) * n + at + i] = 1;
}

static void copy(int count, const sunrealtype *from, wide *to)
{
  for (int k = 0; k < count; k++) to[k] = from[k];
}

static void rounded(int count, const wide *from, sunrealtype *to)
{
  for (int k = 0; k < count; k++) to[k] = (sunrealtype)from[k];
}

/* A <- Q_1 D Q_2 A Q_3 D Q_4, and x <- Q_4^{-1} D^{-1} Q_3^{-1} x. */
static void transform(int n, const wide *scale, const wide w[4][PLANTED_MOST * PLANTED_MOST],
                      sunrealtype *A, sunrealtype *x)
{
  wide M[PLANTED_MOST * PLANTED_MOST], z[PLANTED_MOST];
  copy(n * n, A, M);
  copy(n, x, z);
  reflect(n, w[1], true, M);
  reflect(n, w[2], false, M);
  for (int k = 0; k < n * n; k++) M[k] *= scale[k % n] * scale[k / n];
  reflect(n, w[0], true, M);
  reflect(n, w[3], false, M);
  reflect_back(n, w[2], z);
  for (int i = 0; i < n; i++) z[i] /= scale[i];
  reflect_back(n, w[3], z);
  rounded(n * n, M, A);
  rounded(n, z, x);
}

/* E and F with one transformation each side, and the values before and after with it. */
static void transform_all(planted *p, sunrealtype kappa)
{
  wide w[4][PLANTED_MOST * PLANTED_MOST], scale[PLANTED_MOST];
  const int n = p->n;
  for (int i = 0; i < n; i++) scale[i] = powl(kappa, n > 1 ? -(wide)i / (n - 1) : 0);
  for (int q = 0; q < 4; q++) draw_reflections(&p->random, n, w[q]);
  transform(n, scale, (const wide(*)[PLANTED_MOST * PLANTED_MOST]) w, p->E, p->before);
  transform(n, scale, (const wide(*)[PLANTED_MOST * PLANTED_MOST]) w, p->F, p->after);
}

void planted_dense(planted *p)
{
  stf_random *r = &p->random;
  const sunrealtype kappa = pow(10, (sunrealtype)stf_random_below(r, 4));
  const int blocks = (int)stf_random_below(r, BLOCKS + 1);
  int size[BLOCKS] = {0}, f = 2 * (int)stf_random_below(r, FINITE / 2 + 1);
  if (!f && !blocks) f = 2;
  p->n = p->finite = f;
  for (int b = 0; b < blocks; b++) {
    size[b] = 1 + (int)stf_random_below(r, LONGEST);
    p->n += size[b];
    p->index = size[b] > p->index ? size[b] : p->index;
  }
  put_blocks(p, f, blocks, size, pow(10, stf_random_in(r, 0, 3)));
  for (int i = 0; i < p->n; i++) {
    p->before[i] = stf_random_normal(r);
    p->after[i] = i < f ? p->before[i] : 0;
  }
  p->start = f > 0;
  transform_all(p, kappa);
}
