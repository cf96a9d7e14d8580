/* stage_system.c: the linear systems of the stages for all columns at once, dense or sparse.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>
#include <string.h>

enum { AT_ONCE = 8 }; /* right-hand sides that sparse factors take together */

/* ---- sparse ---- */

static void destroy_vector(void *y) { N_VDestroy(y); }

static void destroy_pencil(void *p)
{
  steif_pencil *pencil = p;
  steif_pencil_free(&pencil);
}

static sunindextype entries_of(SUNMatrix M, sunindextype n)
{
  sunindextype sum = 0;
  for (sunindextype j = 0; j < n; j++) sum += stf_jacobian_column(M, j).count;
  return sum;
}

/* Entry `used` of S and the next become column j of c M, moved down by `first` rows. */
static sunindextype append(SUNMatrix M, bool sparse, sunindextype j, sunrealtype c,
                           sunindextype first, sunindextype used, SUNMatrix S)
{
  const stf_entries from = sparse ? stf_sparse_column(M, j) : stf_jacobian_column(M, j);
  sunindextype *row = SM_INDEXVALS_S(S) + used;
  sunrealtype *value = SM_DATA_S(S) + used;
  for (sunindextype e = 0; e < from.count; e++) {
    row[e] = first + stf_row_of(&from, e);
    value[e] = c * from.value[e];
  }
  return used + from.count;
}

/* diag(E), of as many blocks as are solved together. */
static void repeat(const stf_variation *v, SUNMatrix S)
{
  const sunindextype d = v->d, blocks = v->system.order / d;
  const bool sparse = SUNMatGetID(v->E) == SUNMATRIX_SPARSE;
  sunindextype used = 0;
  for (sunindextype at = 0; at < blocks * d; at++) {
    SM_INDEXPTRS_S(S)[at] = used;
    used = append(v->E, sparse, at % d, 1, at - at % d, used, S);
  }
  SM_INDEXPTRS_S(S)[blocks * d] = used;
}

/* The blocks c_il J_i from stage `first` on. */
static void assemble(stf_variation *v, int first)
{
  const steif_glm *g = v->g;
  const int blocks = v->system.order / v->d;
  const bool sparse = SUNMatGetID(v->J[0]) == SUNMATRIX_SPARSE;
  SUNMatrix S = v->system.S;
  sunindextype used = 0;
  for (int l = 0; l < blocks; l++)
    for (sunindextype j = 0; j < v->d; j++) {
      SM_INDEXPTRS_S(S)[l * v->d + j] = used;
      for (int i = 0; i < blocks; i++) {
        const sunrealtype c = g->C[(first + i) * g->r + first + l];
        if (c != 0)
          used = append(v->J[first + i], sparse, j, c, (sunindextype)i * v->d, used, S);
      }
    }
  SM_INDEXPTRS_S(S)[v->system.order] = used;
}

static int open_columns(stf_pool *pool, stf_variation *v)
{
  stf_stage_system *s = &v->system;
  const size_t n = (size_t)s->order;
  sunrealtype *room = stf_pool_array(pool, AT_ONCE * n, sizeof *room);
  s->column = stf_pool_array(pool, AT_ONCE, sizeof *s->column);
  if (!room || !s->column) return STEIF_NO_MEMORY;
  for (int k = 0; k < AT_ONCE; k++) {
    s->column[k] = N_VMake_Serial(s->order, room + (size_t)k * n, steif_sundials(v->ctx));
    STEIF_CHECK(s->column[k], v->ctx, STEIF_NO_MEMORY, "no memory for a vector of %d",
                s->order);
    STEIF_TRY(stf_pool_adopt(pool, s->column[k], destroy_vector));
  }
  return STEIF_OK;
}

static int open_sparse(stf_pool *pool, stf_variation *v)
{
  stf_stage_system *s = &v->system;
  const sunindextype n = s->order, blocks = n / v->d;
  const sunindextype each =
    SUNMatGetID(v->J[0]) == SUNMATRIX_SPARSE ? SM_NNZ_S(v->J[0]) : entries_of(v->J[0], v->d);
  s->S = stf_jacobian_new(pool, v->ctx, STEIF_SPARSE, n, 0, 0, blocks * blocks * each);
  if (!s->S) return STEIF_NO_MEMORY;
  if (v->E) {
    s->E =
      stf_jacobian_new(pool, v->ctx, STEIF_SPARSE, n, 0, 0, blocks * entries_of(v->E, v->d));
    if (!s->E) return STEIF_NO_MEMORY;
    repeat(v, s->E);
  }
  s->pencil = steif_pencil_new(v->ctx, s->E, s->S);
  if (!s->pencil) return steif_status(v->ctx);
  STEIF_TRY(stf_pool_adopt(pool, s->pencil, destroy_pencil));
  return open_columns(pool, v);
}

