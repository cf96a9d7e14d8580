/* pull.c: lambda and mu pulled back through a step (gradient.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>
#include <string.h>

int stf_pull_parameters(stf_backwards *B, int i, sunrealtype t, N_Vector Y, N_Vector Yp,
                        N_Vector w)
{
  const steif_parameters *q = B->problem->parameters;
  sunrealtype *mu = B->mu + i * B->P;
  if (B->P && q->dFdp_transposed) {
    for (int k = 0; k < B->P; k++) B->gp[k] = 0;
    const int code = q->dFdp_transposed(t, Y, Yp, w, B->gp, B->problem->user);
    STEIF_CHECK(!code, B->ctx, STEIF_CALLBACK, "dFdp_transposed of problem '%s' returned %d",
                B->problem->name, code);
    for (int k = 0; k < B->P; k++) mu[k] -= B->gp[k];
    return STEIF_OK;
  }
  for (int k = 0; k < B->P; k++) {
    STEIF_TRY(stf_slopes_at(B->slopes, k, t, Y, Yp, B->work));
    mu[k] -= N_VDotProd(B->work, w);
  }
  return STEIF_OK;
}

/* What the quadrature with weight c at (t, Y) adds: to J, to mu, and c g_y to `to` of each functional. */
static int quadrature(stf_backwards *B, const sunrealtype *c, sunrealtype t, N_Vector Y,
                      N_Vector *to)
{
  if (!B->functional->integrand) return STEIF_OK;
  STEIF_TRY(stf_functional_at(B, 0, t, Y));
  for (int i = 0; i < B->count; i++) {
    B->value[i] += c[i] * B->g[i];
    for (int k = 0; k < B->P; k++) B->mu[i * B->P + k] += c[i] * B->gp[i * B->P + k];
    stf_axpy(&B->space, c[i], B->gy[i], to[i]);
  }
  return STEIF_OK;
}

static sunrealtype *weights(stf_backwards *B, sunrealtype c)
{
  for (int i = 0; i < B->count; i++) B->other[2 * B->count + i] = c;
  return B->other + 2 * B->count;
}

/* ---- collocation ------------------------------------------------------------------------------ */

/* B->r[i s + j]: right-hand sides of functional i. */
static int pull_collocation(stf_backwards *B, const stf_head *head)
{
  const stf_space *space = &B->space;
  const steif_table *T = B->table;
  const int s = T->s;
  const sunrealtype h = head->h;
  sunrealtype B_over_h[STEIF_STAGES * STEIF_STAGES];
  N_Vector to[1];
  for (int j = 0; j < s * s; j++) B_over_h[j] = B->adjoint.transform.B[j] / h;
  for (int j = 0; j < s; j++)
    STEIF_TRY(
      stf_matrices_at_fill(&B->adjoint.at, j, head->t + T->c[j] * h, B->Y[j], B->Yp[j]));
  STEIF_TRY(stf_adjoint_factor(&B->adjoint, head->t, h, B_over_h));
  (void)to;
  for (int j = 0; j < s; j++) {
    N_Vector *r = B->r + j * B->count; /* by stages, then functionals */
    for (int i = 0; i < B->count; i++) stf_zero(space, r[i]);
    STEIF_TRY(quadrature(B, weights(B, h * T->b[j]), head->t + T->c[j] * h, B->Y[j], r));
  }
  for (int i = 0; i < B->count; i++) {
    N_Vector right[STEIF_STAGES];
    stf_copy(space, B->lambda[i], B->error);
    for (int j = 0; j < s; j++) {
      right[j] = B->r[j * B->count + i];
      stf_axpy(space, 1, right[j], B->lambda[i]);
      stf_axpy(space, B->u.end[j], B->error, right[j]);
    }
    STEIF_TRY(stf_adjoint_solve(&B->adjoint, right, B->w));
    for (int j = 0; j < s; j++) {
      stf_adjoint_add(&B->adjoint, j, 'A', 1, B->w[j], B->lambda[i]);
      STEIF_TRY(stf_pull_parameters(B, i, head->t + T->c[j] * h, B->Y[j], B->Yp[j], B->w[j]));
    }
  }
  return STEIF_OK;
}

