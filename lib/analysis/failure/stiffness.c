/* stiffness.c: steps of an explicit method that stability holds, not accuracy.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "causes.h"
#include <math.h>
#include <string.h>

enum { LEAST = 20, WINDOW = 48, TURNS = 60, LAST = 20 };

/* Does the solution go nearly straight on through the last steps? Then they resolve nothing. */
static bool straight(const stf_search *c)
{
  const steif_history *s = c->scene;
  const size_t n = c->point->n, count = s->count < WINDOW ? s->count : WINDOW;
  const size_t from = s->count - count, last = s->count - 1;
  sunrealtype off = 0, way = 0;
  if (count < LEAST) return false;
  for (size_t j = 0; j < n; j++) {
    const sunrealtype slope =
      (s->y[last * n + j] - s->y[from * n + j]) / (s->t[last] - s->t[from]);
    way = fmax(way, fabs(s->y[last * n + j] - s->y[from * n + j]) / c->weight[j]);
    for (size_t k = from + 1; k < last; k++) {
      const sunrealtype line = s->y[from * n + j] + slope * (s->t[k] - s->t[from]);
      off = fmax(off, fabs(s->y[k * n + j] - line) / c->weight[j]);
    }
  }
  return off <= fmax(10, 0.1 * way);
}

/* |lambda| of the fastest eigenvalue of the n x n matrix M by columns: the mean growth of the last turns
 * of a power iteration, which serves pairs too. v, w: n each. */
static sunrealtype radius(size_t n, const sunrealtype *M, sunrealtype *v, sunrealtype *w)
{
  unsigned seed = 99u;
  sunrealtype sum = 0;
  for (size_t j = 0; j < n; j++) v[j] = stf_point_random(&seed);
  for (int turn = 0; turn < TURNS; turn++) {
    sunrealtype size = 0, before = 0;
    memset(w, 0, n * sizeof *w);
    for (size_t j = 0; j < n; j++)
      for (size_t i = 0; i < n; i++) w[i] += M[j * n + i] * v[j];
    for (size_t j = 0; j < n; j++) size += w[j] * w[j], before += v[j] * v[j];
    if (!(size > 0) || !isfinite(size)) return 0;
    if (turn >= TURNS - LAST) sum += log(size / before) / 2;
    for (size_t j = 0; j < n; j++) v[j] = w[j] / sqrt(size);
  }
  return exp(sum / LAST);
}

int stf_cause_stiff(stf_search *c)
{
  const steif_history *scene = c->scene;
  stf_point *s = c->point;
  const size_t n = s->n;
  if (!scene->explicit_method || !straight(c)) return STEIF_OK;
  sunrealtype *M = stf_allocate(s->ctx, 2 * n * n + 2 * n, sizeof *M);
  if (!M) return STEIF_NO_MEMORY;
  const int code = stf_point_matrices(s, s->t, s->y0, s->yp0, M, M + n * n);
  const sunrealtype fastest = code ? 0 : radius(n, M + n * n, M + 2 * n * n, M + 2 * n * n + n);
  stf_release(s->ctx, M);
  const sunrealtype part = fabs(scene->h) * fastest;
  if (code || !(part > 1)) return code < 0 ? code : STEIF_OK;
  steif_cause *cause = c->cause;
  cause->kind = STEIF_CAUSE_STIFF, cause->value[0] = part, cause->value[1] = fastest;
  stf_point_say(
    cause->message,
    "The problem is stiff: the solution goes straight on, but an eigenvalue "
    "|lambda| = %.3g holds the steps of %s, which is explicit, at h |lambda| = %.2g. "
    "Use an implicit method, or auto.",
    fastest, scene->method ? scene->method : "the method", part);
  return STEIF_OK;
}
