/* planted.c: sparse pencils of whole numbers.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted.h"
#include "prime_field.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

static int between(planted *p, int least, int most)
{
  return least + (int)stf_random_below(&p->random, most - least + 1);
}

static void add(sunrealtype *A, int n, int i, int j, sunrealtype x) { A[j * n + i] += x; }

/* -- whole ---------------------------------------------------------------------------------- */

/* One block at `at`: a pair a +- i w, one eigenvalue, or a chain at infinity; its order. */
static int put_block(planted *p, int at)
{
  const int n = p->n, what = between(p, 0, 3), room = n - at;
  if (what == 0 && room >= 2) {
    const sunrealtype a = between(p, 0, 8) / 4., w = between(p, 1, 12);
    for (int i = 0; i < 2; i++) {
      add(p->E, n, at + i, at + i, 1);
      add(p->F, n, at + i, at + i, a);
      add(p->F, n, at + i, at + 1 - i, i ? -w : w);
    }
    p->finite += 2;
    return 2;
  }
  if (what == 1) {
    add(p->E, n, at, at, between(p, 1, 4));
    add(p->F, n, at, at, between(p, 0, 20));
    p->finite++;
    return 1;
  }
  const int size = between(p, 1, room < 3 ? room : 3);
  for (int i = 0; i < size; i++) {
    add(p->F, n, at + i, at + i, 1);
    if (i + 1 < size) add(p->E, n, at + i, at + i + 1, 1);
  }
  p->index = size > p->index ? size : p->index;
  return size;
}

/* Row i += m row j, or column i += m column j. */
static void mix(planted *p, bool rows, int i, int j, sunrealtype m)
{
  const int n = p->n;
  sunrealtype *both[] = {p->E, p->F};
  for (int w = 0; w < 2; w++)
    for (int q = 0; q < n; q++)
      if (rows)
        both[w][q * n + i] += m * both[w][q * n + j];
      else
        both[w][i * n + q] += m * both[w][j * n + q];
}

static void make_whole(planted *p)
{
  for (int at = 0; at < p->n;) at += put_block(p, at);
  for (int k = between(p, p->n / 2, 2 * p->n); k > 0; k--) {
    const int i = between(p, 0, p->n - 1), j = between(p, 0, p->n - 1), m = between(p, 1, 3);
    if (i != j) mix(p, k % 2, i, j, between(p, 0, 1) ? m : -m);
  }
}

/* -- pattern and circuit ------------------------------------------------------------------------ */

static void make_pattern(planted *p)
{
  const int n = p->n;
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++) p->F[between(p, 0, n - 1) * n + i] = between(p, -4, 4);
    add(p->F, n, i, i, between(p, 0, 2));
    for (int k = between(p, 0, 2) ? 2 : 0; k > 0; k--)
      p->E[between(p, 0, n - 1) * n + i] = between(p, -3, 3);
  }
}

/* A conductance or capacitance between nodes a and b; -1 is ground. */
static void join(planted *p, sunrealtype *A, int a, int b, sunrealtype x)
{
  if (a >= 0) add(A, p->n, a, a, x);
  if (b >= 0) add(A, p->n, b, b, x);
  if (a >= 0 && b >= 0) add(A, p->n, a, b, -x), add(A, p->n, b, a, -x);
}

/* A current unknown from a to b, of a coil or of a source of voltage. */
static void branch(planted *p, int a, int b, int at)
{
  for (int end = 0; end < 2; end++) {
    const int node = end ? b : a;
    if (node < 0) continue;
    add(p->F, p->n, node, at, end ? -1 : 1);
    add(p->F, p->n, at, node, end ? -1 : 1);
  }
  if (between(p, 0, 2)) add(p->E, p->n, at, at, -between(p, 1, 4));
}

static void make_circuit(planted *p)
{
  const int nodes = between(p, 4, 20);
  int at = nodes;
  p->n = nodes + between(p, 2, 8);
  for (int k = 0; k < 3 * nodes; k++) {
    const int a = between(p, -1, nodes - 1), b = between(p, -1, nodes - 1),
              what = between(p, 0, 2);
    if (a == b) continue;
    if (what < 2)
      join(p, what ? p->E : p->F, a, b, between(p, 1, 5));
    else if (at < p->n)
      branch(p, a, b, at++);
  }
  for (; at < p->n; at++) add(p->F, p->n, at, at, 1);
}

/* -- truth ------------------------------------------------------------------------------------ */

static SUNMatrix matrix(steif_context *ctx, const planted *p, const sunrealtype *A)
{
  SUNMatrix M = SUNDenseMatrix(p->n, p->n, steif_sundials(ctx));
  if (M) memcpy(SM_DATA_D(M), A, (size_t)p->n * (size_t)p->n * sizeof *A);
  return M;
}

static int look_exactly(steif_context *ctx, SUNMatrix E, SUNMatrix F, planted *p)
{
  sunindextype weyr[PLANTED_MOST];
  stf_field field;
  STEIF_TRY(stf_field_open(ctx, E, F, false, &field));
  field.prime[0] = field.prime[1] = ((uint64_t)1 << 61) - 1;
  STEIF_TRY(stf_field_singular(ctx, &field, &p->singular));
  if (p->singular) return STEIF_OK;
  STEIF_TRY(stf_field_chains(ctx, &field, PLANTED_MOST, weyr, &p->index));
  p->finite = p->n;
  for (int k = 0; k < p->index; k++) p->finite -= (int)weyr[k];
  return STEIF_OK;
}

static int find_truth(steif_context *ctx, planted *p)
{
  SUNMatrix E = matrix(ctx, p, p->E), F = matrix(ctx, p, p->F);
  const int code = E && F ? look_exactly(ctx, E, F, p)
                          : STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a pencil");
  if (E) SUNMatDestroy(E);
  if (F) SUNMatDestroy(F);
  return code;
}

int planted_new(steif_context *ctx, enum planted_kind kind, long seed, planted *p)
{
  memset(p, 0, sizeof *p);
  p->random.state = (uint64_t)seed * 7919u + 104729u * (uint64_t)kind;
  p->n = between(p, 12, PLANTED_MOST);
  if (kind == PLANTED_DENSE) planted_dense(p);
  if (kind == PLANTED_WHOLE) make_whole(p);
  if (kind == PLANTED_PATTERN) make_pattern(p);
  if (kind == PLANTED_CIRCUIT) make_circuit(p);
  return kind < PLANTED_PATTERN ? STEIF_OK : find_truth(ctx, p);
}

const char *planted_name(enum planted_kind kind)
{
  static const char *const name[] = {"dense", "whole", "pattern", "circuit"};
  return name[kind];
}
