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

/* Legendre's polynomials on [0, 1] with x^k as their leading term are at most this large. */
static sunrealtype size_of(int k)
{
  sunrealtype size = 1;
  for (int i = 1; i <= k; i++) size *= (sunrealtype)i / (k + i);
  return size;
}

/* x^k has k/2 of the one of degree k - 1, and of that of degree k - 2 */
static sunrealtype second(int k) { return k * k * (k - 1.0) / (4 * (2.0 * k - 1)); }

/* Norms of the last three, or two where k = 2. */
static void norms(const stf_step *s, int k, N_Vector const *c, sunrealtype *term)
{
  const int from = k == 2;
  term[0] = 0;
  for (int i = from; i < 3; i++) stf_of_index_one(s, c[i]);
  stf_norm_each(&s->system.space, 3 - from, c + from, s->weights, term + from);
}

void stf_between_powers(stf_step *s, int k, N_Vector const *c)
{
  const stf_space *space = &s->system.space;
  sunrealtype term[3];
  if (k > 2) {
    stf_axpy(space, (k - 1) / 2.0, c[1], c[0]);
    stf_axpy(space, second(k), c[2], c[0]);
  }
  stf_axpy(space, k / 2.0, c[2], c[1]);
  norms(s, k, c, term);
  for (int i = 0; i < 3; i++) term[i] *= size_of(k - 2 + i);
  stf_between(s, term[0], term[1], term[2]);
}

void stf_between_taylor(stf_step *s, int k, N_Vector const *c)
{
  sunrealtype term[3];
  norms(s, k, c, term);
  stf_between(s, term[0], term[1], term[2]);
}
