/* variation.c: the variational equation along the solution that a method computes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "variation.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* ---- J ---- */

static int answer(const stf_variation *v, int returned, const char *what, sunrealtype t)
{
  STEIF_CHECK(returned == 0, v->ctx, STEIF_CALLBACK,
              "%s of problem '%s' returned %d at t = %.12g", what, v->problem->name, returned,
              t);
  return STEIF_OK;
}

static int slope(stf_variation *v, sunrealtype t, N_Vector y, N_Vector out)
{
  if (v->problem->F)
    return answer(v, v->problem->F(t, y, v->yp, out, v->problem->user), "F", t);
  return answer(v, v->problem->f(t, y, out, v->problem->user), "f", t);
}

/* By rows, from any storage. */
static void spread(SUNMatrix M, int d, sunrealtype *J)
{
  memset(J, 0, (size_t)d * (size_t)d * sizeof *J);
  if (SUNMatGetID(M) == SUNMATRIX_DENSE) {
    for (int j = 0; j < d; j++)
      for (int i = 0; i < d; i++) J[i * d + j] = SM_ELEMENT_D(M, i, j);
  } else if (SUNMatGetID(M) == SUNMATRIX_BAND) {
    for (int j = 0; j < d; j++)
      for (int i = 0; i < d; i++)
        if (j - i <= SM_UBAND_B(M) && i - j <= SM_LBAND_B(M))
          J[i * d + j] = SM_ELEMENT_B(M, i, j);
  } else {
    const sunindextype *column = SM_INDEXPTRS_S(M), *row = SM_INDEXVALS_S(M);
    for (int j = 0; j < d; j++)
      for (sunindextype e = column[j]; e < column[j + 1]; e++)
        J[(int)row[e] * d + j] += SM_DATA_S(M)[e];
  }
}

/* dF/dy + c dF/dy' by rows. */
static int implicit_matrix(stf_variation *v, sunrealtype t, sunrealtype c, N_Vector y,
                           sunrealtype *out)
{
  const steif_problem *p = v->problem;
  if (SUNMatGetID(v->M) != SUNMATRIX_SPARSE) SUNMatZero(v->M);
  STEIF_TRY(answer(
    v, p->idajac(t, c, y, v->yp, v->fy, v->M, p->user, v->slope[0], v->slope[1], v->slope[2]),
    "idajac", t));
  spread(v->M, v->d, out);
  return STEIF_OK;
}

int stf_variation_matrix(stf_variation *v, int at, sunrealtype t, N_Vector y)
{
  const steif_problem *p = v->problem;
  const size_t size = (size_t)v->d * (size_t)v->d;
  sunrealtype *J = v->J + (size_t)at * size;
  STEIF_TRY(slope(v, t, y, v->fy));
  if (p->F) {
    STEIF_TRY(implicit_matrix(v, t, 0, y, J));
    for (size_t e = 0; e < size; e++) J[e] = -J[e];
    return STEIF_OK;
  }
  if (SUNMatGetID(v->M) != SUNMATRIX_SPARSE) SUNMatZero(v->M);
  STEIF_TRY(answer(v, p->jac(t, y, v->fy, v->M, p->user, v->slope[0], v->slope[1], v->slope[2]),
                   "jac", t));
  spread(v->M, v->d, J);
  return STEIF_OK;
}

/* By elimination with full pivots; A is lost. */
static int rank_of(int n, sunrealtype *A)
{
  sunrealtype first = 0;
  for (int k = 0; k < n; k++) {
    int row = k, column = k;
    for (int i = k; i < n; i++)
      for (int j = k; j < n; j++)
        if (fabs(A[i * n + j]) > fabs(A[row * n + column])) row = i, column = j;
    const sunrealtype pivot = A[row * n + column];
    if (k == 0) first = fabs(pivot);
    if (!(fabs(pivot) > 1e-12 * first)) return k;
    for (int j = 0; j < n; j++) {
      const sunrealtype kept = A[k * n + j];
      A[k * n + j] = A[row * n + j], A[row * n + j] = kept;
    }
    for (int i = 0; i < n; i++) {
      const sunrealtype kept = A[i * n + k];
      A[i * n + k] = A[i * n + column], A[i * n + column] = kept;
    }
    for (int i = k + 1; i < n; i++)
      for (int j = n - 1; j >= k; j--) A[i * n + j] -= A[i * n + k] / pivot * A[k * n + j];
  }
  return n;
}

