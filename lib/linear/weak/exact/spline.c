/* spline.c: Hermite's interpolation of a test function from its derivatives at equidistant knots, by divided
 * differences on the nodes 0, .., 0, 1, .., 1 of a cell; cells are halved until it is the function to what
 * is known of that.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "spline.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST_CELLS = 1024, POWER = 8, LOOKS = 3, MOST = 2 * STF_DERIVATIVES + 2 };
/* Of the largest |g|, in units of its rounding. */
#define AGREED 2

typedef struct knot {
  stf_real c[STF_DERIVATIVES]; /* g^(q) width^q / q! */
} knot;

static int claim(steif_context *ctx, stf_spline *s)
{
  const size_t degree = (size_t)s->degree, cells = (size_t)s->cells;
  s->p = stf_allocate(ctx, cells * (2 * degree + 3), sizeof *s->p);
  if (!s->p) return STEIF_NO_MEMORY;
  s->primitive = s->p + cells * (degree + 1);
  return STEIF_OK;
}

void stf_spline_close(steif_context *ctx, stf_spline *spline)
{
  stf_release(ctx, spline->p);
  stf_release(ctx, spline->rounded);
  *spline = (stf_spline){0};
}

/* Derivatives to scaled coefficients. */
static int look(const stf_weight *g, const stf_spline *s, int at, int smooth, knot *k)
{
  long double d[STF_DERIVATIVES];
  stf_real scale = stf_real_of(1);
  STEIF_TRY(at < s->cells ? stf_weight_at(g, g->t1 * at / s->cells, smooth, d)
                          : stf_weight_end(g, smooth, d));
  for (int q = 0; q <= smooth; q++) {
    const stf_real value = stf_real_of(d[q]), divisor = stf_real_of(q + 1);
    stf_real_multiply(s->limbs, &value, &scale, k->c + q);
    stf_real_multiply(s->limbs, &scale, &s->width, &scale);
    stf_real_divide(s->limbs, &scale, &divisor, &scale);
  }
  return STEIF_OK;
}

/* The polynomial of a cell. */
static void interpolate(const stf_spline *s, int smooth, const knot *a, const knot *b,
                        stf_real *p)
{
  const int L = s->limbs, half = smooth + 1, last = 2 * smooth + 1;
  stf_real T[MOST];
  for (int i = 0; i <= last; i++) T[i] = i < half ? a->c[0] : b->c[0];
  for (int m = 1; m <= last; m++)
    for (int i = last; i >= m; i--) {
      if (i < half)
        T[i] = a->c[m];
      else if (i - m >= half)
        T[i] = b->c[m];
      else
        stf_real_subtract(L, T + i, T + i - 1, T + i);
    }
  for (int q = 0; q <= last; q++) p[q] = q < half ? a->c[q] : (stf_real){0};
  for (int q = last; q >= half; q--) /* p := p (u - 1) + T_q above u^half */
    for (int j = last; j >= half; j--) {
      stf_real t = j > half ? p[j - 1] : T[q];
      stf_real_subtract(L, &t, p + j, p + j);
    }
}

static void evaluate(int limbs, const stf_real *p, int degree, const stf_real *u,
                     stf_real *value)
{
  stf_real sum = p[degree];
  for (int q = degree - 1; q >= 0; q--) {
    stf_real_multiply(limbs, &sum, u, &sum);
    stf_real_add(limbs, &sum, p + q, &sum);
  }
  *value = sum;
}

/* Primitives of all cells. */
static void integrate(stf_spline *s)
{
  const int L = s->limbs;
  const stf_real one = stf_real_of(1);
  s->whole = (stf_real){0};
  for (int i = 0; i < s->cells; i++) {
    const stf_real *p = s->p + i * (s->degree + 1);
    stf_real *P = s->primitive + i * (s->degree + 2);
    P[0] = s->whole;
    for (int q = 0; q <= s->degree; q++) {
      const stf_real divisor = stf_real_of(q + 1);
      stf_real_multiply(L, p + q, &s->width, P + q + 1);
      stf_real_divide(L, P + q + 1, &divisor, P + q + 1);
    }
    evaluate(L, P, s->degree + 1, &one, &s->whole);
  }
}

