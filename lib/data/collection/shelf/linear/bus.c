/* bus.c: a power network of n=200 buses linearised at rest, index 1. Every fourth bus has a
 * generator of angle delta and speed omega; the angles theta of all buses follow from the balance
 * of power,
 *
 *   delta' - omega = 0,   M omega' + D omega + b (delta - theta) = p(t),
 *   L theta + b (theta - delta) = -q(t),
 *
 * L the Laplacian of the lines weighted by their susceptances: a ring, and from every third bus a
 * chord over 2 to 13 others. The matrix B = L + diag(b) of the last block is positive definite.
 * delta and omega are continuous, theta(0+) = B^{-1} (b delta - q).
 * A. R. Bergen, D. J. Hill, IEEE Trans. Power App. Syst. 100 (1981) 25-35.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <string.h>

typedef struct network {
  sunindextype n, generators;
} network;

/* The block of theta in F. */
static int balance(steif_context *ctx, stf_pool *pool, const stf_linear *l, stf_sparse *B)
{
  const network *q = l->data;
  const sunindextype base = 2 * q->generators;
  stf_sparse m;
  STEIF_TRY(stf_sparse_open(pool, q->n, l->F.count, &m));
  for (sunindextype j = 0; j < q->n; j++)
    for (sunindextype k = l->F.at[base + j]; k < l->F.at[base + j + 1]; k++)
      if (l->F.row[k] >= base) stf_linear_put(&m, l->F.row[k] - base, j, l->F.value[k]);
  return stf_sparse_sort(ctx, pool, &m, B);
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const network *q = l->data;
  const sunindextype base = 2 * q->generators;
  sunrealtype *x = out->x_plus, *work = NULL;
  stf_schur *s = NULL;
  stf_sparse B;
  stf_pool *pool = stf_pool_new(ctx);
  int code = pool && (work = stf_pool_array(pool, (size_t)l->n, sizeof *work))
               ? STEIF_OK
               : STEIF_NO_MEMORY;
  if (!code) code = balance(ctx, pool, l, &B);
  if (!code) code = stf_schur_of(ctx, &B, &s);
  if (code) goto done;
  memcpy(x, x0, (size_t)base * sizeof *x);
  stf_linear_defect(l, x, 0, work);
  for (sunindextype i = 0; i < q->n; i++) x[base + i] = -work[base + i];
  code = stf_schur_solve(s, x + base);
done:
  stf_schur_close(&s);
  stf_pool_free(&pool);
  return code;
}

static void line(stf_linear *l, sunindextype i, sunindextype j, sunrealtype susceptance)
{
  stf_linear_put(&l->F, i, i, susceptance);
  stf_linear_put(&l->F, j, j, susceptance);
  stf_linear_put(&l->F, i, j, -susceptance);
  stf_linear_put(&l->F, j, i, -susceptance);
}

static void lines(stf_linear *l, const network *q, stf_random *r)
{
  const sunindextype base = 2 * q->generators;
  for (sunindextype i = 0; i < q->n; i++) {
    line(l, base + i, base + (i + 1) % q->n, stf_random_in(r, 5, 20));
    const sunindextype reach = 3 + stf_random_below(r, 12);
    if (i % 3 == 0 && reach < q->n) line(l, base + i, base + (i + reach) % q->n, 4);
  }
}

static void generator(stf_linear *l, const network *q, sunindextype j, stf_random *r)
{
  const sunindextype delta = j, omega = q->generators + j, theta = 2 * q->generators + 4 * j;
  stf_linear_put(&l->E, delta, delta, 1);
  stf_linear_put(&l->E, omega, omega, stf_random_in(r, 0.1, 0.3));
  stf_linear_put(&l->F, delta, omega, -1);
  stf_linear_put(&l->F, omega, omega, stf_random_in(r, 0.02, 0.1));
  const sunrealtype b = stf_random_in(r, 2, 6);
  stf_linear_put(&l->F, omega, delta, b);
  stf_linear_put(&l->F, omega, theta, -b);
  stf_linear_put(&l->F, theta, theta, b);
  stf_linear_put(&l->F, theta, delta, -b);
}

static void powers(stf_linear *l, const network *q, stf_random *r)
{
  for (sunindextype i = 0; i < l->n; i++) {
    const sunrealtype pace = stf_random_in(r, 1, 6), phase = stf_random_in(r, 0, 6);
    if (i >= q->generators) stf_linear_wave(l, i, stf_random_in(r, -0.8, 0.8), pace, phase);
    l->start[i] = stf_random_in(r, -0.5, 0.5);
  }
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int buses;
  stf_random r;
  STEIF_TRY(
    stf_spec_only(ctx, spec, (const char *const[]){"n", "seed", "case", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 3, 10000000, 200, &buses));
  STEIF_TRY(stf_random_seed(ctx, spec, &r));
  const sunindextype n = buses, generators = (n + 3) / 4, all = n + 2 * generators;
  stf_linear *l = stf_linear_open(ctx, self, all, 2 * generators, 8 * n + 6 * generators, all);
  network *q = l ? stf_pool_array(l->pool, 1, sizeof *q) : NULL;
  if (!q) return STEIF_NO_MEMORY;
  *q = (network){n, generators};
  l->data = q;
  lines(l, q, &r);
  for (sunindextype j = 0; j < generators; j++) generator(l, q, j, &r);
  powers(l, q, &r);
  l->dae_index = 1;
  l->finite = 2 * generators;
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}

const steif_problem steif_problem_bus = {
  .about =
    "power network of n=200 buses, every fourth with a generator, linearised, index 1, angles "
    "of "
    "the buses off balance at the start (case=inc); A. R. Bergen and D. J. Hill, IEEE Trans. "
    "Power App. Syst. 100 (1981) 25-35",
  .t1 = 5,
  .storage = STEIF_SPARSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
