/* planted_system.c: random systems from canonical ones, and their solutions.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "planted_system.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { PANELS = 64, LONGEST = 6, FIXED = 24 };

static int die(stf_random *r, int n) { return (int)stf_random_below(r, n); }

/* f^_m, derivative j. */
static long double canonical(const planted_system *s, int m, int j, long double t)
{
  long double sum = 0;
  if (m < s->finite || s->forcing == SYSTEM_FREE) return 0;
  if (s->forcing == SYSTEM_COSINE) return s->f[m][0] * cosl(t + m + j * acosl(0));
  for (int q = SYSTEM_DEGREE; q >= j; q--) {
    long double factor = s->f[m][q];
    for (int i = 0; i < j; i++) factor *= q - i;
    sum = sum * t + factor;
  }
  return sum;
}

static int forcing_plain(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const planted_system *s = user;
  for (int m = 0; m < s->n; m++)
    N_VGetArrayPointer(g)[m] = (sunrealtype)canonical(s, m, derivative, t);
  return 0;
}

static int forcing(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const planted_system *s = user;
  long double f[SYSTEM_MOST];
  for (int m = 0; m < s->n; m++) f[m] = canonical(s, m, derivative, t);
  for (int i = 0; i < s->n; i++) {
    long double sum = 0;
    for (int m = 0; m < s->n; m++) sum += s->S[i][m] * f[m];
    N_VGetArrayPointer(g)[i] = (sunrealtype)sum;
  }
  return 0;
}

/* Products of elementary matrices; the inverse where it is wanted. */
static void unimodular(planted_system *s, sunrealtype (*A)[SYSTEM_MOST],
                       sunrealtype (*inverse)[SYSTEM_MOST])
{
  const int n = s->n;
  for (int i = 0; i < n; i++) A[i][i] = 1;
  for (int i = 0; i < n && inverse; i++) inverse[i][i] = 1;
  for (int k = 0; k < n + die(&s->random, n + 1); k++) {
    const int to = die(&s->random, n), from = die(&s->random, n);
    const sunrealtype by = die(&s->random, 2) ? 1 : -1;
    if (to == from) continue;
    for (int j = 0; j < n; j++) A[to][j] += by * A[from][j];
    for (int i = 0; i < n && inverse; i++) inverse[i][from] -= by * inverse[i][to];
  }
}

/* Blocks up to the largest, the first of index `index`. */
static void blocks(planted_system *s)
{
  stf_random *r = &s->random;
  s->finite = die(r, 3);
  s->rate = 1 + die(r, 4), s->turning = 1 + die(r, 5);
  s->index = 1 + die(r, die(r, 4) ? 4 : LONGEST);
  s->n = s->finite;
  for (int i = 0; i < s->finite; i++) s->last[i] = true;
  for (int b = 0; b < 1 + die(r, 3); b++) {
    const int size = b ? 1 + die(r, s->index) : s->index;
    if (s->n + size > SYSTEM_MOST) break;
    for (int j = 0; j < size; j++) s->last[s->n++] = j == size - 1;
  }
}

static void force(planted_system *s)
{
  s->forcing = (enum system_forcing)die(&s->random, 3);
  for (int m = s->finite; m < s->n; m++)
    for (int q = 0; q <= SYSTEM_DEGREE; q++) s->f[m][q] = die(&s->random, 7) - 3;
}

/* (sum_i (-1)^i N^i f^^(i))_m */
static long double smooth(const planted_system *s, int m, long double t)
{
  long double sum = canonical(s, m, 0, t), sign = 1;
  for (int i = m, j = 1; !s->last[i]; i++, j++) {
    sign = -sign;
    sum += sign * canonical(s, i + 1, j, t);
  }
  return sum;
}

void planted_system_settle(planted_system *s)
{
  for (int m = s->finite; m < s->n; m++) {
    s->z0[m] = (sunrealtype)smooth(s, m, 0);
    s->away[m] = (sunrealtype)(s->z0[m] - smooth(s, m, 0));
  }
}

/* Consistent, inconsistent, or with some impulses that are small. */
static void start(planted_system *s)
{
  static const sunrealtype size[] = {1, 1, 1, 0x1p-10, 0x1p-20, 0x1p-36};
  stf_random *r = &s->random;
  const int kind = die(r, 4);
  for (int m = 0; m < s->n; m++) {
    const bool away = m >= s->finite && kind > 0 && (kind > 1 || die(r, 2));
    s->z0[m] = m < s->finite ? die(r, 7) - 3 : (sunrealtype)smooth(s, m, 0);
    s->z0[m] = rint(ldexp(s->z0[m], FIXED)) / ldexp(1, FIXED); /* so that x(0-) is exact */
    if (away) s->z0[m] += (die(r, 7) - 3) * size[kind == 3 ? die(r, 6) : 0];
    s->away[m] = m < s->finite ? 0 : (sunrealtype)(s->z0[m] - smooth(s, m, 0));
  }
  for (int i = 0; i < s->n; i++) {
    s->x0[i] = 0;
    for (int m = 0; m < s->n; m++) s->x0[i] += s->back[i][m] * s->z0[m];
  }
}

