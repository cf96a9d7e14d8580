/* stepmap.c: the map of one step: its Jacobian by differences, whether it is symplectic,
 * whether it comes back when the momenta are turned.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "hamiltonian_thresholds.h"
#include "problem.h"
#include "base.h"
#include "lapack.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/energy.h>
#include <string.h>

typedef struct map {
  steif_context *ctx;
  steif_problem problem; /* whose start is `at` */
  const char *method;
  steif_options options;
  sunrealtype *at;
  sunindextype n;
} map;

/* y = Phi(at). */
static int step(map *m, sunrealtype *y)
{
  steif_solver *s = steif_solver_new(m->ctx, &m->problem, m->method, &m->options);
  int code = s ? steif_solve_step(s) : steif_status(m->ctx);
  if (code == STEIF_OK) memcpy(y, NV_DATA_S(steif_solution(s)), (size_t)m->n * sizeof *y);
  steif_solver_free(&s);
  return code;
}

/* Column j of J. With d near eps^(1/5) truncation, d^4, and rounding, eps/d, are of one
 * size; a linear map may be asked far away. work: n numbers. */
static int column(map *m, sunindextype j, sunrealtype *J, sunrealtype *work)
{
  static const sunrealtype weight[] = {2 / 3.0, -1 / 12.0};
  const sunrealtype here = m->at[j],
                    d = m->problem.linear ? 1 : STF_STEP_MAP_DIFFERENCE * (1 + fabs(here));
  const sunindextype n = m->n;
  for (sunindextype i = 0; i < n; i++) J[i * n + j] = 0;
  for (int k = 0; k < 2; k++)
    for (int sign = -1; sign <= 1; sign += 2) {
      m->at[j] = here + sign * (k + 1) * d;
      const int code = step(m, work);
      m->at[j] = here;
      STEIF_TRY(code);
      for (sunindextype i = 0; i < n; i++) J[i * n + j] += sign * weight[k] / d * work[i];
    }
  return STEIF_OK;
}

/* By elimination with row exchanges; A is overwritten. */
static sunrealtype determinant(sunindextype n, sunrealtype *A)
{
  sunrealtype product = 1;
  for (sunindextype k = 0; k < n; k++) {
    sunindextype p = k;
    for (sunindextype i = k + 1; i < n; i++)
      if (fabs(A[i * n + k]) > fabs(A[p * n + k])) p = i;
    if (A[p * n + k] == 0) return 0;
    if (p != k) product = -product;
    for (sunindextype j = 0; p != k && j < n; j++) {
      const sunrealtype x = A[k * n + j];
      A[k * n + j] = A[p * n + j];
      A[p * n + j] = x;
    }
    product *= A[k * n + k];
    for (sunindextype i = k + 1; i < n; i++) {
      const sunrealtype f = A[i * n + k] / A[k * n + k];
      for (sunindextype j = k; j < n; j++) A[i * n + j] -= f * A[k * n + j];
    }
  }
  return product;
}

static sunrealtype canonical(sunindextype n, sunindextype i, sunindextype j)
{
  return j == i + n / 2 ? 1 : i == j + n / 2 ? -1 : 0;
}

/* max |J^T Omega J - Omega|; W = Omega J. */
static sunrealtype defect(sunindextype n, const sunrealtype *Omega, const sunrealtype *J,
                          sunrealtype *W)
{
  sunrealtype most = 0;
  for (sunindextype i = 0; i < n; i++)
    for (sunindextype j = 0; j < n; j++) {
      sunrealtype sum = 0;
      for (sunindextype k = 0; k < n; k++)
        sum += (Omega ? Omega[i * n + k] : canonical(n, i, k)) * J[k * n + j];
      W[i * n + j] = sum;
    }
  for (sunindextype i = 0; i < n; i++)
    for (sunindextype j = 0; j < n; j++) {
      sunrealtype sum = -(Omega ? Omega[i * n + j] : canonical(n, i, j));
      for (sunindextype k = 0; k < n; k++) sum += J[k * n + i] * W[k * n + j];
      most = fmax(most, fabs(sum));
    }
  return most;
}

/* max |R Phi R Phi(y) - y|. */
static int reversal(map *m, const sunrealtype *start, sunrealtype *y, sunrealtype *most)
{
  const sunindextype q = m->problem.positions;
  STEIF_TRY(step(m, y));
  for (sunindextype i = 0; i < m->n; i++) m->at[i] = i < q ? y[i] : -y[i];
  STEIF_TRY(step(m, y));
  *most = 0;
  for (sunindextype i = 0; i < m->n; i++)
    *most = fmax(*most, fabs((i < q ? y[i] : -y[i]) - start[i]));
  return STEIF_OK;
}