/* The largest |p - g| at a few places of the cells. */
static int compare(const stf_weight *g, const stf_spline *s, long double *apart)
{
  *apart = 0;
  for (int i = 0; i < s->cells; i++)
    for (int k = 1; k <= LOOKS; k++) {
      const long double u = k / (LOOKS + 1.0L);
      const stf_real at = stf_real_of(u);
      stf_real value;
      long double d;
      STEIF_TRY(stf_weight_at(g, g->t1 * (i + u) / s->cells, 0, &d));
      evaluate(s->limbs, s->p + i * (s->degree + 1), s->degree, &at, &value);
      *apart = fmaxl(*apart, fabsl(stf_real_value(&value) - d));
    }
  return STEIF_OK;
}

static void measure(const stf_weight *g, stf_spline *s)
{
  const stf_real cells = stf_real_of(s->cells);
  s->t1 = stf_real_of(g->t1);
  stf_real_divide(s->limbs, &s->t1, &cells, &s->width);
  stf_real_divide(s->limbs, &cells, &s->t1, &s->inverse);
}

static int try_cells(const stf_weight *g, int smooth, int cells, stf_spline *s)
{
  knot *k = NULL;
  s->cells = cells, s->degree = 2 * smooth + 1;
  measure(g, s);
  STEIF_TRY(claim(g->ctx, s));
  if (!(k = stf_allocate(g->ctx, 2, sizeof *k))) return STEIF_NO_MEMORY;
  int code = look(g, s, 0, smooth, k);
  for (int i = 0; i < cells && !code; i++) {
    code = look(g, s, i + 1, smooth, k + (i + 1) % 2);
    if (!code) interpolate(s, smooth, k + i % 2, k + (i + 1) % 2, s->p + i * (s->degree + 1));
  }
  stf_release(g->ctx, k);
  return code ? code : compare(g, s, &s->defect);
}

/* (1 - t)^8 itself. */
static int power(const stf_weight *g, stf_spline *s)
{
  long binomial = 1;
  s->cells = 1, s->degree = POWER;
  measure(g, s);
  STEIF_TRY(claim(g->ctx, s));
  for (int q = 0; q <= POWER; q++) {
    s->p[q] = stf_real_of(q % 2 ? -binomial : binomial);
    binomial = binomial * (POWER - q) / (q + 1);
  }
  return STEIF_OK;
}

/* p(1 - v) in powers of v: sums of sums of coefficients. */
static void turn_around(int limbs, int degree, stf_real *p)
{
  for (int k = 0; k < degree; k++)
    for (int j = degree - 1; j >= k; j--) stf_real_add(limbs, p + j, p + j + 1, p + j);
  for (int q = 1; q <= degree; q += 2) p[q].sign = -p[q].sign;
}

static int round_all(steif_context *ctx, stf_spline *s)
{
  const size_t terms = (size_t)s->degree + 1, cells = (size_t)s->cells;
  s->rounded = stf_allocate(ctx, 2 * cells * terms, sizeof *s->rounded);
  if (!s->rounded) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < cells; i++) {
    long double *to = s->rounded + 2 * i * terms;
    stf_real p[MOST];
    memcpy(p, s->p + i * terms, terms * sizeof *p);
    for (size_t q = 0; q < terms; q++) to[q] = stf_real_value(p + q);
    turn_around(s->limbs, s->degree, p);
    for (size_t q = 0; q < terms; q++) to[terms + q] = stf_real_value(p + q);
  }
  return STEIF_OK;
}

