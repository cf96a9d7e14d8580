/* real_table.c: coefficients of Runge-Kutta methods in many digits: nodes by Newton's iteration from those
 * in long double on the recurrences of nodes.c, a_ij = int_0^{c_i} l_j and b_j = int_0^1 l_j by the powers
 * of Lagrange's polynomials l_j, Radau IA and Lobatto IIIC from them as their own files say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "real_table.h"
#include <string.h>

enum { NEWTON = 6, OTHER = -1 };

typedef struct builder {
  int limbs, s, kind; /* kind: enum stf_node_kind, or OTHER */
  stf_real_table *table;
} builder;

/* x := (k x - y) / (k + 1) */
static void recur(int limbs, int k, stf_real *x, const stf_real *y)
{
  const stf_real factor = stf_real_of(k), divisor = stf_real_of(k + 1);
  stf_real_multiply(limbs, x, &factor, x);
  stf_real_subtract(limbs, x, y, x);
  stf_real_divide(limbs, x, &divisor, x);
}

/* c -= f(c) / f'(c), f of the kind. */
static void newton(const builder *z, stf_real *c)
{
  const int L = z->limbs;
  stf_real q = stf_real_of(1), dq = {0}, e = {0}, de = {0}, e0 = {0}, de0 = {0}, t;
  for (int k = 0; k < z->s; k++) {
    const stf_real slope = stf_real_of(2 * (2 * k + 1));
    e0 = e, de0 = de;
    t = q;
    stf_real_gather(L, 1, c, &dq, &t);
    stf_real_multiply(L, &t, &slope, &t);
    recur(L, k, &de, &t);
    stf_real_multiply(L, c, &q, &t);
    stf_real_multiply(L, &t, &slope, &t);
    recur(L, k, &e, &t);
    stf_real_add(L, &q, &e, &q);
    stf_real_add(L, &dq, &de, &dq);
  }
  if (z->kind == STF_RADAU_RIGHT) {
    stf_real_add(L, &q, &q, &q), stf_real_subtract(L, &q, &e, &q);
    stf_real_add(L, &dq, &dq, &dq), stf_real_subtract(L, &dq, &de, &dq);
  } else if (z->kind == STF_RADAU_LEFT)
    q = e, dq = de;
  else if (z->kind == STF_LOBATTO)
    stf_real_add(L, &e, &e0, &q), stf_real_add(L, &de, &de0, &dq);
  stf_real_divide(L, &q, &dq, &t);
  stf_real_subtract(L, c, &t, c);
}

static int nodes(steif_context *ctx, const builder *z)
{
  long double start[STEIF_STAGES];
  STEIF_TRY(stf_nodes(ctx, (enum stf_node_kind)z->kind, z->s, start));
  for (int i = 0; i < z->s; i++) {
    z->table->c[i] = stf_real_of(start[i]);
    const bool end = start[i] == 0 || start[i] == 1;
    for (int k = 0; k < NEWTON && !end; k++) newton(z, z->table->c + i);
  }
  return STEIF_OK;
}

/* Powers of l_j; the product of c_j - c_k. */
static void lagrange(const builder *z, int j, stf_real *l, stf_real *product)
{
  const int L = z->limbs;
  const stf_real *c = z->table->c;
  int degree = 0;
  *product = l[0] = stf_real_of(1);
  for (int k = 0; k < z->s; k++) {
    stf_real gap;
    if (k == j) continue;
    stf_real_subtract(L, c + j, c + k, &gap);
    stf_real_multiply(L, product, &gap, product);
    l[++degree] = (stf_real){0};
    for (int q = degree; q >= 0; q--) {
      stf_real t = q ? l[q - 1] : (stf_real){0};
      stf_real_gather(L, -1, c + k, l + q, &t);
      l[q] = t;
    }
  }
  for (int q = 0; q <= degree; q++) stf_real_divide(L, l + q, product, l + q);
}

/* int_0^x l */
static void integral(const builder *z, const stf_real *l, const stf_real *x, stf_real *out)
{
  const int L = z->limbs;
  *out = (stf_real){0};
  for (int q = z->s - 1; q >= 0; q--) {
    const stf_real divisor = stf_real_of(q + 1);
    stf_real t;
    stf_real_divide(L, l + q, &divisor, &t);
    stf_real_add(L, out, &t, out);
    stf_real_multiply(L, out, x, out);
  }
}

/* a_ij = b_j - b_j a^_ji / b_i from a^ of collocation, kept in omega meanwhile. */
static void adjoin(const builder *z)
{
  const int L = z->limbs, s = z->s;
  stf_real_table *t = z->table;
  memcpy(t->omega, t->A, (size_t)(s * s) * sizeof *t->A);
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++) {
      stf_real part;
      stf_real_divide(L, t->omega + j * s + i, t->b + i, &part);
      t->A[i * s + j] = t->b[j];
      stf_real_gather(L, -1, t->b + j, &part, t->A + i * s + j);
    }
}

