/* staircase.c: the infinite part of a pencil s E + F by singular values: ker E is compressed,
 * the range of F ker E deflated by a QR factorisation, and the rest treated again. The number
 * of deflations is the index, their sizes are the Weyr characteristic at infinity. P. Van
 * Dooren, The computation of Kronecker's canonical form of a singular pencil, Linear Algebra
 * Appl. 27 (1979); J. Demmel, B. Kagstrom, GUPTRI, ACM TOMS 19 (1993).
 *
 * Dividing by sigma_min(F ker E) makes rounding grow by up to ||F|| / sigma_min: so does the
 * tolerance above which singular values are kept. E_inf is strictly block upper triangular in
 * exact zeros, hence N is nilpotent, and
 *   R <- F_inf^{-1} ((E_inf R + E_12) E_f^{-1} F_f - F_12)
 * ends after as many sweeps as there are deflations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_thresholds.h"
#include "separation.h"
#include "staircase.h"
#include "lapack.h"
#include <math.h>
#include <string.h>

enum { BLOCK = 65 * 64 }; /* what dormqr keeps for its triangular factors */

typedef struct stairs {
  stf_separation separation; /* m rows and columns are deflated so far */
  stf_pool *pool;
  stf_svd svd;
  sunrealtype *W, *move, *tau, *work;
  int lwork, rank, levels, least; /* least: deflations before the first doubtful decision */
  sunindextype *weyr;
  sunrealtype norm_E, norm_F, tolerance, first, rcond, gap;
  sunrealtype dropped; /* largest singular value taken for 0 */
  bool singular, doubtful;
} stairs;

static int open(steif_context *ctx, stf_pool *pool, int n, const sunrealtype *E,
                const sunrealtype *F, stairs *s)
{
  const size_t size = (size_t)n * (size_t)n * sizeof *E;
  *s = (stairs){.pool = pool, .gap = INFINITY, .lwork = 64 * n + BLOCK};
  STEIF_TRY(stf_separation_open(ctx, pool, n, &s->separation));
  STEIF_TRY(stf_svd_open(ctx, pool, n, &s->svd));
  s->W = stf_pool_square(pool, n);
  s->move = stf_pool_square(pool, n);
  s->tau = stf_pool_array(pool, 4 * (size_t)n, sizeof *s->tau);
  s->work = stf_pool_array(pool, (size_t)s->lwork, sizeof *s->work);
  s->weyr = stf_pool_array(pool, (size_t)n, sizeof *s->weyr);
  if (!s->W || !s->move || !s->tau || !s->work || !s->weyr) return STEIF_NO_MEMORY;
  memcpy(s->separation.E, E, size);
  memcpy(s->separation.F, F, size);
  memset(s->separation.P, 0, size);
  memset(s->separation.Q, 0, size);
  for (int i = 0; i < n; i++) {
    const size_t at = (size_t)i * (size_t)n + (size_t)i;
    s->separation.P[at] = s->separation.Q[at] = 1;
  }
  STEIF_TRY(stf_svd_find(&s->svd, n, n, F, n, false));
  s->norm_F = s->svd.sigma[0];
  return STEIF_OK;
}

static sunrealtype *trailing(const stairs *s, sunrealtype *A, int row, int column)
{
  return A + (size_t)column * (size_t)s->separation.n + row;
}

static void doubt(stairs *s)
{
  if (s->doubtful) return;
  s->doubtful = true;
  s->least = s->levels;
}

/* A gap that is too small makes this decision and all later ones doubtful. */
static void note(stairs *s, sunrealtype gap)
{
  s->gap = fmin(s->gap, gap);
  if (s->gap < STF_DECIDED_GAP) doubt(s);
}

/* Smallest value kept over the largest dropped when `rank` of r values are kept; rounding of E
 * stands for dropped values below it. */
static sunrealtype step(const stairs *s, int r, int rank)
{
  const sunrealtype *sigma = s->svd.sigma;
  const sunrealtype kept = rank ? sigma[rank - 1] : s->norm_E;
  return kept / fmax(rank < r ? sigma[rank] : 0, s->first);
}

/* Values above the grown tolerance are kept, values below the first one dropped, and between
 * them the largest step decides; it is worth as much as it exceeds the second largest. */
static int choose(stairs *s, int r)
{
  const sunrealtype *sigma = s->svd.sigma;
  int least = 0, most, rank;
  while (least < r && sigma[least] > s->tolerance) least++;
  for (most = least; most < r && sigma[most] > s->first;) most++;
  rank = least;
  for (int j = least + 1; j <= most; j++)
    if (step(s, r, j) > step(s, r, rank)) rank = j;
  sunrealtype second = 1;
  for (int j = least; j <= most; j++)
    if (j != rank) second = fmax(second, step(s, r, j));
  const sunrealtype kept = rank ? sigma[rank - 1] : s->norm_E;
  const sunrealtype dropped = rank < r ? sigma[rank] : s->first;
  if (dropped > 0) note(s, kept / dropped / second);
  return rank;
}