/* ---- one stage after another ------------------------------------------------------------------ */

/* B->r: what comes to the slopes K_j, by stages and functionals. */
static int pull_stage(stf_backwards *B, const stf_head *head, int m)
{
  const stf_space *space = &B->space;
  const steif_table *T = B->table;
  const sunrealtype h = head->h, gamma = T->A[m * T->s + m], t = head->t + T->c[m] * h;
  const sunrealtype shift = gamma > 0 ? 1 / (gamma * h) : 0;
  N_Vector *x = B->r + T->s * B->count; /* what comes to Y_m */
  for (int i = 0; i < B->count; i++) stf_zero(space, x[i]);
  STEIF_TRY(quadrature(B, weights(B, h * T->b[m]), t, B->Y[m], x));
  if (gamma > 0) {
    STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t, B->Y[m], B->Yp[m]));
    STEIF_TRY(stf_adjoint_factor(&B->adjoint, t, h, &shift));
  }
  for (int i = 0; i < B->count; i++) {
    N_Vector *k = B->r + i, slope = k[m * B->count];
    if (gamma > 0) {
      stf_sum(space, shift, slope, 1, x[i], slope);
      STEIF_TRY(stf_adjoint_solve(&B->adjoint, &slope, B->w));
      stf_adjoint_add(&B->adjoint, 0, 'A', 1, B->w[0], x[i]);
      STEIF_TRY(stf_pull_parameters(B, i, t, B->Y[m], B->Yp[m], B->w[0]));
    }
    stf_axpy(space, 1, x[i], B->lambda[i]);
    for (int j = 0; j < m; j++) stf_axpy(space, h * T->A[m * T->s + j], x[i], k[j * B->count]);
  }
  return STEIF_OK;
}

static int pull_chain(stf_backwards *B, const stf_head *head)
{
  const steif_table *T = B->table;
  const stf_space *space = &B->space;
  for (int m = 0; m < T->s; m++)
    for (int i = 0; i < B->count; i++)
      stf_scale(space, head->h * T->b[m], B->lambda[i], B->r[m * B->count + i]);
  for (int i = 0; i < B->count; i++)
    stf_axpy(space, 1, B->kappa[i], B->r[(T->s - 1) * B->count + i]);
  for (int m = T->s; m-- > 0;) STEIF_TRY(pull_stage(B, head, m));
  for (int i = 0; i < B->count; i++)
    if (T->A[0] == 0)
      stf_copy(space, B->r[i], B->kappa[i]);
    else
      stf_zero(space, B->kappa[i]);
  return STEIF_OK;
}

/* ---- BDF ---------------------------------------------------------------------------------------- */

/* One step of length h to t + h at point `at`; q = sum of (alpha_j/alpha_0) q of the past + (h/alpha_0) g. */
static int pull_bdf_step(stf_backwards *B, int at, sunrealtype t, sunrealtype h, int order,
                         const sunrealtype *alpha)
{
  const stf_space *space = &B->space;
  const sunrealtype shift = alpha[0] / h;
  sunrealtype *c = weights(B, 0);
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t + h, B->Y[at], B->Yp[at]));
  STEIF_TRY(stf_adjoint_factor(&B->adjoint, t, h, &shift));
  for (int i = 0; i < B->count; i++) c[i] = h / alpha[0] * B->nu[i];
  STEIF_TRY(quadrature(B, c, t + h, B->Y[at], B->lambda));
  for (int i = 0; i < B->count; i++) {
    const sunrealtype nu = B->nu[i];
    STEIF_TRY(stf_adjoint_solve(&B->adjoint, &B->lambda[i], B->w));
    STEIF_TRY(stf_pull_parameters(B, i, t + h, B->Y[at], B->Yp[at], B->w[0]));
    stf_zero(space, B->work);
    stf_adjoint_add(&B->adjoint, 0, 'E', 1, B->w[0], B->work);
    for (int j = 1; j <= order; j++) {
      stf_axpy(space, -alpha[j] / h, B->work, B->past[j][i]);
      B->nu[j * B->count + i] -= alpha[j] / alpha[0] * nu;
    }
    stf_zero(space, B->lambda[i]);
    B->nu[i] = 0;
  }
  return STEIF_OK;
}

