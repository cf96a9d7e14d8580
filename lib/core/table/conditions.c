/* conditions.c: order conditions over all rooted trees, and the stability function.
 *
 * A tree [t_1 .. t_m] has the stage weights Phi_i = prod_k (A Phi(t_k))_i and the density
 * gamma = |t| prod_k gamma(t_k); order p asks for sum b_i Phi_i = 1/gamma for every tree with
 * at most p vertices (Butcher; Hairer, Norsett, Wanner: Solving ODEs I, II.2).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <math.h>

/* 1 + 1 + 2 + 4 + 9 + 20 + 48 rooted trees with at most 7 vertices are grafted together. */
enum { ORDERS = 8, TREES = 85 };

typedef struct forest {
  const steif_table *table;
  const sunrealtype *b;
  int p, count; /* vertices of the trees being made; trees kept */
  int order[TREES];
  long double gamma[TREES];
  long double branch[TREES][STEIF_STAGES]; /* A Phi */
  long double worst;                       /* largest defect of order p */
} forest;

static void keep(forest *f, long double gamma, const long double *phi)
{
  const int s = f->table->s, n = f->count++;
  f->order[n] = f->p, f->gamma[n] = gamma;
  for (int i = 0; i < s; i++) {
    f->branch[n][i] = 0;
    for (int j = 0; j < s; j++) f->branch[n][i] += (long double)f->table->A[i * s + j] * phi[j];
  }
}

static void measure(forest *f, long double gamma, const long double *phi)
{
  long double sum = -1 / gamma;
  for (int i = 0; i < f->table->s; i++) sum += (long double)f->b[i] * phi[i];
  if (!(fabsl(sum) <= f->worst)) f->worst = fabsl(sum);
}

/* Graft onto the root `phi`, `gamma` all sets of kept trees with `left` vertices in all and
 * numbers not above `highest`; each set once, as its numbers do not ascend. */
static void grow(forest *f, int last, int left, int highest, long double gamma,
                 const long double *phi)
{
  if (left == 0) {
    if (f->p == last)
      measure(f, gamma, phi);
    else
      keep(f, gamma, phi);
    return;
  }
  for (int n = highest; n >= 0; n--) {
    if (f->order[n] > left) continue;
    long double product[STEIF_STAGES];
    for (int i = 0; i < f->table->s; i++) product[i] = phi[i] * f->branch[n][i];
    grow(f, last, left - f->order[n], n, gamma * f->gamma[n], product);
  }
}

int steif_table_defect(steif_context *ctx, const steif_table *table, int p, int hat,
                       sunrealtype *defect)
{
  STEIF_TRY(stf_table_check(ctx, table));
  STEIF_CHECK(
    defect && p >= 1 && p <= ORDERS, ctx, STEIF_BAD_INPUT,
    "order conditions are computed for orders 1 to %d into a result, not for order %d", ORDERS,
    p);
  STEIF_CHECK(!hat || table->bhat, ctx, STEIF_BAD_INPUT,
              "table '%s' has no embedded weights; ask with hat = 0", table->name);
  forest f = {.table = table, .b = hat ? table->bhat : table->b};
  long double root[STEIF_STAGES];
  for (int i = 0; i < table->s; i++) root[i] = 1;
  for (f.p = 1; f.p <= p; f.p++) grow(&f, p, f.p - 1, f.count - 1, f.p, root);
  *defect = (sunrealtype)f.worst;
  return STEIF_OK;
}

/* The matrix w - z A and (unless NULL) ones, of the stages from `first` on. */
static void system_of(const steif_table *t, int first, stf_complex w, stf_complex z,
                      stf_complex *K, stf_complex *x)
{
  const int n = t->s - first;
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < n; j++)
      K[i * n + j] = (i == j ? w : 0) - z * t->A[(first + i) * t->s + first + j];
    if (x) x[i] = 1;
  }
}

static stf_complex weigh(const steif_table *t, int first, const stf_complex *x)
{
  stf_complex sum = 0;
  for (int i = first; i < t->s; i++) sum += t->b[i] * x[i - first];
  return sum;
}