static int open(const stf_weight *g, int smooth, int limbs, stf_spline *s)
{
  long double most, rate;
  *s = (stf_spline){.limbs = limbs};
  STEIF_TRY(stf_weight_scale(g, &most, &rate));
  if (!g->given) {
    STEIF_TRY(power(g, s));
    integrate(s);
    return STEIF_OK;
  }
  STEIF_CHECK(smooth < STF_DERIVATIVES, g->ctx, STEIF_UNSUPPORTED,
              "%d derivatives of the test function are too many for a run in many digits",
              smooth);
  const long double wanted =
    AGREED * fmaxl((long double)g->given->rounding, LDBL_EPSILON) * most;
  for (int cells = 1; cells <= MOST_CELLS; cells *= 2) {
    stf_spline_close(g->ctx, s);
    s->limbs = limbs;
    STEIF_TRY(try_cells(g, smooth, cells, s));
    if (s->defect <= wanted) break;
  }
  s->defect /= most;
  integrate(s);
  return STEIF_OK;
}

int stf_spline_open(const stf_weight *g, int smooth, int limbs, bool rounded, stf_spline *s)
{
  STEIF_TRY(open(g, smooth, limbs, s));
  return rounded ? round_all(g->ctx, s) : STEIF_OK;
}

/* The coefficients about the nearer end of the cell of t, and how far that is; NULL: t is beyond. */
static const long double *nearer(const stf_spline *s, long double t, long double *v)
{
  const long double at = t * s->cells / stf_real_value(&s->t1);
  if (!(at < s->cells)) return NULL;
  const int cell = at > 0 ? (int)at : 0;
  const long double *p = s->rounded + 2 * cell * (s->degree + 1), u = at - cell;
  *v = u <= 0.5L ? u : 1 - u;
  return u <= 0.5L ? p : p + s->degree + 1;
}

long double stf_spline_value(const stf_spline *s, long double t)
{
  long double v;
  const long double *p = nearer(s, t, &v);
  if (!p) return 0;
  long double sum = p[s->degree];
  for (int q = s->degree - 1; q >= 0; q--) sum = sum * v + p[q];
  return sum;
}

/* Horner's running error bound (N. J. Higham, Accuracy and Stability of Numerical Algorithms, 5.1), and the
 * derivative times t. */
long double stf_spline_size(const stf_spline *s, long double t)
{
  long double v;
  const long double *p = nearer(s, t, &v);
  if (!p) return 0;
  long double sum = p[s->degree], slope = 0, size = fabsl(sum) / 2;
  for (int q = s->degree - 1; q >= 0; q--) {
    slope = slope * v + sum;
    sum = sum * v + p[q];
    size = size * v + fabsl(sum);
  }
  return size + fabsl(t * s->cells / stf_real_value(&s->t1) * slope);
}

/* The cell of t and its place there. */
static int place(const stf_spline *s, int limbs, const stf_real *t, stf_real *u)
{
  stf_real_multiply(limbs, t, &s->inverse, u);
  const long double at = floorl(stf_real_value(u));
  const int i = at < s->cells ? (int)at : s->cells - 1;
  const stf_real cell = stf_real_of(i);
  stf_real_subtract(limbs, u, &cell, u);
  return i;
}

void stf_spline_at(const stf_spline *s, int limbs, const stf_real *t, stf_real *value)
{
  stf_real u;
  *value = (stf_real){0};
  if (stf_real_compare(limbs, t, &s->t1) >= 0) return;
  const int i = place(s, limbs, t, &u);
  evaluate(limbs, s->p + i * (s->degree + 1), s->degree, &u, value);
}

void stf_spline_integral(const stf_spline *s, int limbs, const stf_real *t, stf_real *value)
{
  stf_real u;
  *value = s->whole;
  if (stf_real_compare(limbs, t, &s->t1) >= 0) return;
  const int i = place(s, limbs, t, &u);
  evaluate(limbs, s->primitive + i * (s->degree + 2), s->degree + 1, &u, value);
}
