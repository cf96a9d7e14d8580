/* array.c: x(0+) and impulses of a sparse system of index k by sparse QR of the impulse array. The
 * unknowns u_r = c_{k-2}, ..., c_0, x(0+), x'(0+), ..., x^(k)(0+) satisfy
 *   E u_r + F u_{r-1} = b_r,  r = 0 .. 2k-1,  u_{-1} = 0,
 * b_{k-1} = E x(0-), b_{k+j} = f^(j)(0+), the others 0. The rank is 2kn - (n - n_f), n_f the number
 * of finite eigenvalues, and the kernel vanishes in c_i and x(0+): a basic solution has them. With
 * u_r = tau^-r y_r the blocks are E / tau and F, equilibrated. No shift and no circle is needed;
 * certified when the rank is that of n_f = the structural degree for two values of tau, and the two
 * answers agree. T. A. Davis, Algorithm 915, ACM TOMS 38 (2011): SuiteSparseQR, which is under the
 * GPL and is linked with -DSTEIF_SPQR=ON only.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "circle.h"

#ifdef STEIF_HAVE_SPQR
#include <SuiteSparseQR_C.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

enum { TAUS = 2 };
/* A circle lies ten times as far out as the eigenvalues end: tau = 10/R, and 1/R for comparison. */
static const sunrealtype apart = 10;
static const sunrealtype agreed = 1e-3, fitting = 1e-6; /* of two answers; of a residual */

typedef struct array {
  stf_scaled scaled;
  cholmod_common common;
  const stf_sources *sources;
  steif_impulse *impulse;
  cholmod_sparse *A;
  cholmod_dense *b;
  sunindextype rank[TAUS];
  sunrealtype left;   /* largest ||b - A y|| / ||b|| */
  sunrealtype *first; /* x(0+) of the first tau */
  int k, terms;
} array;

static int failed(const array *w)
{
  const steif_impulse *i = w->impulse;
  STEIF_CHECK(w->common.status != CHOLMOD_OUT_OF_MEMORY, w->scaled.ctx, STEIF_NO_MEMORY,
              "no memory for the QR factors of the impulse array of index %d (%lld equations); "
              "take the contour",
              i->index, 2 * w->k * (long long)i->n);
  return STEIF_FAIL(w->scaled.ctx, STEIF_UNSUPPORTED,
                    "SuiteSparseQR failed with status %d on the impulse array of %lld equations",
                    w->common.status, 2 * w->k * (long long)i->n);
}

/* Column j of M times `factor` behind the entries there, moved down by `shift` rows. */
static void put(array *w, SUNMatrix M, sunindextype j, sunrealtype factor, sunindextype shift,
                SuiteSparse_long *used)
{
  for (sunindextype p = SM_INDEXPTRS_S(M)[j]; p < SM_INDEXPTRS_S(M)[j + 1]; p++) {
    ((SuiteSparse_long *)w->A->i)[*used] = SM_INDEXVALS_S(M)[p] + shift;
    ((double *)w->A->x)[(*used)++] = factor * SM_DATA_S(M)[p];
  }
}

/* Column block r: E / tau in row block r, F (the scaled matrix holds -F) in row block r + 1. */
static void fill(array *w, sunrealtype tau)
{
  const sunindextype n = w->scaled.n;
  SuiteSparse_long used = 0, *at = w->A->p;
  for (int r = 0; r < 2 * w->k; r++)
    for (sunindextype j = 0; j < n; j++) {
      at[r * n + j] = used;
      put(w, w->scaled.E, j, 1 / tau, r * n, &used);
      if (r + 1 < 2 * w->k) put(w, w->scaled.A, j, -1, (r + 1) * n, &used);
    }
  at[2 * w->k * n] = used;
}

/* Row block r of b is tau^(r-1) b_r, with the scales of the rows. */
static void load(array *w, sunrealtype tau)
{
  const sunindextype n = w->scaled.n;
  sunrealtype *b = w->b->x, weight = pow(tau, w->k - 2);
  memset(b, 0, 2 * (size_t)w->k * (size_t)n * sizeof *b);
  for (int j = -1; j < w->terms; j++, weight *= tau) {
    const sunrealtype *from = j < 0 ? w->sources->Ex0 : w->sources->f + j * n;
    for (sunindextype i = 0; i < n; i++)
      b[(w->k + j) * n + i] = weight * w->scaled.row[i] * from[i];
  }
}

/* c_i = u_{k-2-i} and x(0+) = u_{k-1}. */
static void take(array *w, sunrealtype tau, const sunrealtype *y)
{
  const sunindextype n = w->scaled.n;
  steif_impulse *out = w->impulse;
  for (int r = 0; r < w->k; r++) {
    sunrealtype *u = r == w->k - 1 ? out->x_plus : out->c + (w->k - 2 - r) * n;
    for (sunindextype i = 0; i < n; i++)
      u[i] = pow(tau, -r) * w->scaled.column[i] * y[r * n + i];
  }
}

