/* scalar.c: phi functions of real and complex numbers.
 *
 * Near 0, and on the positive axis, where nothing cancels, by doubling. Elsewhere by phi_{k+1}
 * = (phi_k - 1/k!)/z in twice the working precision: its errors shrink like k/|z|, while
 * doubling cancels where Re z > 0 and Im z is large.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "matfun.h"

/* Where the recurrence takes over, and where squaring adds up more than the rounding of exp. */
static const double near_zero = 8, far_out = 1048576;

static const stf_two minus_one = {-1, 0};

static stf_jet exponential(double x, double y)
{
  if (hypot(x, y) > far_out) {
    const double size = exp(x);
    if (size == 0 || y == 0) return (stf_jet){{size, 0}, {0, 0}};
    return (stf_jet){{size * cos(y), 0}, {size * sin(y), 0}};
  }
  stf_spot s;
  stf_spot_open(&s, 0, (stf_jet){{x, 0}, {y, 0}}, minus_one);
  return s.phi[0];
}

/* 1/z = (x - iy)/(x^2 + y^2), scaled by the power of two g so that no square overflows. */
static stf_jet reciprocal(double x, double y)
{
  int e;
  frexp(fmax(fabs(x), fabs(y)), &e);
  const double g = ldexp(1, -e);
  const stf_two a = {x * g, 0}, b = {-y * g, 0};
  const stf_two square = stf_two_add(stf_two_mul(a, a), stf_two_mul(b, b));
  return stf_jet_scale((stf_jet){stf_two_div(a, square), stf_two_div(b, square)}, g);
}

static void recur(int p, double x, double y, stf_jet *phi)
{
  const stf_jet inverse = reciprocal(x, y);
  phi[0] = exponential(x, y);
  for (int k = 0; k < p; k++) {
    stf_jet d = phi[k];
    d.a = stf_two_add(d.a, stf_two_scale(stf_inverse_factorial(k), -1));
    phi[k + 1] = stf_jet_mul(d, inverse, minus_one);
  }
}

int steif_phi_scalar(int p, double x, double y, double *re, double *im)
{
  if (p < 0 || p > STEIF_PHI_MOST || !re || (!im && y != 0)) return STEIF_BAD_INPUT;
  stf_spot s;
  if (!isfinite(x) || !isfinite(y))
    for (int k = 0; k <= p; k++) s.phi[k] = (stf_jet){{NAN, 0}, {NAN, 0}};
  else if (hypot(x, y) <= near_zero || (y == 0 && x > 0 && x <= far_out))
    stf_spot_open(&s, p, (stf_jet){{x, 0}, {y, 0}}, minus_one);
  else
    recur(p, x, y, s.phi);
  for (int k = 0; k <= p; k++) re[k] = s.phi[k].a.hi;
  for (int k = 0; im && k <= p; k++) im[k] = s.phi[k].b.hi;
  return STEIF_OK;
}
