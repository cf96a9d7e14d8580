/* tangent.c: a problem and one solution of its variational equation, side by side.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tangent.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* -- callbacks --------------------------------------------------------------------------- */

static int jacobian(stf_tangent *g, sunrealtype t, N_Vector y, N_Vector fy)
{
  const steif_problem *p = g->problem;
  if (SUNMatGetID(g->J) != SUNMATRIX_SPARSE) SUNMatZero(g->J);
  return p->jac(t, y, fy, g->J, p->user, g->scratch[0], g->scratch[1], g->scratch[2]);
}

static void aim(const stf_tangent *g, sunrealtype *z, N_Vector upper, N_Vector lower)
{
  N_VSetArrayPointer(z, upper);
  N_VSetArrayPointer(z + (g->direct ? 0 : g->n), lower);
}

static int slope(sunrealtype t, N_Vector z, N_Vector zdot, void *data)
{
  stf_tangent *g = data;
  aim(g, N_VGetArrayPointer(z), g->y, g->w);
  aim(g, N_VGetArrayPointer(zdot), g->fy, g->fw);
  const int code = g->problem->f(t, g->y, g->fy, g->problem->user);
  if (code || g->direct) return code;
  const int filled = jacobian(g, t, g->y, g->fy);
  if (filled) return filled;
  return SUNMatMatvec(g->J, g->w, g->fw) ? -1 : 0;
}

static void twice_sparse(SUNMatrix J, SUNMatrix to)
{
  const sunindextype n = SM_COLUMNS_S(J), *column = SM_INDEXPTRS_S(J), *row = SM_INDEXVALS_S(J),
                     nnz = column[n];
  for (int half = 0; half < 2; half++)
    for (sunindextype j = 0; j < n; j++) {
      SM_INDEXPTRS_S(to)[half * n + j] = half * nnz + column[j];
      for (sunindextype e = column[j]; e < column[j + 1]; e++) {
        SM_INDEXVALS_S(to)[half * nnz + e] = half * n + row[e];
        SM_DATA_S(to)[half * nnz + e] = SM_DATA_S(J)[e];
      }
    }
  SM_INDEXPTRS_S(to)[2 * n] = 2 * nnz;
}

/* diag(J, J); dense and band matrices arrive zeroed. */
static void twice(SUNMatrix J, SUNMatrix to)
{
  if (SUNMatGetID(J) == SUNMATRIX_SPARSE) {
    twice_sparse(J, to);
    return;
  }
  const bool band = SUNMatGetID(J) == SUNMATRIX_BAND;
  const sunindextype n = band ? SM_COLUMNS_B(J) : SM_COLUMNS_D(J);
  for (sunindextype j = 0; j < 2 * n; j++)
    for (sunindextype i = 0; i < n; i++)
      if (!band)
        SM_ELEMENT_D(to, j < n ? i : n + i, j) = SM_ELEMENT_D(J, i, j % n);
      else if (i - j % n <= SM_LBAND_B(J) && j % n - i <= SM_UBAND_B(J))
        SM_ELEMENT_B(to, j < n ? i : n + i, j) = SM_ELEMENT_B(J, i, j % n);
}

static int matrix(sunrealtype t, N_Vector z, N_Vector fz, SUNMatrix M, void *data, N_Vector a,
                  N_Vector b, N_Vector c)
{
  stf_tangent *g = data;
  const steif_problem *p = g->problem;
  if (g->direct) return p->jac(t, z, fz, M, p->user, a, b, c);
  aim(g, N_VGetArrayPointer(z), g->y, g->w);
  aim(g, N_VGetArrayPointer(fz), g->fy, g->fw);
  const int code = jacobian(g, t, g->y, g->fy);
  if (code == 0) twice(g->J, M);
  return code;
}

sunrealtype stf_tangent_size(const stf_tangent *g, const sunrealtype *z)
{
  const sunrealtype *w = z + (g->direct ? 0 : g->n);
  sunrealtype most = 0, sum = 0;
  for (sunindextype i = 0; i < g->n; i++) most = fmax(most, fabs(w[i]));
  for (sunindextype i = 0; i < g->n && most > 0; i++) sum += (w[i] / most) * (w[i] / most);
  return most * sqrt(sum);
}

int stf_tangent_weights(N_Vector z, N_Vector ewt, void *data)
{
  const stf_tangent *g = data;
  const sunrealtype *y = N_VGetArrayPointer(z);
  sunrealtype *weight = N_VGetArrayPointer(ewt);
  const sunrealtype size = stf_tangent_size(g, y) / sqrt((sunrealtype)g->n);
  for (sunindextype i = 0; !g->direct && i < g->n; i++)
    weight[i] = 1 / (g->rtol * fabs(y[i]) + g->atol);
  for (sunindextype i = 0; i < g->n; i++)
    weight[i + (g->direct ? 0 : g->n)] = 1 / (g->rtol * size);
  return 0;
}

/* -- opening ----------------------------------------------------------------------------- */

