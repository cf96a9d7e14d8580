/* glm_state.c: what a step of a general linear method makes of its data by rows of weights.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "glm_state.h"
#include <math.h>
#include <string.h>

enum { DATA = STF_GLM_DATA };
typedef stf_glm_state state;

void stf_glm_combine(const stf_step *s, const sunrealtype *d, const stf_glm_step *of,
                     N_Vector out)
{
  const state *e = s->state;
  sunrealtype weight[DATA];
  N_Vector v[DATA];
  int count = 0;
  for (int i = 0; i < e->data; i++) {
    if (d[i] == 0) continue;
    const int f = i - e->k, b = f - e->r;
    weight[count] = f >= 0 && b < 0 ? of->h * d[i] : d[i];
    v[count++] = f < 0 ? of->X[i] : b < 0 ? of->F[f] : of->before[b];
  }
  stf_combine(&s->system.space, count, weight, v, out);
}

void stf_glm_rescale(const stf_step *s, sunrealtype h, const stf_glm_step *last, N_Vector *X)
{
  const state *e = s->state;
  const int n = e->p + 1;
  for (int i = 0; i < e->k; i++) {
    sunrealtype row[DATA] = {0}, power = 1;
    for (int j = 0; j < n; j++, power *= h / last->h)
      for (int m = 0; m < e->data && e->g->W[i * n + j] != 0; m++)
        row[m] += e->g->W[i * n + j] * power * e->z[j * e->data + m];
    stf_glm_combine(s, row, last, X[i]);
  }
}

void stf_glm_advance(const stf_step *s, const stf_glm_step *now, N_Vector next)
{
  const state *e = s->state;
  const steif_glm *g = e->g;
  for (int i = 0; i < e->k; i++) {
    sunrealtype row[DATA] = {0};
    memcpy(row + e->k, g->D + i * e->r, (size_t)e->r * sizeof *row);
    memcpy(row + e->k + e->r, g->V + i * e->k, (size_t)e->k * sizeof *row);
    stf_glm_combine(s, row, now, now->X[i]);
  }
  stf_glm_combine(s, e->finish, now, next);
}

void stf_glm_error(const stf_step *s, const stf_glm_step *now, const stf_glm_step *last,
                   N_Vector work, N_Vector out)
{
  const state *e = s->state;
  const sunrealtype *z = e->z + e->p * e->data;
  sunrealtype at_end[DATA], at_start[DATA];
  if (e->estimates) {
    stf_glm_combine(s, e->error, now, out);
    return;
  }
  const sunrealtype power = pow(now->h / last->h, e->p);
  for (int i = 0; i < e->data; i++)
    at_end[i] = e->g->error * z[i], at_start[i] = power * at_end[i];
  stf_glm_combine(s, at_end, now, out);
  stf_glm_combine(s, at_start, last, work);
  stf_axpy(&s->system.space, -1, work, out);
}

/* Taylor's polynomial at the end of the step, or where it is not known the straight line. */
void stf_glm_dense(const stf_step *s, sunrealtype t, const stf_glm_step *last, N_Vector before,
                   N_Vector y, N_Vector out)
{
  const state *e = s->state;
  const sunrealtype x = (t - s->t) / s->h;
  if (!e->dense) {
    stf_sum(&s->system.space, 1 + x, y, -x, before, out);
    return;
  }
  sunrealtype d[DATA] = {0}, term = 1;
  for (int j = 0; j <= e->p; j++, term *= x / j)
    for (int m = 0; m < e->data; m++) d[m] += term * e->z[j * e->data + m];
  stf_glm_combine(s, d, last, out);
}
