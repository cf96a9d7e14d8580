/* variation.c: the variational equation along the solution that a method computes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "lyapunov_thresholds.h"
#include "integrator.h"
#include "simd.h"
#include "variation.h"
#include <math.h>
#include <string.h>

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

/* dF/dy + c dF/dy'. */
static int implicit_matrix(stf_variation *v, sunrealtype t, sunrealtype c, N_Vector y,
                           N_Vector fy, SUNMatrix out)
{
  const steif_problem *p = v->problem;
  stf_jacobian_clear(out);
  return answer(
    v, p->idajac(t, c, y, v->yp, fy, out, p->user, v->slope[0], v->slope[1], v->slope[2]),
    "idajac", t);
}

int stf_variation_matrix(stf_variation *v, int at, sunrealtype t, N_Vector y, N_Vector fy)
{
  const steif_problem *p = v->problem;
  SUNMatrix J = v->J[at];
  if (!fy) STEIF_TRY(slope(v, t, y, fy = v->fy));
  if (p->F) {
    STEIF_TRY(implicit_matrix(v, t, 0, y, fy, J));
    stf_jacobian_scale(J, -1);
    return STEIF_OK;
  }
  stf_jacobian_clear(J);
  return answer(v, p->jac(t, y, fy, J, p->user, v->slope[0], v->slope[1], v->slope[2]), "jac",
                t);
}

