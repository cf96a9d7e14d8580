/* exact_schemes.c: schemes with the exact exponential; they differ in the weights of the input.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <string.h>

/* The highest phi function that a rule needs. */
static int highest(const stf_rule *rule)
{
  for (int k = 2; k > 0; k--)
    for (int i = 0; i < 3; i++)
      if (rule->weight[i][k] != 0) return k;
  return 0;
}

/* W = dt sum_k weight_k phi_k B; M: n x n scratch. */
static void weigh(const stf_plan *p, const double weight[4], const double *phi, double *M,
                  double *W)
{
  const int n = p->s->n;
  const size_t count = (size_t)n * (size_t)n;
  for (size_t j = 0; j < count; j++) {
    M[j] = j % ((size_t)n + 1) == 0 ? weight[3] : 0;
    for (size_t k = 0; k < 3; k++)
      if (weight[k] != 0) M[j] += weight[k] * phi[j + k * count];
  }
  stf_product(n, p->s->m, n, p->dt, M, p->s->B, 0, W);
}

static void weights(const stf_plan *p, const double *phi, double *M)
{
  double *const W[] = {p->B0, p->Bm, p->B1};
  double sum[4] = {0};
  for (int i = 0; i < 3; i++) {
    weigh(p, p->rule->weight[i], phi, M, W[i]);
    for (int k = 0; k < 4; k++) sum[k] += p->rule->weight[i][k];
  }
  weigh(p, sum, phi, M, p->Bd);
}

/* x = h - B1 u: Bd = B0 + Ad B1, Dd = D + C B1. */
static void shift(const stf_plan *p)
{
  const steif_state_space *s = p->s;
  memcpy(p->Bd, p->B0, (size_t)s->n * (size_t)s->m * sizeof *p->Bd);
  stf_product(s->n, s->m, s->n, 1, p->Ad, p->B1, 1, p->Bd);
  stf_product(s->p, s->m, s->n, 1, s->C, p->B1, 1, p->Dd);
}

int stf_exponential_build(const stf_plan *p)
{
  const int n = p->s->n, k = highest(p->rule);
  const size_t count = (size_t)n * (size_t)n;
  double *phi = stf_allocate(p->ctx, count * (size_t)(k + 2), sizeof *phi);
  if (!phi) return STEIF_NO_MEMORY;
  double *M = phi + count * (size_t)(k + 1);
  for (size_t i = 0; i < count; i++) M[i] = p->dt * p->s->A[i];
  const int code = steif_phi_matrix(p->ctx, n, k, M, phi);
  if (code == STEIF_OK) {
    memcpy(p->Ad, phi, count * sizeof *phi);
    if (p->s->m) weights(p, phi, M);
    if (p->s->m && p->rule->shifted) shift(p);
  }
  stf_release(p->ctx, phi);
  return code;
}
