/* push.c: steps differentiated along a line of parameters and start values, from their records.
 *
 * With the stages' matrix K, sensitivity.h: K dZ_j = A_j dy - dF_j/dtheta, of BDF
 *   (alpha_0/h E - A) dy_new = - dF/dtheta - E sum of alpha_j/h dy_past,j over j > 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <string.h>

static void destroy_matrix(void *M) { SUNMatDestroy(M); }

static int clone(stf_backwards *B, SUNMatrix like, SUNMatrix *M)
{
  if (!like) return STEIF_OK;
  *M = SUNMatClone(like);
  STEIF_CHECK(*M, B->ctx, STEIF_NO_MEMORY, "no memory for a matrix of order %lld",
              (long long)B->n);
  return stf_pool_adopt(B->pool, *M, destroy_matrix);
}

static int claim_vectors(stf_backwards *B, stf_pushed *D, int stages)
{
  N_Vector *one[] = {&D->y, &D->kappa, &D->at, &D->slope_at};
  for (size_t i = 0; i < STF_COUNT(one); i++)
    if (!(*one[i] = stf_pool_vector(B->pool, B->space.like))) return STEIF_NO_MEMORY;
  const struct {
    N_Vector **to;
    int count;
  } many[] = {{&D->Y, B->points}, {&D->Yp, B->points}, {&D->past, STF_PAST},
              {&D->x, stages},    {&D->r, stages},     {&D->bend_E, stages},
              {&D->gy, B->count}, {&D->bend_A, stages}};
  for (size_t i = 0; i < STF_COUNT(many); i++)
    if (!(*many[i].to = stf_pool_vectors(B->pool, many[i].count, B->space.like)))
      return STEIF_NO_MEMORY;
  return STEIF_OK;
}

int stf_push_open(stf_backwards *B, steif_direction *line)
{
  stf_system *system = B->adjoint.at.system;
  const size_t size = (size_t)(B->count * B->P) + 1;
  stf_pushed *D = B->tangent = stf_pool_array(B->pool, 1, sizeof *D);
  if (!D) return STEIF_NO_MEMORY;
  *D = (stf_pushed){.line = line};
  STEIF_TRY(claim_vectors(B, D, B->kind == STF_TRACE_BDF ? 1 : B->table->s));
  D->gp = stf_pool_array(B->pool, size, sizeof *D->gp);
  if (!D->gp) return STEIF_NO_MEMORY;
  D->has_E = system->form != STEIF_ODE;
  if (!system->A) STEIF_TRY(stf_matrices_at_open(B->pool, system, 1, &D->moved));
  STEIF_TRY(clone(B, system->A, &D->A));
  STEIF_TRY(clone(B, system->E, &D->E));
  return stf_slopes_open(B->pool, B->ctx, &line->problem,
                         steif_problem_form(B->ctx, B->problem), B->space.like, &D->slopes);
}

/* work = dF/dtheta. */
static int slope_at(stf_backwards *B, sunrealtype t, N_Vector y, N_Vector yp)
{
  const stf_pushed *D = B->tangent;
  STEIF_TRY(stf_slopes_at(D->slopes, 0, t, y, yp, B->work));
  return stf_finite(&B->space, B->work) ? STEIF_OK
                                        : stf_slopes_not_finite(D->slopes, 0, t, B->work);
}

int stf_push_start(stf_backwards *B, sunrealtype t0, N_Vector y0, N_Vector yp0)
{
  stf_pushed *D = B->tangent;
  const int code = steif_parameter_start(B->ctx, &D->line->problem, 0, D->y);
  if (code) return code;
  for (int j = 0; j < STF_PAST; j++) stf_zero(&B->space, D->past[j]);
  stf_copy(&B->space, D->y, D->past[0]);
  stf_zero(&B->space, D->kappa);
  if (B->kind != STF_TRACE_CHAIN || B->table->A[0] != 0) return STEIF_OK;
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t0, y0, yp0));
  STEIF_TRY(stf_matrices_at_product(&B->adjoint.at, 0, 'A', D->y, D->kappa));
  STEIF_TRY(slope_at(B, t0, y0, yp0));
  stf_axpy(&B->space, -1, B->work, D->kappa);
  return STEIF_OK;
}

