/* ladder.c: a ladder of n=200 nodes by modified nodal analysis, index 2.
 *
 * Node i has a capacitor C_i to ground; R_i and L_i in series lead to node i + 1, with the node m_i
 * between them. An ideal voltage source V at node 0 closes a loop with C_0. Every fifth node is
 * joined by an inductor l_j to a node x_j that only a current source feeds. Equations
 *
 *   e_i:  C_i e_i' + (e_i - m_i)/R_i - i_{i-1} - k_j + [i = 0] i_V = f     (k_j at its node only)
 *   m_i:  (m_i - e_i)/R_i + i_i = f           i_i:  L_i i_i' - m_i + e_{i+1} = f
 *   i_V:  e_0 = V                             x_j:  k_j = I_j
 *                                             k_j:  l_j k_j' - x_j + e_i = f
 *
 * in SI units. At the start e_0 = V and k_j = I_j at once, c_0(i_V) = -C_0 (V - e_0(0-)),
 * c_0(x_j) = l_j (I_j - k_j(0-)); every other e_i and i_i is continuous.
 * C. Tischendorf, Surv. Math. Ind. 8 (1999) 187-199 (index of such circuits).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "generated.h"
#include <string.h>

typedef struct ladder {
  sunindextype n, cuts;
  sunrealtype *R, *l; /* n - 1, cuts */
  sunrealtype C0;
} ladder;

/* First of the unknowns m, i, i_V and of the pairs x_j, k_j. */
static sunindextype middle(const ladder *q) { return q->n; }
static sunindextype current(const ladder *q) { return 2 * q->n - 1; }
static sunindextype source(const ladder *q) { return 3 * q->n - 2; }
static sunindextype pair(const ladder *q, sunindextype j) { return 3 * q->n - 1 + 2 * j; }
static sunindextype tapped(sunindextype j) { return 5 * j + 4; }

/* The inductors that hang on current sources: f0 = f(0), f1 = f'(0). */
static void cutsets(const stf_linear *l, const sunrealtype *f0, const sunrealtype *f1,
                    const sunrealtype *x0, stf_exact_start *out)
{
  const ladder *q = l->data;
  sunrealtype *x = out->x_plus;
  for (sunindextype j = 0; j < q->cuts; j++) {
    const sunindextype a = pair(q, j), k = a + 1;
    out->c[a] = q->l[j] * (f0[a] - x0[k]);
    x[k] = f0[a];
    x[a] = q->l[j] * f1[a] + x[tapped(j)] - f0[k];
  }
}

static int jump(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
                stf_exact_start *out)
{
  const ladder *q = l->data;
  const sunindextype m = middle(q), i0 = current(q), V = source(q);
  sunrealtype *f0 = stf_allocate(ctx, 2 * (size_t)l->n, sizeof *f0);
  if (!f0) return STEIF_NO_MEMORY;
  sunrealtype *f1 = f0 + l->n;
  sunrealtype *x = out->x_plus;
  stf_linear_force(l, 0, 0, f0);
  stf_linear_force(l, 0, 1, f1);
  memcpy(x, x0, (size_t)l->n * sizeof *x);
  out->c[V] = -q->C0 * (f0[V] - x0[0]);
  x[0] = f0[V];
  for (sunindextype i = 0; i < q->n - 1; i++)
    x[m + i] = x[i] - q->R[i] * (x[i0 + i] - f0[m + i]);
  x[V] = f0[0] - q->C0 * f1[V] - (x[0] - x[m]) / q->R[0];
  cutsets(l, f0, f1, x0, out);
  stf_release(ctx, f0);
  return STEIF_OK;
}

static void rung(stf_linear *l, const ladder *q, sunindextype i, stf_random *r)
{
  const sunindextype m = middle(q) + i, k = current(q) + i;
  const sunrealtype R = q->R[i] = stf_random_in(r, 50, 100);
  stf_linear_put(&l->E, k, k, stf_random_in(r, 1e-3, 2e-3));
  stf_linear_put(&l->F, i, i, 1 / R);
  stf_linear_put(&l->F, i, m, -1 / R);
  stf_linear_put(&l->F, m, i, -1 / R);
  stf_linear_put(&l->F, m, m, 1 / R);
  stf_linear_put(&l->F, m, k, 1);
  stf_linear_put(&l->F, k, m, -1);
  stf_linear_put(&l->F, k, i + 1, 1);
  stf_linear_put(&l->F, i + 1, k, -1);
}