/* By elimination with full pivots; A is lost. */
static int rank_of(int n, sunrealtype *A)
{
  sunrealtype first = 0;
  for (int k = 0; k < n; k++) {
    int row = k, column = k;
    for (int i = k; i < n; i++)
      for (int j = k; j < n; j++)
        if (fabs(A[i * n + j]) > fabs(A[row * n + column])) {
          row = i;
          column = j;
        }
    const sunrealtype pivot = A[row * n + column];
    if (k == 0) first = fabs(pivot);
    if (!(fabs(pivot) > STF_RANK_PIVOT * first)) return k;
    for (int j = 0; j < n; j++) {
      const sunrealtype kept = A[k * n + j];
      A[k * n + j] = A[row * n + j];
      A[row * n + j] = kept;
    }
    for (int i = 0; i < n; i++) {
      const sunrealtype kept = A[i * n + k];
      A[i * n + k] = A[i * n + column];
      A[i * n + column] = kept;
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
    STEIF_TRY(implicit_matrix(v, v->t, 0, v->y, v->fy, v->E));
    STEIF_TRY(implicit_matrix(v, v->t, 1, v->y, v->fy, v->J[0]));
    STEIF_CHECK(SUNMatScaleAdd(-1, v->E, v->J[0]) == 0, v->ctx, STEIF_NO_MEMORY,
                "no memory for the leading matrix of '%s'", p->name);
  } else {
    stf_jacobian_clear(v->E);
    STEIF_TRY(answer(v, p->E(v->t, v->y, v->yp, v->E, p->user), "E", v->t));
  }
  sunrealtype *spread = stf_allocate(v->ctx, size, sizeof *spread);
  if (!spread) return STEIF_NO_MEMORY;
  stf_jacobian_spread(v->E, 1, v->d, 0, 0, spread);
  v->finite = rank_of(v->d, spread);
  stf_release(v->ctx, spread);
  return STEIF_OK;
}

/* ---- trajectories ---- */

static int linear_matrices(stf_variation *v)
{
  if (v->filled && v->problem->linear) return STEIF_OK;
  for (int i = 0; i < v->g->r; i++)
    STEIF_TRY(stf_variation_matrix(v, i, v->t + v->g->xi[i] * v->h, v->y, NULL));
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
    STEIF_TRY(stf_variation_matrix(v, i, t, v->stage, v->f[i]));
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
  STEIF_TRY(stf_step_untimed(v->solver));
  const sunrealtype made = steif_time(v->solver) - v->t;
  STEIF_CHECK(
    fabs(made - v->h) <= STF_STEP_OFF * v->h, v->ctx, STEIF_UNSUPPORTED,
    "%s made a step of %g at t = %g where %g was asked for; exponents need a constant step "
    "size",
    v->method, made, v->t, v->h);
  STEIF_TRY(steif_stages(v->solver, &count, &c, &b, &Y));
  if (count == 0)
    return stf_variation_matrix(v, 0, v->t + v->h, steif_solution(v->solver), NULL);
  for (int i = 0; i < g->r; i++)
    STEIF_TRY(stf_variation_matrix(v, i, v->t + g->xi[i] * v->h, Y[i], NULL));
  return STEIF_OK;
}

/* ---- one step ---- */

/* Blocks with factors, to be summed. */
typedef struct terms {
  int count;
  sunrealtype c[STF_LEAST];
  const sunrealtype *x[STF_LEAST];
} terms;

static void term(terms *q, sunrealtype c, const sunrealtype *x)
{
  if (c != 0) {
    q->c[q->count] = c;
    q->x[q->count++] = x;
  }
}

/* out (= or +=) the sum of `count` terms from number k on. */
INLINE void pass(const int count, const bool more, size_t size, const terms *q, int k,
                 sunrealtype *restrict out)
{
  const sunrealtype *const *x = q->x + k, *c = q->c + k;
  const sunrealtype *restrict x0 = x[0], *restrict x1 = x[count > 1 ? 1 : 0],
                              *restrict x2 = x[count > 2 ? 2 : 0],
                              *restrict x3 = x[count > 3 ? 3 : 0];
  const sunrealtype c0 = c[0], c1 = c[count > 1 ? 1 : 0], c2 = c[count > 2 ? 2 : 0],
                    c3 = c[count > 3 ? 3 : 0];
  for (size_t e = 0; e < size; e++) {
    sunrealtype sum = c0 * x0[e];
    if (count > 1) sum += c1 * x1[e];
    if (count > 2) sum += c2 * x2[e];
    if (count > 3) sum += c3 * x3[e];
    out[e] = more ? out[e] + sum : sum;
  }
}

/* Four terms at a time: the blocks of many columns are far away from the processor. */
static void sum(size_t size, const terms *q, sunrealtype *out)
{
  if (q->count == 0) memset(out, 0, size * sizeof *out);
  for (int k = 0; k < q->count; k += 4) {
    const int left = q->count - k;
    if (k == 0 && left >= 4)
      pass(4, false, size, q, k, out);
    else if (k == 0 && left == 3)
      pass(3, false, size, q, k, out);
    else if (k == 0 && left == 2)
      pass(2, false, size, q, k, out);
    else if (k == 0)
      pass(1, false, size, q, k, out);
    else if (left >= 4)
      pass(4, true, size, q, k, out);
    else if (left == 3)
      pass(3, true, size, q, k, out);
    else if (left == 2)
      pass(2, true, size, q, k, out);
    else
      pass(1, true, size, q, k, out);
  }
}

static size_t block_size(const stf_variation *v) { return (size_t)v->d * (size_t)v->m; }

/* K_i = h J_i (sum_j U_ij X_j + sum_{l < last} C_il K_l) */
static void stage_slope(stf_variation *v, int i, int last)
{
  const steif_glm *g = v->g;
  const size_t size = block_size(v);
  terms q;
  q.count = 0;
  for (int j = 0; j < g->k; j++) term(&q, g->U[i * g->k + j], v->X + (size_t)j * size);
  for (int l = 0; l < last; l++) term(&q, g->C[i * g->r + l], v->K + (size_t)l * size);
  const bool plain = q.count == 1 && q.c[0] == 1;
  if (!plain) sum(size, &q, v->base);
  stf_jacobian_times(v->J[i], v->m, v->h, plain ? q.x[0] : v->base, v->K + (size_t)i * size);
}

static int stages(stf_variation *v)
{
  const steif_glm *g = v->g;
  const bool full = v->shape == STEIF_COLLOCATION;
  for (int i = 0; i < g->r; i++) {
    stage_slope(v, i, full ? 0 : i);
    if (!full && g->C[i * g->r + i] != 0) STEIF_TRY(stf_stage_system_solve(v, i));
  }
  return full ? stf_stage_system_solve(v, 0) : STEIF_OK;
}

static void advance(stf_variation *v)
{
  const steif_glm *g = v->g;
  const size_t size = block_size(v);
  for (int i = 0; i < g->k; i++) {
    terms q;
    q.count = 0;
    for (int j = 0; j < g->k; j++) term(&q, g->V[i * g->k + j], v->X + (size_t)j * size);
    for (int l = 0; l < g->r; l++) term(&q, g->D[i * g->r + l], v->K + (size_t)l * size);
    sum(size, &q, v->next + (size_t)i * size);
  }
  sunrealtype *kept = v->X;
  v->X = v->next;
  v->next = kept;
}

int stf_variation_step(stf_variation *v)
{
  STEIF_CHECK(!v->stop || !*v->stop, v->ctx, STEIF_STOPPED,
              "the run was stopped from outside at t = %.12g", v->t);
  STEIF_TRY(v->linear   ? linear_matrices(v)
            : v->solver ? implicit_matrices(v)
                        : explicit_matrices(v));
  STEIF_TRY(stages(v));
  advance(v);
  v->t = v->t0 + (sunrealtype)++v->count * v->h;
  return STEIF_OK;
}

void stf_variation_principal(const stf_variation *v, sunrealtype *w)
{
  const size_t size = block_size(v);
  terms q;
  q.count = 0;
  for (int j = 0; j < v->g->k; j++) term(&q, v->g->ell[j], v->X + (size_t)j * size);
  sum(size, &q, w);
}

void stf_variation_solution(const stf_variation *v, sunrealtype *x)
{
  const steif_glm *g = v->g;
  const size_t size = block_size(v);
  terms q;
  q.count = 0;
  for (int i = 0; i < g->k; i++) term(&q, v->finish[i], v->X + (size_t)i * size);
  for (int i = 0; i < g->r; i++) term(&q, v->finish[g->k + i], v->K + (size_t)i * size);
  for (int i = 0; i < g->k; i++)
    term(&q, v->finish[g->k + g->r + i], v->next + (size_t)i * size);
  sum(size, &q, x);
}

int stf_variation_carry(stf_variation *v, sunrealtype t, sunrealtype h, int count,
                        sunrealtype *x)
{
  const size_t bytes = block_size(v) * sizeof *x;
  if (v->h != h / count) v->system.c = NAN;
  v->t = v->t0 = t;
  v->count = 0;
  v->h = h / count;
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
  for (int i = 0; i < v->g->r; i++) most = fmax(most, stf_jacobian_size(v->J[i], v->base));
  return most;
}

int stf_variation_substeps(const stf_variation *v, sunrealtype h)
{
  enum { MOST = 64 };
  const sunrealtype wanted = ceil(2 * fabs(h) * (1 + stf_variation_size(v)));
  return wanted < MOST ? (int)wanted : MOST;
}
