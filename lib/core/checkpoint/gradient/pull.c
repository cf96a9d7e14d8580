/* pull.c: lambda and mu pulled back through a step (gradient.h).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>
#include <string.h>

/* Over host arrays, as all here. */
static sunrealtype dot(const stf_backwards *B, N_Vector a, N_Vector b)
{
  const sunrealtype *x = STF_ARRAY(a), *y = STF_ARRAY(b);
  sunrealtype sum = 0;
  for (sunindextype i = 0; i < B->n; i++) sum += x[i] * y[i];
  return sum;
}

int stf_parameters_times(stf_backwards *B, sunrealtype t, N_Vector Y, N_Vector Yp, N_Vector w,
                         sunrealtype *out)
{
  const steif_parameters *q = B->problem->parameters;
  for (int k = 0; k < B->P; k++) out[k] = 0;
  if (B->P && q->dFdp_transposed) {
    const int code = q->dFdp_transposed(t, Y, Yp, w, out, B->problem->user);
    STEIF_CHECK(!code, B->ctx, STEIF_CALLBACK, "dFdp_transposed of problem '%s' returned %d",
                B->problem->name, code);
  }
  for (int k = 0; k < B->P; k++) {
    if (!q->dFdp_transposed) {
      STEIF_TRY(stf_slopes_at(B->slopes, k, t, Y, Yp, B->work));
      out[k] = dot(B, B->work, w);
    }
    STEIF_CHECK(isfinite(out[k]), B->ctx, STEIF_NOT_FINITE,
                "the derivative of problem '%s' by parameter %d%s%.40s%s is not finite at t = "
                "%.12g",
                B->problem->name, k + 1, q->name ? " (" : "", q->name ? q->name[k] : "",
                q->name ? ")" : "", t);
  }
  return STEIF_OK;
}

int stf_pull_parameters(stf_backwards *B, int i, sunrealtype t, N_Vector Y, N_Vector Yp,
                        N_Vector w)
{
  STEIF_TRY(stf_parameters_times(B, t, Y, Yp, w, B->Fp));
  for (int k = 0; k < B->P; k++) B->mu[i * B->P + k] -= B->Fp[k];
  return STEIF_OK;
}

