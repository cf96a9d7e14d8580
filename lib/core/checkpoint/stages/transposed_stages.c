/* transposed_stages.c: K^T w = r, K = (B_jm/h E_j - delta_jm A_j) the matrix of the stages of a step.
 *
 * One stage, or a constant matrix: by factors. Few unknowns: K itself, dense. Large and sparse: stage_krylov.c. Else K^T is
 * iterated,
 *   w <- w + M^{-T} (r - K^T w),   M = B/h x E - I x A with E, A of the middle stage,
 * B = T Lambda T^{-1}: T^T in, transposed solves, T^{-T} out, coupled shifts from the first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include "lapack.h"
#include "lu.h"
#include <math.h>

/* m n of systems that are dense at once, and that may become it; sweeps. Up to ROWS the columns of K are rows of K^T. */
enum { SMALL = 48, ROWS = 100, LARGEST = 1500, SWEEPS = 60 };
/* Of GMRES with factors of another step; ratio of shifts that they serve. */
enum { MANY = 10 };
static const sunrealtype ratio_most = 1.7;

static int claim(stf_adjoint *a, N_Vector like)
{
  a->residual = stf_pool_vectors(a->pool, a->m, like);
  a->omega = stf_pool_vectors(a->pool, a->m, like);
  a->extra = stf_pool_vectors(a->pool, a->m, like);
  a->nothing = stf_pool_vectors(a->pool, a->m, like);
  a->product = stf_pool_vector(a->pool, like);
  a->total = stf_pool_vector(a->pool, like);
  return a->residual && a->omega && a->extra && a->nothing && a->product && a->total
           ? STEIF_OK
           : STEIF_NO_MEMORY;
}

static int claim_dense(stf_adjoint *a)
{
  const size_t size = (size_t)a->m * (size_t)a->n;
  if (a->K) return STEIF_OK;
  a->K = stf_pool_array(a->pool, size * size, sizeof *a->K);
  a->pivot = stf_pool_array(a->pool, size, sizeof *a->pivot);
  a->side = stf_pool_array(a->pool, size * (size_t)a->channels, sizeof *a->side);
  return a->K && a->pivot && a->side ? STEIF_OK : STEIF_NO_MEMORY;
}

static int open_transform(stf_adjoint *a, const steif_table *table)
{
  const stf_transform *T = &a->transform;
  const int s = a->m;
  STEIF_TRY(stf_transform_build(a->pool, a->ctx, table, &a->transform));
  a->in = stf_pool_array(a->pool, (size_t)(s * s), sizeof *a->in);
  a->out = stf_pool_array(a->pool, (size_t)(s * s), sizeof *a->out);
  if (!a->in || !a->out) return STEIF_NO_MEMORY;
  for (int i = 0; i < s * s; i++)
    a->in[i] = T->T[i % s * s + i / s], a->out[i] = T->Tinv[i % s * s + i / s];
  return STEIF_OK;
}

int stf_adjoint_open(stf_pool *pool, stf_system *system, int m, const steif_table *table,
                     int channels, stf_adjoint *a)
{
  *a = (stf_adjoint){.ctx = system->ctx, .pool = pool, .space = &system->space, .m = m};
  a->channels = channels;
  a->n = system->space.n, a->middle = m / 2;
  STEIF_TRY(stf_matrices_at_open(pool, system, m, &a->at));
  if (m > 1) STEIF_TRY(open_transform(a, table));
  STEIF_TRY(claim(a, system->space.like));
  if (system->krylov) return stf_lanes_open(a);
  if (m > 1 && m * a->n <= SMALL) return claim_dense(a);
  a->pencil = steif_pencil_new(a->ctx, a->at.E[a->middle], a->at.A[a->middle]);
  if (!a->pencil) return steif_status(a->ctx);
  return stf_pool_adopt(pool, a->pencil, stf_system_destroy_pencil);
}

int stf_adjoint_add(const stf_adjoint *a, int point, char which, sunrealtype c, N_Vector x,
                    N_Vector out)
{
  if (a->at.point)
    return stf_matrices_at_transposed(&a->at, point, which, c, x, out, a->turned);
  stf_add_transposed(which == 'E' ? a->at.E[point] : a->at.A[point], a->n, c, STF_ARRAY(x),
                     STF_ARRAY(out));
  return STEIF_OK;
}