/* out = A base - dF/dtheta at record point `point`, with the matrices at `j`. */
static int right_side(stf_backwards *B, int j, int point, sunrealtype t, N_Vector base,
                      N_Vector out)
{
  STEIF_TRY(slope_at(B, t, B->Y[point], B->Yp[point]));
  STEIF_TRY(stf_matrices_at_product(&B->adjoint.at, j, 'A', base, out));
  stf_axpy(&B->space, -1, B->work, out);
  return STEIF_OK;
}

static int push_collocation(stf_backwards *B, const stf_head *head)
{
  stf_pushed *D = B->tangent;
  const steif_table *T = B->table;
  STEIF_TRY(stf_factor_collocation(B, head));
  for (int j = 0; j < T->s; j++)
    STEIF_TRY(right_side(B, j, j, head->t + T->c[j] * head->h, D->y, D->r[j]));
  STEIF_TRY(stf_adjoint_solve_forward(&B->adjoint, D->r, D->x));
  for (int j = 0; j < T->s; j++) {
    stf_sum(&B->space, 1, D->y, 1, D->x[j], D->Y[j]);
    stf_combine(&B->space, T->s, B->adjoint.B + j * T->s, D->x, D->Yp[j]);
  }
  for (int j = 0; j < T->s; j++) stf_axpy(&B->space, B->u.end[j], D->x[j], D->y);
  return STEIF_OK;
}

static int push_stage(stf_backwards *B, const stf_head *head, int m)
{
  stf_pushed *D = B->tangent;
  const steif_table *T = B->table;
  const stf_space *space = &B->space;
  const sunrealtype h = head->h, gamma = T->A[m * T->s + m], t = head->t + T->c[m] * h;
  const sunrealtype shift = gamma > 0 ? 1 / (gamma * h) : 0;
  stf_copy(space, D->y, D->Y[m]);
  for (int j = 0; j < m; j++) stf_axpy(space, h * T->A[m * T->s + j], D->Yp[j], D->Y[m]);
  if (gamma == 0) {
    stf_copy(space, D->kappa, D->Yp[m]);
    return STEIF_OK;
  }
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t, B->Y[m], B->Yp[m]));
  STEIF_TRY(stf_adjoint_factor(&B->adjoint, t, h, &shift));
  STEIF_TRY(right_side(B, 0, m, t, D->Y[m], D->r[0]));
  STEIF_TRY(stf_adjoint_solve_forward(&B->adjoint, D->r, D->x));
  stf_axpy(space, 1, D->x[0], D->Y[m]);
  stf_scale(space, shift, D->x[0], D->Yp[m]);
  return STEIF_OK;
}

static int push_chain(stf_backwards *B, const stf_head *head)
{
  stf_pushed *D = B->tangent;
  const steif_table *T = B->table;
  for (int m = 0; m < T->s; m++) STEIF_TRY(push_stage(B, head, m));
  for (int m = 0; m < T->s; m++) stf_axpy(&B->space, head->h * T->b[m], D->Yp[m], D->y);
  stf_copy(&B->space, D->Yp[T->s - 1], D->kappa);
  return STEIF_OK;
}

/* D->Y[at] from past values past[0], past[1], ... */
static int push_bdf_step(stf_backwards *B, int at, sunrealtype t, sunrealtype h, int order,
                         const sunrealtype *alpha, N_Vector *past)
{
  stf_pushed *D = B->tangent;
  const stf_space *space = &B->space;
  const sunrealtype shift = alpha[0] / h;
  N_Vector slope = D->Yp[at];
  STEIF_TRY(stf_matrices_at_fill(&B->adjoint.at, 0, t + h, B->Y[at], B->Yp[at]));
  STEIF_TRY(stf_adjoint_factor(&B->adjoint, t, h, &shift));
  stf_zero(space, slope);
  for (int j = 1; j <= order; j++) stf_axpy(space, alpha[j] / h, past[j - 1], slope);
  STEIF_TRY(stf_matrices_at_product(&B->adjoint.at, 0, 'E', slope, D->r[0]));
  STEIF_TRY(slope_at(B, t + h, B->Y[at], B->Yp[at]));
  stf_sum(space, -1, D->r[0], -1, B->work, D->r[0]);
  STEIF_TRY(stf_adjoint_solve_forward(&B->adjoint, D->r, &D->Y[at]));
  stf_axpy(space, shift, D->Y[at], slope);
  return STEIF_OK;
}