/* a_ij += (b_1 - a_i1) v_j / v_1, 1 / v_j the products of lagrange(). */
static void fix_first_column(const builder *z, const stf_real *product)
{
  const int L = z->limbs, s = z->s;
  stf_real_table *t = z->table;
  for (int i = 0; i < s; i++) {
    stf_real missing, ratio;
    stf_real_subtract(L, t->b, t->A + i * s, &missing);
    for (int j = 0; j < s; j++) {
      stf_real_divide(L, product, product + j, &ratio);
      stf_real_gather(L, 1, &missing, &ratio, t->A + i * s + j);
    }
  }
}

static int collocation(steif_context *ctx, const builder *z)
{
  const int s = z->s;
  const stf_real one = stf_real_of(1);
  stf_real_table *t = z->table;
  stf_real *l = stf_allocate(ctx, 2 * STEIF_STAGES, sizeof *l), *product = l + STEIF_STAGES;
  if (!l) return STEIF_NO_MEMORY;
  const int code = nodes(ctx, z);
  for (int j = 0; j < s && !code; j++) {
    lagrange(z, j, l, product + j);
    integral(z, l, &one, t->b + j);
    for (int i = 0; i < s; i++) integral(z, l, t->c + i, t->A + i * s + j);
  }
  if (!code && z->kind == STF_RADAU_LEFT) adjoin(z);
  if (!code && z->kind == STF_LOBATTO) fix_first_column(z, product);
  stf_release(ctx, l);
  return code;
}

static long double shake(stf_random *shaken)
{
  return shaken ? 1 + (long double)STF_EPS * stf_random_in(shaken, -1, 1) : 1;
}

static void copied(const builder *z, const steif_table *given, stf_random *shaken)
{
  stf_real_table *t = z->table;
  for (int i = 0; i < z->s * z->s; i++)
    t->A[i] = stf_real_of(given->A[i] * shake(given->A[i] == 1 ? NULL : shaken));
  for (int i = 0; i < z->s; i++) {
    t->c[i] = stf_real_of(given->c[i]);
    t->b[i] = stf_real_of(given->b[i] * shake(given->b[i] == 1 ? NULL : shaken));
  }
}

static int kind_of(const char *name)
{
  static const struct {
    const char *name;
    int kind;
  } known[] = {{"gauss", STF_GAUSS},
               {"radau", STF_RADAU_RIGHT},
               {"radau1a", STF_RADAU_LEFT},
               {"lobatto3c", STF_LOBATTO}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (!strcmp(name, known[i].name)) return known[i].kind;
  return OTHER;
}

/* omega and w; A is spent. */
static int invert(steif_context *ctx, const builder *z, const char *name)
{
  const int L = z->limbs, s = z->s;
  stf_real_table *t = z->table;
  stf_real_matrix m = {s, t->A, t->pivot};
  stf_real *column = t->w; /* room */
  for (int j = 0; j < s && t->stiffly; j++) t->b[j] = t->A[(s - 1) * s + j];
  STEIF_CHECK(stf_real_factor(L, &m), ctx, STEIF_UNSUPPORTED, "A of table '%s' is singular",
              name);
  for (int j = 0; j < s; j++) {
    for (int i = 0; i < s; i++) column[i] = stf_real_of(i == j);
    stf_real_solve(L, &m, column);
    for (int i = 0; i < s; i++) t->omega[i * s + j] = column[i];
  }
  for (int j = 0; j < s; j++) {
    t->w[j] = (stf_real){0};
    for (int i = 0; i < s; i++) stf_real_gather(L, 1, t->b + i, t->omega + i * s + j, t->w + j);
  }
  return STEIF_OK;
}

static int fill(steif_context *ctx, const steif_table *given, int limbs, stf_random *shaken,
                stf_real_table *t)
{
  const int s = given->s;
  const builder z = {limbs, s, kind_of(given->name), t};
  t->omega = stf_allocate(ctx, (size_t)(2 * s * s + 3 * s), sizeof *t->omega);
  if (!t->omega) return STEIF_NO_MEMORY;
  t->A = t->omega + s * s, t->b = t->A + s * s, t->c = t->b + s, t->w = t->c + s;
  t->s = s, t->full = z.kind != OTHER;
  t->stiffly = given->claims & STEIF_STIFFLY_ACCURATE;
  if (t->full)
    STEIF_TRY(collocation(ctx, &z));
  else
    copied(&z, given, shaken);
  return invert(ctx, &z, given->name);
}

int stf_real_table_open(steif_context *ctx, const char *method, int limbs, stf_random *shaken,
                        stf_real_table *table)
{
  *table = (stf_real_table){0};
  steif_table *given = steif_table_new(ctx, !strncmp(method, "dirk:", 5) ? method + 5 : method);
  if (!given) return steif_status(ctx);
  const int code = fill(ctx, given, limbs, shaken, table);
  steif_table_free(ctx, &given);
  return code;
}

void stf_real_table_close(steif_context *ctx, stf_real_table *table)
{
  stf_release(ctx, table->omega);
  *table = (stf_real_table){0};
}
