/* matched.c: poles and finite zeros s of a system with one input and one output go to e^{s dt},
 * all but one of the zeros at infinity to -1; the gain is matched at s = 0, or at another real
 * s when a pole or zero lies there. The result stands in controller form.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "discrete.h"
#include <math.h>

enum { MOST = 30 };

/* k prod (z - root), roots and their number; conjugate pairs are complete. */
typedef struct roots {
  int count;
  double re[MOST], im[MOST];
} roots;

static roots mapped(const roots *r, double dt)
{
  roots e = {.count = r->count};
  for (int i = 0; i < r->count; i++) {
    const double size = exp(r->re[i] * dt);
    e.re[i] = size * cos(r->im[i] * dt), e.im[i] = size * sin(r->im[i] * dt);
  }
  return e;
}

/* prod (z - root) at a real z; imaginary parts cancel. */
static double value(const roots *r, double z)
{
  double re = 1, im = 0;
  for (int i = 0; i < r->count; i++) {
    const double a = z - r->re[i], b = -r->im[i], old = re;
    re = old * a - im * b, im = old * b + im * a;
  }
  return re;
}

/* Coefficients of the powers z^count, ..., z^0 of prod (z - root). */
static void expand(const roots *r, double *c)
{
  double im[MOST + 1] = {0};
  c[0] = 1;
  for (int i = 0; i < r->count; i++) {
    c[i + 1] = im[i + 1] = 0;
    for (int k = i + 1; k > 0; k--) {
      c[k] -= r->re[i] * c[k - 1] - r->im[i] * im[k - 1];
      im[k] -= r->re[i] * im[k - 1] + r->im[i] * c[k - 1];
    }
  }
}

static double nearest(const roots *r, double s)
{
  double least = HUGE_VAL;
  for (int i = 0; i < r->count; i++) least = fmin(least, hypot(s - r->re[i], r->im[i]));
  return least;
}

/* The first of 0, 1/dt, 1/2dt, ... away from poles and zeros. */
static double place(const roots *poles, const roots *zeros, double dt)
{
  double s = 0, next = 1 / dt;
  for (int k = 0; k < 2 * MOST; k++, s = next, next /= 2)
    if (fmin(nearest(poles, s), nearest(zeros, s)) > 1e-5 * (s > 0 ? s : 1e-3 / dt)) break;
  return s;
}

static int gain(const stf_plan *p, const roots *poles, const roots *zeros, const roots *P,
                const roots *Z, double *k)
{
  const double s = place(poles, zeros, p->dt), z = exp(s * p->dt);
  double H[2];
  STEIF_TRY(steif_response(p->ctx, p->s, s, 0, H));
  *k = H[0] * value(P, z) / value(Z, z);
  return STEIF_OK;
}

/* num/den in controller form: the first row of Ad is -den. */
static void realise(const stf_plan *p, const roots *P, const roots *Z, double k)
{
  const int n = p->s->n, lag = n - Z->count;
  double den[MOST + 1], num[MOST + 1], b[MOST + 1] = {0};
  expand(P, den), expand(Z, num);
  for (int i = 0; i <= Z->count; i++) b[i + lag] = k * num[i];
  for (int i = 0; i < n; i++) {
    p->Ad[n * i] = -den[i + 1];
    if (i + 1 < n) p->Ad[i + 1 + n * i] = 1;
    p->Cd[i] = b[i + 1] - b[0] * den[i + 1];
  }
  p->Bd[0] = p->B0[0] = 1;
  p->Dd[0] = b[0];
}

int stf_matched_build(const stf_plan *p)
{
  const int n = p->s->n;
  roots poles = {.count = n}, zeros = {0};
  STEIF_CHECK(p->s->m == 1 && p->s->p == 1, p->ctx, STEIF_UNSUPPORTED,
              "matched is for one input and one output, not %d and %d; take zoh or bilinear",
              p->s->m, p->s->p);
  STEIF_CHECK(
    n <= MOST, p->ctx, STEIF_UNSUPPORTED,
    "matched expands polynomials, which is accurate up to n = %d, not %d; take zoh or "
    "bilinear",
    (int)MOST, n);
  STEIF_TRY(stf_eigenvalues(p->ctx, n, p->s->A, poles.re, poles.im));
  STEIF_TRY(stf_zeros(p->ctx, p->s, &zeros.count, zeros.re, zeros.im));
  const roots P = mapped(&poles, p->dt);
  roots Z = mapped(&zeros, p->dt);
  while (Z.count < n - 1) Z.re[Z.count] = -1, Z.im[Z.count++] = 0;
  double k;
  STEIF_TRY(gain(p, &poles, &zeros, &P, &Z, &k));
  realise(p, &P, &Z, k);
  return STEIF_OK;
}