static void circuit(stf_linear *l, ladder *q, stf_random *r)
{
  for (sunindextype i = 0; i < q->n; i++) {
    const sunrealtype C = stf_random_in(r, 1e-6, 2e-6);
    stf_linear_put(&l->E, i, i, C);
    if (i == 0) q->C0 = C;
    if (i < q->n - 1) rung(l, q, i, r);
  }
  stf_linear_put(&l->F, 0, source(q), 1);
  stf_linear_put(&l->F, source(q), 0, 1);
  l->index[source(q)] = 2;
  for (sunindextype j = 0; j < q->cuts; j++) {
    const sunindextype a = pair(q, j), k = a + 1, i = tapped(j);
    stf_linear_put(&l->E, k, k, q->l[j] = stf_random_in(r, 1e-3, 2e-3));
    stf_linear_put(&l->F, k, a, -1);
    stf_linear_put(&l->F, k, i, 1);
    stf_linear_put(&l->F, i, k, -1);
    stf_linear_put(&l->F, a, k, 1);
    l->index[a] = 2;
  }
}

/* Volts in rows of voltages and starts of potentials, hundredths of amperes in the others. */
static void signals(stf_linear *l, const ladder *q, stf_random *r)
{
  const sunindextype k = current(q), V = source(q);
  for (sunindextype i = 0; i < l->n; i++) {
    const bool odd = i > V && (i - V) % 2 == 0; /* k_j */
    const bool volts = (i >= k && i <= V) || odd, potential = i < k || (i > V && !odd);
    const sunrealtype most = volts ? 1 : 0.01, start = potential ? 1 : 0.01;
    const sunrealtype size = stf_random_in(r, -most, most), pace = stf_random_in(r, 100, 1000);
    stf_linear_wave(l, i, size, pace, stf_random_in(r, 0, 6));
    l->start[i] = stf_random_in(r, -start, start);
  }
}

static int data(stf_linear *l, sunindextype n)
{
  ladder *q = stf_pool_array(l->pool, 1, sizeof *q);
  if (!q) return STEIF_NO_MEMORY;
  *q = (ladder){.n = n, .cuts = n / 5};
  q->R = stf_pool_array(l->pool, (size_t)(n + q->cuts), sizeof *q->R);
  q->l = q->R + n;
  l->data = q;
  return q->R ? STEIF_OK : STEIF_NO_MEMORY;
}

static int build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  int nodes;
  stf_random r;
  STEIF_TRY(
    stf_spec_only(ctx, spec, (const char *const[]){"n", "seed", "case", "storage", NULL}));
  STEIF_TRY(stf_spec_int(ctx, spec, "n", 2, 10000000, 200, &nodes));
  STEIF_TRY(stf_random_seed(ctx, spec, &r));
  const sunindextype n = nodes, cuts = n / 5, all = 3 * n - 1 + 2 * cuts;
  stf_linear *l = stf_linear_open(ctx, self, all, 2 * n + cuts, 8 * n + 2 + 4 * cuts, all);
  if (!l || data(l, n)) return STEIF_NO_MEMORY;
  ladder *q = l->data;
  circuit(l, q, &r);
  signals(l, q, &r);
  l->dae_index = 2;
  l->finite = 2 * n - 2;
  l->jump = jump;
  return stf_linear_finish(ctx, spec, self);
}

const steif_problem steif_problem_ladder = {
  .about =
    "RLC ladder of n=200 nodes with a loop of capacitor and voltage source and cutsets of "
    "inductor and current source, index 2, impulses in the source's current and in node "
    "voltages "
    "(case=inc); C. Tischendorf, Surv. Math. Ind. 8 (1999) 187-199",
  .t1 = 0.01,
  .storage = STEIF_SPARSE,
  .build = build,
  STF_LINEAR_CALLBACKS,
};