/* f(t, 2 y) = 2 f(t, y) and f(t, -y) = -f(t, y) bit for bit, and f(t, y + x) the sum to rounding,
 * at t0 and t1: linear and homogeneous. */
static int probe(stf_tangent *g, N_Vector *v)
{
  const steif_problem *p = g->problem;
  const sunindextype n = g->n;
  sunrealtype *a[6];
  for (int k = 0; k < 6; k++) a[k] = N_VGetArrayPointer(v[k]);
  g->direct = true;
  for (int end = 0; end < 2 && g->direct; end++) {
    const sunrealtype t = end ? p->t1 : p->t0;
    static const sunrealtype part[][2] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {-1, 0}};
    N_Vector out[5] = {v[1], v[2], v[3], v[4], v[5]};
    for (int k = 0; k < 5; k++) {
      for (sunindextype i = 0; i < n; i++)
        a[0][i] = part[k][0] * sin(1 + (sunrealtype)i) + part[k][1] * cos(2 * (sunrealtype)i);
      if (p->f(t, v[0], out[k], p->user)) g->direct = false;
    }
    sunrealtype most = 0;
    for (sunindextype i = 0; i < n; i++) most = fmax(most, fmax(fabs(a[1][i]), fabs(a[2][i])));
    for (sunindextype i = 0; i < n && g->direct; i++)
      g->direct = a[4][i] == 2 * a[1][i] && a[5][i] == -a[1][i] &&
                  fabs(a[3][i] - a[1][i] - a[2][i]) <= 1e-12 * most;
  }
  return STEIF_OK;
}

static void destroy_vector(void *v) { N_VDestroy(v); }
static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int open_matrix(stf_pool *pool, stf_tangent *g)
{
  const steif_problem *p = g->problem;
  SUNContext sun = steif_sundials(g->ctx);
  const sunindextype stated = p->pattern ? p->pattern->column[p->n] : 1;
  const sunindextype entries = p->nnz > stated ? p->nnz : stated;
  STEIF_CHECK(p->jac && p->storage != STEIF_KRYLOV, g->ctx, STEIF_UNSUPPORTED,
              "problem '%s' is not linear and homogeneous: its variational equation needs .jac "
              "and a storage with a matrix",
              p->name);
  g->J = p->storage == STEIF_DENSE  ? SUNDenseMatrix(p->n, p->n, sun)
         : p->storage == STEIF_BAND ? SUNBandMatrix(p->n, p->upper, p->lower, sun)
                                    : SUNSparseMatrix(p->n, p->n, entries, CSC_MAT, sun);
  STEIF_CHECK(g->J, g->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)p->n);
  g->pair.nnz = 2 * entries;
  return stf_claim_owner(pool, g->J, destroy_matrix);
}

static int open_views(stf_pool *pool, stf_tangent *g)
{
  N_Vector *const view[] = {&g->y, &g->fy, &g->w, &g->fw};
  for (int k = 0; k < 4; k++) {
    *view[k] = N_VNewEmpty_Serial(g->n, steif_sundials(g->ctx));
    STEIF_CHECK(*view[k], g->ctx, STEIF_NO_MEMORY, "no memory for a vector");
    STEIF_TRY(stf_claim_owner(pool, *view[k], destroy_vector));
  }
  return STEIF_OK;
}

/* Callbacks are handed the tangent: only those that know it are taken over. */
static steif_problem pair_of(stf_tangent *g)
{
  const steif_problem *p = g->problem;
  steif_problem z = {.name = p->name,
                     .n = g->direct ? p->n : 2 * p->n,
                     .f = slope,
                     .jac = p->jac ? matrix : NULL,
                     .user = g,
                     .storage = p->storage,
                     .lower = p->lower,
                     .upper = p->upper,
                     .nnz = g->pair.nnz,
                     .autonomous = p->autonomous,
                     .rtol_scale = p->rtol_scale,
                     .breaks = p->breaks,
                     .break_count = p->break_count};
  if (g->direct) z.nnz = p->nnz, z.pattern = p->pattern, z.linear = p->linear;
  return z;
}

int stf_tangent_open(stf_pool *pool, steif_context *ctx, const steif_problem *p, stf_tangent *g)
{
  *g = (stf_tangent){.ctx = ctx, .problem = p, .n = p->n};
  N_Vector like = N_VNew_Serial(p->n, steif_sundials(ctx));
  STEIF_CHECK(like, ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld", (long long)p->n);
  STEIF_TRY(stf_claim_owner(pool, like, destroy_vector));
  N_Vector *room = stf_claim_vectors(pool, 6, like);
  if (!room) return STEIF_NO_MEMORY;
  STEIF_TRY(open_views(pool, g));
  STEIF_TRY(probe(g, room));
  for (int k = 0; k < 3; k++) g->scratch[k] = room[k];
  if (!g->direct) STEIF_TRY(open_matrix(pool, g));
  g->pair = pair_of(g);
  return STEIF_OK;
}
