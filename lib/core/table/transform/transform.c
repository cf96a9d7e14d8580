/* transform.c: B = A^{-1} of a table as independent (or triangularly coupled) real and complex
 * shifts: Butcher, BIT 16 (1976); Hairer, Wanner: Solving ODEs II, IV.8. Everything is computed
 * in long double and rounded once.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "transform.h"
#include "stored.h"
#include "table.h"
#include <math.h>

enum { SQUARE = STEIF_STAGES * STEIF_STAGES };

/* Eigenvectors are used while |T| |T^{-1}| stays below: Newton's residuals are formed in the
 * untransformed stages, so 1e-16 times this is what T may cost its convergence. */
static const long double dependent = 1e8L;

static void round_to(int count, const long double *x, sunrealtype *y)
{
  for (int i = 0; i < count; i++) y[i] = (sunrealtype)x[i];
}

bool stf_transform_invert(int s, const long double *M, long double tiny, long double *inverse)
{
  stf_complex K[SQUARE], X[SQUARE];
  for (int i = 0; i < s * s; i++) K[i] = M[i], X[i] = i % (s + 1) == 0;
  if (!stf_solve(s, s, K, X, tiny)) return false;
  for (int i = 0; i < s * s; i++) inverse[i] = creall(X[i]);
  return true;
}

/* A to all its digits, its largest entry, and B. */
static int prepare(steif_context *ctx, const steif_table *table, stf_transform_work *w)
{
  const int s = table->s;
  long double largest = 0;
  STEIF_CHECK(
    table->kind == STEIF_COLLOCATION, ctx, STEIF_UNSUPPORTED,
    "table '%s' has a triangular A: its stages are solved one after another and need no "
    "split",
    table->name);
  for (int i = 0; i < s * s; i++) {
    STEIF_CHECK(isfinite(table->A[i]), ctx, STEIF_NOT_FINITE,
                "entry (%d, %d) of the A of table '%s' is %g; give finite coefficients",
                i / s + 1, i % s + 1, table->name, table->A[i]);
    w->A[i] = (long double)table->A[i] + (table->A_low ? (long double)table->A_low[i] : 0);
    if (fabsl(w->A[i]) > largest) largest = fabsl(w->A[i]);
  }
  STEIF_CHECK(
    stf_transform_invert(s, w->A, 4 * STF_EPS * largest, w->B), ctx, STEIF_UNSUPPORTED,
    "the A of table '%s' is singular, so it has no split into shifts; drop its explicit "
    "stage or take a table with regular A, such as radau:s=%d",
    table->name, s);
  return STEIF_OK;
}

/* The columns of T from an eigenvector, scaled to last component 1 (to largest
 * component 1 where the last vanishes). */
static void place(int s, int row, bool pair, const stf_complex *v, long double *T)
{
  int largest = 0;
  for (int i = 1; i < s; i++)
    if (cabsl(v[i]) > cabsl(v[largest])) largest = i;
  const stf_complex unit = cabsl(v[s - 1]) > 1e-6L * cabsl(v[largest]) ? v[s - 1] : v[largest];
  for (int i = 0; i < s; i++) {
    const stf_complex x = v[i] / unit;
    T[i * s + row] = pair ? 2 * creall(x) : creall(x);
    if (pair) T[i * s + row + 1] = -2 * cimagl(x);
  }
}

/* Largest row sum. */
static long double norm(int s, const long double *M)
{
  long double most = 0;
  for (int i = 0; i < s; i++) {
    long double sum = 0;
    for (int j = 0; j < s; j++) sum += fabsl(M[i * s + j]);
    if (sum > most) most = sum;
  }
  return most;
}

/* Refined on A, whose entries are known relatively, not on B. False when eigenvectors are
 * nearly dependent or not found. */
static bool eigen(int s, const stf_complex *near, int shifts, stf_transform_work *w)
{
  stf_complex v[STEIF_STAGES];
  w->shifts = 0;
  for (int k = 0, row = 0; k < shifts; k++) {
    const bool pair = cimagl(near[k]) > 0;
    stf_complex mu = 1 / near[k];
    if (!stf_eigen_refine(s, w->A, &mu, v)) return false;
    place(s, row, pair, v, w->T);
    w->lambda[w->shifts] = 1 / mu, w->row[w->shifts++] = row;
    row += pair ? 2 : 1;
  }
  return stf_transform_invert(s, w->T, 0, w->Tinv) &&
         norm(s, w->T) * norm(s, w->Tinv) < dependent;
}