static int factor_sparse(stf_variation *v, int first)
{
  stf_stage_system *s = &v->system;
  assemble(v, first);
  STEIF_TRY(steif_pencil_update(s->pencil));
  return steif_pencil_factor(s->pencil, 1, &(steif_shift){1 / v->h, 0});
}

/* (1/h diag(E) - c J) K = K / h, some columns of K at a time, which are rows by rows there. */
static int solve_sparse(stf_variation *v, sunrealtype *K)
{
  const stf_stage_system *s = &v->system;
  const size_t m = (size_t)v->m, n = (size_t)s->order;
  const sunrealtype rate = 1 / v->h;
  sunrealtype *x = NV_DATA_S(s->column[0]);
  for (size_t from = 0; from < m; from += AT_ONCE) {
    const size_t now = m - from < AT_ONCE ? m - from : AT_ONCE;
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < now; k++) x[k * n + i] = rate * K[i * m + from + k];
    STEIF_TRY(steif_pencil_solve(s->pencil, 0, (int)now, s->column, NULL));
    for (size_t i = 0; i < n; i++)
      for (size_t k = 0; k < now; k++) K[i * m + from + k] = x[k * n + i];
  }
  return STEIF_OK;
}

/* ---- dense ---- */

static int factor_dense(stf_variation *v, int first)
{
  stf_stage_system *s = &v->system;
  const steif_glm *g = v->g;
  const int n = s->order, d = v->d, blocks = n / d;
  memset(s->matrix, 0, (size_t)n * (size_t)n * sizeof *s->matrix);
  for (int i = 0; i < blocks; i++) {
    for (int l = 0; l < blocks; l++)
      stf_jacobian_spread(v->J[first + i], -v->h * g->C[(first + i) * g->r + first + l], n,
                          i * d, l * d, s->matrix);
    if (v->E) stf_jacobian_spread(v->E, 1, n, i * d, i * d, s->matrix);
  }
  for (int i = 0; i < n && !v->E; i++) s->matrix[(size_t)i * (size_t)n + (size_t)i] += 1;
  return stf_factor(n, s->matrix, &v->algebra) ? STEIF_OK : STEIF_SINGULAR;
}

/* ---- both ---- */

int stf_stage_system_open(stf_pool *pool, stf_variation *v)
{
  stf_stage_system *s = &v->system;
  const size_t n = (size_t)(v->shape == STEIF_COLLOCATION ? v->g->r * v->d : v->d);
  s->order = (int)n;
  s->c = NAN;
  if (v->problem->storage != STEIF_DENSE)
    return v->shape == STEIF_EXPLICIT ? STEIF_OK : open_sparse(pool, v);
  s->matrix = stf_pool_array(pool, n * n, sizeof *s->matrix);
  return s->matrix ? STEIF_OK : STEIF_NO_MEMORY;
}

int stf_stage_system_solve(stf_variation *v, int i)
{
  stf_stage_system *s = &v->system;
  const sunrealtype c = v->g->C[i * v->g->r + i];
  sunrealtype *K = v->K + (size_t)i * (size_t)v->d * (size_t)v->m;
  if (!(v->problem->linear && s->c == c)) {
    s->c = NAN;
    const int code = s->matrix ? factor_dense(v, i) : factor_sparse(v, i);
    STEIF_CHECK(
      code != STEIF_SINGULAR, v->ctx, STEIF_SINGULAR,
      "the stages of %s on the variational equation of '%s' are singular at t = %.12g with "
      "h = %g: 1/h meets the spectrum of J; change h a little",
      v->method, v->problem->name, v->t, v->h);
    STEIF_TRY(code);
    s->c = c;
  }
  if (!s->matrix) return solve_sparse(v, K);
  stf_substitute(s->order, v->m, s->matrix, K, &v->algebra);
  return STEIF_OK;
}
