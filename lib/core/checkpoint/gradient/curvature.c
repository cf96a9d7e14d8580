/* curvature.c: second derivatives along a line, as differences of first ones.
 *
 * f(x) = what is asked, at Y + x dY, Y' + x dY', p + x v. With f at x = +-e and +-e/2,
 *   f'(0) = (8 (f(e/2) - f(-e/2)) - (f(e) - f(-e))) / (6 e) + O(e^4),
 * e 2^-10 of the size of what moves most: an error of about 1e-12 where f comes from callbacks and varies over the size
 * of its arguments; rounding of f counts 2^11 times.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "backwards.h"
#include <math.h>

enum { POINTS = 4 };
static const sunrealtype place[POINTS] = {0.5, -0.5, 1, -1}, weight[POINTS] = {8, -8, -1, 1};

/* The largest of |dy_i| in sizes of y_i, small ones by that of the largest. */
static sunrealtype movement(N_Vector y, N_Vector dy)
{
  const sunrealtype most = N_VMaxNorm(y), floor = most > 0 ? 1e-3 * most : 1;
  const sunrealtype *a = STF_ARRAY(y), *b = STF_ARRAY(dy);
  sunrealtype largest = 0;
  for (sunindextype i = 0; i < NV_LENGTH_S(y); i++)
    largest = fmax(largest, fabs(b[i]) / fmax(fabs(a[i]), floor));
  return largest;
}

/* e; 0: nothing moves. */
static sunrealtype length(const stf_backwards *B, const N_Vector *point, bool slopes)
{
  sunrealtype most = B->tangent->line->reach;
  if (point) most = fmax(most, movement(point[0], point[2]));
  if (slopes) most = fmax(most, movement(point[1], point[3]));
  return most > 0 ? 1 / (1024 * most) : 0;
}

/* p at x; point NULL: no more than that. */
static int move(stf_backwards *B, const N_Vector *point, sunrealtype x)
{
  stf_pushed *D = B->tangent;
  if (point) stf_sum(&B->space, 1, point[0], x, point[2], D->at);
  if (point && point[1]) stf_sum(&B->space, 1, point[1], x, point[3], D->slope_at);
  D->line->theta = x;
  const int code = D->line->parameters.moved(D->line);
  STEIF_CHECK(!code, B->ctx, STEIF_CALLBACK,
              "parameters.moved of problem '%s' returned %d in a second difference",
              B->problem->name, code);
  return STEIF_OK;
}

/* p as it was, whatever has failed. */
static int home(stf_backwards *B, int code)
{
  const int back = move(B, NULL, 0);
  return code ? code : back;
}

static int fill(stf_backwards *B, sunrealtype t)
{
  stf_system *s = B->adjoint.at.system, here = *s;
  if (!B->tangent->A)
    return stf_matrices_at_fill(&B->tangent->moved, 0, t, B->tangent->at, B->tangent->slope_at);
  here.A = B->tangent->A, here.E = B->tangent->E;
  here.central = true, here.filled = false;
  const int code = stf_system_matrices(&here, t, B->tangent->at, B->tangent->slope_at);
  s->nfe = here.nfe;
  return code;
}

static int add(stf_backwards *B, char which, sunrealtype c, N_Vector w, N_Vector out)
{
  const stf_pushed *D = B->tangent;
  if (!D->A) return stf_matrices_at_transposed(&D->moved, 0, which, c, w, out, B->work);
  stf_add_transposed(which == 'E' ? D->E : D->A, B->n, c, STF_ARRAY(w), STF_ARRAY(out));
  return STEIF_OK;
}

static int bend_at(stf_backwards *B, int i, sunrealtype t, N_Vector w, sunrealtype c,
                   N_Vector bend_E, N_Vector bend_A)
{
  const stf_pushed *D = B->tangent;
  sunrealtype *mu = B->mu + (B->count + i) * B->P;
  STEIF_TRY(fill(B, t));
  STEIF_TRY(add(B, 'A', c, w, bend_A));
  if (D->has_E) STEIF_TRY(add(B, 'E', c, w, bend_E));
  STEIF_TRY(stf_parameters_times(B, t, D->at, D->slope_at, w, B->Fp));
  for (int k = 0; k < B->P; k++) mu[k] -= c * B->Fp[k];
  return STEIF_OK;
}

int stf_bend(stf_backwards *B, int i, sunrealtype t, const N_Vector point[4], N_Vector w,
             N_Vector bend_E, N_Vector bend_A)
{
  const bool slopes = B->adjoint.at.system->form == STEIF_IMPLICIT;
  const sunrealtype e = length(B, point, slopes);
  stf_zero(&B->space, bend_E), stf_zero(&B->space, bend_A);
  int code = STEIF_OK;
  for (int j = 0; e > 0 && !code && j < POINTS; j++) {
    code = move(B, point, place[j] * e);
    if (!code) code = bend_at(B, i, t, w, weight[j] / (6 * e), bend_E, bend_A);
  }
  return home(B, code);
}

int stf_bend_functional(stf_backwards *B, int at_end, sunrealtype t, N_Vector y, N_Vector dy)
{
  stf_pushed *D = B->tangent;
  const N_Vector point[] = {y, NULL, dy, NULL};
  const sunrealtype e = length(B, point, false);
  int code = STEIF_OK;
  for (int i = 0; i < B->count; i++) stf_zero(&B->space, D->gy[i]);
  for (int k = 0; k < B->count * B->P; k++) D->gp[k] = 0;
  for (int j = 0; e > 0 && !code && j < POINTS; j++) {
    const sunrealtype c = weight[j] / (6 * e);
    code = move(B, point, place[j] * e);
    if (!code) code = stf_functional_at(B, at_end, t, D->at);
    for (int i = 0; !code && i < B->count; i++) stf_axpy(&B->space, c, B->gy[i], D->gy[i]);
    for (int k = 0; !code && k < B->count * B->P; k++) D->gp[k] += c * B->gp[k];
  }
  return home(B, code);
}

int stf_bend_start(stf_backwards *B, int k, N_Vector out)
{
  const sunrealtype e = length(B, NULL, false);
  int code = STEIF_OK;
  stf_zero(&B->space, out);
  for (int j = 0; e > 0 && !code && j < POINTS; j++) {
    code = move(B, NULL, place[j] * e);
    if (!code) code = steif_parameter_start(B->ctx, B->problem, k, B->tangent->at);
    if (!code) stf_axpy(&B->space, weight[j] / (6 * e), B->tangent->at, out);
  }
  return home(B, code);
}
