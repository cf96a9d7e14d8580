/* long_general.c: general linear methods with one real shift in long double, begun as their family does: by
 * Radau IIA within the first step. With G_i = sum_j U_ij X_j + h sum_l C_il K_l stage i solves
 *   E (G_i - base) / (gamma h) + F G_i = f(t_n + xi_i h),   K_i = (G_i - base) / (gamma h).
 * Entries of the tableau, and weights of the solution and of the start, are the doubles of the family.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "longer.h"
#include "general.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DATA = 2 * STEIF_PAST + STEIF_STAGES };

typedef struct general {
  stf_longer *run;
  const steif_glm *g;
  int k, r, n, count; /* count: of further values of the start */
  long double gamma;
  long double U[STEIF_STAGES * STEIF_PAST], V[STEIF_PAST * STEIF_PAST],
    C[STEIF_STAGES * STEIF_STAGES], D[STEIF_PAST * STEIF_STAGES];
  sunrealtype finish[DATA], *first; /* first: k x (count + 1) */
  stf_long_matrix matrix;
  long double *x, *X, *next, *K, *base; /* n, k n, k n, r n, n */
} general;

/* The one value on the diagonal of C; 0: there is none, or more than one. */
static sunrealtype shift_of(const steif_glm *g)
{
  if (stf_glm_shape(g) == STEIF_COLLOCATION) return 0;
  for (int i = 1; i < g->r; i++)
    if (g->C[i * (g->r + 1)] != g->C[0]) return 0;
  return g->C[0];
}

int stf_longer_general_serves(steif_context *ctx, const char *method, int *values)
{
  sunrealtype finish[DATA];
  *values = 0;
  steif_glm *g = steif_glm_new(ctx, method);
  if (!g) return STEIF_OK;
  if (shift_of(g) > 0 && !stf_glm_solution(ctx, g, finish)) *values = g->r;
  steif_glm_free(ctx, &g);
  return STEIF_OK;
}

/* Whole numbers are what they are. */
static void shake(stf_longer *run, int count, const sunrealtype *from, long double *to)
{
  for (int i = 0; i < count; i++)
    to[i] = from[i] == rint(from[i]) ? from[i] : from[i] * stf_longer_shake(run);
}

static int coefficients(general *m)
{
  const steif_glm *g = m->g;
  stf_longer *r = m->run;
  const size_t size = (size_t)m->n * (size_t)m->n;
  shake(r, m->r * m->k, g->U, m->U);
  shake(r, m->k * m->k, g->V, m->V);
  shake(r, m->r * m->r, g->C, m->C);
  shake(r, m->k * m->r, g->D, m->D);
  m->gamma = shift_of(g);
  for (int i = 0; i < m->r; i++) m->C[i * (m->r + 1)] = m->gamma;
  stf_glm_first(g, m->count, m->first);
  STEIF_TRY(stf_glm_solution(r->ctx, g, m->finish));
  for (size_t i = 0; i < size; i++) m->matrix.a[i] = r->E[i] / (m->gamma * r->h) + r->F[i];
  STEIF_CHECK(stf_long_factor(&m->matrix), r->ctx, STEIF_SINGULAR,
              "E/(gamma h) + F is singular at h = %Lg", r->h);
  return STEIF_OK;
}

static void add(int n, long double factor, const long double *x, long double *y)
{
  for (int l = 0; l < n && factor != 0; l++) y[l] += factor * x[l];
}

/* X from x(t), x(t + h / count), ..., x(t + h). */
static int begin(general *m)
{
  char radau[24];
  stf_longer *r = m->run;
  const size_t n = (size_t)m->n;
  long double *state = r->state;
  const stf_longer kept = *r;
  stf_pairing none = *r->pairing;
  int code = STEIF_OK;
  none.convention = STEIF_P, none.steps = 0, none.events = NULL;
  snprintf(radau, sizeof radau, "radau:s=%d", m->g->order / 2 + 2);
  memset(m->X, 0, n * (size_t)m->k * sizeof *m->X);
  memcpy(m->base, m->x, n * sizeof *m->base);
  for (int i = 0; i <= m->count && !code; i++) {
    if (i > 0) {
      r->h = kept.h / m->count, r->from = kept.from + (i - 1) * r->h, r->steps = 1;
      r->state = m->base, r->continued = true, r->pairing = &none;
      code = stf_longer_stages(r, radau);
    }
    for (int j = 0; j < m->k; j++)
      add(m->n, m->first[j * (m->count + 1) + i], m->base, m->X + (size_t)j * n);
  }
  r->h = kept.h, r->from = kept.from, r->steps = kept.steps;
  r->state = state, r->continued = kept.continued, r->pairing = kept.pairing;
  return code;
}