static int publish(stf_pool *pool, const stf_transform_work *w, bool coupled,
                   stf_transform *transform)
{
  const size_t count = (size_t)(transform->s * transform->s);
  sunrealtype *B = stf_pool_array(pool, count, sizeof *B),
              *T = stf_pool_array(pool, count, sizeof *T);
  sunrealtype *Tinv = stf_pool_array(pool, count, sizeof *Tinv);
  sunrealtype *coupling = coupled ? stf_pool_array(pool, count, sizeof *coupling) : NULL;
  if (!B || !T || !Tinv || (coupled && !coupling)) return STEIF_NO_MEMORY;
  round_to((int)count, w->B, B);
  round_to((int)count, w->T, T);
  round_to((int)count, w->Tinv, Tinv);
  if (coupled) round_to((int)count, w->S, coupling);
  transform->B = B, transform->T = T, transform->Tinv = Tinv, transform->coupling = coupling;
  transform->shifts = w->shifts;
  for (int k = 0; k < w->shifts; k++) {
    transform->re[k] = (sunrealtype)creall(w->lambda[k]);
    transform->im[k] = (sunrealtype)cimagl(w->lambda[k]);
    transform->row[k] = w->row[k];
  }
  return STEIF_OK;
}

static int compute(stf_pool *pool, steif_context *ctx, const steif_table *table,
                   stf_transform_work *w, stf_transform *transform)
{
  stf_complex near[STEIF_STAGES];
  int shifts;
  STEIF_TRY(prepare(ctx, table, w));
  STEIF_TRY(stf_eigen_values(ctx, table->s, w->B, near, &shifts));
  const bool diagonal = table->s <= STF_EIGEN_STAGES && eigen(table->s, near, shifts, w);
  if (!diagonal) STEIF_TRY(stf_transform_schur(ctx, table->s, w));
  transform->s = table->s;
  return publish(pool, w, !diagonal, transform);
}

int stf_transform_build(stf_pool *pool, steif_context *ctx, const steif_table *table,
                        stf_transform *transform)
{
  const stf_stored *kept = table ? stf_stored_find(table->name, table->s) : NULL;
  if (!kept || kept->A != table->A) return stf_transform_compute(pool, ctx, table, transform);
  stf_stored_transform(kept, transform);
  return STEIF_OK;
}

int stf_transform_compute(stf_pool *pool, steif_context *ctx, const steif_table *table,
                          stf_transform *transform)
{
  STEIF_TRY(stf_table_check(ctx, table));
  stf_transform_work *w = stf_allocate(ctx, 1, sizeof *w);
  if (!w) return STEIF_NO_MEMORY;
  const int code = compute(pool, ctx, table, w, transform);
  stf_release(ctx, w);
  return code;
}

static void part(int count, const long double *x, sunrealtype *const parts[2])
{
  for (int i = 0; i < count; i++) {
    parts[0][i] = (float)x[i];
    parts[1][i] = (sunrealtype)(x[i] - (long double)parts[0][i]);
  }
}

/* Only the symplectic tables, Gauss's, have weights to more digits than those of the table. */
int stf_transform_parts(stf_pool *pool, steif_context *ctx, const steif_table *table,
                        stf_parts *parts)
{
  const int s = table->s;
  stf_transform_work *w = stf_pool_array(pool, 1, sizeof *w);
  sunrealtype *x = stf_pool_array(pool, (size_t)(2 * s * (s + 1)), sizeof *x);
  if (!w || !x) return STEIF_NO_MEMORY;
  long double b[STEIF_STAGES], c[STEIF_STAGES], end[STEIF_STAGES] = {0};
  *parts = (stf_parts){{x, x + s * s}, {x + 2 * s * s, x + 2 * s * s + s}};
  STEIF_TRY(prepare(ctx, table, w));
  if (table->claims & STEIF_SYMPLECTIC) stf_gauss(s, c, b);
  for (int i = 0; i < s && !(table->claims & STEIF_SYMPLECTIC); i++) b[i] = table->b[i];
  for (int j = 0; j < s; j++) {
    for (int i = 0; i < s; i++) end[j] += b[i] * w->B[i * s + j];
    if (table->claims & STEIF_STIFFLY_ACCURATE) end[j] = j == s - 1;
  }
  part(s * s, w->B, parts->B);
  part(s, end, parts->w);
  return STEIF_OK;
}