/* What the quadrature with weight c at point j adds: to J, to mu, and c g_y to `to` of each channel. */
static int quadrature(stf_backwards *B, const sunrealtype *c, sunrealtype t, int j,
                      N_Vector *to)
{
  stf_pushed *D = B->tangent;
  if (!B->functional->integrand || B->cut) return STEIF_OK;
  if (D) STEIF_TRY(stf_bend_functional(B, 0, t, B->Y[j], D->Y[j]));
  for (int i = 0; D && i < B->count; i++) {
    sunrealtype *mu = B->mu + (B->count + i) * B->P;
    for (int k = 0; k < B->P; k++) mu[k] += c[i] * D->gp[i * B->P + k];
    stf_axpy(&B->space, c[i], D->gy[i], to[B->count + i]);
  }
  STEIF_TRY(stf_functional_shifted(B, c, t, B->Y[j], B->shifted));
  STEIF_TRY(stf_functional_at(B, 0, t, B->Y[j]));
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

/* Equations that are solved at once. */
static int stages_of(const stf_backwards *B) { return B->adjoint.m; }

/* Derivatives of the matrices of stage j, at `point`, times w_j of channel i. */
static int bend(stf_backwards *B, int i, sunrealtype t, int point, int j)
{
  stf_pushed *D = B->tangent;
  const N_Vector at[] = {B->Y[point], B->Yp[point], D->Y[point], D->Yp[point]};
  return stf_bend(B, i, t, at, B->w[i * stages_of(B) + j], D->bend_E[j], D->bend_A[j]);
}

/* ---- collocation ------------------------------------------------------------------------------ */

/* B->r[j channels + i] := right-hand sides of channel i, and lambda what does not pass the stages. */
static void right_sides(stf_backwards *B, int i, N_Vector *right)
{
  const stf_space *space = &B->space;
  stf_copy(space, B->lambda[i], B->error);
  for (int j = 0; j < B->table->s; j++) {
    right[j] = B->r[j * B->channels + i];
    stf_axpy(space, 1, right[j], B->lambda[i]);
    stf_axpy(space, B->end[j], B->error, right[j]);
    if (B->cut && B->extra) stf_axpy(space, 1, B->extra[j * B->count + i], right[j]);
  }
  if (B->cut && B->extra)
    stf_axpy(space, 1, B->extra[B->table->s * B->count + i], B->lambda[i]);
}

/* lambda and mu of channel i by its w. */
static int pull_channel(stf_backwards *B, const stf_head *head, int i, N_Vector *w)
{
  const steif_table *T = B->table;
  for (int j = 0; j < T->s; j++) {
    const sunrealtype t = head->t + T->c[j] * head->h;
    STEIF_TRY(stf_adjoint_add(&B->adjoint, j, 'A', 1, w[j], B->lambda[i]));
    STEIF_TRY(stf_pull_parameters(B, i, t, B->Y[j], B->Yp[j], w[j]));
  }
  return STEIF_OK;
}

/* right := right - K'^T w, lambda := lambda + A'^T w, after channel i, for channel count + i. */
static int bend_stages(stf_backwards *B, const stf_head *head, int i, N_Vector *right)
{
  const stf_space *space = &B->space;
  const stf_pushed *D = B->tangent;
  const steif_table *T = B->table;
  const int s = T->s;
  for (int j = 0; j < s; j++) STEIF_TRY(bend(B, i, head->t + T->c[j] * head->h, j, j));
  right_sides(B, B->count + i, right);
  for (int j = 0; j < s; j++) {
    stf_axpy(space, 1, D->bend_A[j], right[j]);
    stf_axpy(space, 1, D->bend_A[j], B->lambda[B->count + i]);
    for (int m = 0; D->has_E && m < s; m++)
      stf_axpy(space, -B->adjoint.B[j * s + m], D->bend_E[j], right[m]);
  }
  return STEIF_OK;
}

int stf_factor_collocation(stf_backwards *B, const stf_head *head)
{
  const steif_table *T = B->table;
  const int s = T->s;
  const sunrealtype h = head->h;
  sunrealtype B_over_h[STEIF_STAGES * STEIF_STAGES];
  for (int j = 0; j < s * s; j++) B_over_h[j] = B->adjoint.transform.B[j] / h;
  for (int j = 0; j < s; j++)
    STEIF_TRY(
      stf_matrices_at_fill(&B->adjoint.at, j, head->t + T->c[j] * h, B->Y[j], B->Yp[j]));
  return stf_adjoint_factor(&B->adjoint, head->t, h, B_over_h);
}

static int pull_collocation(stf_backwards *B, const stf_head *head)
{
  const steif_table *T = B->table;
  const int s = T->s;
  const sunrealtype h = head->h;
  STEIF_TRY(stf_factor_collocation(B, head));
  for (int j = 0; j < s; j++) {
    N_Vector *r = B->r + j * B->channels;
    for (int i = 0; i < B->channels; i++) stf_zero(&B->space, r[i]);
    STEIF_TRY(quadrature(B, weights(B, h * T->b[j]), head->t + T->c[j] * h, j, r));
  }
  for (int i = 0; i < B->count; i++) right_sides(B, i, B->right + i * s);
  STEIF_TRY(stf_adjoint_solve_all(&B->adjoint, B->right, B->w));
  for (int i = 0; i < B->count; i++) STEIF_TRY(pull_channel(B, head, i, B->w + i * s));
  for (int i = 0; B->tangent && i < B->count; i++) {
    STEIF_TRY(bend_stages(B, head, i, B->right));
    N_Vector *w = B->w + (B->count + i) * s;
    STEIF_TRY(stf_adjoint_solve(&B->adjoint, B->right, w));
    STEIF_TRY(pull_channel(B, head, B->count + i, w));
  }
  B->adjoint.h_behind = h;
  return STEIF_OK;
}

/* ---- one stage after another ------------------------------------------------------------------ */

/* x of channel i, what comes to Y_m, by its w. */
static int add_equation(stf_backwards *B, int i, int m, sunrealtype t, N_Vector x)
{
  STEIF_TRY(stf_adjoint_add(&B->adjoint, 0, 'A', 1, B->w[i], x));
  return stf_pull_parameters(B, i, t, B->Y[m], B->Yp[m], B->w[i]);
}

/* x of all channels through the equation of stage m, whose slopes they come to. */
static int pull_equation(stf_backwards *B, int m, sunrealtype t, sunrealtype shift,
                         N_Vector *slope, N_Vector *x)
{
  const stf_pushed *D = B->tangent;
  const stf_space *space = &B->space;
  for (int i = 0; i < B->channels; i++) stf_sum(space, shift, slope[i], 1, x[i], slope[i]);
  STEIF_TRY(stf_adjoint_solve_all(&B->adjoint, slope, B->w));
  for (int i = 0; i < B->count; i++) STEIF_TRY(add_equation(B, i, m, t, x[i]));
  for (int i = B->count; i < B->channels; i++) {
    STEIF_TRY(bend(B, i - B->count, t, m, 0));
    if (D->has_E) stf_axpy(space, -shift, D->bend_E[0], slope[i]);
    stf_axpy(space, 1, D->bend_A[0], slope[i]);
    stf_axpy(space, 1, D->bend_A[0], x[i]);
    STEIF_TRY(stf_adjoint_solve(&B->adjoint, slope + i, B->w + i));
    STEIF_TRY(add_equation(B, i, m, t, x[i]));
  }
  return STEIF_OK;
}

/* B->r: what comes to the slopes K_j, by stages and channels. */
static int pull_stage(stf_backwards *B, const stf_head *head, int m)
{
  const stf_space *space = &B->space;
  const steif_table *T = B->table;
  const sunrealtype h = head->h, gamma = T->A[m * T->s + m], t = head->t + T->c[m] * h;
  const sunrealtype shift = gamma > 0 ? 1 / (gamma * h) : 0;
  N_Vector *x = B->r + T->s * B->channels; /* what comes to Y_m */
  for (int i = 0; i < B->channels; i++) stf_zero(space, x[i]);
  STEIF_TRY(quadrature(B, weights(B, h * T->b[m]), t, m, x));
  if (gamma > 0) {
    STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t, B->Y[m], B->Yp[m]));
    STEIF_TRY(stf_adjoint_factor(&B->adjoint, t, h, &shift));
    STEIF_TRY(pull_equation(B, m, t, shift, B->r + m * B->channels, x));
  }
  for (int i = 0; i < B->channels; i++) {
    stf_axpy(space, 1, x[i], B->lambda[i]);
    for (int j = 0; j < m; j++)
      stf_axpy(space, h * T->A[m * T->s + j], x[i], B->r[j * B->channels + i]);
  }
  return STEIF_OK;
}