/* The value before becomes the last one. */
static void shift_past(stf_backwards *B)
{
  N_Vector *gone = B->lambda;
  B->lambda = B->past[1];
  for (int j = 1; j < STF_PAST - 1; j++) B->past[j] = B->past[j + 1];
  B->past[STF_PAST - 1] = gone;
  memmove(B->nu, B->nu + B->count, (size_t)((STF_PAST - 1) * B->count) * sizeof *B->nu);
  for (int i = 0; i < B->count; i++) B->nu[(STF_PAST - 1) * B->count + i] = 0;
}

/* The point between two halves is no past value of others: it takes the place of the value before. */
static int pull_bdf(stf_backwards *B, const stf_head *head)
{
  const sunrealtype h = head->h, d = h / 2;
  if (!head->halved) {
    STEIF_TRY(pull_bdf_step(B, 1, head->t, h, head->order, head->alpha));
    shift_past(B);
    return STEIF_OK;
  }
  N_Vector *before = B->past[1], *between = B->past[STF_PAST - 1];
  sunrealtype *nu = B->nu + B->count;
  B->past[1] = between;
  for (int i = 0; i < B->count; i++) {
    B->other[i] = nu[i], nu[i] = 0;
    stf_zero(&B->space, between[i]);
  }
  for (int i = 0; i < B->count; i++) B->estimate[B->count + i] = B->other[i];
  STEIF_TRY(pull_bdf_step(B, 1, head->t + d, d, 1, head->alpha));
  B->past[STF_PAST - 1] = B->lambda, B->lambda = between, B->past[1] = before;
  for (int i = 0; i < B->count; i++) B->nu[i] = nu[i], nu[i] = B->estimate[B->count + i];
  STEIF_TRY(pull_bdf_step(B, 0, head->t, d, 1, head->alpha));
  shift_past(B);
  return STEIF_OK;
}

/* ---- all ---------------------------------------------------------------------------------------- */

static void read_points(stf_backwards *B, const sunrealtype *record)
{
  const size_t n = (size_t)B->n;
  for (int j = 0; j < B->points; j++) {
    memcpy(STF_ARRAY(B->Y[j]), record, n * sizeof *record);
    memcpy(STF_ARRAY(B->Yp[j]), record + n, n * sizeof *record);
    record += 2 * n;
  }
  if (B->adaptive) memcpy(STF_ARRAY(B->error), record, n * sizeof *record);
}

int stf_pull(stf_backwards *B, const sunrealtype *record)
{
  stf_head head;
  memcpy(&head, record, sizeof head);
  read_points(B, record + STF_HEAD);
  for (int i = 0; B->adaptive && i < B->count; i++)
    B->estimate[i] += N_VDotProd(B->error, B->lambda[i]);
  STEIF_TRY(B->kind == STF_TRACE_COLLOCATION ? pull_collocation(B, &head)
            : B->kind == STF_TRACE_CHAIN     ? pull_chain(B, &head)
                                             : pull_bdf(B, &head));
  for (int i = 0; i < B->count; i++)
    STEIF_CHECK(stf_finite(&B->space, B->lambda[i]), B->ctx, STEIF_NOT_FINITE,
                "the adjoint of functional %d of problem '%s' is not finite at t = %.12g",
                i + 1, B->problem->name, head.t);
  return STEIF_OK;
}

/* A chain that began with the slope f(t0, y0) hands on what has come to that. */
int stf_pull_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0)
{
  if (B->kind != STF_TRACE_CHAIN || B->table->A[0] != 0) return STEIF_OK;
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t0, y0, yp0));
  for (int i = 0; i < B->count; i++) {
    stf_adjoint_add(&B->adjoint, 0, 'A', 1, B->kappa[i], B->lambda[i]);
    STEIF_TRY(stf_pull_parameters(B, i, t0, y0, yp0, B->kappa[i]));
  }
  return STEIF_OK;
}