static int push_bdf(stf_backwards *B, const stf_head *head)
{
  stf_pushed *D = B->tangent;
  const sunrealtype h = head->h, d = h / 2;
  if (head->halved) {
    STEIF_TRY(push_bdf_step(B, 0, head->t, d, 1, head->alpha, D->past));
    STEIF_TRY(push_bdf_step(B, 1, head->t + d, d, 1, head->alpha, D->Y));
  } else {
    STEIF_TRY(push_bdf_step(B, 1, head->t, h, head->order, head->alpha, D->past));
    stf_zero(&B->space, D->Y[0]), stf_zero(&B->space, D->Yp[0]);
  }
  N_Vector oldest = D->past[STF_PAST - 1];
  for (int j = STF_PAST - 1; j > 0; j--) D->past[j] = D->past[j - 1];
  D->past[0] = oldest;
  stf_copy(&B->space, D->Y[1], oldest);
  stf_copy(&B->space, D->Y[1], D->y);
  return STEIF_OK;
}

int stf_push(stf_backwards *B, sunrealtype *record)
{
  const stf_pushed *D = B->tangent;
  const size_t n = (size_t)B->n, size = n * sizeof *record;
  stf_head head;
  memcpy(&head, record, sizeof head);
  stf_record_read(B, record);
  STEIF_TRY(B->kind == STF_TRACE_COLLOCATION ? push_collocation(B, &head)
            : B->kind == STF_TRACE_CHAIN     ? push_chain(B, &head)
                                             : push_bdf(B, &head));
  sunrealtype *to = record + B->own;
  for (int j = 0; j < B->points; j++, to += 2 * n) {
    memcpy(to, STF_ARRAY(D->Y[j]), size);
    memcpy(to + n, STF_ARRAY(D->Yp[j]), size);
  }
  STEIF_CHECK(stf_finite(&B->space, D->y), B->ctx, STEIF_NOT_FINITE,
              "the derivative of problem '%s' along the line is not finite after t = %.12g",
              B->problem->name, head.t);
  return STEIF_OK;
}

void stf_push_read(stf_backwards *B, const sunrealtype *record)
{
  const stf_pushed *D = B->tangent;
  const size_t n = (size_t)B->n;
  const sunrealtype *from = record + B->own;
  for (int j = 0; j < B->points; j++, from += 2 * n) {
    memcpy(STF_ARRAY(D->Y[j]), from, n * sizeof *from);
    memcpy(STF_ARRAY(D->Yp[j]), from + n, n * sizeof *from);
  }
}

/* ---- kept beside images ---------------------------------------------------------------------------- */

size_t stf_push_size(const stf_backwards *B) { return (size_t)B->n * (STF_PAST + 2); }

void stf_push_keep(stf_backwards *B, sunrealtype *to)
{
  const stf_pushed *D = B->tangent;
  const size_t n = (size_t)B->n, size = n * sizeof *to;
  memcpy(to, STF_ARRAY(D->y), size);
  memcpy(to + n, STF_ARRAY(D->kappa), size);
  for (int j = 0; j < STF_PAST; j++)
    memcpy(to + (size_t)(j + 2) * n, STF_ARRAY(D->past[j]), size);
}

void stf_push_back(stf_backwards *B, const sunrealtype *from)
{
  const stf_pushed *D = B->tangent;
  const size_t n = (size_t)B->n, size = n * sizeof *from;
  memcpy(STF_ARRAY(D->y), from, size);
  memcpy(STF_ARRAY(D->kappa), from + n, size);
  for (int j = 0; j < STF_PAST; j++)
    memcpy(STF_ARRAY(D->past[j]), from + (size_t)(j + 2) * n, size);
}