/* ||b - A y|| / ||b||, b spoilt. */
static sunrealtype misfit(array *w, cholmod_dense *y)
{
  double one[2] = {1, 0}, minus[2] = {-1, 0};
  const double size = cholmod_l_norm_dense(w->b, 2, &w->common);
  cholmod_l_sdmult(w->A, 0, minus, one, y, w->b, &w->common);
  return size > 0 ? cholmod_l_norm_dense(w->b, 2, &w->common) / size : 0;
}

static int answer(array *w, int which, sunrealtype tau)
{
  STEIF_TRY(stf_scaled_set(&w->scaled, 1 / tau));
  fill(w, tau), load(w, tau);
  cholmod_dense *y = SuiteSparseQR_C_backslash(SPQR_ORDERING_DEFAULT, SPQR_DEFAULT_TOL, w->A,
                                               w->b, &w->common);
  if (!y) return failed(w);
  w->rank[which] = (sunindextype)w->common.SPQR_istat[4];
  take(w, tau, y->x);
  w->left = fmax(w->left, misfit(w, y));
  cholmod_l_free_dense(&y, &w->common);
  return STEIF_OK;
}

static void say(array *w, const steif_structure *s)
{
  steif_impulse *out = w->impulse;
  const long long all = 2 * w->k * (long long)out->n,
                  wanted = all - ((long long)out->n - (long long)s->degree);
  const bool full = w->rank[0] == wanted && w->rank[1] == wanted;
  out->certified =
    full && s->degree >= 0 && w->left <= fitting && out->estimate <= agreed && s->index >= 0;
  snprintf(out->message, sizeof out->message,
           "%sthe impulse array has rank %lld and %lld of %lld at two scales of time, %lld where "
           "the structural degree %lld is the number of finite eigenvalues; residual %.1e, x(0+) "
           "apart by %.1e",
           out->certified ? "" : "not certified: ", (long long)w->rank[0],
           (long long)w->rank[1], all, wanted, (long long)s->degree, w->left, out->estimate);
}

static int analyse(array *w, sunrealtype R, const steif_structure *structure)
{
  const sunindextype n = w->scaled.n;
  steif_impulse *out = w->impulse;
  sunrealtype off = 0, size = 0;
  STEIF_TRY(answer(w, 0, 1 / R));
  memcpy(w->first, out->x_plus, (size_t)n * sizeof *w->first);
  STEIF_TRY(answer(w, 1, apart / R));
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype d = out->x_plus[i] - w->first[i];
    off += d * d, size += out->x_plus[i] * out->x_plus[i];
  }
  out->estimate = off > 0 ? sqrt(off / size) : 0;
  say(w, structure);
  return STEIF_OK;
}

static int claim(array *w)
{
  const size_t n = (size_t)w->scaled.n, all = 2 * (size_t)w->k * n;
  const size_t entries = (size_t)SM_INDEXPTRS_S(w->scaled.E)[n] +
                         (size_t)SM_INDEXPTRS_S(w->scaled.A)[n];
  w->first = stf_claim(w->scaled.pool, n, sizeof *w->first);
  if (!w->first) return STEIF_NO_MEMORY;
  w->A = cholmod_l_allocate_sparse(all, all, 2 * (size_t)w->k * entries, 0, 1, 0, CHOLMOD_REAL,
                                   &w->common);
  w->b = w->A ? cholmod_l_allocate_dense(all, 1, all, CHOLMOD_REAL, &w->common) : NULL;
  return w->b ? STEIF_OK : failed(w);
}

int stf_array_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, const sunrealtype *x0,
                      const stf_sources *sources, steif_structure *structure,
                      steif_impulse *impulse)
{
  const int index = structure->index < 0 ? structure->index_least : structure->index;
  (void)x0; /* only E x(0-) enters */
  STEIF_CHECK(!sources->f || index <= sources->derivatives + 1, ctx, STEIF_BAD_INPUT,
              "index %d asks for derivatives of the forcing up to order %d, %d is known: give "
              "them in the forcing function",
              index, index - 1, sources->derivatives);
  STEIF_TRY(stf_impulse_claim(ctx, sources->n, index, impulse));
  impulse->method = "array";
  array w = {.sources = sources, .impulse = impulse, .k = index > 1 ? index : 1};
  w.terms = sources->f ? w.k < index ? w.k : index : 0;
  STEIF_TRY(stf_scaled_open(ctx, E, F, &w.scaled));
  cholmod_l_start(&w.common);
  w.common.print = 0;
  int code = claim(&w);
  if (!code) code = analyse(&w, stf_radius(E, F, analysis, structure), structure);
  cholmod_l_free_dense(&w.b, &w.common), cholmod_l_free_sparse(&w.A, &w.common);
  cholmod_l_finish(&w.common);
  stf_scaled_close(&w.scaled);
  return code;
}

#else

int stf_array_impulse(steif_context *ctx, SUNMatrix E, SUNMatrix F,
                      const steif_analysis *analysis, const sunrealtype *x0,
                      const stf_sources *sources, steif_structure *structure,
                      steif_impulse *impulse)
{
  (void)E, (void)F, (void)analysis, (void)x0, (void)sources, (void)structure, (void)impulse;
  return STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
                    "steif was built without SuiteSparseQR, which is under the GPL: build it anew "
                    "with -DSTEIF_SPQR=ON, or take the contour");
}

#endif
