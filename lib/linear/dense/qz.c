/* qz.c: the infinite part of a pencil by the generalised Schur form, reordered so that exactly
 * the m largest eigenvalues |alpha / beta| lead. Infinite eigenvalues in chains of length k
 * come out as a cluster of size eps^(-1/k); the subspace of the cluster is well conditioned
 * all the same. B. Kagstrom, P. Poromaa, Computing eigenspaces with specified eigenvalues of a
 * regular matrix pair (A, B) and condition estimation, Numer. Algorithms 12 (1996).
 *
 * The two parts are decoupled by one generalised Sylvester equation,
 *   F_inf R + L F_f = -F_12,  E_inf R + L E_f = -E_12,
 * and the index is the first j where N^j, N = F_inf^{-1} E_inf, is noise.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_thresholds.h"
#include "separation.h"
#include "staircase.h"
#include "lapack.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct schur {
  stf_separation separation;
  stf_pool *pool;
  sunrealtype *re, *im, *beta, *size, *work, *next;
  int *select, *iwork, lwork, liwork, index;
  sunrealtype gap;
  sunrealtype radius,
    edge; /* the largest |alpha / beta| taken for finite, the smallest for infinite */
  const char *objection; /* why the form decides nothing; NULL: it does */
} schur;

static int open(steif_context *ctx, stf_pool *pool, int n, const sunrealtype *E,
                const sunrealtype *F, schur *s)
{
  const size_t m = (size_t)n;
  /* dgges: 8 n + 16; dtgsen with ijob = 0: 4 n + 16; more for blocks of 64 columns. */
  *s = (schur){.pool = pool, .lwork = 80 * n + 16, .liwork = n + 6, .index = -1};
  STEIF_TRY(stf_separation_open(ctx, pool, n, &s->separation));
  s->re = stf_pool_array(pool, 4 * m, sizeof *s->re);
  s->work = stf_pool_array(pool, (size_t)s->lwork, sizeof *s->work);
  s->select = stf_pool_array(pool, 2 * m, sizeof *s->select);
  s->iwork = stf_pool_array(pool, (size_t)s->liwork, sizeof *s->iwork);
  if (!s->re || !s->work || !s->select || !s->iwork) return STEIF_NO_MEMORY;
  s->im = s->re + m;
  s->beta = s->im + m;
  s->size = s->beta + m;
  memcpy(s->separation.E, E, m * m * sizeof *E);
  memcpy(s->separation.F, F, m * m * sizeof *F);
  return STEIF_OK;
}

static void triangularise(schur *s)
{
  stf_separation *p = &s->separation;
  int found, info;
  dgges_("V", "V", "N", NULL, &p->n, p->F, &p->n, p->E, &p->n, &found, s->re, s->im, s->beta,
         p->P, &p->n, p->Q, &p->n, s->work, &s->lwork, s->select, &info, 1, 1, 1);
  if (info) s->objection = "the generalised Schur form did not converge";
}

/* |alpha / beta|; the two of a complex pair get the same value. */
static void measure(schur *s)
{
  for (int i = 0; i < s->separation.n; i++) {
    const sunrealtype alpha = hypot(s->re[i], s->im[i]);
    s->size[i] = s->beta[i] > 0 ? alpha / s->beta[i] : INFINITY;
    if (i > 0 && s->im[i] < 0 && s->im[i - 1] > 0)
      s->size[i] = s->size[i - 1] = fmax(s->size[i], s->size[i - 1]);
  }
}

/* The m largest; an objection when that would take one of a complex pair. */
static void choose(schur *s, int m)
{
  const int n = s->separation.n;
  int taken = 0;
  memset(s->select, 0, (size_t)n * sizeof *s->select);
  while (taken < m) {
    int most = -1;
    for (int i = 0; i < n; i++)
      if (!s->select[i] && (most < 0 || s->size[i] > s->size[most])) most = i;
    const bool pair = s->im[most] > 0;
    s->select[most] = 1;
    if (pair) s->select[most + 1] = 1;
    taken += pair ? 2 : 1;
  }
  if (taken > m) s->objection = "the separation falls between two conjugate eigenvalues";
  s->radius = 0;
  s->edge = INFINITY;
  for (int i = 0; i < n; i++)
    if (s->select[i])
      s->edge = fmin(s->edge, s->size[i]);
    else
      s->radius = fmax(s->radius, s->size[i]);
}

static void reorder(schur *s, int m)
{
  stf_separation *p = &s->separation;
  const int none = 0, yes = 1;
  int leads, info;
  sunrealtype pl, pr, dif[2];
  p->m = m;
  if (s->objection || !m || m == p->n) return;
  dtgsen_(&none, &yes, &yes, s->select, &p->n, p->F, &p->n, p->E, &p->n, s->re, s->im, s->beta,
          p->P, &p->n, p->Q, &p->n, &leads, &pl, &pr, dif, s->work, &s->lwork, s->iwork,
          &s->liwork, &info);
  if (info || leads != m) s->objection = "the generalised Schur form could not be reordered";
}

