/* planted_dense.c: U diag(s I + J, s N + I) V with U and V between two orthogonal matrices.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted.h"
#include <math.h>
#include <string.h>

enum { FINITE = 10, BLOCKS = 3, LONGEST = 3 };

/* A <- Q A or A Q of n x n A by columns, Q a product of n reflections given by w. */
static void reflect(int n, const sunrealtype *w, bool left, sunrealtype *A)
{
  for (int k = 0; k < n; k++)
    for (int j = 0; j < n; j++) {
      const sunrealtype *v = w + k * n;
      sunrealtype dot = 0;
      for (int i = 0; i < n; i++) dot += v[i] * (left ? A[j * n + i] : A[i * n + j]);
      for (int i = 0; i < n; i++) A[left ? j * n + i : i * n + j] -= 2 * dot * v[i];
    }
}

/* Q^{-1} x of A Q: the reflection next to A comes first. */
static void reflect_back(int n, const sunrealtype *w, sunrealtype *x)
{
  for (int k = 0; k < n; k++) {
    const sunrealtype *v = w + k * n;
    sunrealtype dot = 0;
    for (int i = 0; i < n; i++) dot += v[i] * x[i];
    for (int i = 0; i < n; i++) x[i] -= 2 * dot * v[i];
  }
}

static void draw_reflections(stf_random *r, int n, sunrealtype *w)
{
  for (int k = 0; k < n; k++) {
    sunrealtype square = 0;
    for (int i = 0; i < n; i++) {
      w[k * n + i] = stf_random_normal(r);
      square += w[k * n + i] * w[k * n + i];
    }
    for (int i = 0; i < n; i++) w[k * n + i] /= sqrt(square);
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

/* E <- Q_1 D Q_2 E Q_3 D Q_4, F likewise; x = Q_4^{-1} D^{-1} Q_3^{-1} z. */
static void transform(planted *p, sunrealtype kappa)
{
  sunrealtype w[4][PLANTED_MOST * PLANTED_MOST], *both[] = {p->E, p->F};
  sunrealtype *start[] = {p->before, p->after};
  const int n = p->n;
  for (int q = 0; q < 4; q++) draw_reflections(&p->random, n, w[q]);
  for (int m = 0; m < 2; m++) {
    reflect(n, w[1], true, both[m]);
    reflect(n, w[2], false, both[m]);
    for (int k = 0; k < n * n; k++)
      both[m][k] *= pow(kappa, n > 1 ? -(sunrealtype)(k % n + k / n) / (n - 1) : 0);
    reflect(n, w[0], true, both[m]);
    reflect(n, w[3], false, both[m]);
    reflect_back(n, w[2], start[m]);
    for (int i = 0; i < n; i++) start[m][i] *= pow(kappa, n > 1 ? (sunrealtype)i / (n - 1) : 0);
    reflect_back(n, w[3], start[m]);
  }
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
  transform(p, kappa);
}