static int pull_chain(stf_backwards *B, const stf_head *head)
{
  const steif_table *T = B->table;
  const stf_space *space = &B->space;
  for (int m = 0; m < T->s; m++)
    for (int i = 0; i < B->channels; i++)
      stf_scale(space, head->h * B->end[m], B->lambda[i], B->r[m * B->channels + i]);
  for (int i = 0; i < B->channels; i++)
    stf_axpy(space, 1, B->kappa[i], B->r[(T->s - 1) * B->channels + i]);
  for (int m = 0; B->cut && B->extra && m <= T->s; m++)
    for (int i = 0; i < B->count; i++)
      stf_axpy(space, 1, B->extra[m * B->count + i],
               m < T->s ? B->r[m * B->channels + i] : B->lambda[i]);
  for (int m = T->s; m-- > 0;) STEIF_TRY(pull_stage(B, head, m));
  for (int i = 0; i < B->channels; i++)
    if (T->A[0] == 0)
      stf_copy(space, B->r[i], B->kappa[i]);
    else
      stf_zero(space, B->kappa[i]);
  return STEIF_OK;
}

/* ---- BDF ---------------------------------------------------------------------------------------- */

/* mu of channel i by its w, which of derivatives is found first. */
static int pull_value(stf_backwards *B, int i, int at, sunrealtype t, sunrealtype shift)
{
  const stf_pushed *D = B->tangent;
  if (i >= B->count) {
    STEIF_TRY(bend(B, i - B->count, t, at, 0));
    if (D->has_E) stf_axpy(&B->space, -shift, D->bend_E[0], B->lambda[i]);
    stf_axpy(&B->space, 1, D->bend_A[0], B->lambda[i]);
    STEIF_TRY(stf_adjoint_solve(&B->adjoint, &B->lambda[i], B->w + i));
  }
  return stf_pull_parameters(B, i, t, B->Y[at], B->Yp[at], B->w[i]);
}

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
  STEIF_TRY(quadrature(B, c, t + h, at, B->lambda));
  STEIF_TRY(stf_adjoint_solve_all(&B->adjoint, B->lambda, B->w));
  for (int i = 0; i < B->channels; i++) {
    STEIF_TRY(pull_value(B, i, at, t + h, shift));
    stf_zero(space, B->work);
    STEIF_TRY(stf_adjoint_add(&B->adjoint, 0, 'E', 1, B->w[i], B->work));
    if (i >= B->count && B->tangent->has_E) stf_axpy(space, 1, B->tangent->bend_E[0], B->work);
    for (int j = 1; j <= order; j++) stf_axpy(space, -alpha[j] / h, B->work, B->past[j][i]);
    stf_zero(space, B->lambda[i]);
  }
  B->adjoint.h_behind = 1 / shift;
  for (int i = 0; i < B->count; i++) {
    const sunrealtype nu = B->nu[i];
    for (int j = 1; j <= order; j++) B->nu[j * B->count + i] -= alpha[j] / alpha[0] * nu;
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
  for (int i = 0; i < B->count; i++) B->other[i] = nu[i], nu[i] = 0;
  for (int i = 0; i < B->channels; i++) stf_zero(&B->space, between[i]);
  for (int i = 0; i < B->count; i++) B->estimate[B->count + i] = B->other[i];
  STEIF_TRY(pull_bdf_step(B, 1, head->t + d, d, 1, head->alpha));
  B->past[STF_PAST - 1] = B->lambda, B->lambda = between, B->past[1] = before;
  for (int i = 0; i < B->count; i++) B->nu[i] = nu[i], nu[i] = B->estimate[B->count + i];
  STEIF_TRY(pull_bdf_step(B, 0, head->t, d, 1, head->alpha));
  shift_past(B);
  return STEIF_OK;
}