/* b = e_s^T A: then R(z) = e_s^T (1 - z A)^{-1} 1, which does not cancel at large z. */
static bool ends_in_last_stage(const steif_table *t)
{
  bool same = true;
  for (int j = 0; j < t->s; j++) same = same && t->b[j] == t->A[(t->s - 1) * t->s + j];
  return same;
}

static long double largest(const steif_table *t)
{
  long double most = 0;
  for (int i = 0; i < t->s * t->s; i++)
    if (fabsl((long double)t->A[i]) > most) most = fabsl((long double)t->A[i]);
  return most;
}

/* A = [0 0; a A2], b = (b_1, b2): (w - A)^{-1} 1 = (1/w, (w - A2)^{-1} (1 + a/w)), so with
 * u = A2^{-1} a, R = 1 + (b_1 - b2.u)/w - b2.A2^{-1} (1 + u) + O(w). */
static bool limit(const steif_table *t, stf_complex *R)
{
  stf_complex K[STEIF_STAGES * STEIF_STAGES], x[STEIF_STAGES];
  const int s = t->s, n = s - 1;
  const long double tiny = 4 * STF_EPS * largest(t);
  for (int j = 0; j < s; j++)
    if (t->A[j] != 0) return false;
  system_of(t, 1, 0, -1, K, NULL);
  for (int i = 0; i < n; i++) x[i] = t->A[(i + 1) * s];
  if (!stf_solve(n, 1, K, x, tiny)) return false;
  const stf_complex growth = t->b[0] - weigh(t, 1, x);
  for (int i = 0; i < n; i++) x[i] += 1;
  system_of(t, 1, 0, -1, K, NULL);
  (void)stf_solve(n, 1, K, x, tiny);
  const bool bounded = ends_in_last_stage(t) || cabsl(growth) <= 1e-13L;
  *R = bounded ? 1 - weigh(t, 1, x) : (stf_complex)INFINITY;
  return true;
}

static int at_infinity(steif_context *ctx, const steif_table *t, stf_complex *R)
{
  stf_complex K[STEIF_STAGES * STEIF_STAGES], x[STEIF_STAGES];
  *R = INFINITY; /* a polynomial 1 + z + ... */
  if (t->kind == STEIF_EXPLICIT) return STEIF_OK;
  system_of(t, 0, 0, -1, K, x);
  if (stf_solve(t->s, 1, K, x, 4 * STF_EPS * largest(t))) {
    *R = ends_in_last_stage(t) ? 0 : 1 - weigh(t, 0, x);
    return STEIF_OK;
  }
  STEIF_CHECK(
    limit(t, R), ctx, STEIF_UNSUPPORTED,
    "R(inf) of table '%s' is not computed: its A is singular beyond an explicit first "
    "stage; evaluate R at a large z",
    t->name);
  return STEIF_OK;
}

/* For |z| > 1 in the form 1 + b^T (1/z - A)^{-1} 1, which does not overflow. */
static stf_complex finite(const steif_table *t, stf_complex z)
{
  stf_complex K[STEIF_STAGES * STEIF_STAGES], x[STEIF_STAGES];
  const bool large = cabsl(z) > 1;
  system_of(t, 0, large ? 1 / z : 1, large ? 1 : z, K, x);
  if (!stf_solve(t->s, 1, K, x, 0)) return INFINITY; /* a pole */
  if (ends_in_last_stage(t)) return (large ? 1 / z : 1) * x[t->s - 1];
  return 1 + (large ? 1 : z) * weigh(t, 0, x);
}

int steif_table_stability(steif_context *ctx, const steif_table *table, const sunrealtype z[2],
                          sunrealtype R[2])
{
  STEIF_TRY(stf_table_check(ctx, table));
  STEIF_CHECK(z && R && !isnan(z[0]) && !isnan(z[1]), ctx, STEIF_BAD_INPUT,
              "R(z) of table '%s' needs a number z and a place for the result", table->name);
  stf_complex value;
  if (isinf(z[0]) || isinf(z[1]))
    STEIF_TRY(at_infinity(ctx, table, &value));
  else
    value = finite(table, (long double)z[0] + (long double)z[1] * I);
  R[0] = (sunrealtype)creall(value), R[1] = (sunrealtype)cimagl(value);
  return STEIF_OK;
}