int stf_variation_leading(stf_variation *v)
{
  const steif_problem *p = v->problem;
  const size_t size = (size_t)v->d * (size_t)v->d;
  STEIF_TRY(slope(v, v->t, v->y, v->fy));
  if (p->F) {
    STEIF_TRY(implicit_matrix(v, v->t, 0, v->y, v->matrix));
    STEIF_TRY(implicit_matrix(v, v->t, 1, v->y, v->E));
    for (size_t e = 0; e < size; e++) v->E[e] -= v->matrix[e];
  } else {
    if (SUNMatGetID(v->M) != SUNMATRIX_SPARSE) SUNMatZero(v->M);
    STEIF_TRY(answer(v, p->E(v->t, v->y, v->yp, v->M, p->user), "E", v->t));
    spread(v->M, v->d, v->E);
  }
  memcpy(v->matrix, v->E, size * sizeof *v->E);
  v->finite = rank_of(v->d, v->matrix);
  return STEIF_OK;
}

/* ---- trajectories ---- */

static int linear_matrices(stf_variation *v)
{
  if (v->filled && v->problem->linear) return STEIF_OK;
  for (int i = 0; i < v->g->r; i++)
    STEIF_TRY(stf_variation_matrix(v, i, v->t + v->g->xi[i] * v->h, v->y));
  v->filled = true;
  return STEIF_OK;
}

static int explicit_matrices(stf_variation *v)
{
  const steif_glm *g = v->g;
  sunrealtype *y = N_VGetArrayPointer(v->y), *Y = N_VGetArrayPointer(v->stage);
  for (int i = 0; i < g->r; i++) {
    const sunrealtype t = v->t + g->xi[i] * v->h;
    memcpy(Y, y, (size_t)v->d * sizeof *y);
    for (int l = 0; l < i; l++)
      for (int e = 0; e < v->d; e++)
        Y[e] += v->h * g->C[i * g->r + l] * N_VGetArrayPointer(v->f[l])[e];
    STEIF_TRY(slope(v, t, v->stage, v->f[i]));
    STEIF_TRY(stf_variation_matrix(v, i, t, v->stage));
  }
  bool finite = true;
  for (int e = 0; e < v->d; e++) {
    for (int l = 0; l < g->r; l++) y[e] += v->h * g->D[l] * N_VGetArrayPointer(v->f[l])[e];
    finite = finite && isfinite(y[e]);
  }
  STEIF_CHECK(
    finite, v->ctx, STEIF_NOT_FINITE,
    "the solution of '%s' by %s overflows in the step to t = %.12g: take a smaller h than "
    "%g, or an implicit method",
    v->problem->name, v->method, v->t + v->h, v->h);
  return STEIF_OK;
}

static int implicit_matrices(stf_variation *v)
{
  int count;
  const sunrealtype *b, *c;
  N_Vector *Y;
  const steif_glm *g = v->g;
  STEIF_TRY(steif_solve_step(v->solver));
  const sunrealtype made = steif_time(v->solver) - v->t;
  STEIF_CHECK(
    fabs(made - v->h) <= 1e-6 * v->h, v->ctx, STEIF_UNSUPPORTED,
    "%s made a step of %g at t = %g where %g was asked for; exponents need equal steps",
    v->method, made, v->t, v->h);
  STEIF_TRY(steif_stages(v->solver, &count, &c, &b, &Y));
  if (count == 0) return stf_variation_matrix(v, 0, v->t + v->h, steif_solution(v->solver));
  for (int i = 0; i < g->r; i++)
    STEIF_TRY(stf_variation_matrix(v, i, v->t + g->xi[i] * v->h, Y[i]));
  return STEIF_OK;
}

/* ---- one step ---- */

/* base = sum_j U_ij X_j + sum_{l < last} C_il K_l */
static void stage_base(stf_variation *v, int i, int last)
{
  const steif_glm *g = v->g;
  const int size = v->d * v->m;
  memset(v->base, 0, (size_t)size * sizeof *v->base);
  for (int j = 0; j < g->k; j++)
    for (int e = 0; e < size; e++) v->base[e] += g->U[i * g->k + j] * v->X[j * size + e];
  for (int l = 0; l < last; l++) {
    const sunrealtype c = g->C[i * g->r + l];
    if (c == 0) continue;
    for (int e = 0; e < size; e++) v->base[e] += c * v->K[l * size + e];
  }
}

/* K_i = h J_i base */
static void stage_slope(stf_variation *v, int i)
{
  const size_t d = (size_t)v->d;
  stf_variation_product(v->d, v->m, v->h, v->J + (size_t)i * d * d, v->base,
                        v->K + i * v->d * v->m);
}

/* Block (i, l) of E - h J C at (row, column) of the matrix of order n. */
static void block(stf_variation *v, int i, int l, int n, int row, int column)
{
  const int d = v->d;
  const sunrealtype c = v->h * v->g->C[i * v->g->r + l];
  const sunrealtype *J = v->J + (size_t)i * (size_t)d * (size_t)d;
  for (int a = 0; a < d; a++)
    for (int b = 0; b < d; b++) {
      const sunrealtype e = v->E ? v->E[a * d + b] : a == b;
      v->matrix[(row + a) * n + column + b] = (i == l ? e : 0) - c * J[a * d + b];
    }
}

