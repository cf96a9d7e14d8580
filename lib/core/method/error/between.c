/* between.c: the error of the solution between the ends of a step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "step_error.h"
#include <math.h>

void stf_between(stf_step *s, sunrealtype a, sunrealtype b, sunrealtype c)
{
  const sunrealtype allowed = 3;
  const sunrealtype r = a > 0 ? sqrt(fmin(1, c / a)) : fmin(1, c / b);
  s->control.between = c > 0 && s->tries < STF_STUBBORN ? r * fmax(c, r * b) / allowed : 0;
}

void stf_estimate_between(stf_step *s, const stf_estimate *e, sunrealtype lower,
                          sunrealtype below, sunrealtype top)
{
  const int k = e->s;
  s->control.between = 0;
  if (k < 2) return;
  const sunrealtype less = e->legendre * 2 * (2 * k - 1) / k, /* legendre of k - 1 and k - 2 */
    least = less * 2 * (2 * k - 3) / (k - 1);
  stf_between(s, k > 2 ? least * lower : 0, less * below, e->legendre * top);
}

/* Powers by the polynomials 2^-1, 6^-1 and 20^-1 of degrees 1 to 3, orthogonal on [0, 1] and at most as large:
 * x^2 has x, x^3 has 3/2 x^2 and 9/10 x of the ones below. */
void stf_between_powers(stf_step *s, int k, N_Vector const *c)
{
  static const sunrealtype size[] = {1.0 / 2, 1.0 / 6, 1.0 / 20};
  const stf_space *space = &s->system.space;
  sunrealtype term[3];
  stf_axpy(space, 1, c[1], c[0]);
  if (k > 2) stf_axpy(space, 0.9, c[2], c[0]), stf_axpy(space, 1.5, c[2], c[1]);
  for (int i = 0; i < k; i++) stf_of_index_one(s, c[i]);
  stf_norm_each(space, k, c, s->weights, term);
  for (int i = 0; i < k; i++) term[i] *= size[i];
  stf_between(s, k > 2 ? term[0] : 0, term[k - 2], term[k - 1]);
}