static int stages(general *m, size_t step)
{
  stf_longer *r = m->run;
  const size_t n = (size_t)m->n;
  for (int i = 0; i < m->r; i++) {
    long double *K = m->K + (size_t)i * n;
    memset(m->base, 0, n * sizeof *m->base);
    for (int j = 0; j < m->k; j++) add(m->n, m->U[i * m->k + j], m->X + (size_t)j * n, m->base);
    for (int l = 0; l < i; l++)
      add(m->n, r->h * m->C[i * m->r + l], m->K + (size_t)l * n, m->base);
    STEIF_TRY(stf_longer_force(r, step, m->g->xi[i], K));
    stf_long_multiply(m->n, r->E, 1 / (m->gamma * r->h), m->base, K);
    stf_long_solve(&m->matrix, K);
    for (size_t l = 0; l < n; l++) K[l] = (K[l] - m->base[l]) / (m->gamma * r->h);
  }
  return STEIF_OK;
}

static void advance(general *m)
{
  const size_t n = (size_t)m->n;
  const long double h = m->run->h;
  memset(m->next, 0, n * (size_t)m->k * sizeof *m->next);
  memset(m->x, 0, n * sizeof *m->x);
  for (int j = 0; j < m->k; j++) {
    long double *to = m->next + (size_t)j * n;
    for (int i = 0; i < m->k; i++) add(m->n, m->V[j * m->k + i], m->X + (size_t)i * n, to);
    for (int i = 0; i < m->r; i++) add(m->n, h * m->D[j * m->r + i], m->K + (size_t)i * n, to);
    add(m->n, m->finish[j], to, m->x);
    add(m->n, m->finish[m->k + m->r + j], m->X + (size_t)j * n, m->x);
  }
  for (int i = 0; i < m->r; i++) add(m->n, h * m->finish[m->k + i], m->K + (size_t)i * n, m->x);
  long double *old = m->X;
  m->X = m->next, m->next = old;
}

static int follow(general *m)
{
  stf_longer *r = m->run;
  for (int l = 0; l < m->n; l++) m->x[l] = r->continued ? r->state[l] : (long double)r->x0[l];
  STEIF_TRY(coefficients(m));
  STEIF_TRY(begin(m));
  STEIF_TRY(stf_pairing_node(r->pairing, 0, m->x));
  for (size_t i = 0; i < r->steps; i++) {
    STEIF_TRY(stages(m, i));
    advance(m);
    STEIF_TRY(stf_pairing_node(r->pairing, i + 1, m->x));
  }
  if (r->state) memcpy(r->state, m->x, (size_t)m->n * sizeof *r->state);
  return STEIF_OK;
}

int stf_longer_general(stf_longer *run, const char *method)
{
  steif_context *ctx = run->ctx;
  steif_glm *g = steif_glm_new(ctx, method);
  if (!g) return steif_status(ctx);
  const size_t n = (size_t)run->n, k = (size_t)g->k, r = (size_t)g->r;
  const int count = stf_glm_powers(g);
  general *m = stf_allocate(ctx, 1, sizeof *m);
  long double *room = stf_allocate(ctx, n * (n + 2 + 2 * k + r), sizeof *room);
  sunrealtype *first = stf_allocate(ctx, k * (size_t)(count + 1), sizeof *first);
  int *pivot = stf_allocate(ctx, n, sizeof *pivot);
  int code = STEIF_NO_MEMORY;
  if (m && room && first && pivot) {
    *m = (general){.run = run, .g = g, .k = g->k, .r = g->r, .n = run->n, .count = count};
    m->matrix = (stf_long_matrix){run->n, room, pivot};
    m->first = first, m->x = room + n * n, m->base = m->x + n, m->X = m->base + n;
    m->next = m->X + k * n, m->K = m->next + k * n;
    code = follow(m);
  }
  stf_release(ctx, m);
  stf_release(ctx, room);
  stf_release(ctx, first);
  stf_release(ctx, pivot);
  steif_glm_free(ctx, &g);
  return code;
}
