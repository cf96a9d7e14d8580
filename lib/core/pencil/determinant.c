/* determinant.c: log |det(s E - A)| of a factored sparse pencil, half the logarithm of a product of
 * squares. The products of CHAINS columns are carried on side by side, and their logarithms taken
 * when they have grown or shrunk much; the error of the sum is carried along (A. Neumaier, ZAMM 54,
 * 1974).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lu.h"
#include "sparse.h"
#include <math.h>

/* Squares and products between these lose no digits when they meet. */
enum { CHAINS = 4 };
#define LEAST 1e-140
#define MOST 1e140

typedef struct logs {
  const double *u, *row; /* the diagonal of U; scales of rows, NULL: none */
  bool complex;
  double product[CHAINS], sum, error;
} logs;

static void gain(logs *l, double y)
{
  const double t = l->sum + y;
  l->error += fabs(l->sum) >= fabs(y) ? (l->sum - t) + y : (y - t) + l->sum;
  l->sum = t;
}

static inline double square(const logs *l, sunindextype k)
{
  const double *u = l->u, row = l->row ? l->row[k] : 1;
  const double z = l->complex ? u[2 * k] * u[2 * k] + u[2 * k + 1] * u[2 * k + 1] : u[k] * u[k];
  return z * (row * row);
}

/* What is too large or small for squares. */
static void take_out(logs *l, int lane, sunindextype k)
{
  const double *u = l->u;
  gain(l, log(l->product[lane]));
  gain(l, 2 * log(l->complex ? hypot(u[2 * k], u[2 * k + 1]) : fabs(u[k])));
  if (l->row) gain(l, 2 * log(l->row[k]));
  l->product[lane] = 1;
}

static inline void multiply(logs *l, sunindextype k, int count)
{
  double x[CHAINS];
  bool good = true;
  for (int i = 0; i < count; i++) {
    x[i] = l->product[i] * square(l, k + i);
    good &= x[i] > LEAST && x[i] < MOST;
  }
  for (int i = 0; i < count; i++)
    if (good || (x[i] > LEAST && x[i] < MOST))
      l->product[i] = x[i];
    else
      take_out(l, i, k + i);
}

static void of_pivots(logs *l, sunindextype n)
{
  sunindextype k = 0;
  for (; k + CHAINS <= n; k += CHAINS) multiply(l, k, CHAINS);
  multiply(l, k, (int)(n - k));
}

/* Of the reciprocals of the pivots. */
static void of_fronts(const stf_multifrontal *f, const double *factors, logs *l)
{
  int count;
  sunindextype step;
  for (int i = 0; (l->u = stf_multifrontal_pivots(f, factors, i, &count, &step)); i++)
    for (int k = 0; k < count; k++) multiply(l, k * step, 1);
}

int stf_pencil_logdet(steif_pencil *p, int slot, sunrealtype *log_abs_det)
{
  STEIF_CHECK(p->backend == &stf_backend_sparse, p->ctx, STEIF_UNSUPPORTED,
              "the determinant of a %s pencil is not kept: use sparse matrices",
              p->backend->name);
  STEIF_CHECK(slot >= 0 && slot < p->slots && p->fresh[slot], p->ctx, STEIF_BAD_INPUT,
              "slot %d of %d has no factors: call steif_pencil_factor first", slot, p->slots);
  const stf_sparse_blocks blocks = stf_sparse_fronts(p, slot);
  const klu_l_numeric *f = stf_sparse_factors(p, slot);
  logs l = {.complex = stf_is_complex(p->shift[slot]), .product = {1, 1, 1, 1}};
  if (blocks.fronts)
    of_fronts(blocks.fronts, blocks.factors, &l);
  else
    l.u = f->Udiag, l.row = f->Rs, of_pivots(&l, p->n);
  for (int i = 0; i < CHAINS; i++) gain(&l, log(l.product[i]));
  *log_abs_det = (blocks.fronts ? -0.5 : 0.5) * (l.sum + l.error);
  return STEIF_OK;
}