static int factor_dense(stf_adjoint *a, sunrealtype t)
{
  const int size = (int)(a->m * a->n);
  int info;
  a->by_rows = size <= ROWS;
  STEIF_TRY(claim_dense(a));
  for (sunindextype j = 0; j < size; j++)
    for (sunindextype i = 0; i < size; i++) a->K[i + j * size] = 0;
  for (int j = 0; j < a->m; j++)
    for (int k = 0; k < a->m; k++) {
      double *block = a->K + j + (sunindextype)k * size;
      stf_add_dense(a->at.E[j], a->n, a->B[j * a->m + k], block, a->m,
                    (sunindextype)a->m * size);
      if (j == k) stf_add_dense(a->at.A[j], a->n, -1, block, a->m, (sunindextype)a->m * size);
    }
  if (a->by_rows)
    info = !stf_rows_best()->factor(size, a->K, a->pivot);
  else
    dgetrf_(&size, &size, a->K, &size, a->pivot, &info);
  a->factors++, a->direct = true;
  STEIF_CHECK(!info, a->ctx, STEIF_SINGULAR,
              "the matrix of the stages of the step from t = %.12g is singular backwards: take "
              "another step size",
              t);
  return STEIF_OK;
}

/* One real shift, unless the factors that are there serve. */
static int factor_one(stf_adjoint *a, bool again)
{
  const sunrealtype shift = a->m > 1 ? 1 / (a->gamma * a->h) : a->B[0];
  const sunrealtype ratio = a->held > 0 ? shift / a->held : 0;
  a->fresh = false;
  if (!again && !a->slow && ratio <= ratio_most && ratio * ratio_most >= 1) return STEIF_OK;
  const steif_pencil_stats *stats = steif_pencil_statistics(a->pencil);
  const long before = stats->factors + stats->refactors;
  STEIF_TRY(steif_pencil_update(a->pencil));
  STEIF_TRY(steif_pencil_factor(a->pencil, 1, &(steif_shift){.re = shift}));
  a->factors += stats->factors + stats->refactors - before;
  a->held = shift, a->fresh = true, a->slow = false;
  return STEIF_OK;
}

static int factor_lanes(stf_adjoint *a)
{
  if (a->krylov && !a->lanes) return factor_one(a, false);
  steif_shift s[STEIF_STAGES] = {{.re = a->B[0]}};
  const stf_transform *T = &a->transform;
  for (int k = 0; a->m > 1 && k < T->shifts; k++)
    s[k] = (steif_shift){T->re[k] / a->h, T->im[k] / a->h};
  const steif_pencil_stats *stats = steif_pencil_statistics(a->pencil);
  const long before = stats->factors + stats->refactors;
  if (!a->at.system->linear || a->at.point) STEIF_TRY(steif_pencil_update(a->pencil));
  STEIF_TRY(steif_pencil_factor(a->pencil, a->m > 1 ? T->shifts : 1, s));
  a->factors += stats->factors + stats->refactors - before;
  return STEIF_OK;
}

int stf_adjoint_factor(stf_adjoint *a, sunrealtype t, sunrealtype h, const sunrealtype *B)
{
  a->h = h, a->direct = false;
  for (int i = 0; i < a->m * a->m; i++) a->B[i] = B[i];
  return a->pencil ? factor_lanes(a) : factor_dense(a, t);
}

static void count_solve(stf_adjoint *a)
{
  if (a->forward)
    a->forward_solves++;
  else
    a->solves++;
}

