/* dense_eigenvalues.c: all finite eigenvalues by the QZ algorithm on the finite part of a pencil.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "eigenpairs.h"
#include "lapack.h"
#include "separated_parts.h"
#include <math.h>
#include <string.h>

/* dggev asks for 8 rows of work at least; more for blocks. */
enum { WORK = 80, SQUARES = 5 };

typedef struct finite {
  int n, f;
  sunrealtype *E, *A, *vector, *re, *im, *beta, *work;
} finite;

/* The last f rows and columns, packed; `sign` times them. */
static void take(int n, int f, sunrealtype sign, const sunrealtype *from, sunrealtype *to)
{
  for (int j = 0; j < f; j++)
    for (int i = 0; i < f; i++)
      to[j * f + i] = sign * from[(size_t)(j + n - f) * (size_t)n + (size_t)(i + n - f)];
}

/* x = back (0, y), y in column j, or columns j and j + 1 as real and imaginary part. */
static void lift(const finite *q, const sunrealtype *back, int j, int pair, double complex *x)
{
  const int n = q->n, f = q->f;
  const sunrealtype *y = q->vector + j * f;
  for (int i = 0; i < n; i++) x[i] = 0;
  for (int k = 0; k < f; k++) {
    const double complex weight = pair ? y[k] + I * y[f + k] : y[k];
    const sunrealtype *column = back + (size_t)(k + n - f) * (size_t)n;
    for (int i = 0; i < n; i++) x[i] += weight * column[i];
  }
}

static int solve(stf_eigenpairs *p, finite *q, const sunrealtype *back, double complex *x)
{
  const int lwork = WORK * q->f, one = 1;
  int info = 0;
  dggev_("N", "V", &q->f, q->A, &q->f, q->E, &q->f, q->re, q->im, q->beta, q->vector, &one,
         q->vector, &q->f, q->work, &lwork, &info, 1, 1);
  STEIF_CHECK(!info, p->ctx, STEIF_NOT_CERTIFIED,
              "the QZ algorithm did not converge (dggev: %d): scale the equations", info);
  for (int j = 0; j < q->f; j++) {
    const sunrealtype size = hypot(q->re[j], q->im[j]) / fabs(q->beta[j]);
    if (isfinite(size)) p->largest = fmax(p->largest, size);
  }
  for (int j = 0; j < q->f; j++) {
    const bool pair = q->im[j] > 0 && j + 1 < q->f;
    const double complex s = (q->re[j] + I * q->im[j]) / q->beta[j];
    lift(q, back, j, pair, x);
    p->value[p->count++] = stf_eigenpairs_measure(p, s, x);
    if (!pair) continue;
    p->value[p->count] = p->value[p->count - 1];
    p->value[p->count++].im = -cimag(s);
    j++;
  }
  return STEIF_OK;
}

int stf_eigenpairs_dense(stf_eigenpairs *p)
{
  const int n = p->n, f = (int)p->structure->finite;
  const size_t square = (size_t)n * (size_t)n, part = (size_t)f * (size_t)f;
  sunrealtype *all = stf_pool_array(p->pool, SQUARES * square, sizeof *all);
  sunrealtype *own =
    stf_pool_array(p->pool, 3 * part + (WORK + 3) * (size_t)f + 1, sizeof *own);
  double complex *x = stf_pool_array(p->pool, (size_t)n, sizeof *x);
  p->value = stf_pool_array(p->pool, (size_t)f + 1, sizeof *p->value);
  if (!all || !own || !x || !p->value) return STEIF_NO_MEMORY;
  if (!f) return STEIF_OK;
  const stf_decoupling d = {all, all + square, all + 2 * square, all + 3 * square,
                            all + 4 * square};
  STEIF_TRY(
    stf_dense_parts(p->ctx, p->E, p->F, p->analysis, &(stf_separated){.decoupling = &d}));
  finite q = {.n = n, .f = f, .E = own, .A = own + part, .vector = own + 2 * part};
  q.re = own + 3 * part;
  q.im = q.re + f;
  q.beta = q.im + f;
  q.work = q.beta + f;
  take(n, f, 1, d.E, q.E);
  take(n, f, -1, d.F, q.A);
  return solve(p, &q, d.back, x);
}
