/* exact_stages.c: Runge-Kutta methods with regular A in many digits, as long_stages.c has them in long double.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include "real_table.h"

enum { LARGEST = 96 }; /* order of the dense systems */

typedef struct stages {
  stf_exact_run *run;
  stf_real_table table;
  stf_real over_h[STEIF_STAGES]; /* row sums of omega / h */
  long double c[STEIF_STAGES];
  int order[STEIF_STAGES]; /* of stages by their times */
  stf_real_matrix matrix;  /* of order s n */
  stf_real *x, *X;         /* n, s n */
} stages;

static int factor(stages *g)
{
  const stf_exact_run *r = g->run;
  const stf_real_table *t = &g->table;
  const int L = r->limbs;
  const size_t n = (size_t)r->of.n, s = (size_t)t->s, order = s * n;
  for (size_t i = 0; i < s; i++) {
    g->over_h[i] = (stf_real){0};
    g->c[i] = stf_real_value(t->c + i);
    for (size_t j = 0; j < s; j++) {
      stf_real part;
      stf_real_divide(L, t->omega + i * s + j, &r->h, &part);
      stf_real_add(L, g->over_h + i, &part, g->over_h + i);
      for (size_t k = 0; k < n; k++)
        for (size_t l = 0; l < n; l++) {
          stf_real *a = g->matrix.a + (i * n + k) * order + j * n + l;
          *a = i == j ? r->F[k * n + l] : (stf_real){0};
          stf_real_gather(L, 1, &part, r->E + k * n + l, a);
        }
    }
  }
  STEIF_CHECK(stf_real_factor(L, &g->matrix), r->of.ctx, STEIF_SINGULAR,
              "the system of the stages is singular at h = %Lg", r->of.h);
  return STEIF_OK;
}

/* x_{n+1} = x_n + sum_j w_j (X_j - x_n) */
static void advance(stages *g)
{
  const int L = g->run->limbs, s = g->table.s;
  const size_t n = (size_t)g->run->of.n;
  for (size_t l = 0; l < n; l++) {
    stf_real sum = g->x[l], away;
    for (int k = 0; k < s && !g->table.stiffly; k++) {
      stf_real_subtract(L, g->X + (size_t)k * n + l, g->x + l, &away);
      stf_real_gather(L, 1, g->table.w + k, &away, &sum);
    }
    g->x[l] = g->table.stiffly ? g->X[((size_t)s - 1) * n + l] : sum;
  }
}

static int step(stages *g, size_t i)
{
  stf_exact_run *r = g->run;
  const size_t n = (size_t)r->of.n;
  for (int k = 0; k < g->table.s; k++) {
    STEIF_TRY(stf_exact_force(r, i, g->c[k], g->X + (size_t)k * n));
    stf_real_apply(r->limbs, r->of.n, r->E, g->over_h + k, g->x, g->X + (size_t)k * n);
  }
  stf_real_solve(r->limbs, &g->matrix, g->X);
  for (int j = 0; j < g->table.s; j++) {
    const int k = g->order[j];
    stf_exact_stage(r, i, g->table.c + k, g->table.b + k, g->X + (size_t)k * n);
  }
  advance(g);
  stf_exact_node(r, i + 1, g->x);
  return STEIF_OK;
}

static int follow(stages *g)
{
  stf_exact_run *r = g->run;
  STEIF_TRY(factor(g));
  stf_exact_begin(r, g->x);
  stf_exact_node(r, 0, g->x);
  for (size_t i = 0; i < r->of.steps; i++) STEIF_TRY(step(g, i));
  stf_exact_end(r, g->x);
  return STEIF_OK;
}

/* Masses are taken in the order of time. */
static int put_in_order(stages *g)
{
  const stf_exact_run *r = g->run;
  const stf_real *c = g->table.c;
  const int s = g->table.s;
  for (int i = 0, k; i < s; i++) {
    for (k = i; k > 0 && stf_real_compare(r->limbs, c + g->order[k - 1], c + i) > 0; k--)
      g->order[k] = g->order[k - 1];
    g->order[k] = i;
  }
  const bool within =
    stf_real_value(c + g->order[0]) >= 0 && stf_real_value(c + g->order[s - 1]) <= 1;
  STEIF_CHECK(within || !r->integrals, r->of.ctx, STEIF_UNSUPPORTED,
              "nodes of '%s' lie outside of the step, so norms are not known in many digits: "
              "leave .exact out",
              r->of.method);
  return STEIF_OK;
}

static int open(stages *g)
{
  stf_exact_run *r = g->run;
  const size_t n = (size_t)r->of.n, order = (size_t)g->table.s * n;
  STEIF_CHECK(order <= LARGEST, r->of.ctx, STEIF_UNSUPPORTED,
              "%zu stage values are too many for a run in many digits, %d are the most", order,
              LARGEST);
  g->matrix = (stf_real_matrix){
    (int)order, stf_allocate(r->of.ctx, order * order + order + n, sizeof(stf_real)),
    stf_allocate(r->of.ctx, order, sizeof(int))};
  if (!g->matrix.a || !g->matrix.pivot) return STEIF_NO_MEMORY;
  g->X = g->matrix.a + order * order;
  g->x = g->X + order;
  return STEIF_OK;
}

int stf_exact_stages(stf_exact_run *run)
{
  steif_context *ctx = run->of.ctx;
  stages *g = stf_allocate(ctx, 1, sizeof *g);
  if (!g) return STEIF_NO_MEMORY;
  g->run = run;
  int code = stf_real_table_open(ctx, run->of.method, run->limbs,
                                 run->of.shaken ? &run->of.random : NULL, &g->table);
  if (!code) code = put_in_order(g);
  if (!code) code = open(g);
  if (!code) code = follow(g);
  stf_release(ctx, g->matrix.a);
  stf_release(ctx, g->matrix.pivot);
  stf_real_table_close(ctx, &g->table);
  stf_release(ctx, g);
  return code;
}
