/* carry_rosenbrock.c: derivatives by parameters through Rosenbrock methods.
 *
 * With w_i = u_i/(gamma h) - sum_j (c_ij/h) u_j a stage is M w_i - J u_i = f(t_i, Y_i) + gamma_i h f_t, J = df/dy at
 * (t_n, y_n). Along column k, F = M y' - f,
 *   (M/(gamma h) - J) du_i = J_i dY_i - F_p(t_i, Y_i, w_i) + gamma_i h df_t + M sum_j (c_ij/h) du_j + (dJ) u_i,
 * the matrix of the step itself: nothing is iterated. (dJ) u_i = f_yy[S, u_i] + f_yp u_i is symmetric in S and u_i: the
 * derivative of J S + f_p along u_i, by differences of the exact J and f_p over u_i/128 and u_i/256, extrapolated; their
 * errors are about 1e-11 where f changes by its own size in a step, and none where f is a polynomial of degree 5.
 * f_t is the difference that the step has taken.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "carry.h"
#include "rosenbrock_state.h"
#include <math.h>
#include <steif/parameters.h>

typedef stf_rosenbrock_state state;

enum { TOGETHER = 16 }; /* right-hand sides of one solve, at most */

/* Points: the stages, and one for differences. */
static stf_carrier_size sizes(const stf_step *s)
{
  const stf_rodas *r = ((const state *)s->state)->r;
  return (stf_carrier_size){r->s + 1, r->s, r->s, r->s, 0};
}

static int check(const stf_step *s)
{
  const steif_problem *p = s->problem;
  const stf_rodas *r = ((const state *)s->state)->r;
  STEIF_CHECK((p->jac || p->A) && p->parameters && p->parameters->dFdp, s->ctx,
              STEIF_UNSUPPORTED,
              "'%s' carries sensitivities by second derivatives, differences of exact first "
              "ones: problem "
              "'%s' has no %s; give it, or take radau:s=3",
              r->name, p->name, p->jac || p->A ? "parameters.dFdp" : "jac");
  return STEIF_OK;
}

/* Y_i into T->last from that of the stage before, w_i into T->last_slope. */
static void argument(stf_carry *T, sunrealtype h, int i)
{
  stf_step *s = T->step;
  state *e = s->state;
  const stf_rodas *r = e->r;
  const stf_space *space = &s->system.space;
  sunrealtype c[STF_RODAS_STAGES];
  if (i >= r->rows)
    stf_axpy(space, 1, e->u[i - 1], T->last);
  else {
    stf_combine(space, i, r->a + i * (i - 1) / 2, e->u, T->last);
    stf_axpy(space, 1, s->y, T->last);
  }
  for (int j = 0; j < i; j++) c[j] = -r->c[i * (i - 1) / 2 + j] / h;
  stf_combine(space, i, c, e->u, T->last_slope);
  stf_axpy(space, 1 / (r->g * h), e->u[i], T->last_slope);
}

/* out_k += weight (J S + f_p) at (t, y), y' being 0 in F_p. */
static int add_slope(stf_carry *T, sunrealtype t, N_Vector y, sunrealtype weight,
                     N_Vector **out, int at)
{
  const stf_space *space = &T->step->system.space;
  const int point = T->size.points - 1;
  STEIF_TRY(stf_carry_point(T, point, t, y, T->Yp));
  for (int k = 0; k < T->count; k++) {
    STEIF_TRY(stf_carry_residual(T, point, k, T->S[k], NULL, T->work));
    stf_axpy(space, weight, T->work, at < 0 ? T->error[k] : out[k][at]);
  }
  return STEIF_OK;
}

/* T->r[k][i] = (dJ) u_i. */
static int bend(stf_carry *T, int i)
{
  static const sunrealtype place[] = {0.5, -0.5, 1, -1}, weight[] = {8, -8, -1, 1};
  const sunrealtype step = 1.0 / 128;
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_space *space = &s->system.space;
  for (int k = 0; k < T->count; k++) stf_zero(space, T->r[k][i]);
  for (int j = 0; j < 4; j++) {
    stf_sum(space, 1, s->y, place[j] * step, e->u[i], T->Y);
    STEIF_TRY(add_slope(T, s->t, T->Y, weight[j] / (6 * step), T->r, i));
  }
  return STEIF_OK;
}

