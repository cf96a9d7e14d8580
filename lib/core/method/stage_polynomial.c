/* stage_polynomial.c: coefficients of the polynomial through the stages of collocation.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "stage_polynomial.h"
#include "method.h"

/* Coefficients of w in long double: int_0^x l_i = sum_k, l_i from its roots. */
static void integrals(int s, const sunrealtype *c, int i, long double *coefficient)
{
  long double l[STEIF_STAGES + 1] = {1}; /* l_i by ascending powers */
  int degree = 0;
  for (int m = 0; m < s; m++) {
    if (m == i) continue;
    const long double scale = 1 / ((long double)c[i] - c[m]);
    l[degree + 1] = 0;
    for (int k = ++degree; k >= 0; k--)
      l[k] = ((k ? l[k - 1] : 0) - (k < degree ? l[k] * c[m] : 0)) * scale;
  }
  for (int k = 0; k < s; k++) coefficient[k] = l[k] / (k + 1);
}

static void fill_w(stf_stage_polynomial *e, const sunrealtype *B)
{
  const int s = e->s;
  long double L[STEIF_STAGES][STEIF_STAGES];
  for (int i = 0; i < s; i++) integrals(s, e->table->c, i, L[i]);
  for (int j = 0; j < s; j++) {
    long double total = 0;
    for (int k = 0; k < s; k++) {
      long double sum = 0;
      for (int i = 0; i < s; i++) sum += L[i][k] * B[i * s + j];
      e->w[j * s + k] = (sunrealtype)sum;
      total += sum;
    }
    e->end[j] = (sunrealtype)total;
  }
  if (e->accurate)
    for (int j = 0; j < s; j++) e->end[j] = j == s - 1;
}

sunrealtype stf_stage_polynomial_weight(const stf_stage_polynomial *e, int j, sunrealtype x)
{
  sunrealtype sum = 0;
  for (int k = e->s; k-- > 0;) sum = (sum + e->w[j * e->s + k]) * x;
  return sum;
}

int stf_stage_polynomial_at(const stf_stage_polynomial *e, const stf_space *space,
                            sunrealtype x, N_Vector from, N_Vector *Z, N_Vector out)
{
  sunrealtype w[STEIF_STAGES];
  for (int j = 0; j < e->s; j++) w[j] = stf_stage_polynomial_weight(e, j, x);
  stf_combine(space, e->s, w, Z, out);
  stf_axpy(space, 1, from, out);
  return STEIF_OK;
}

/* Slope of the polynomial through (0, 0), (c_i, Z_i), c_1 > 0: at 0, or at 1 if that is no node. */
static void fill_slope(stf_stage_polynomial *e)
{
  for (int j = 0; j < e->s; j++) {
    const sunrealtype *w = e->w + j * e->s;
    e->slope[j] = w[0];
    for (int k = 1; !e->accurate && k < e->s; k++) e->slope[j] += (k + 1) * w[k];
  }
}

/* Row i of P: the polynomial through the last points of (0, 0), (c_j, Z_j) at 1 + ratio c_i, minus
 * the end value. More than POINTS of them would amplify rounding and noise. */
enum { POINTS = 6 };

static void fill_P(stf_stage_polynomial *e, int i)
{
  const int s = e->s, count = s < POINTS ? s : POINTS;
  const bool origin = s < POINTS && e->table->c[0] > 0;
  sunrealtype node[POINTS + 1] = {0}, value[POINTS + 1], *row = e->P + i * s;
  for (int j = 0; j < count; j++) node[origin + j] = e->table->c[s - count + j];
  stf_interpolate(count - 1 + origin, node, 1 + e->ratio * e->table->c[i], value);
  for (int j = 0; j < s; j++) row[j] = -e->end[j];
  for (int j = 0; j < count; j++) row[s - count + j] += value[origin + j];
}

const sunrealtype *stf_stage_polynomial_ahead(stf_stage_polynomial *e, sunrealtype ratio)
{
  if (e->ratio == ratio) return e->P;
  e->ratio = ratio;
  for (int i = 0; i < e->s; i++) fill_P(e, i);
  return e->P;
}

int stf_stage_polynomial_open(stf_pool *pool, const steif_table *table, const sunrealtype *B,
                              stf_stage_polynomial *e)
{
  const size_t s = (size_t)table->s;
  *e = (stf_stage_polynomial){.table = table, .s = table->s};
  e->accurate = table->claims & STEIF_STIFFLY_ACCURATE;
  e->w = stf_pool_array(pool, s * s, sizeof *e->w);
  e->P = stf_pool_array(pool, s * s, sizeof *e->P);
  e->end = stf_pool_array(pool, s, sizeof *e->end);
  e->slope = stf_pool_array(pool, s, sizeof *e->slope);
  if (!e->w || !e->P || !e->end || !e->slope) return STEIF_NO_MEMORY;
  fill_w(e, B);
  if (table->c[0] > 0) fill_slope(e);
  return STEIF_OK;
}
