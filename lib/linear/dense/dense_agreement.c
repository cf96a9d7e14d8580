/* dense_agreement.c: two starts of one dense system beside each other, and one beside those of systems
 * whose entries are rounded otherwise.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "dense_agreement.h"
#include "dense_algebra.h"
#include "dense_thresholds.h"
#include "staircase.h"
#include <math.h>

static sunrealtype distance(const stf_two_starts *p, const sunrealtype *a, const sunrealtype *b)
{
  for (int i = 0; i < p->units->n; i++) p->difference[i] = a[i] - b[i];
  return stf_length(p->units->n, p->difference);
}

static sunrealtype norm(const stf_two_starts *p, const sunrealtype *A)
{
  return stf_frobenius(p->units->n, p->units->n, A, p->units->n);
}

static sunrealtype measure(const stf_two_starts *p)
{
  return stf_sources_measure(p->sources, stf_length(p->units->n, p->one->x_plus),
                             norm(p, p->units->E), norm(p, p->units->F));
}

static sunrealtype relative(const stf_two_starts *p, const sunrealtype *x_plus)
{
  const sunrealtype off = distance(p, p->one->x_plus, x_plus);
  return off > 0 ? off / measure(p) : off;
}

/* What was compared last, component by component. */
static void keep(const stf_two_starts *p, sunrealtype factor)
{
  for (int i = 0; p->apart && i < p->units->n; i++)
    p->apart[i] = fmax(p->apart[i], factor * fabs(p->difference[i]));
}

sunrealtype stf_starts_apart(const stf_two_starts *p)
{
  const sunrealtype off = relative(p, p->two->x_plus);
  keep(p, 1);
  return off;
}

bool stf_starts_agree(const stf_two_starts *p, sunrealtype tolerance)
{
  const int n = p->units->n;
  const sunrealtype E = norm(p, p->units->E), F = norm(p, p->units->F);
  sunrealtype scale = E * stf_length(n, p->one->x_plus) + stf_length(n, p->sources->Ex0);
  if (!(stf_starts_apart(p) <= tolerance)) return false;
  for (int i = 0; i < p->one->count && i < p->two->count; i++) {
    const size_t at = (size_t)i * (size_t)n;
    const sunrealtype size = stf_length(n, p->one->c + at);
    const sunrealtype off = distance(p, p->one->c + at, p->two->c + at);
    if (!(off <= tolerance * size || F * off <= STF_NEGLIGIBLE * scale)) return false;
    scale = fmax(E * size, scale * E / F);
  }
  return true;
}

/* -- rounding of the entries -------------------------------------------------------------------- */

static void shake(size_t count, const sunrealtype *A, uint64_t *state, sunrealtype *out)
{
  for (size_t k = 0; k < count; k++) out[k] = A[k] * (1 + STF_EPS * stf_draw(state));
}

static int move(const stf_two_starts *p, uint64_t *state, sunrealtype *E, sunrealtype *F,
                sunrealtype *x, sunrealtype *moved)
{
  const stf_dense_units *u = p->units;
  const int n = u->n;
  const size_t count = (size_t)n * (size_t)n;
  stf_sources sources = *p->sources;
  steif_structure found = {0};
  steif_impulse other = {0};
  shake(count, u->E, state, E);
  shake(count, u->F, state, F);
  shake((size_t)n, p->x0, state, x);
  stf_gemm('N', 'N', n, 1, n, 1, E, n, x, n, 0, x + n, n);
  sources.Ex0 = x + n;
  int code = stf_staircase(p->ctx, n, E, F, p->analysis, &sources, &found, &other, NULL);
  const bool longer = code == STEIF_BAD_INPUT && found.weyr_count > p->one->index;
  if (longer) { /* f has not the derivatives of a higher index */
    steif_forget(p->ctx);
    code = STEIF_OK;
  }
  if (!code && (longer || !found.regular || other.index != p->one->index))
    *moved = INFINITY;
  else if (!code) {
    *moved = fmax(*moved, relative(p, other.x_plus));
    keep(p, STF_DRAW_FACTOR);
  }
  steif_structure_clear(p->ctx, &found);
  steif_impulse_clear(p->ctx, &other);
  return code;
}

int stf_start_moves(const stf_two_starts *p, sunrealtype *moved)
{
  uint64_t state = p->analysis->seed ? p->analysis->seed : 1;
  sunrealtype *E = stf_pool_square(p->pool, p->units->n);
  sunrealtype *F = stf_pool_square(p->pool, p->units->n);
  sunrealtype *x = stf_pool_array(p->pool, 2 * (size_t)p->units->n, sizeof *x);
  *moved = 0;
  if (!E || !F || !x) return STEIF_NO_MEMORY;
  for (int k = 0; k < STF_DRAWS && isfinite(*moved); k++)
    STEIF_TRY(move(p, &state, E, F, x, moved));
  return STEIF_OK;
}
