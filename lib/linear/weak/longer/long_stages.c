/* long_stages.c: Runge-Kutta methods with regular A in long double. With omega = A^{-1} the stages solve
 *   E (1/h) sum_j omega_ij (X_j - x_n) + F X_i = f(t_n + c_i h),
 * and x_{n+1} = x_n + sum_j w_j (X_j - x_n), w = b^T omega; X_s where b is the last row of A.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "longer.h"
#include "table.h"
#include <math.h>
#include <string.h>

typedef struct stages {
  stf_longer *run;
  int s;
  bool stiffly; /* accurate */
  long double omega[STEIF_STAGES * STEIF_STAGES], w[STEIF_STAGES], b[STEIF_STAGES],
    c[STEIF_STAGES];
  stf_long_matrix matrix; /* of order s n */
  long double *x, *X;     /* n, s n */
} stages;

/* Nodes of the families of collocation; their weights integrate polynomials through them. */
static bool nodes(steif_context *ctx, const char *name, int s, long double *c)
{
  static const struct {
    const char *name;
    enum stf_node_kind kind;
  } known[] = {{"gauss", STF_GAUSS},
               {"radau", STF_RADAU_RIGHT},
               {"radau1a", STF_RADAU_LEFT},
               {"lobatto3c", STF_LOBATTO}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (!strcmp(name, known[i].name)) return stf_nodes(ctx, known[i].kind, s, c) == STEIF_OK;
  return false;
}

/* b_j = int_0^1 l_j by Gauss's rule. */
static void weights(int s, const long double *c, long double *b)
{
  long double node[STEIF_STAGES], w[STEIF_STAGES];
  stf_gauss(s, node, w);
  for (int j = 0; j < s; j++) {
    b[j] = 0;
    for (int q = 0; q < s; q++) {
      long double l = 1;
      for (int k = 0; k < s; k++)
        if (k != j) l *= (node[q] - c[k]) / (c[j] - c[k]);
      b[j] += w[q] * l;
    }
  }
}

/* X := A^{-1} for A (s x s). */
static bool invert(int s, long double *A, long double *X)
{
  int pivot[STEIF_STAGES];
  const stf_long_matrix m = {s, A, pivot};
  long double column[STEIF_STAGES];
  if (!stf_long_factor(&(stf_long_matrix){s, A, pivot})) return false;
  for (int j = 0; j < s; j++) {
    for (int i = 0; i < s; i++) column[i] = i == j;
    stf_long_solve(&m, column);
    for (int i = 0; i < s; i++) X[i * s + j] = column[i];
  }
  return true;
}

static int coefficients(stages *g, const steif_table *table)
{
  stf_longer *r = g->run;
  const int s = g->s = table->s;
  long double A[STEIF_STAGES * STEIF_STAGES];
  for (int i = 0; i < s * s; i++)
    A[i] = table->A_low ? table->A[i] + (long double)table->A_low[i]
                        : table->A[i] * stf_longer_shake(r);
  g->stiffly = table->claims & STEIF_STIFFLY_ACCURATE;
  if (nodes(r->ctx, table->name, s, g->c))
    weights(s, g->c, g->b);
  else
    for (int i = 0; i < s; i++) {
      g->c[i] = table->c[i];
      g->b[i] = table->b[i] * stf_longer_shake(r);
    }
  for (int i = 0; g->stiffly && i < s; i++) g->b[i] = A[(s - 1) * s + i];
  STEIF_CHECK(invert(s, A, g->omega), r->ctx, STEIF_UNSUPPORTED, "A of table '%s' is singular",
              table->name);
  for (int j = 0; j < s; j++) {
    g->w[j] = 0;
    for (int i = 0; i < s; i++) g->w[j] += g->b[i] * g->omega[i * s + j];
  }
  return STEIF_OK;
}

static int factor(stages *g)
{
  const stf_longer *r = g->run;
  const size_t n = (size_t)r->n, s = (size_t)g->s, order = s * n;
  for (size_t i = 0; i < s; i++)
    for (size_t j = 0; j < s; j++)
      for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l < n; l++)
          g->matrix.a[(i * n + k) * order + j * n + l] =
            g->omega[i * s + j] / r->h * r->E[k * n + l] + (i == j ? r->F[k * n + l] : 0);
  STEIF_CHECK(stf_long_factor(&g->matrix), r->ctx, STEIF_SINGULAR,
              "the system of the stages is singular at h = %Lg", r->h);
  return STEIF_OK;
}

static int step(stages *g, size_t i)
{
  stf_longer *r = g->run;
  const int s = g->s;
  const size_t n = (size_t)r->n;
  for (int k = 0; k < s; k++) {
    long double sum = 0, *to = g->X + (size_t)k * n;
    for (int j = 0; j < s; j++) sum += g->omega[k * s + j];
    STEIF_TRY(stf_longer_force(r, i, g->c[k], to));
    stf_long_multiply(r->n, r->E, sum / r->h, g->x, to);
  }
  stf_long_solve(&g->matrix, g->X);
  for (int k = 0; k < s; k++)
    STEIF_TRY(stf_pairing_stage(r->pairing, i, g->c[k], g->b[k], g->X + (size_t)k * n));
  for (size_t l = 0; l < n; l++) {
    long double sum = g->x[l];
    for (int k = 0; k < s; k++) sum += g->w[k] * (g->X[(size_t)k * n + l] - g->x[l]);
    g->x[l] = g->stiffly ? g->X[((size_t)s - 1) * n + l] : sum;
  }
  return stf_pairing_node(r->pairing, i + 1, g->x);
}

static int follow(stages *g, const steif_table *table)
{
  stf_longer *r = g->run;
  STEIF_TRY(coefficients(g, table));
  STEIF_TRY(factor(g));
  for (int k = 0; k < r->n; k++) g->x[k] = r->continued ? r->state[k] : (long double)r->x0[k];
  STEIF_TRY(stf_pairing_node(r->pairing, 0, g->x));
  for (size_t i = 0; i < r->steps; i++) STEIF_TRY(step(g, i));
  if (r->state) memcpy(r->state, g->x, (size_t)r->n * sizeof *r->state);
  return STEIF_OK;
}

int stf_longer_stages(stf_longer *run, const char *method)
{
  const char *spec = !strncmp(method, "dirk:", 5) ? method + 5 : method;
  steif_table *table = steif_table_new(run->ctx, spec);
  if (!table) return steif_status(run->ctx);
  const size_t n = (size_t)run->n, order = (size_t)table->s * n;
  stages *g = stf_allocate(run->ctx, 1, sizeof *g);
  long double *room = stf_allocate(run->ctx, order * (order + 1) + n, sizeof *room);
  int *pivot = stf_allocate(run->ctx, order, sizeof *pivot);
  int code = STEIF_NO_MEMORY;
  if (g && room && pivot) {
    *g = (stages){.run = run, .matrix = {(int)order, room, pivot}};
    g->X = room + order * order, g->x = g->X + order;
    code = follow(g, table);
  }
  stf_release(run->ctx, g);
  stf_release(run->ctx, room);
  stf_release(run->ctx, pivot);
  steif_table_free(run->ctx, &table);
  return code;
}