/* T->error = the derivatives of stf_slope_in_time. */
static int slope_in_time(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const sunrealtype d = fmax(1e-4 * h, 64 * STF_EPS * fabs(s->t));
  const sunrealtype weight[] = {-1.5 / d, 2 / d, -0.5 / d};
  for (int k = 0; k < T->count; k++) stf_zero(&s->system.space, T->error[k]);
  for (int j = 0; j < 3 && !s->problem->autonomous; j++)
    STEIF_TRY(add_slope(T, s->t + j * d, s->y, weight[j], NULL, -1));
  return STEIF_OK;
}

/* dY_i into T->next[k] from that of the stage before; the right side into trial[k][i]. */
static int right_side(stf_carry *T, sunrealtype h, int i, int k)
{
  stf_step *s = T->step;
  const stf_rodas *r = ((const state *)s->state)->r;
  const stf_space *space = &s->system.space;
  sunrealtype c[STF_RODAS_STAGES];
  N_Vector *u = T->trial[k], dY = T->next[k];
  if (i >= r->rows)
    stf_axpy(space, 1, u[i - 1], dY);
  else {
    stf_combine(space, i, r->a + i * (i - 1) / 2, u, dY);
    stf_axpy(space, 1, T->S[k], dY);
  }
  STEIF_TRY(stf_carry_residual(T, i, k, dY, NULL, u[i]));
  stf_axpy(space, r->gamma[i] * h, T->error[k], u[i]);
  stf_axpy(space, 1, T->r[k][i], u[i]);
  for (int j = 0; j < i; j++) c[j] = r->c[i * (i - 1) / 2 + j] / h;
  stf_combine(space, i, c, u, T->work);
  STEIF_TRY(stf_matrices_at_product(&T->at, i, 'E', T->work, T->product));
  stf_axpy(space, 1, T->product, u[i]);
  return STEIF_OK;
}

static int solve(stf_carry *T, int i)
{
  N_Vector together[TOGETHER];
  for (int k = 0; k < T->count; k += TOGETHER) {
    const int count = T->count - k < TOGETHER ? T->count - k : TOGETHER;
    for (int j = 0; j < count; j++) together[j] = T->trial[k + j][i];
    STEIF_TRY(steif_pencil_solve(T->step->system.pencil, 0, count, together, NULL));
  }
  return STEIF_OK;
}

static int carry(stf_carry *T, sunrealtype h)
{
  stf_step *s = T->step;
  const state *e = s->state;
  const stf_rodas *r = e->r;
  const stf_space *space = &s->system.space;
  stf_zero(space, T->Yp);
  for (int i = 0; i < r->s; i++) {
    argument(T, h, i);
    STEIF_TRY(stf_carry_point(T, i, s->t + r->alpha[i] * h, T->last, T->last_slope));
    STEIF_TRY(bend(T, i));
  }
  STEIF_TRY(slope_in_time(T, h));
  for (int i = 0; i < r->s; i++) {
    for (int k = 0; k < T->count; k++) STEIF_TRY(right_side(T, h, i, k));
    STEIF_TRY(solve(T, i));
  }
  for (int k = 0; k < T->count; k++) {
    N_Vector last = T->trial[k][r->s - 1];
    stf_axpy(space, 1, last, T->next[k]);
    stf_copy(space, last, T->error[k]);
    T->tolerance[k] = stf_carry_allowed(s, e->wanted, s->control.order, r->order);
  }
  return STEIF_OK;
}

static int carried_dense(stf_carry *T, int k, sunrealtype t, N_Vector S)
{
  const state *e = T->step->state;
  return stf_rodas_inside(T->step, e->r, t, T->before[k], T->S[k], T->kept[k], S);
}

const stf_carrier stf_rosenbrock_carrier = {
  .check = check, .size = sizes, .carry = carry, .dense = carried_dense};
