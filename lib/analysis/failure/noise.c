/* noise.c: noise of F from difference tables along a random line, and jumps of F along the
 * predicted path. J. J. More and S. M. Wild, SIAM J. Sci. Comput. 33 (2011) 1292-1314.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include <math.h>
#include <string.h>

enum { LINE = 9, SAMPLES = 33, HALVINGS = 60 };

static void sort(sunrealtype *x, size_t count)
{
  for (size_t i = 1; i < count; i++)
    for (size_t k = i; k > 0 && x[k - 1] > x[k]; k--) {
      const sunrealtype y = x[k];
      x[k] = x[k - 1], x[k - 1] = y;
    }
}

/* A step of F across the line: one difference towers above the others. */
static bool one_jump(const sunrealtype *F)
{
  sunrealtype d[LINE - 1];
  for (int i = 0; i + 1 < LINE; i++) d[i] = fabs(F[i + 1] - F[i]);
  sort(d, LINE - 1);
  return d[LINE - 2] > 10 * d[LINE / 2];
}

/* sigma_k^2 = gamma_k mean (k-th differences)^2, gamma_k = k!^2/(2k)!; levels 4 .. 6 must
 * agree. */
static sunrealtype level_noise(const sunrealtype *F, size_t n)
{
  sunrealtype d[LINE], gamma = 1, low = INFINITY, high = 0, middle = 0;
  for (int i = 0; i < LINE; i++) d[i] = F[(size_t)i * n];
  if (one_jump(d)) return 0;
  for (int k = 1; k <= 6; k++) {
    sunrealtype sum = 0;
    gamma *= 0.5 * k / (2 * k - 1);
    for (int i = 0; i < LINE - k; i++) d[i] = d[i + 1] - d[i], sum += d[i] * d[i];
    const sunrealtype sigma = sqrt(gamma * sum / (LINE - k));
    if (k >= 4) low = fmin(low, sigma), high = fmax(high, sigma);
    if (k == 5) middle = sigma;
  }
  return high <= 4 * low ? middle : 0;
}

int stf_cause_noise(stf_search *c)
{
  static const sunrealtype apart[] = {1e-10, 1e-8, 1e-6};
  stf_point *s = c->point;
  const size_t n = s->n;
  sunrealtype *F = stf_allocate(s->ctx, (LINE + 2) * n, sizeof *F);
  if (!F) return STEIF_NO_MEMORY;
  sunrealtype *y = F + LINE * n, *yp = F + (LINE + 1) * n;
  int code = STEIF_OK;
  for (int k = 0; k < 3 && code >= 0; k++) {
    code = STEIF_OK;
    for (int i = 0; i < LINE && !code; i++) {
      unsigned seed = 4242u;
      for (size_t j = 0; j < n; j++) {
        const sunrealtype size = s->y0[j] != 0 ? fabs(s->y0[j]) : s->floor[j];
        y[j] = s->y0[j] + (i - LINE / 2) * apart[k] * size * stf_point_random(&seed);
        yp[j] = s->yp0[j] * (1 + (i - LINE / 2) * apart[k] * stf_point_random(&seed));
      }
      code = stf_point_residual(s, s->t, y, yp, F + (size_t)i * n);
    }
    for (size_t i = 0; i < n && !code; i++)
      c->noise[i] = fmax(c->noise[i], level_noise(F + i, n));
  }
  stf_release(s->ctx, F);
  return code < 0 ? code : STEIF_OK;
}

/* -- jumps ------------------------------------------------------------------------------- */

typedef struct path {
  stf_search *c;
  sunrealtype *y, *F;        /* y: n; F: SAMPLES x n */
  sunrealtype *left, *right; /* n: F on both sides */
  size_t held;               /* unknown that does not move, n: none */
  bool frozen;               /* only the time moves */
} path;

static int walk(path *p, sunrealtype dt, sunrealtype *F)
{
  const stf_point *s = p->c->point;
  for (size_t j = 0; j < s->n; j++)
    p->y[j] = s->y0[j] + (p->frozen || j == p->held ? 0 : dt * s->yp0[j]);
  return stf_point_residual(p->c->point, s->t + dt, p->y, s->yp0, F);
}

