/* tangent.c: a problem and one solution of its variational equation, side by side.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "tangent.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/pencil.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* -- callbacks --------------------------------------------------------------------------- */

static void clear(SUNMatrix M)
{
  if (SUNMatGetID(M) != SUNMATRIX_SPARSE) SUNMatZero(M);
}

static int jacobian(stf_tangent *g, sunrealtype t, N_Vector y, N_Vector fy)
{
  const steif_problem *p = g->problem;
  clear(g->J);
  return p->jac(t, y, fy, g->J, p->user, g->scratch[0], g->scratch[1], g->scratch[2]);
}

/* F_y + c F_y' at the views. */
static int pencil(stf_tangent *g, sunrealtype t, sunrealtype c)
{
  const steif_problem *p = g->problem;
  clear(g->J);
  return p->idajac(t, c, g->y, g->yp, g->fy, g->J, p->user, g->scratch[0], g->scratch[1],
                   g->scratch[2]);
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

/* F_y w + F_y' w' = F_y (w - w') + (F_y + F_y') w'. */
static int residual(sunrealtype t, N_Vector z, N_Vector zp, N_Vector r, void *data)
{
  stf_tangent *g = data;
  const steif_problem *p = g->problem;
  aim(g, N_VGetArrayPointer(z), g->y, g->w);
  aim(g, N_VGetArrayPointer(zp), g->yp, g->wp);
  aim(g, N_VGetArrayPointer(r), g->fy, g->fw);
  int code = p->F(t, g->y, g->yp, g->fy, p->user);
  if (code || g->direct) return code;
  N_VLinearSum(1, g->w, -1, g->wp, g->turn);
  if ((code = pencil(g, t, 0))) return code;
  if (SUNMatMatvec(g->J, g->turn, g->part)) return -1;
  if ((code = pencil(g, t, 1))) return code;
  if (SUNMatMatvec(g->J, g->wp, g->fw)) return -1;
  N_VLinearSum(1, g->part, 1, g->fw, g->fw);
  return 0;
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

static int pencil_matrix(sunrealtype t, sunrealtype c, N_Vector z, N_Vector zp, N_Vector r,
                         SUNMatrix M, void *data, N_Vector a, N_Vector b, N_Vector d)
{
  stf_tangent *g = data;
  const steif_problem *p = g->problem;
  if (g->direct) return p->idajac(t, c, z, zp, r, M, p->user, a, b, d);
  aim(g, N_VGetArrayPointer(z), g->y, g->w);
  aim(g, N_VGetArrayPointer(zp), g->yp, g->wp);
  aim(g, N_VGetArrayPointer(r), g->fy, g->fw);
  const int code = pencil(g, t, c);
  if (code == 0) twice(g->J, M);
  return code;
}

static int leading(sunrealtype t, N_Vector z, N_Vector zp, SUNMatrix M, void *data)
{
  stf_tangent *g = data;
  const steif_problem *p = g->problem;
  if (g->direct) return p->E(t, z, zp, M, p->user);
  aim(g, N_VGetArrayPointer(z), g->y, g->w);
  aim(g, N_VGetArrayPointer(zp), g->yp, g->wp);
  clear(g->E);
  const int code = p->E(t, g->y, g->yp, g->E, p->user);
  if (code == 0) twice(g->E, M);
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

enum { ROOM = 7 }; /* vectors of the problem's length */

/* -- opening ----------------------------------------------------------------------------- */

static int evaluate(const stf_tangent *g, sunrealtype t, N_Vector y, N_Vector yp, N_Vector out)
{
  const steif_problem *p = g->problem;
  return p->F ? p->F(t, y, yp, out, p->user) : p->f(t, y, out, p->user);
}

/* f(t, 2 y) = 2 f(t, y) and f(t, -y) = -f(t, y) bit for bit, and f(t, y + x) the sum to rounding,
 * at t0 and t1: linear and homogeneous; F likewise in (y, y'). */
static void probe(stf_tangent *g, N_Vector *v)
{
  const steif_problem *p = g->problem;
  const sunindextype n = g->n;
  sunrealtype *a[ROOM];
  for (int k = 0; k < ROOM; k++) a[k] = N_VGetArrayPointer(v[k]);
  g->direct = true;
  for (int end = 0; end < 2 && g->direct; end++) {
    const sunrealtype t = end ? p->t1 : p->t0;
    static const sunrealtype part[][2] = {{1, 0}, {0, 1}, {1, 1}, {2, 0}, {-1, 0}};
    N_Vector out[5] = {v[1], v[2], v[3], v[4], v[5]};
    for (int k = 0; k < 5; k++) {
      for (sunindextype i = 0; i < n; i++) {
        a[0][i] = part[k][0] * sin(1 + (sunrealtype)i) + part[k][1] * cos(2 * (sunrealtype)i);
        a[6][i] = part[k][0] * cos(3 * (sunrealtype)i) + part[k][1] * sin(2 + (sunrealtype)i);
      }
      if (evaluate(g, t, v[0], v[6], out[k])) g->direct = false;
    }
    sunrealtype most = 0;
    for (sunindextype i = 0; i < n; i++) most = fmax(most, fmax(fabs(a[1][i]), fabs(a[2][i])));
    for (sunindextype i = 0; i < n && g->direct; i++)
      g->direct = a[4][i] == 2 * a[1][i] && a[5][i] == -a[1][i] &&
                  fabs(a[3][i] - a[1][i] - a[2][i]) <= STF_LINEAR_OFF * most;
  }
  bool nothing = true; /* a start of 0 does not tell what is consistent */
  for (sunindextype i = 0; i < n; i++) nothing = nothing && p->y0[i] == 0;
  g->direct = g->direct && !(nothing && g->form != STEIF_ODE);
}

static void destroy_vector(void *v) { N_VDestroy(v); }
static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static SUNMatrix storage_of(const stf_tangent *g, sunindextype entries)
{
  const steif_problem *p = g->problem;
  SUNContext sun = steif_sundials(g->ctx);
  return p->storage == STEIF_DENSE  ? SUNDenseMatrix(p->n, p->n, sun)
         : p->storage == STEIF_BAND ? SUNBandMatrix(p->n, p->upper, p->lower, sun)
                                    : SUNSparseMatrix(p->n, p->n, entries, CSC_MAT, sun);
}

static int claim_matrix(stf_pool *pool, stf_tangent *g, sunindextype entries, SUNMatrix *M)
{
  *M = storage_of(g, entries > 0 ? entries : 1);
  STEIF_CHECK(*M, g->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)g->n);
  return stf_pool_adopt(pool, *M, destroy_matrix);
}

static int open_matrices(stf_pool *pool, stf_tangent *g)
{
  const steif_problem *p = g->problem;
  const sunindextype stated = p->pattern ? p->pattern->column[p->n] : 1;
  const sunindextype entries = p->nnz > stated ? p->nnz : stated;
  STEIF_CHECK((p->F ? p->idajac != NULL : p->jac != NULL) && p->storage != STEIF_KRYLOV, g->ctx,
              STEIF_UNSUPPORTED,
              "problem '%s' is not linear and homogeneous: its variational equation needs .%s "
              "and a storage with a matrix",
              p->name, p->F ? "idajac" : "jac");
  STEIF_TRY(claim_matrix(pool, g, entries, &g->J));
  g->pair.nnz = 2 * entries;
  g->pair.nnz_E = 2 * p->nnz_E;
  return p->E ? claim_matrix(pool, g, p->nnz_E, &g->E) : STEIF_OK;
}

static int open_views(stf_pool *pool, stf_tangent *g)
{
  N_Vector *const view[] = {&g->y, &g->fy, &g->yp, &g->w, &g->fw, &g->wp};
  for (int k = 0; k < 6; k++) {
    *view[k] = N_VNewEmpty_Serial(g->n, steif_sundials(g->ctx));
    STEIF_CHECK(*view[k], g->ctx, STEIF_NO_MEMORY, "no memory for a vector");
    STEIF_TRY(stf_pool_adopt(pool, *view[k], destroy_vector));
  }
  return STEIF_OK;
}

/* Callbacks are handed the tangent: only those that know it are taken over. */
static steif_problem pair_of(stf_tangent *g)
{
  const steif_problem *p = g->problem;
  steif_problem z = {.name = p->name,
                     .n = g->direct ? p->n : 2 * p->n,
                     .f = p->F ? NULL : slope,
                     .jac = p->jac ? matrix : NULL,
                     .E = p->E ? leading : NULL,
                     .F = p->F ? residual : NULL,
                     .idajac = p->idajac ? pencil_matrix : NULL,
                     .user = g,
                     .storage = p->storage,
                     .lower = p->lower,
                     .upper = p->upper,
                     .nnz = g->pair.nnz,
                     .nnz_E = g->pair.nnz_E,
                     .autonomous = p->autonomous,
                     .rtol_scale = p->rtol_scale,
                     .breaks = p->breaks,
                     .break_count = p->break_count};
  if (g->direct) {
    z.nnz = p->nnz;
    z.nnz_E = p->nnz_E;
    z.pattern = p->pattern;
    z.linear = p->linear;
  }
  return z;
}

static int suits(stf_tangent *g)
{
  const steif_problem *p = g->problem;
  g->form = steif_problem_form(g->ctx, p);
  if (!g->form) return steif_status(g->ctx);
  STEIF_CHECK(
    g->form != STEIF_DESCRIPTOR && p->y0 && !p->handle_event, g->ctx, STEIF_UNSUPPORTED,
    "problem '%s' of the form %s is not M y' = f(t, y) or F(t, y, y') = 0 with .y0, without "
    "events that change y",
    p->name, steif_form_name(g->form));
  STEIF_CHECK(p->dae_index <= 1, g->ctx, STEIF_UNSUPPORTED,
              "problem '%s' has index %d: its variational equation has hidden constraints; "
              "reduce it to index 1",
              p->name, p->dae_index);
  return STEIF_OK;
}

int stf_tangent_open(stf_pool *pool, steif_context *ctx, const steif_problem *p, stf_tangent *g)
{
  *g = (stf_tangent){.ctx = ctx, .problem = p, .n = p->n};
  STEIF_TRY(suits(g));
  N_Vector like = N_VNew_Serial(p->n, steif_sundials(ctx));
  STEIF_CHECK(like, ctx, STEIF_NO_MEMORY, "no memory for a vector of %lld", (long long)p->n);
  STEIF_TRY(stf_pool_adopt(pool, like, destroy_vector));
  N_Vector *room = stf_pool_vectors(pool, ROOM, like);
  if (!room) return STEIF_NO_MEMORY;
  STEIF_TRY(open_views(pool, g));
  probe(g, room);
  for (int k = 0; k < 3; k++) g->scratch[k] = room[k];
  g->turn = room[3];
  g->part = room[4];
  g->side = room[5];
  if (!g->direct) STEIF_TRY(open_matrices(pool, g));
  g->pair = pair_of(g);
  return STEIF_OK;
}

/* -- the start --------------------------------------------------------------------------- */

/* c E w and c E - J, or the same of F, at the start with y frozen. */
static int start_matrix(stf_tangent *g, sunrealtype c, sunrealtype *z, N_Vector side)
{
  const steif_problem *p = g->problem;
  const sunrealtype t = p->t0;
  N_VConst(0, g->turn);
  aim(g, z, g->y, g->w);
  aim(g, N_VGetArrayPointer(g->turn), g->yp, g->yp);
  aim(g, N_VGetArrayPointer(g->part), g->fy, g->fy);
  if (p->yp0) memcpy(N_VGetArrayPointer(g->turn), p->yp0, (size_t)g->n * sizeof *z);
  int code = evaluate(g, t, g->y, g->yp, g->fy);
  if (!code && p->F) {
    if ((code = pencil(g, t, 0)) || (code = SUNMatMatvec(g->J, g->w, side))) return code;
    if ((code = pencil(g, t, 1)) || (code = SUNMatMatvec(g->J, g->w, g->fy))) return code;
    N_VLinearSum(-c, g->fy, c, side, side); /* the pencil below is -(F_y + c F_y') */
    return pencil(g, t, c);
  }
  if (code || (code = jacobian(g, t, g->y, g->fy))) return code;
  clear(g->E);
  if ((code = p->E(t, g->y, g->yp, g->E, p->user))) return code;
  code = SUNMatMatvec(g->E, g->w, side);
  N_VScale(c, side, side);
  return code;
}

/* (c E - J) w = c E w_0, c large. */
static int make_consistent(stf_tangent *g, sunrealtype *z, N_Vector side)
{
  const steif_problem *p = g->problem;
  const sunrealtype c = STF_CONSISTENT_SHIFT / (p->t1 - p->t0);
  const int failed = start_matrix(g, c, z, side);
  STEIF_CHECK(!failed, g->ctx, STEIF_CALLBACK,
              "a callback of problem '%s' returned %d at the start, t = %.12g", p->name, failed,
              p->t0);
  const steif_shift shift = {p->F ? 0 : c, 0};
  steif_pencil *shifted = steif_pencil_new(g->ctx, p->F ? NULL : g->E, g->J);
  int code = shifted ? steif_pencil_factor(shifted, 1, &shift) : steif_status(g->ctx);
  if (code == STEIF_OK) code = steif_pencil_solve(shifted, 0, 1, &side, NULL);
  steif_pencil_free(&shifted);
  if (code == STEIF_OK) memcpy(z + g->n, N_VGetArrayPointer(side), (size_t)g->n * sizeof *z);
  return code;
}

int stf_tangent_begin(stf_tangent *g, sunrealtype *z)
{
  const size_t bytes = (size_t)g->n * sizeof *z;
  sunrealtype *w = z + (g->direct ? 0 : g->n);
  memcpy(z, g->problem->y0, bytes);
  memcpy(w, g->problem->y0, bytes);
  const bool nothing = !(stf_tangent_size(g, z) > 0);
  for (sunindextype i = 0; nothing && i < g->n; i++) w[i] = 1;
  return g->direct || g->form == STEIF_ODE ? STEIF_OK : make_consistent(g, z, g->side);
}
