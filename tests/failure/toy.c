/* toy.c: one-step methods of order 1 and 2 for F(t, y, y') = 0, with plain error weights.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "toy.h"
#include "evidence.h"
#include <math.h>
#include <string.h>

typedef struct stepper {
  stf_point point;
  toy *r;
  size_t n;
  double h, before;
  double Y[TOY_LARGEST], Yp[TOY_LARGEST], F[TOY_LARGEST];
  double E[TOY_LARGEST * TOY_LARGEST], B[TOY_LARGEST * TOY_LARGEST];
} stepper;

/* Gaussian elimination with pivoting; 0 when singular. */
static int solve(size_t n, double *M, double *b)
{
  for (size_t k = 0; k < n; k++) {
    size_t p = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabs(M[k * n + i]) > fabs(M[k * n + p])) p = i;
    if (M[k * n + p] == 0 || !isfinite(M[k * n + p])) return 0;
    for (size_t j = 0; j < n; j++) {
      const double x = M[j * n + k];
      M[j * n + k] = M[j * n + p], M[j * n + p] = x;
    }
    const double x = b[k];
    b[k] = b[p], b[p] = x;
    for (size_t i = k + 1; i < n; i++) {
      const double factor = M[k * n + i] / M[k * n + k];
      for (size_t j = k + 1; j < n; j++) M[j * n + i] -= factor * M[j * n + k];
      b[i] -= factor * b[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    b[k] /= M[k * n + k];
    for (size_t i = 0; i < k; i++) b[i] -= M[k * n + i] * b[k];
  }
  return 1;
}

static double weight(const stepper *s, size_t j, const double *y)
{
  const int number = s->r->weighted && s->point.problem.index ? s->point.problem.index[j] : 1;
  return (s->r->rtol * fabs(y[j]) + s->r->atol) / pow(fmin(1, s->h), number - 1);
}

static int newton(stepper *s, const double *y, const double *yp, double t)
{
  const size_t n = s->n;
  const double c = (s->r->trapezoid ? 2 : 1) / s->h;
  double M[TOY_LARGEST * TOY_LARGEST], last = INFINITY;
  for (size_t j = 0; j < n; j++) s->Y[j] = y[j] + s->h * yp[j];
  for (int k = 0; k < 8; k++) {
    for (size_t j = 0; j < n; j++)
      s->Yp[j] = c * (s->Y[j] - y[j]) - (s->r->trapezoid ? yp[j] : 0);
    if (stf_point_residual(&s->point, t + s->h, s->Y, s->Yp, s->F)) return 0;
    if (stf_point_matrices(&s->point, t + s->h, s->Y, s->Yp, s->E, s->B)) return 0;
    for (size_t q = 0; q < n * n; q++) M[q] = c * s->E[q] + s->B[q];
    if (!solve(n, M, s->F)) return 0;
    double size = 0;
    for (size_t j = 0; j < n; j++) {
      size = fmax(size, fabs(s->F[j]) / weight(s, j, y));
      s->Y[j] -= s->F[j];
    }
    if (!(size < 4 * last)) return 0;
    if (size < 1e-3) return 1;
    last = size;
  }
  return 0;
}

/* Error by comparison with the extrapolated slope. */
static double estimate(stepper *s, const double *y, const double *yp)
{
  double most = 0;
  for (size_t j = 0; j < s->n; j++) {
    s->r->error[j] = (s->Y[j] - y[j] - s->h * yp[j]) * s->h / (s->h + s->before);
    most = fmax(most, fabs(s->r->error[j]) / weight(s, j, y));
  }
  return most;
}

/* Every other point of those older than the last hundred goes. */
static void thin(toy *r, size_t n)
{
  size_t to = 0;
  for (size_t k = 0; k < TOY_RING; k++) {
    if (k < TOY_RING - 100 && k % 2) continue;
    r->t[to] = r->t[k];
    memmove(r->y + to * n, r->y + k * n, n * sizeof *r->y);
    memmove(r->yp + to * n, r->yp + k * n, n * sizeof *r->yp);
    to++;
  }
  r->scene.count = to;
}

static void keep(stepper *s, double t)
{
  toy *r = s->r;
  const size_t n = s->n;
  if (r->scene.count == TOY_RING) thin(r, n);
  const size_t k = r->scene.count++;
  r->t[k] = t;
  memcpy(r->y + k * n, s->Y, n * sizeof *r->y);
  memcpy(r->yp + k * n, s->Yp, n * sizeof *r->yp);
}

static void march(stepper *s)
{
  toy *r = s->r;
  double t = s->point.t;
  s->h = s->before = r->h0;
  while (t < r->t1 * (1 - 1e-12)) {
    const double *y = r->y + (r->scene.count - 1) * s->n,
                 *yp = r->yp + (r->scene.count - 1) * s->n;
    s->h = fmin(s->h, r->t1 - t);
    r->scene.h = s->h;
    r->failed = s->h < 1e-13 * fmax(fabs(t), r->t1 - s->point.t) || r->scene.steps >= r->most;
    if (r->failed) return;
    if (!newton(s, y, yp, t)) {
      s->h /= 4;
      continue;
    }
    const double error = estimate(s, y, yp);
    if (!(error <= 1)) {
      s->h *= isfinite(error) ? fmax(0.2, 0.8 / sqrt(error)) : 0.2;
      continue;
    }
    for (size_t j = 0; j < s->n; j++)
      s->Yp[j] = (r->trapezoid ? 2 : 1) * (s->Y[j] - y[j]) / s->h - (r->trapezoid ? yp[j] : 0);
    t += s->h;
    keep(s, t);
    r->scene.steps++;
    s->before = s->h;
    s->h *= fmin(2, fmax(0.5, 0.9 / sqrt(error + 1e-10)));
  }
}

int toy_run(steif_context *ctx, const steif_problem *p, const double *y, const double *yp,
            toy *r)
{
  stepper s = {.r = r, .n = (size_t)p->n};
  const steif_point q = {.y = y ? y : p->y0, .yp = yp ? yp : p->yp0, .t = p->t0};
  const int code = stf_point_open(ctx, p, &q, &s.point);
  if (code) return code;
  r->scene =
    (steif_history){.t = r->t,
                    .y = r->y,
                    .yp = r->yp,
                    .t0 = p->t0,
                    .rtol = r->rtol,
                    .atol = r->atol,
                    .error = r->error,
                    .weighted = r->weighted,
                    .method = r->trapezoid ? "the trapezoidal rule" : "backward Euler"};
  if (!(r->h0 > 0)) r->h0 = 1e-4 * (r->t1 - p->t0);
  if (r->most < 1) r->most = 20000;
  memset(r->error, 0, sizeof r->error);
  memcpy(s.Y, s.point.y0, s.n * sizeof *s.Y), memcpy(s.Yp, s.point.yp0, s.n * sizeof *s.Yp);
  keep(&s, p->t0);
  march(&s);
  stf_point_close(&s.point);
  return 0;
}

int toy_explain(steif_context *ctx, const steif_problem *p, const toy *r, steif_point names,
                steif_cause *cause)
{
  const size_t n = (size_t)p->n, last = r->scene.count - 1;
  names.t = r->t[last], names.y = r->y + last * n, names.yp = r->yp + last * n;
  return steif_explain(ctx, p, &names, &r->scene, cause);
}