static void decouple(schur *s)
{
  stf_separation *p = &s->separation;
  const int m = p->m, n = p->n, f = n - m, none = 0, one = 1;
  const size_t corner = (size_t)m * (size_t)n;
  sunrealtype scale = 1, dif, work = 0;
  int info;
  if (!m || !f) return;
  stf_separation_block(p, p->F, 0, m, m, f, p->R);
  stf_separation_block(p, p->E, 0, m, m, f, p->L);
  dtgsyl_("N", &none, &m, &f, p->F, &n, p->F + corner + m, &n, p->R, &m, p->E, &n,
          p->E + corner + m, &n, p->L, &m, &scale, &dif, &work, &one, s->iwork, &info, 1);
  /* info > 0, eigenvalues that are close, still leaves a solution: the two algorithms judge
   * it. */
  if (info < 0 || !(scale > 0)) {
    s->objection = "infinite and finite eigenvalues are too close to be decoupled";
    return;
  }
  for (size_t i = 0; i < (size_t)m * (size_t)f; i++) {
    p->R[i] /= -scale;
    p->L[i] /= scale;
  }
}

/* The index is 1 when E_inf is rounding, else the first j where N^j falls to sqrt(eps) of
 * ||N^{j-1}|| ||N||. */
static int find_index(schur *s, sunrealtype norm_E)
{
  const stf_separation *p = &s->separation;
  const int m = p->m;
  const size_t count = (size_t)m * (size_t)m;
  const sunrealtype noise = STF_SCHUR_NOISE * p->n * STF_EPS * norm_E;
  const sunrealtype first = stf_frobenius(m, m, p->E, p->n);
  s->index = m ? 1 : 0;
  s->gap = first > 0 ? norm_E / first : INFINITY;
  if (first <= noise) return STEIF_OK;
  sunrealtype *power = stf_pool_array(s->pool, 2 * count, sizeof *power);
  if (!power) return STEIF_NO_MEMORY;
  const sunrealtype norm = stf_frobenius(m, m, p->N, m);
  sunrealtype *next = power + count, before = norm;
  memcpy(power, p->N, count * sizeof *power);
  for (int j = 2; j <= m; j++) {
    stf_gemm('N', 'N', m, m, m, 1, p->N, m, power, m, 0, next, m);
    memcpy(power, next, count * sizeof *power);
    const sunrealtype now = stf_frobenius(m, m, power, m);
    s->index = j;
    s->gap = now > 0 ? before * norm / now : INFINITY;
    if (now <= sqrt(STF_EPS) * before * norm) return STEIF_OK;
    before = now;
  }
  s->objection = "its infinite part is not nilpotent";
  return STEIF_OK;
}

static void tell(const schur *s, steif_structure *structure)
{
  const stf_separation *p = &s->separation;
  structure->n = p->n;
  structure->method = "qz";
  structure->regular = 1;
  structure->index = s->objection ? -1 : s->index;
  structure->index_least = s->objection ? 0 : s->index;
  structure->finite = s->objection ? -1 : p->n - p->m;
  structure->infinite = s->objection ? -1 : p->m;
  structure->gap = s->gap;
  structure->radius = s->radius;
  structure->resolution = s->edge;
  snprintf(structure->message, sizeof structure->message, "%s",
           s->objection ? s->objection : "separated by the generalised Schur form");
}

static int run(schur *s, int m, sunrealtype norm_E, const stf_sources *sources,
               steif_structure *structure, steif_impulse *impulse)
{
  triangularise(s);
  if (!s->objection) {
    measure(s);
    choose(s, m);
    reorder(s, m);
  }
  if (!s->objection) {
    const int code = stf_separation_factor(s->pool, &s->separation);
    if (code != STEIF_OK && code != STEIF_RETRY) return code;
    if (code == STEIF_RETRY) s->objection = "one of the two parts is singular";
  }
  if (!s->objection) decouple(s);
  if (!s->objection) STEIF_TRY(find_index(s, norm_E));
  tell(s, structure);
  if (s->objection || !sources) return STEIF_OK;
  const int most = sources->f ? sources->derivatives + 1 : s->index;
  return stf_separation_impulse(&s->separation, s->index < most ? s->index : most, sources,
                                impulse);
}

int stf_schur(steif_context *ctx, int n, const sunrealtype *E, const sunrealtype *F,
              int infinite, const stf_sources *sources, steif_structure *structure,
              steif_impulse *impulse)
{
  schur s;
  stf_pool *pool = stf_pool_new(ctx);
  if (!pool) return STEIF_NO_MEMORY;
  int code = open(ctx, pool, n, E, F, &s);
  if (code == STEIF_OK)
    code = run(&s, infinite, stf_frobenius(n, n, E, n), sources, structure, impulse);
  stf_pool_free(&pool);
  return code;
}
