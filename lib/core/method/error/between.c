/* between.c: the error of the solution between the ends of a step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "step_error.h"
#include <math.h>

enum { ALLOWED = 5 }; /* tolerances */

static void set(stf_step *s, sunrealtype r, sunrealtype b, sunrealtype c)
{
  const bool known = c > 0 && s->tries < STF_STUBBORN;
  s->control.between = known ? fmin(1, r) * fmax(c, fmin(1, r) * b) / ALLOWED : 0;
}

/* Of two terms: c/b is 0 where the solution bends to the other side, and may not fall at once. */
static sunrealtype remembered(stf_step *s, sunrealtype b, sunrealtype c)
{
  const sunrealtype forgotten = 0.8;
  const sunrealtype r = fmin(1, fmax(c / b, forgotten * s->control.rate * s->h_try));
  s->control.rate = r / s->h_try;
  return r;
}

void stf_estimate_between(stf_step *s, const stf_estimate *e, sunrealtype lower,
                          sunrealtype below, sunrealtype top)
{
  const int k = e->s;
  s->control.between = 0;
  if (k < 2) return;
  const sunrealtype less = e->legendre * 2 * (2 * k - 1) / k, /* legendre of k - 1 and k - 2 */
    least = less * 2 * (2 * k - 3) / (k - 1);
  const sunrealtype a = least * lower, b = less * below, c = e->legendre * top;
  set(s, k > 2 ? sqrt(c / a) : remembered(s, b, c), b, c);
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
  set(s, k > 2 ? sqrt(term[2] / term[0]) : term[2] / term[1], term[1], term[2]);
}

void stf_between_taylor(stf_step *s, int k, N_Vector const *c)
{
  sunrealtype term[3];
  norms(s, k, c, term);
  set(s, k > 2 ? sqrt(term[2] / term[0]) : remembered(s, term[1], term[2]), term[1], term[2]);
}
