/* stage_krylov.c: K^T w = r and K x = r of large sparse stages, by GMRES with factors that serve several steps.
 *
 * Of m > 1 stages the preconditioner is the blended iteration (newton/blended.h) with one real shift sigma = 1/(gamma h') of
 * the step h' that was factored,
 *   M^{-1} = P + sigma P E P (sigma h' A x I - I),   P = (sigma E - A)^{-1},
 * and of its transpose the same from the other side. Of one stage it is P. What is asked is the size of M^{-T}(r - K^T w) in
 * that of w, so a step of another length, or matrices that have moved, cost some more vectors and no accuracy.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>

enum { ROUNDS = 4 };
static const sunrealtype rounding = 1e-11;

int stf_stage_krylov_open(stf_adjoint *a, const steif_table *table, sunrealtype tolerance,
                          int channels, bool smooth)
{
  const stf_transform *T = &a->transform;
  int widest = 0;
  a->krylov = true, a->tolerance = tolerance, a->gamma = 1;
  for (int k = 1; a->m > 1 && k < T->shifts; k++)
    if (T->im[k] * T->re[widest] > T->im[widest] * T->re[k]) widest = k;
  if (a->m > 1) a->gamma = 1 / hypot(T->re[widest], T->im[widest]), a->table = table;
  for (int i = 0; i <= STF_BASIS; i++)
    if (!(a->basis[i] = stf_pool_vectors(a->pool, a->m, a->space->like)))
      return STEIF_NO_MEMORY;
  if (a->m == 1 && !smooth) return STEIF_OK;
  a->behind = stf_pool_vectors(a->pool, a->m * channels, a->space->like);
  return a->behind ? STEIF_OK : STEIF_NO_MEMORY;
}

/* ---- the preconditioner ------------------------------------------------------------------------ */

/* out[j] := sigma times E, or its transpose, times v[j]. */
static int times_E(stf_adjoint *a, N_Vector *v, N_Vector *out)
{
  for (int j = 0; j < a->m; j++) {
    stf_zero(a->space, out[j]);
    if (!a->forward)
      STEIF_TRY(stf_adjoint_add(a, a->middle, 'E', a->held, v[j], out[j]));
    else {
      STEIF_TRY(stf_matrices_at_product(&a->at, a->middle, 'E', v[j], out[j]));
      stf_scale(a->space, a->held, out[j], out[j]);
    }
  }
  return STEIF_OK;
}

/* sigma h' A - I, or transposed. */
static void mix_of(const stf_adjoint *a, sunrealtype *mix)
{
  const int s = a->m;
  for (int i = 0; i < s; i++)
    for (int j = 0; j < s; j++)
      mix[i * s + j] =
        (a->forward ? a->table->A[i * s + j] : a->table->A[j * s + i]) / a->gamma - (i == j);
}

static int precondition(stf_adjoint *a, N_Vector *x)
{
  sunrealtype mix[STEIF_STAGES * STEIF_STAGES];
  const int s = a->m;
  N_Vector *other = a->omega;
  if (a->lanes) return stf_adjoint_precondition(a, x);
  if (a->forward) {
    if (s == 1) return steif_pencil_solve(a->pencil, 0, 1, x, NULL);
    mix_of(a, mix);
    stf_mix(a->space, s, s, mix, x, a->extra);
    STEIF_TRY(steif_pencil_solve(a->pencil, 0, s, a->extra, NULL));
    STEIF_TRY(times_E(a, a->extra, other));
    for (int j = 0; j < s; j++) stf_axpy(a->space, 1, other[j], x[j]);
    return steif_pencil_solve(a->pencil, 0, s, x, NULL);
  }
  STEIF_TRY(steif_pencil_solve_transposed(a->pencil, 0, s, x, NULL));
  if (s == 1) return STEIF_OK;
  STEIF_TRY(times_E(a, x, a->extra));
  STEIF_TRY(steif_pencil_solve_transposed(a->pencil, 0, s, a->extra, NULL));
  mix_of(a, mix);
  stf_mix(a->space, s, s, mix, a->extra, other);
  for (int j = 0; j < s; j++) stf_axpy(a->space, 1, other[j], x[j]);
  return STEIF_OK;
}

/* ---- GMRES --------------------------------------------------------------------------------------- */

typedef struct cycle {
  sunrealtype H[STF_BASIS + 1][STF_BASIS], c[STF_BASIS], s[STF_BASIS], g[STF_BASIS + 1];
} cycle;

static sunrealtype dot(const stf_adjoint *a, N_Vector *x, N_Vector *y)
{
  sunrealtype sum = 0;
  for (int j = 0; j < a->m; j++) sum += N_VDotProd(x[j], y[j]);
  return sum;
}

static void scale(const stf_adjoint *a, sunrealtype c, N_Vector *from, N_Vector *to)
{
  for (int j = 0; j < a->m; j++) stf_scale(a->space, c, from[j], to[j]);
}

static void add(const stf_adjoint *a, sunrealtype c, N_Vector *x, N_Vector *to)
{
  for (int j = 0; j < a->m; j++) stf_axpy(a->space, c, x[j], to[j]);
}