/* `count` right-hand sides of m vectors each, side by side. Stage j of unknown i is at i m + j: the zeros of A stay. */
static int solve_dense(stf_adjoint *a, int count, N_Vector *r, N_Vector *w)
{
  const int size = (int)(a->m * a->n), n = (int)a->n, m = a->m;
  double *x = a->side;
  int info;
  const int across = a->by_rows ? count : 1, down = a->by_rows ? 1 : size;
  for (int q = 0; q < count; q++) count_solve(a);
  for (int q = 0; q < count; q++)
    for (int j = 0; j < m; j++)
      for (int i = 0; i < n; i++)
        x[(i * m + j) * across + q * down] = STF_ARRAY(r[q * m + j])[i];
  if (a->by_rows && a->forward)
    stf_rows_best()->transposed(size, a->K, a->pivot, x);
  else if (a->by_rows)
    stf_rows_best()->substitute(size, count, a->K, a->pivot, x);
  else
    dgetrs_(a->forward ? "N" : "T", &size, &count, a->K, &size, a->pivot, x, &size, &info, 1);
  for (int q = 0; q < count; q++)
    for (int j = 0; j < m; j++)
      for (int i = 0; i < n; i++)
        STF_ARRAY(w[q * m + j])[i] = x[(i * m + j) * across + q * down];
  return STEIF_OK;
}

/* x := M^{-1} x: from the last of coupled shifts. */
static int precondition_forward(stf_adjoint *a, N_Vector *x)
{
  const stf_transform *T = &a->transform;
  const int s = a->m;
  if (s == 1) return steif_pencil_solve(a->pencil, 0, 1, x, NULL);
  stf_mix(a->space, s, s, T->Tinv, x, a->omega);
  for (int k = T->shifts; k-- > 0;) {
    const int row = T->row[k], next = row + (T->im[k] != 0 ? 2 : 1);
    N_Vector *omega = a->omega + row;
    for (int i = row; T->coupling && i < next; i++)
      for (int m = next; m < s; m++) {
        STEIF_TRY(stf_matrices_at_product(&a->at, a->middle, 'E', a->omega[m], a->product));
        stf_axpy(a->space, -T->coupling[i * s + m] / a->h, a->product, a->omega[i]);
      }
    STEIF_TRY(steif_pencil_solve(a->pencil, k, 1, omega, T->im[k] != 0 ? omega + 1 : NULL));
  }
  stf_mix(a->space, s, s, T->T, a->omega, x);
  return STEIF_OK;
}

/* x := M^{-T} x. */
static int precondition_transposed(stf_adjoint *a, N_Vector *x)
{
  const stf_transform *T = &a->transform;
  const int s = a->m;
  if (s == 1) return steif_pencil_solve_transposed(a->pencil, 0, 1, x, NULL);
  stf_mix(a->space, s, s, a->in, x, a->omega);
  for (int k = 0; k < T->shifts; k++) {
    const int row = T->row[k], next = row + (T->im[k] != 0 ? 2 : 1);
    N_Vector *omega = a->omega + row;
    STEIF_TRY(
      steif_pencil_solve_transposed(a->pencil, k, 1, omega, T->im[k] != 0 ? omega + 1 : NULL));
    for (int i = row; T->coupling && i < next; i++)
      for (int m = next; m < s; m++)
        STEIF_TRY(stf_adjoint_add(a, a->middle, 'E', -T->coupling[i * s + m] / a->h,
                                  a->omega[i], a->omega[m]));
  }
  stf_mix(a->space, s, s, a->out, a->omega, x);
  return STEIF_OK;
}

/* No other step will do: what a callback could not evaluate is a failure, and not a solve that does not converge. */
static int finally(const stf_adjoint *a, int code)
{
  return code > 0 ? steif_status(a->ctx) : code;
}

int stf_adjoint_precondition(stf_adjoint *a, N_Vector *x)
{
  return finally(a, a->forward ? precondition_forward(a, x) : precondition_transposed(a, x));
}

/* residual = r - K x. */
static int residuals_forward(stf_adjoint *a, N_Vector *r, N_Vector *x)
{
  for (int j = 0; j < a->m; j++) {
    stf_combine(a->space, a->m, a->B + j * a->m, x, a->total);
    STEIF_TRY(stf_matrices_at_product(&a->at, j, 'E', a->total, a->product));
    stf_sum(a->space, 1, r[j], -1, a->product, a->residual[j]);
    STEIF_TRY(stf_matrices_at_product(&a->at, j, 'A', x[j], a->product));
    stf_axpy(a->space, 1, a->product, a->residual[j]);
  }
  return STEIF_OK;
}