/* dim ker of the trailing block of E; its singular vectors stay in svd. */
static int kernel(stairs *s, int *k)
{
  const int r = s->separation.n - s->separation.m, m = s->separation.m;
  STEIF_TRY(
    stf_svd_find(&s->svd, r, r, trailing(s, s->separation.E, m, m), s->separation.n, true));
  if (s->levels == 0) {
    s->norm_E = s->svd.sigma[0];
    s->first = s->tolerance = STF_RANK_NOISE * s->separation.n * STF_EPS * s->norm_E;
  }
  const int rank = choose(s, r);
  if (rank < r) s->dropped = fmax(s->dropped, s->svd.sigma[rank]);
  if (s->levels == 0) s->rank = rank;
  *k = r - rank;
  return STEIF_OK;
}

/* A[:, m:] := A[:, m:] W. */
static void turn(stairs *s, sunrealtype *A)
{
  const int n = s->separation.n, r = n - s->separation.m;
  sunrealtype *right = trailing(s, A, 0, s->separation.m);
  stf_gemm('N', 'N', n, r, r, 1, right, n, s->W, r, 0, s->move, n);
  memcpy(right, s->move, (size_t)n * (size_t)r * sizeof *A);
}

/* Columns [ker E, rest] of the right singular vectors. */
static void compress(stairs *s, int k)
{
  const int n = s->separation.n, m = s->separation.m, r = n - m;
  for (int j = 0; j < r; j++) {
    const int from = j < k ? r - k + j : j - k;
    for (int i = 0; i < r; i++)
      s->W[(size_t)j * (size_t)r + (size_t)i] = s->svd.VT[(size_t)i * (size_t)n + (size_t)from];
  }
  turn(s, s->separation.E);
  turn(s, s->separation.F);
  turn(s, s->separation.Q);
  for (int j = 0; j < k; j++)
    memset(trailing(s, s->separation.E, m, m + j), 0, (size_t)r * sizeof *s->W);
}

/* A := H^T A or A H with the reflectors of F ker E, stored packed in `move`. */
static void reflect(stairs *s, char side, int rows, int columns, int k, sunrealtype *A)
{
  const int n = s->separation.n, r = n - s->separation.m;
  const char op = side == 'L' ? 'T' : 'N';
  int info;
  if (rows > 0 && columns > 0)
    dormqr_(&side, &op, &rows, &columns, &k, s->move, &r, s->tau, A, &n, s->work, &s->lwork,
            &info, 1, 1);
}

/* F ker E = H [T; 0]: T stands in F, H goes to the rows below the stairs. */
static void deflate(stairs *s, int k)
{
  const int n = s->separation.n, m = s->separation.m, r = n - m;
  int info;
  stf_separation_block(&s->separation, s->separation.F, m, m, r, k, s->move);
  dgeqrf_(&r, &k, s->move, &r, s->tau, s->work, &s->lwork, &info);
  for (int j = 0; j < k; j++)
    for (int i = 0; i < r; i++)
      *trailing(s, s->separation.F, m + i, m + j) =
        i <= j ? s->move[(size_t)j * (size_t)r + (size_t)i] : 0;
  reflect(s, 'L', r, r - k, k, trailing(s, s->separation.E, m, m + k));
  reflect(s, 'L', r, r - k, k, trailing(s, s->separation.F, m, m + k));
  reflect(s, 'R', n, r, k, trailing(s, s->separation.P, 0, m));
}

/* Columns of F ker E that depend on each other make det(s E + F) vanish for all s; the
 * resolvent must say so too. */
static void judge(stairs *s, sunrealtype low)
{
  const sunrealtype noise = STF_RANK_NOISE * s->separation.n * STF_EPS * s->norm_F;
  const sunrealtype grown = s->first > 0 ? s->tolerance / s->first : 1;
  const bool no_resolvent = s->rcond < s->separation.n * STF_EPS;
  if (low <= noise * grown) {
    s->singular = no_resolvent || !(low > 0);
    doubt(s);
  }
}

static int climb(stairs *s)
{
  const int n = s->separation.n;
  while (s->separation.m < n) {
    int k;
    STEIF_TRY(kernel(s, &k));
    if (!k) break;
    compress(s, k);
    const int m = s->separation.m;
    STEIF_TRY(stf_svd_find(&s->svd, n - m, k, trailing(s, s->separation.F, m, m), n, false));
    const sunrealtype low = s->svd.sigma[k - 1];
    judge(s, low);
    if (s->singular) break;
    deflate(s, k);
    s->tolerance = fmax(s->tolerance, n * STF_EPS * s->norm_E * s->norm_F / low);
    s->weyr[s->levels++] = k;
    s->separation.m += k;
  }
  return STEIF_OK;
}