/* diag(I, N) and diag(-J, I) at (i, j). */
static sunrealtype entry(const planted_system *s, bool first, int i, int j)
{
  const bool slow = i < s->finite;
  if (first) return slow ? i == j : j == i + 1 && !s->last[i];
  if (!slow || j >= s->finite) return i == j;
  if (s->finite == 1) return s->rate;
  return i == j ? s->rate : i < j ? -s->turning : s->turning;
}

int planted_system_matrices(steif_context *ctx, planted_system *s)
{
  SUNMatrix A[4];
  for (int k = 0; k < 4; k++) A[k] = SUNDenseMatrix(s->n, s->n, steif_sundials(ctx));
  s->linear = (steif_linear){A[0], A[1], s->forcing ? forcing : NULL, s};
  s->plain = (steif_linear){A[2], A[3], s->forcing ? forcing_plain : NULL, s};
  for (int k = 0; k < 4; k++)
    if (!A[k]) return STEIF_FAIL(ctx, STEIF_NO_MEMORY, "no memory for a system");
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < s->n; i++)
      for (int j = 0; j < s->n; j++) {
        const sunrealtype v = entry(s, k == 0, i, j);
        SM_ELEMENT_D(A[2 + k], i, j) = v;
        for (int p = 0; p < s->n && v != 0; p++)
          for (int q = 0; q < s->n; q++)
            SM_ELEMENT_D(A[k], p, q) += s->S[p][i] * v * s->T[j][q];
      }
  return STEIF_OK;
}

int planted_system_new(steif_context *ctx, long seed, planted_system *s)
{
  planted_system_free(s);
  *s = (planted_system){.random = {(uint64_t)seed}};
  blocks(s);
  unimodular(s, s->S, NULL);
  unimodular(s, s->T, s->back);
  force(s);
  start(s);
  return planted_system_matrices(ctx, s);
}

void planted_system_free(planted_system *s)
{
  const SUNMatrix A[] = {s->linear.E, s->linear.F, s->plain.E, s->plain.F};
  for (int k = 0; k < 4; k++)
    if (A[k]) SUNMatDestroy(A[k]);
  s->linear = s->plain = (steif_linear){NULL, NULL, NULL, NULL};
}

long double planted_system_component(const planted_system *s, int m, const long double *z)
{
  long double sum = 0;
  for (int i = 0; i < s->n; i++) sum += s->back[m][i] * z[i];
  return sum;
}

/* z_m(t) without impulses. */
static long double value(const planted_system *s, int m, long double t)
{
  const long double decay = expl(-s->rate * t), c = cosl(s->turning * t),
                    d = sinl(s->turning * t);
  if (m >= s->finite) return smooth(s, m, t);
  if (s->finite == 1) return s->z0[0] * decay;
  return decay * (c * s->z0[m] + (m ? -d * s->z0[0] : d * s->z0[1]));
}

int planted_system_exact(planted_system *s, const stf_weight *g, long double *z, long double *c)
{
  const int n = s->n;
  long double d[STF_DERIVATIVES], at;
  STEIF_TRY(stf_weight_at(g, 0, s->index, d));
  for (int m = 0; m < n; m++) z[m] = 0;
  for (int p = 0; p < PANELS; p++)
    for (int i = 0; i < STF_BOX; i++) {
      const long double t = g->t1 * (p + g->node[i]) / PANELS;
      STEIF_TRY(stf_weight_at(g, t, 0, &at));
      for (int m = 0; m < n; m++) z[m] += g->t1 / PANELS * g->weight[i] * at * value(s, m, t);
    }
  for (int i = 0; i < s->index - 1; i++) { /* c_i = (-1)^i N^{i+1} away */
    long double in_z[SYSTEM_MOST] = {0};
    for (int m = s->finite; m < n; m++) {
      int from = m;
      while (from - m <= i && !s->last[from]) from++;
      if (from - m == i + 1) in_z[m] = (i % 2 ? -1 : 1) * s->away[from];
      z[m] += (i % 2 ? -1 : 1) * in_z[m] * d[i];
    }
    for (int m = 0; m < n; m++) c[i * n + m] = planted_system_component(s, m, in_z);
  }
  return STEIF_OK;
}