/* residual = r - K^T w. */
static int residuals_transposed(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  for (int j = 0; j < a->m; j++) {
    stf_copy(a->space, r[j], a->residual[j]);
    STEIF_TRY(stf_adjoint_add(a, j, 'A', 1, w[j], a->residual[j]));
  }
  for (int j = 0; j < a->m; j++) {
    stf_zero(a->space, a->product);
    STEIF_TRY(stf_adjoint_add(a, j, 'E', 1, w[j], a->product));
    for (int m = 0; m < a->m; m++)
      stf_axpy(a->space, -a->B[j * a->m + m], a->product, a->residual[m]);
  }
  return STEIF_OK;
}

int stf_adjoint_residuals(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  return finally(a, a->forward ? residuals_forward(a, r, w) : residuals_transposed(a, r, w));
}

static sunrealtype size_of(const stf_adjoint *a, N_Vector *x)
{
  sunrealtype sum = 0;
  for (int j = 0; j < a->m; j++) sum += N_VDotProd(x[j], x[j]);
  return sqrt(sum);
}

/* 0: done, 1: does not converge, < 0: failed. */
static int iterate(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  sunrealtype last = INFINITY;
  for (int j = 0; j < a->m; j++) stf_zero(a->space, w[j]);
  for (int j = 0; j < a->m; j++) stf_copy(a->space, r[j], a->residual[j]);
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    STEIF_TRY(stf_adjoint_precondition(a, a->residual));
    count_solve(a);
    const sunrealtype moved = size_of(a, a->residual);
    for (int j = 0; j < a->m; j++) stf_axpy(a->space, 1, a->residual[j], w[j]);
    const sunrealtype size = size_of(a, w);
    if (!(moved <= 1e300)) return 1;
    if (moved == 0 || a->at.system->linear || a->m == 1) return STEIF_OK;
    if (moved <= 1e-15 * size || (moved <= 1e-11 * size && moved > 0.5 * last)) return STEIF_OK;
    if (sweep > 3 && moved > 2 * last) return 1;
    last = moved;
    STEIF_TRY(stf_adjoint_residuals(a, r, w));
  }
  return 1;
}

/* Factors of another step that do badly are made anew. */
static int large(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  a->sweeps = 0;
  int code = stf_stage_krylov(a, r, w);
  if (code > 0 && !a->fresh && !a->lanes) {
    STEIF_TRY(factor_one(a, true));
    code = stf_stage_krylov(a, r, w);
  }
  a->slow = a->slow || (!a->fresh && a->sweeps > MANY);
  for (long i = 0; i < a->sweeps; i++) count_solve(a);
  return code;
}

static int solve(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  if (a->direct) return solve_dense(a, 1, r, w);
  const int code = a->krylov ? large(a, r, w) : iterate(a, r, w);
  if (code <= 0) return code;
  if (a->lanes) return stf_lanes_short(a);
  STEIF_CHECK(a->m * a->n <= LARGEST, a->ctx, STEIF_NO_CONVERGENCE,
              "the %s equations of a step of length %.6g did not converge: the matrices at "
              "its stages differ too much; make the steps smaller",
              a->forward ? "differentiated" : "transposed", a->h);
  STEIF_TRY(factor_dense(a, NAN));
  return solve_dense(a, 1, r, w);
}

/* One stage, by its own factors. */
static int solve_stage(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  for (int q = 0; q < a->channels; q++) {
    stf_copy(a->space, r[q], w[q]);
    count_solve(a);
  }
  return steif_pencil_solve_transposed(a->pencil, 0, a->channels, w, NULL);
}

int stf_adjoint_solve_all(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  a->forward = false;
  if (a->direct) return solve_dense(a, a->channels, r, w);
  if (a->m == 1 && !a->krylov) return solve_stage(a, r, w);
  for (a->channel = 0; a->channel < a->channels; a->channel++)
    STEIF_TRY(solve(a, r + a->channel * a->m, w + a->channel * a->m));
  return STEIF_OK;
}

int stf_adjoint_solve(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  a->forward = false;
  return solve(a, r, w);
}

int stf_adjoint_solve_forward(stf_adjoint *a, N_Vector *r, N_Vector *x)
{
  a->forward = true;
  return solve(a, r, x);
}