/* Column k of H, its rotation, and what is left of the residual. */
static sunrealtype reduce(const stf_adjoint *a, cycle *q, int k)
{
  N_Vector *v = a->basis[k + 1];
  for (int i = 0; i <= k; i++) {
    q->H[i][k] = dot(a, a->basis[i], v);
    add(a, -q->H[i][k], a->basis[i], v);
  }
  const sunrealtype size = sqrt(dot(a, v, v));
  if (size > 0) scale(a, 1 / size, v, v);
  for (int i = 0; i < k; i++) {
    const sunrealtype x = q->H[i][k], y = q->H[i + 1][k];
    q->H[i][k] = q->c[i] * x + q->s[i] * y, q->H[i + 1][k] = q->c[i] * y - q->s[i] * x;
  }
  const sunrealtype r = hypot(q->H[k][k], size);
  q->c[k] = r > 0 ? q->H[k][k] / r : 1, q->s[k] = r > 0 ? size / r : 0;
  q->H[k][k] = r;
  q->g[k + 1] = -q->s[k] * q->g[k], q->g[k] *= q->c[k];
  return fabs(q->g[k + 1]);
}

static void update(const stf_adjoint *a, cycle *q, int count, N_Vector *w)
{
  for (int i = count; i-- > 0;) {
    for (int k = i + 1; k < count; k++) q->g[i] -= q->H[i][k] * q->g[k];
    q->g[i] = q->H[i][i] != 0 ? q->g[i] / q->H[i][i] : 0;
  }
  for (int i = 0; i < count; i++) add(a, q->g[i], a->basis[i], w);
}

/* v := M^{-T} K^T basis_k: the product is minus a residual with right-hand side 0. */
static int advance(stf_adjoint *a, int k)
{
  for (int j = 0; j < a->m; j++) stf_zero(a->space, a->nothing[j]);
  STEIF_TRY(stf_adjoint_residuals(a, a->nothing, a->basis[k]));
  STEIF_TRY(precondition(a, a->residual));
  scale(a, -1, a->residual, a->basis[k + 1]);
  a->sweeps++;
  return STEIF_OK;
}

/* w := what the polynomial through the stages of the step behind, of length h', says of this one: w_j is about h b_j
 * times the adjoint at c_j. Of BDF h/alpha_0 takes the place of h b_j, and the adjoint is that of the step behind. */
static void guess(stf_adjoint *a, N_Vector *from, N_Vector *w)
{
  const steif_table *T = a->table;
  sunrealtype node[STEIF_STAGES], value[STEIF_STAGES];
  if (a->m == 1) {
    stf_scale(a->space, 1 / (a->B[0] * a->h_behind), from[0], w[0]);
    return;
  }
  for (int m = 0; m < a->m; m++) node[m] = a->h + T->c[m] * a->h_behind;
  for (int j = 0; j < a->m; j++) {
    stf_interpolate(a->m - 1, node, T->c[j] * a->h, value);
    for (int m = 0; m < a->m; m++) value[m] *= a->h * T->b[j] / (a->h_behind * T->b[m]);
    stf_combine(a->space, a->m, value, from, w[j]);
  }
}

static bool guesses(const stf_adjoint *a)
{
  bool all = !a->forward && a->behind && a->h_behind > 0;
  for (int j = 0; all && a->m > 1 && j < a->m; j++) all = a->table->b[j] != 0;
  return all;
}

/* 0: done, 1: does not converge, < 0: failed. Lanes are looked at again and again, until what they see is rounding. */
static int solve(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  cycle q;
  sunrealtype last = INFINITY;
  for (int round = 0; round < (a->lanes ? 3 * ROUNDS : ROUNDS); round++) {
    STEIF_TRY(stf_adjoint_residuals(a, r, w));
    STEIF_TRY(precondition(a, a->residual));
    a->sweeps++;
    const sunrealtype size = sqrt(dot(a, a->residual, a->residual)), known = sqrt(dot(a, w, w)),
                      asked = a->tolerance * (known > 0 ? known : size);
    if (!(size <= 1e300)) return 1;
    if (size <= asked || size == 0) return STEIF_OK;
    if (a->lanes && size > 0.5 * last && size <= rounding * known) return STEIF_OK;
    last = size;
    const sunrealtype until = a->lanes ? fmax(asked, STF_LANES_GAIN * size) : asked;
    scale(a, 1 / size, a->residual, a->basis[0]);
    q.g[0] = size;
    int k = 0;
    for (bool more = true; more && k < STF_BASIS; k++) {
      STEIF_TRY(advance(a, k));
      more = reduce(a, &q, k) > until;
    }
    const sunrealtype left = fabs(q.g[k]);
    update(a, &q, k, w);
    if (!a->lanes && left <= 2 * a->tolerance * sqrt(dot(a, w, w))) return STEIF_OK;
  }
  return 1;
}

int stf_stage_krylov(stf_adjoint *a, N_Vector *r, N_Vector *w)
{
  N_Vector *behind = a->behind ? a->behind + a->channel * a->m : NULL;
  if (guesses(a))
    guess(a, behind, w);
  else
    for (int j = 0; j < a->m; j++) stf_zero(a->space, w[j]);
  const int code = a->lanes && (a->m == 1 || a->at.system->linear) ? stf_lanes_refine(a, r, w)
                                                                   : solve(a, r, w);
  for (int j = 0; !code && behind && j < a->m; j++) stf_copy(a->space, w[j], behind[j]);
  return code;
}
