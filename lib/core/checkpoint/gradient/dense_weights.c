/* dense_weights.c: steps that events cut: y there, and integrals up to there, by dense output.
 *
 *   y(x) = y_n + sum_j w_j(x) Z_j = y_n + h sum_j b_j(x) K_j,   or of BDF sum_j c_j(x) y_{n+1-j};
 * a slope v of what was asked of y(x) goes to all of these with their weights.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <string.h>

/* b_j(x) of a chain of stages: the polynomial of degree 1 to 3 of its dense output. */
static void chain(const steif_table *T, sunrealtype x, sunrealtype *b)
{
  const int s = T->s;
  const sunrealtype u = 1 - x;
  const bool accurate = T->claims & STEIF_STIFFLY_ACCURATE, first = T->A[0] == 0;
  const sunrealtype whole = !accurate ? x : first ? x * x * (1 + 2 * u) : x * (1 + u);
  const sunrealtype *end = accurate ? T->A + (s - 1) * s : T->b;
  for (int j = 0; j < s; j++) b[j] = whole * end[j];
  if (accurate && first) b[0] += x * u * u;
  if (accurate) b[s - 1] -= first ? x * x * u : x * u;
}

static void weights(const stf_backwards *B, sunrealtype x, sunrealtype *w)
{
  if (B->kind == STF_TRACE_CHAIN)
    chain(B->table, x, w);
  else
    for (int j = 0; j < B->table->s; j++) w[j] = stf_stage_polynomial_weight(&B->u, j, x);
}

/* Node i of the integrals: J, mu, and c g_y with its weights to B->extra. */
static int node(stf_backwards *B, const stf_head *head, int i, int rows)
{
  const stf_passed *p = B->cut;
  const bool history = B->kind == STF_TRACE_BDF;
  const sunrealtype h = head->h, c = p->c[i] * h;
  sunrealtype own[STEIF_STAGES];
  const sunrealtype *w = history ? p->weight[i] : own;
  if (!history) weights(B, p->x[i], own);
  memcpy(STF_ARRAY(B->work), p->inside + (size_t)i * (size_t)B->n,
         (size_t)B->n * sizeof *p->inside);
  sunrealtype *all = B->other + 2 * B->count;
  for (int k = 0; k < B->count; k++) all[k] = c;
  STEIF_TRY(stf_functional_shifted(B, all, head->t + p->x[i] * h, B->work, B->shifted));
  STEIF_TRY(stf_functional_at(B, 0, head->t + p->x[i] * h, B->work));
  for (int k = 0; k < B->count; k++) {
    B->value[k] += c * B->g[k];
    for (int m = 0; m < B->P; m++) B->mu[k * B->P + m] += c * B->gp[k * B->P + m];
    for (int j = 0; j < rows; j++)
      stf_axpy(&B->space, (B->kind == STF_TRACE_CHAIN ? h : 1) * c * w[j], B->gy[k],
               B->extra[j * B->count + k]);
    if (!history) stf_axpy(&B->space, c, B->gy[k], B->extra[rows * B->count + k]);
  }
  return STEIF_OK;
}

static int integrals(stf_backwards *B, const stf_head *head, int rows)
{
  for (int j = 0; j < (rows + 1) * B->count; j++) stf_zero(&B->space, B->extra[j]);
  for (int i = 0; i < STF_INSIDE; i++) STEIF_TRY(node(B, head, i, rows));
  return STEIF_OK;
}

/* To past values, where pull_bdf expects it; the integral is that before the step and what is inside. */
static void history(stf_backwards *B, int order, const sunrealtype *weight)
{
  const stf_space *space = &B->space;
  for (int j = 1; j <= order; j++)
    for (int i = 0; i < B->count; i++) {
      stf_axpy(space, weight[j], B->lambda[i], B->past[j][i]);
      if (B->extra) stf_axpy(space, 1, B->extra[j * B->count + i], B->past[j][i]);
    }
  for (int i = 0; i < B->count; i++) {
    stf_scale(space, weight[0], B->lambda[i], B->lambda[i]);
    if (B->extra) stf_axpy(space, 1, B->extra[i], B->lambda[i]);
    B->nu[B->count + i] += B->nu[i], B->nu[i] = 0;
  }
}

int stf_see_cut(stf_backwards *B, const stf_head *head)
{
  const stf_passed *p = B->cut;
  const bool bdf = B->kind == STF_TRACE_BDF;
  if (p && B->extra) STEIF_TRY(integrals(B, head, bdf ? head->order + 1 : B->table->s));
  if (p && bdf) history(B, head->order, p->weight[STF_INSIDE]);
  if (p && !bdf) weights(B, p->x[STF_INSIDE], B->end);
  if (p || bdf) return STEIF_OK;
  const sunrealtype *end = B->kind == STF_TRACE_CHAIN ? B->table->b : B->u.end;
  for (int j = 0; j < B->table->s; j++) B->end[j] = end[j];
  return STEIF_OK;
}