/* The equation with the increment that stands out most, > 20 times the median; n: none. */
static size_t outstanding(const path *p, size_t *at, sunrealtype *middle)
{
  const size_t n = p->c->point->n;
  size_t equation = n;
  sunrealtype best = 20;
  for (size_t i = 0; i < n; i++) {
    sunrealtype step[SAMPLES - 1], most = 0;
    size_t where = 0;
    for (size_t k = 0; k + 1 < SAMPLES; k++) {
      step[k] = fabs(p->F[(k + 1) * n + i] - p->F[k * n + i]);
      if (step[k] > most) most = step[k], where = k;
    }
    sort(step, SAMPLES - 1);
    const sunrealtype least = 1e4 * STF_EPS * p->c->scale[i] + 30 * p->c->noise[i];
    if (!(most > least)) continue;
    const sunrealtype ratio = most / fmax(step[SAMPLES / 2], 1e-3 * least);
    if (ratio > best) best = ratio, equation = i, *at = where, *middle = step[SAMPLES / 2];
  }
  return equation;
}

/* Halve [a, b] around the larger increment of equation i, down to neighbouring times; its
 * size. */
static int bisect(path *p, size_t i, sunrealtype *a, sunrealtype *b, sunrealtype *size)
{
  const size_t n = p->c->point->n;
  STEIF_TRY(walk(p, *a, p->left));
  STEIF_TRY(walk(p, *b, p->right));
  for (int k = 0; k < HALVINGS; k++) {
    const sunrealtype middle = *a + (*b - *a) / 2, t = p->c->point->t;
    if (t + middle <= t + *a || t + middle >= t + *b) break;
    STEIF_TRY(walk(p, middle, p->F));
    if (fabs(p->F[i] - p->left[i]) >= fabs(p->right[i] - p->F[i])) {
      *b = middle;
      memcpy(p->right, p->F, n * sizeof *p->F);
    } else {
      *a = middle;
      memcpy(p->left, p->F, n * sizeof *p->F);
    }
  }
  *size = p->right[i] - p->left[i];
  return STEIF_OK;
}

/* A pole is no jump: F grows towards it, from its mean at 256 times the distance on both sides. There even
 * 1/|d|^(1/3) is six times smaller. */
static int is_pole(path *p, size_t i, sunrealtype a, sunrealtype b, bool *pole)
{
  const sunrealtype away = 256 * (b - a), ratio = 4;
  STEIF_TRY(walk(p, a - away, p->F));
  const sunrealtype before = p->F[i];
  STEIF_TRY(walk(p, b + away, p->F));
  const sunrealtype middle = before + (p->F[i] - before) / 2, far = fabs(p->F[i] - before) / 2;
  *pole = fmax(fabs(p->left[i] - middle), fabs(p->right[i] - middle)) > ratio * far;
  return STEIF_OK;
}

/* The unknown whose movement makes the jump: without it there is none. n: time does. */
static int guilty(path *p, size_t i, sunrealtype a, sunrealtype b, sunrealtype size,
                  size_t *unknown)
{
  const size_t n = p->c->point->n;
  *unknown = n;
  p->frozen = true;
  STEIF_TRY(walk(p, a, p->left));
  STEIF_TRY(walk(p, b, p->right));
  p->frozen = false;
  if (fabs(p->right[i] - p->left[i]) > 0.5 * fabs(size) || stf_cause_large(p->c))
    return STEIF_OK;
  for (p->held = 0; p->held < n; p->held++) {
    STEIF_TRY(walk(p, a, p->left));
    STEIF_TRY(walk(p, b, p->right));
    if (fabs(p->right[i] - p->left[i]) < 0.5 * fabs(size)) break;
  }
  *unknown = p->held;
  p->held = n;
  return STEIF_OK;
}