/* L = -(E_inf R + E_12) E_f^{-1}, through its transpose; T holds the bracket. */
static void left(const stairs *s, const sunrealtype *T)
{
  const size_t m = (size_t)s->separation.m, f = (size_t)s->separation.n - m;
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < f; j++) s->move[i * f + j] = T[j * m + i];
  stf_separation_finite(&s->separation, 'T', (int)m, s->move);
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < f; j++) s->separation.L[j * m + i] = -s->move[i * f + j];
}

static int decouple(stairs *s)
{
  stf_separation *p = &s->separation;
  const int m = p->m, n = p->n, f = n - m;
  sunrealtype *T = s->svd.U, *G = s->svd.VT;
  const int code = stf_separation_factor(s->pool, p);
  if (code == STEIF_RETRY) s->singular = true;
  if (code != STEIF_OK || !m || !f) return code == STEIF_RETRY ? STEIF_OK : code;
  stf_separation_block(p, p->F, m, m, f, f, G);
  stf_separation_finite(p, 'N', f, G);
  for (int sweep = 0; sweep <= s->levels + 1; sweep++) {
    stf_separation_block(p, p->E, 0, m, m, f, T);
    stf_gemm('N', 'N', m, f, m, 1, p->E, n, p->R, m, 1, T, m);
    if (sweep > s->levels) break;
    stf_separation_block(p, p->F, 0, m, m, f, p->R);
    stf_gemm('N', 'N', m, f, f, 1, T, m, G, f, -1, p->R, m);
    stf_separation_infinite(p, f, p->R);
  }
  left(s, T);
  return STEIF_OK;
}

static int tell(const stairs *s, steif_structure *structure)
{
  const stf_separation *p = &s->separation;
  structure->n = p->n;
  structure->method = "staircase";
  structure->rank_E = s->rank;
  structure->regular = !s->singular;
  structure->rcond = s->rcond;
  structure->gap = s->gap;
  const bool sure = !s->singular && !s->doubtful;
  structure->index = sure ? s->levels : -1;
  structure->index_least = sure ? s->levels : s->singular ? 0 : s->least;
  structure->finite = sure ? p->n - p->m : -1;
  structure->infinite = sure ? p->m : -1;
  STEIF_TRY(stf_structure_list(p->ctx, s->levels, &structure->weyr));
  structure->weyr_count = s->levels;
  for (int i = 0; i < s->levels; i++) structure->weyr[i] = s->weyr[i];
  return STEIF_OK;
}

/* What was taken for 0 in E, or rounding of it, may hide an entry as large as that times the norm of
 * F_inf^{-1} [I L] P^T in N = F_inf^{-1} E_inf: 1/s of a finite eigenvalue s. */
static int resolve(stairs *s, steif_structure *structure)
{
  sunrealtype rows;
  structure->resolution = INFINITY;
  if (!s->levels) return STEIF_OK;
  STEIF_TRY(stf_separation_rows(s->pool, &s->separation, &rows));
  const sunrealtype hidden = fmax(s->dropped, s->separation.n * STF_EPS * s->norm_E);
  if (hidden > 0) structure->resolution = 1 / (rows * hidden);
  return STEIF_OK;
}

static int run(stairs *s, const sunrealtype *E, const sunrealtype *F,
               const steif_analysis *analysis, const stf_sources *sources,
               steif_structure *structure, steif_impulse *impulse, const stf_separated *parts)
{
  stf_separation *p = &s->separation;
  const unsigned seed = analysis->seed ? analysis->seed : 1;
  STEIF_TRY(stf_best_rcond(s->pool, p->n, E, F, seed, &s->rcond));
  STEIF_TRY(climb(s));
  if (!s->singular) STEIF_TRY(decouple(s));
  STEIF_TRY(tell(s, structure));
  if (s->singular)
    return stf_null_offenders(p->ctx, &s->svd, p->n, E, F, seed, s->tau, structure);
  STEIF_TRY(resolve(s, structure));
  if (s->levels > 1) STEIF_TRY(stf_separation_offenders(s->pool, p, s->levels, structure));
  if (parts) STEIF_TRY(stf_separation_give(s->pool, p, parts));
  return sources ? stf_separation_impulse(p, s->levels, sources, impulse) : STEIF_OK;
}

int stf_staircase(steif_context *ctx, int n, const sunrealtype *E, const sunrealtype *F,
                  const steif_analysis *analysis, const stf_sources *sources,
                  steif_structure *structure, steif_impulse *impulse,
                  const stf_separated *parts)
{
  stairs s;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = open(ctx, pool, n, E, F, &s);
  if (code == STEIF_OK) code = run(&s, E, F, analysis, sources, structure, impulse, parts);
  stf_pool_free(&pool);
  return code;
}