/* Vectors that J turns round, J v = -v: singular values of J + I, which is lost, that are 0. */
static int turned_vectors(steif_context *ctx, int n, sunrealtype *J, sunrealtype *work,
                          int *count)
{
  const int one = 1, length = STF_STEP_MAP_WORK * n;
  sunrealtype none;
  int info;
  for (int i = 0; i < n; i++) J[i * (n + 1)] += 1;
  dgesvd_("N", "N", &n, &n, J, &n, work, &none, &one, &none, &one, work + n, &length, &info, 1,
          1);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "the singular values of a step were not found (dgesvd: %d)", info);
  *count = 0;
  for (int i = 0; i < n; i++) *count += work[i] <= STF_STEP_MAP_TURNED * fmax(1, work[0]);
  return STEIF_OK;
}

/* The eigenvalues of J, which is lost; how many are at -1. */
static int multipliers(steif_context *ctx, int n, sunrealtype *J, sunrealtype *work,
                       sunrealtype *radius, int *turned)
{
  const int one = 1, length = STF_STEP_MAP_WORK * n;
  sunrealtype *re = work, *im = re + n, none;
  int info;
  *radius = 0, *turned = 0;
  dgeev_("N", "N", &n, J, &n, re, im, &none, &one, &none, &one, im + n, &length, &info, 1, 1);
  STEIF_CHECK(info == 0, ctx, STEIF_NO_CONVERGENCE,
              "the multipliers of a step were not found (dgeev: %d)", info);
  for (int i = 0; i < n; i++) {
    *radius = fmax(*radius, hypot(re[i], im[i]));
    *turned += hypot(re[i] + 1, im[i]) <= STF_STEP_MAP_TURNED;
  }
  return STEIF_OK;
}

/* W: n x n. More multipliers at -1 than vectors of theirs: others grow like the number of steps. */
static int look_at_border(const map *m, const sunrealtype *J, sunrealtype *W, sunrealtype *work,
                          steif_step_map *out)
{
  const size_t bytes = (size_t)(m->n * m->n) * sizeof *J;
  int turned, vectors = 0;
  memcpy(W, J, bytes);
  STEIF_TRY(multipliers(m->ctx, (int)m->n, W, work, &out->radius, &turned));
  memcpy(W, J, bytes);
  if (turned > 1) STEIF_TRY(turned_vectors(m->ctx, (int)m->n, W, work, &vectors));
  out->border = turned > 1 && turned > vectors;
  return STEIF_OK;
}

static int find(map *m, const sunrealtype *Omega, sunrealtype *J, sunrealtype *work,
                steif_step_map *out)
{
  const sunindextype n = m->n;
  const size_t square = (size_t)(n * n);
  sunrealtype *W = work, *start = work + square, *y = start + n;
  for (sunindextype j = 0; j < n; j++) STEIF_TRY(column(m, j, J, y));
  memcpy(W, J, square * sizeof *W);
  out->determinant = determinant(n, W);
  out->symplectic = out->reversal = NAN;
  if (Omega || 2 * m->problem.positions == n) out->symplectic = defect(n, Omega, J, W);
  STEIF_TRY(look_at_border(m, J, W, start, out));
  if (m->problem.positions == 0) return STEIF_OK;
  memcpy(start, m->at, (size_t)n * sizeof *start);
  return reversal(m, start, y, &out->reversal);
}

int steif_step_map_find(steif_context *ctx, const steif_problem *problem, const char *method,
                        sunrealtype h, const sunrealtype *Omega, sunrealtype *J,
                        steif_step_map *out)
{
  STF_NAMED(problem);
  STEIF_CHECK(problem && method && out, ctx, STEIF_BAD_INPUT,
              "a problem, a method and room for the answer are needed");
  STEIF_CHECK(h > 0 && isfinite(h), ctx, STEIF_BAD_INPUT,
              "the step h = %g must be positive and finite", h);
  STEIF_CHECK(problem->y0 && problem->n > 0, ctx, STEIF_UNSUPPORTED,
              "the map of a step needs the start values .y0 of problem '%s'", problem->name);
  const sunindextype n = problem->n;
  const size_t square = (size_t)(n * n);
  sunrealtype *work =
    stf_allocate(ctx, 2 * square + (STF_STEP_MAP_WORK + 4) * (size_t)n, sizeof *work);
  if (!work) return STEIF_NO_MEMORY;
  map m = {.ctx = ctx, .problem = *problem, .method = method, .at = work, .n = n};
  m.problem.y0 = memcpy(m.at, problem->y0, (size_t)n * sizeof *m.at);
  m.options = steif_defaults();
  m.options.h = h;
  m.options.t1 = problem->t0 + h;
  m.options.newton = STF_STEP_MAP_NEWTON; /* differences of steps are taken */
  const int code =
    find(&m, Omega, J ? J : work + square + (STF_STEP_MAP_WORK + 4) * n, work + n, out);
  stf_release(ctx, work);
  return code;
}