static bool stage_by_stage(stf_variation *v)
{
  const steif_glm *g = v->g;
  for (int i = 0; i < g->r; i++) {
    stage_base(v, i, i);
    stage_slope(v, i);
    if (g->C[i * g->r + i] == 0) continue;
    block(v, i, i, v->d, 0, 0);
    if (!stf_eliminate(v->d, v->m, v->matrix, v->K + i * v->d * v->m, &v->algebra))
      return false;
  }
  return true;
}

static bool all_stages(stf_variation *v)
{
  const int d = v->d, r = v->g->r;
  for (int i = 0; i < r; i++) {
    stage_base(v, i, 0);
    stage_slope(v, i);
    for (int l = 0; l < r; l++) block(v, i, l, r * d, i * d, l * d);
  }
  return stf_eliminate(r * d, v->m, v->matrix, v->K, &v->algebra);
}

static void advance(stf_variation *v)
{
  const steif_glm *g = v->g;
  const int size = v->d * v->m;
  for (int i = 0; i < g->k; i++) {
    sunrealtype *out = v->next + i * size;
    memset(out, 0, (size_t)size * sizeof *out);
    for (int j = 0; j < g->k; j++)
      for (int e = 0; e < size && g->V[i * g->k + j] != 0; e++)
        out[e] += g->V[i * g->k + j] * v->X[j * size + e];
    for (int l = 0; l < g->r; l++)
      for (int e = 0; e < size && g->D[i * g->r + l] != 0; e++)
        out[e] += g->D[i * g->r + l] * v->K[l * size + e];
  }
  sunrealtype *kept = v->X;
  v->X = v->next, v->next = kept;
}

int stf_variation_step(stf_variation *v)
{
  STEIF_TRY(v->linear   ? linear_matrices(v)
            : v->solver ? implicit_matrices(v)
                        : explicit_matrices(v));
  STEIF_CHECK(
    stf_glm_shape(v->g) != STEIF_COLLOCATION ? stage_by_stage(v) : all_stages(v), v->ctx,
    STEIF_SINGULAR,
    "the stages of %s on the variational equation of '%s' are singular at t = %.12g with "
    "h = %g: 1/h meets the spectrum of J; change h a little",
    v->method, v->problem->name, v->t, v->h);
  advance(v);
  v->t = v->t0 + (sunrealtype)++v->count * v->h;
  return STEIF_OK;
}

void stf_variation_principal(const stf_variation *v, sunrealtype *w)
{
  const int size = v->d * v->m;
  memset(w, 0, (size_t)size * sizeof *w);
  for (int j = 0; j < v->g->k; j++)
    for (int e = 0; e < size; e++) w[e] += v->g->ell[j] * v->X[j * size + e];
}

void stf_variation_solution(const stf_variation *v, sunrealtype *x)
{
  const steif_glm *g = v->g;
  const int size = v->d * v->m;
  memset(x, 0, (size_t)size * sizeof *x);
  for (int i = 0; i < 2 * g->k + g->r; i++) {
    if (v->finish[i] == 0) continue;
    const int f = i - g->k, b = f - g->r;
    const sunrealtype *data = f < 0   ? v->X + i * size
                              : b < 0 ? v->K + f * size
                                      : v->next + b * size;
    for (int e = 0; e < size; e++) x[e] += v->finish[i] * data[e];
  }
}

int stf_variation_carry(stf_variation *v, sunrealtype t, sunrealtype h, int count,
                        sunrealtype *x)
{
  const size_t bytes = (size_t)(v->d * v->m) * sizeof *x;
  v->t = v->t0 = t, v->count = 0, v->h = h / count;
  memcpy(v->X, x, bytes);
  for (int i = 0; i < count; i++) STEIF_TRY(stf_variation_step(v));
  memcpy(x, v->X, bytes);
  return STEIF_OK;
}

N_Vector stf_variation_state(const stf_variation *v)
{
  return v->solver ? steif_solution(v->solver) : v->y;
}

sunrealtype stf_variation_size(const stf_variation *v)
{
  sunrealtype most = 0;
  for (int i = 0; i < v->g->r * v->d; i++) {
    sunrealtype row = 0;
    for (int j = 0; j < v->d; j++) row += fabs(v->J[i * v->d + j]);
    most = fmax(most, row);
  }
  return most;
}

int stf_variation_substeps(const stf_variation *v, sunrealtype h)
{
  enum { MOST = 64 };
  const sunrealtype wanted = ceil(2 * fabs(h) * (1 + stf_variation_size(v)));
  return wanted < MOST ? (int)wanted : MOST;
}
