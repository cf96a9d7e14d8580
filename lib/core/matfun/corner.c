/* corner.c: closed forms on the diagonal of block triangular matrices.
 *
 * Where A is block upper triangular, the diagonal blocks of phi_l(A) are phi_l of those of A,
 * and the entry between neighbouring 1 x 1 blocks is a divided difference. Setting them after
 * every squaring keeps overscaling from growing (A. H. Al-Mohy and N. J. Higham, 2009, section
 * 2).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"

static stf_corner *append(stf_core *c, enum stf_corner_kind kind, int i)
{
  stf_corner *k = c->corner + c->corners++;
  *k = (stf_corner){.kind = kind, .i = i, .g = 1};
  return k;
}

static double exponent(double a)
{
  int e;
  if (a == 0 || !isfinite(a)) return 1;
  frexp(a, &e);
  return ldexp(1, e > 1000 ? 1000 : e < -1000 ? -1000 : e);
}

/* mu, N and N^2 = q of the 2 x 2 block at i. */
static stf_corner *block(stf_core *c, enum stf_corner_kind kind, int i)
{
  stf_corner *k = append(c, kind, i);
  const size_t n = (size_t)c->n, at = (size_t)i * (n + 1);
  const double a = c->A[at], d = c->A[at + n + 1];
  k->up = c->A[at + n], k->low = kind == STF_BLOCK ? c->A[at + 1] : 0;
  k->mu = stf_two_sum(a / 2, d / 2);
  k->half = stf_two_sum(a / 2, -d / 2);
  k->g = exponent(fmax(fabs(k->half.hi), sqrt(fabs(k->up)) * sqrt(fabs(k->low))));
  k->half = stf_two_scale(k->half, 1 / k->g);
  k->q = stf_two_mul(k->half, k->half);
  if (kind == STF_BLOCK)
    k->q = stf_two_add(k->q, stf_two_mul(stf_two_of(k->up / k->g), stf_two_of(k->low / k->g)));
  return k;
}

static stf_corner *one(stf_core *c, int i)
{
  stf_corner *k = append(c, STF_ONE, i);
  k->mu = stf_two_of(c->A[(size_t)i * (size_t)(c->n + 1)]);
  return k;
}

/* The lowest row with an entry in column j, at least j. */
static int lowest(const stf_core *c, int j)
{
  const double *column = c->A + (size_t)j * (size_t)c->n;
  int i = c->n - 1;
  while (i > j && column[i] == 0) i--;
  return i;
}

void stf_corners_find(stf_core *c)
{
  int first = 0, reach = 0;
  const stf_corner *before = NULL; /* the 1 x 1 block before this one */
  c->corners = 0;
  for (int j = 0; j < c->n; j++) {
    const int low = lowest(c, j);
    if (low > reach) reach = low;
    if (reach > j) continue;
    const int size = j + 1 - first;
    const stf_corner *now = size == 1 ? one(c, j) : NULL;
    if (now && before) {
      stf_corner *k = block(c, STF_BETWEEN, j - 1);
      k->upper = before, k->lower = now;
    }
    if (size == 2) block(c, STF_BLOCK, first);
    before = now;
    first = reach = j + 1;
  }
}

void stf_corners_open(stf_core *c, int s)
{
  for (stf_corner *k = c->corner; k < c->corner + c->corners; k++) {
    k->plain = c->p == 0 && k->kind != STF_BLOCK;
    k->scale = ldexp(1, -s);
    if (k->plain) continue;
    const double y = k->kind == STF_ONE ? 0 : ldexp(k->g, -s);
    stf_spot_open(&k->spot, c->p, (stf_jet){stf_two_scale(k->mu, ldexp(1, -s)), {y, 0}}, k->q);
  }
}

void stf_corners_double(stf_core *c)
{
  for (stf_corner *k = c->corner; k < c->corner + c->corners; k++)
    if (k->plain)
      k->scale *= 2;
    else
      stf_spot_double(&k->spot);
}

/* e^a, and exp[a, d] times the entry between a and d. */
static double exponential(const stf_corner *k)
{
  const double size = exp(k->scale * k->mu.hi) * (1 + k->scale * k->mu.lo);
  if (k->kind == STF_ONE) return size;
  const double whole = 2 * k->half.hi * k->g, half = 0.5 * k->scale * whole;
  if (fabs(half) < 0.5) return size * (half == 0 ? 1 : sinh(half) / half) * (k->scale * k->up);
  return (exp(k->scale * k->upper->mu.hi) - exp(k->scale * k->lower->mu.hi)) * (k->up / whole);
}

/* phi_l[a, d] of neighbours: the quotient of differences, in twice the working precision, for
 * |a - d| >= 1; mu and N would lose the smaller of two values that lie very far apart. */
static double divided(const stf_corner *k, int l)
{
  const stf_two f = k->upper->spot.phi[l].a, g = k->lower->spot.phi[l].a;
  const double gap = 2 * k->half.hi * k->spot.z.b.hi, whole = 2 * k->half.hi * k->g;
  if (!(fabs(gap) >= 1)) return k->spot.phi[l].b.hi / k->g * k->up;
  return stf_two_add(f, stf_two_scale(g, -1)).hi * (k->up / whole);
}

void stf_corners_fix(const stf_core *c, int l, double *X)
{
  const size_t n = (size_t)c->n;
  for (const stf_corner *k = c->corner; k < c->corner + c->corners; k++) {
    if (k->plain) {
      X[(size_t)k->i * (n + 1) + (k->kind == STF_BETWEEN ? n : 0)] = exponential(k);
      continue;
    }
    const stf_jet f = k->spot.phi[l];
    const stf_two skew = stf_two_mul(f.b, k->half);
    double *x = X + (size_t)k->i * (n + 1);
    if (k->kind == STF_ONE) x[0] = f.a.hi;
    if (k->kind == STF_BETWEEN) x[n] = divided(k, l);
    if (k->kind != STF_BLOCK) continue;
    x[0] = stf_two_add(f.a, skew).hi;
    x[n + 1] = stf_two_add(f.a, stf_two_scale(skew, -1)).hi;
    x[n] = f.b.hi / k->g * k->up;
    x[1] = f.b.hi / k->g * k->low;
  }
}