static int tell(path *p, size_t i, sunrealtype at, sunrealtype size, sunrealtype middle,
                size_t unknown)
{
  stf_search *c = p->c;
  char e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_JUMP, cause->t = c->point->t + at,
  cause->equation = (sunindextype)i;
  cause->unknown = unknown < c->point->n ? (sunindextype)unknown : -1;
  cause->value[0] = size, cause->value[1] = middle;
  stf_point_say(cause->message, "Equation %s jumps by %.4g at t = %.15g (found by bisection)",
                stf_point_equation(c->point, i, e), size, cause->t);
  if (cause->unknown >= 0)
    stf_point_say(cause->message, ", where %s crosses %.12g",
                  stf_point_unknown(c->point, unknown, y),
                  c->point->y0[unknown] + at * c->point->yp0[unknown]);
  stf_point_say(cause->message, ". Declare an event or a break there and restart after it.");
  if (stf_cause_large(c)) return STEIF_OK;
  STEIF_TRY(stf_cause_diagnose(c));
  if (c->diagnosis.index >= 2)
    stf_point_say(cause->message, " The index is %d: expect an impulse.", c->diagnosis.index);
  return STEIF_OK;
}

static void tell_pole(path *p, size_t i, sunrealtype at, size_t unknown)
{
  const stf_point *s = p->c->point;
  char e[STEIF_SPEC_WORD], y[STEIF_SPEC_WORD];
  steif_cause *cause = p->c->cause;
  cause->kind = STEIF_CAUSE_IMPASSE, cause->t = s->t + at, cause->equation = (sunindextype)i;
  cause->unknown = unknown < s->n ? (sunindextype)unknown : -1;
  stf_point_say(cause->message, "Equation %s has a pole at t = %.9g",
                stf_point_equation(s, i, e), cause->t);
  if (cause->unknown >= 0) {
    const sunrealtype x = s->y0[unknown] + at * s->yp0[unknown];
    const bool zero = fabs(x) < p->c->weight[unknown]; /* within the tolerance */
    stf_point_say(cause->message, ", where %s passes %.3g", stf_point_unknown(s, unknown, y),
                  zero ? 0 : x);
  }
  stf_point_say(cause->message,
                ": slopes grow without bound on the way there, and no method goes "
                "through it. End the run before, or change the model there.");
}

static int look(path *p, sunrealtype reach, bool *found)
{
  const size_t n = p->c->point->n;
  size_t at = 0, unknown;
  sunrealtype middle = 0, size;
  const stf_search *c = p->c;
  const sunrealtype from = fmax(-reach, c->scene->t0 - c->point->t); /* nothing is before t0 */
  const sunrealtype width = (reach - from) / (SAMPLES - 1);
  for (size_t k = 0; k < SAMPLES; k++)
    STEIF_TRY(walk(p, from + width * (sunrealtype)k, p->F + k * n));
  const size_t i = outstanding(p, &at, &middle);
  if (i == n) return STEIF_OK;
  const sunrealtype first = fabs(p->F[(at + 1) * n + i] - p->F[at * n + i]);
  sunrealtype a = from + width * (sunrealtype)at, b = a + width;
  STEIF_TRY(bisect(p, i, &a, &b, &size));
  const sunrealtype least = 1e4 * STF_EPS * p->c->scale[i] + 30 * p->c->noise[i];
  if (!(fabs(size) > 0.5 * first) || !(fabs(size) > least)) return STEIF_OK;
  const sunrealtype t0 = c->scene->t0; /* what changes there has no other side */
  if (c->point->t + b <= t0 + 16 * STF_EPS * fmax(fabs(t0), fabs(c->scene->h))) return STEIF_OK;
  bool pole;
  STEIF_TRY(is_pole(p, i, a, b, &pole));
  STEIF_TRY(guilty(p, i, a, b, size, &unknown));
  *found = true;
  if (pole) return tell_pole(p, i, b, unknown), STEIF_OK;
  return tell(p, i, b, size, middle, unknown);
}

int stf_cause_jump(stf_search *c)
{
  static const sunrealtype reach[] = {1, 8, 64, 512};
  const size_t n = c->point->n;
  path p = {.c = c, .held = n};
  const sunrealtype shortest = 256 * STF_EPS * fabs(c->point->t);
  bool found = false;
  p.y = stf_allocate(c->point->ctx, (SAMPLES + 3) * n, sizeof *p.y);
  if (!p.y) return STEIF_NO_MEMORY;
  p.left = p.y + n, p.right = p.y + 2 * n, p.F = p.y + 3 * n;
  int code = STEIF_OK;
  for (int k = 0; k < 4 && code >= 0 && !found; k++)
    code = look(&p, reach[k] * fmax(fabs(c->scene->h), shortest), &found);
  stf_release(c->point->ctx, p.y);
  return code < 0 ? code : STEIF_OK;
}