/* ---- all ---------------------------------------------------------------------------------------- */

int stf_pull(stf_backwards *B, const sunrealtype *record)
{
  stf_head head;
  memcpy(&head, record, sizeof head);
  stf_record_read(B, record);
  if (B->tangent) stf_push_read(B, record);
  for (int i = 0; B->adaptive && i < B->count; i++)
    B->estimate[i] += dot(B, B->error, B->lambda[i]);
  STEIF_TRY(stf_see_cut(B, &head));
  STEIF_TRY(B->kind == STF_TRACE_COLLOCATION ? pull_collocation(B, &head)
            : B->kind == STF_TRACE_CHAIN     ? pull_chain(B, &head)
                                             : pull_bdf(B, &head));
  for (int i = 0; i < B->channels; i++)
    STEIF_CHECK(stf_finite(&B->space, B->lambda[i]), B->ctx, STEIF_NOT_FINITE,
                "the adjoint of functional %d of problem '%s' is not finite at t = %.12g",
                i % B->count + 1, B->problem->name, head.t);
  return STEIF_OK;
}

/* A chain that began with the slope f(t0, y0) hands on what has come to that: at the start, and behind events and
 * breaks. */
int stf_pull_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0)
{
  stf_pushed *D = B->tangent;
  if (B->kind != STF_TRACE_CHAIN || B->table->A[0] != 0) return STEIF_OK;
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t0, y0, yp0));
  for (int i = 0; i < B->channels; i++) {
    STEIF_TRY(stf_adjoint_add(&B->adjoint, 0, 'A', 1, B->kappa[i], B->lambda[i]));
    STEIF_TRY(stf_pull_parameters(B, i, t0, y0, yp0, B->kappa[i]));
    if (!D) stf_zero(&B->space, B->kappa[i]);
  }
  const N_Vector at[] = {y0, yp0, D ? D->y : NULL, D ? D->kappa : NULL};
  for (int i = 0; D && i < B->count; i++) {
    STEIF_TRY(stf_bend(B, i, t0, at, B->kappa[i], D->bend_E[0], D->bend_A[0]));
    stf_axpy(&B->space, 1, D->bend_A[0], B->lambda[B->count + i]);
  }
  return STEIF_OK;
}
