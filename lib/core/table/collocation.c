/* collocation.c: a_ij = int_0^{c_i} l_j and b_j = int_0^1 l_j on given nodes, in long double by
 * Gauss's rule, and what families of tables share (Hairer, Wanner: Solving ODEs II, IV.5).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stored.h"

int stf_family_stages(steif_context *ctx, const steif_spec *spec, int lowest, int fallback,
                      int *s)
{
  STEIF_TRY(stf_spec_only(ctx, spec, (const char *const[]){"s", "compensated", NULL}));
  return stf_spec_int(ctx, spec, "s", lowest, STEIF_STAGES, fallback, s);
}

typedef struct rule {
  int s, points;
  long double c[STEIF_STAGES], bary[STEIF_STAGES]; /* l_j = bary_j prod_{k != j} (x - c_k) */
  long double g[STEIF_STAGES], w[STEIF_STAGES];    /* exact for l_j, of degree s - 1 */
} rule;

static int prepare(steif_context *ctx, enum stf_node_kind kind, int s, rule *r)
{
  r->s = s, r->points = (s + 1) / 2;
  STEIF_TRY(stf_nodes(ctx, kind, s, r->c));
  stf_gauss(r->points, r->g, r->w);
  for (int j = 0; j < s; j++) {
    long double product = 1;
    for (int k = 0; k < s; k++)
      if (k != j) product *= r->c[j] - r->c[k];
    r->bary[j] = 1 / product;
  }
  return STEIF_OK;
}

/* row_j = int_0^x l_j; the products from the left and from the right of j meet without
 * division. */
static void integrate(const rule *r, long double x, long double *row)
{
  for (int j = 0; j < r->s; j++) row[j] = 0;
  for (int q = 0; q < r->points; q++) {
    const long double at = x * r->g[q];
    long double before[STEIF_STAGES], after = 1;
    before[0] = 1;
    for (int j = 1; j < r->s; j++) before[j] = before[j - 1] * (at - r->c[j - 1]);
    for (int j = r->s - 1; j >= 0; after *= at - r->c[j--])
      row[j] += x * r->w[q] * r->bary[j] * before[j] * after;
  }
}

/* x = hi + lo. */
static void halve(long double x, sunrealtype *hi, sunrealtype *lo)
{
  *hi = (sunrealtype)x;
  *lo = (sunrealtype)(x - (long double)*hi);
}

int stf_family_fill(steif_context *ctx, enum stf_node_kind kind, stf_alter *alter,
                    steif_table *self, sunrealtype *A, sunrealtype *b, sunrealtype *c)
{
  const stf_stored *kept = stf_stored_find(self->name, self->s);
  if (!kept) return stf_family_compute(ctx, kind, alter, self, A, b, c);
  self->A = kept->A, self->A_low = kept->A_low, self->b = kept->b, self->c = kept->c;
  return STEIF_OK;
}

int stf_family_compute(steif_context *ctx, enum stf_node_kind kind, stf_alter *alter,
                       steif_table *self, sunrealtype *A, sunrealtype *b, sunrealtype *c)
{
  const int s = self->s;
  rule r;
  long double weights[STEIF_STAGES], full[STEIF_STAGES * STEIF_STAGES];
  STEIF_TRY(prepare(ctx, kind, s, &r));
  integrate(&r, 1, weights);
  for (int i = 0; i < s; i++) integrate(&r, r.c[i], full + i * s);
  if (alter) alter(s, weights, full);
  for (int i = 0; i < s * s; i++) halve(full[i], A + i, A + s * s + i);
  for (int i = 0; i < s; i++) b[i] = (sunrealtype)weights[i], c[i] = (sunrealtype)r.c[i];
  self->A = A, self->A_low = A + s * s, self->b = b, self->c = c;
  return STEIF_OK;
}
