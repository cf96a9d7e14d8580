/* sliding.c: runs that do not get past a corner of f or F: each step over it is rejected, each step up to it is
 * accepted, and the solution slides along it or chatters. They end where such a corner is found.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <math.h>

/* Looked at after so many steps, of which this part was rejected. */
enum { WINDOW = 4000, MOST_UNKNOWNS = 2000 };
static const sunrealtype rejected_part = 0.3;
/* A second difference over first ones, within the tolerance of one unknown. */
static const sunrealtype bent = 0.2, rounding = 1e4;

typedef struct corner {
  sunindextype equation, unknown; /* -1: none */
  sunrealtype part;               /* of its bend in its change */
} corner;

static int evaluate(steif_solver *s, N_Vector y, N_Vector out)
{
  stf_system *system = &s->step.system;
  const bool implicit = system->form == STEIF_IMPLICIT;
  return implicit ? stf_system_residual(system, s->step.t, y, s->step.yp, out)
                  : stf_system_rhs(system, s->step.t, y, out);
}

/* F at y, y + w e_j and y - w e_j: which equation bends most? */
static void compare(sunindextype n, sunindextype j, N_Vector *F, corner *c)
{
  const sunrealtype *at = stf_array(F[0]), *up = stf_array(F[1]), *down = stf_array(F[2]);
  for (sunindextype i = 0; i < n; i++) {
    const sunrealtype a = fabs(up[i] - at[i]), b = fabs(down[i] - at[i]);
    const sunrealtype bend = fabs(up[i] - 2 * at[i] + down[i]), size = a + b;
    const sunrealtype noise = rounding * STF_EPS * (fabs(at[i]) + fabs(up[i]) + fabs(down[i]));
    if (size <= noise || bend <= fmax(bent, c->part) * size) continue;
    c->part = bend / size;
    c->equation = i;
    c->unknown = j;
  }
}

static int search(steif_solver *s, N_Vector *v, corner *c)
{
  const stf_step *step = &s->step;
  const sunindextype n = s->problem->n;
  const sunrealtype *w = stf_array(step->weights);
  sunrealtype *y = stf_array(v[3]);
  N_VScale(1, step->y, v[3]);
  STEIF_TRY(evaluate(s, v[3], v[0]));
  for (sunindextype j = 0; j < n; j++) {
    const sunrealtype at = y[j], move = 1 / w[j];
    int code = STEIF_OK;
    for (int k = 1; k <= 2 && !code; k++) {
      y[j] = k == 1 ? at + move : at - move;
      code = evaluate(s, v[3], v[k]);
    }
    y[j] = at;
    if (code < 0) return code;
    if (!code) compare(n, j, v, c);
  }
  return STEIF_OK;
}

/* At the accepted point, within the tolerance of each unknown. */
static int find(steif_solver *s, corner *c)
{
  *c = (corner){-1, -1, 0};
  if (s->problem->n > MOST_UNKNOWNS || s->step.system.form == STEIF_DESCRIPTOR ||
      !stf_array(s->step.y))
    return STEIF_OK;
  stf_pool *pool = stf_pool_new(s->ctx);
  N_Vector *v = pool ? stf_pool_vectors(pool, 4, s->step.y) : NULL;
  int code = v ? stf_weigh(s) : STEIF_NO_MEMORY;
  if (!code) code = search(s, v, c);
  stf_pool_free(&pool);
  return code > 0 ? STEIF_OK : code;
}

static int told(const steif_solver *s, const corner *c, long rejected)
{
  char equation[STEIF_SPEC_WORD], unknown[STEIF_SPEC_WORD];
  const stf_step *step = &s->step;
  return STEIF_FAIL(
    s->ctx, STEIF_STEP_SIZE,
    "the last %d steps of problem '%s' were rejected %ld times and are %.3g long at t = %.12g: "
    "corner of %s at %s = %.6g, along which the solution slides or chatters; give the model "
    "a rule for that (hysteresis, a sliding mode, an event), or make the law smooth",
    WINDOW, s->problem->name, rejected, step->h, step->t,
    stf_equation(s->problem, c->equation, equation),
    stf_unknown(s->problem, c->unknown, unknown), stf_array(step->y)[c->unknown]);
}

int stf_corner_check(steif_solver *s)
{
  const stf_step *step = &s->step;
  stf_pace *p = &s->pace;
  const long rejected = s->rejected - p->rejected;
  const sunrealtype progress = step->t - p->t, left = s->t1 - step->t;
  const bool cycles = p->steps > 0 && (sunrealtype)rejected > rejected_part * WINDOW;
  const sunrealtype ahead = left / progress * WINDOW;
  *p = (stf_pace){step->count + WINDOW, s->rejected, step->t};
  if (!cycles || !(ahead > (sunrealtype)(s->options.max_steps - step->count))) return STEIF_OK;
  corner c;
  STEIF_TRY(find(s, &c));
  return c.equation < 0 ? STEIF_OK : told(s, &c, rejected);
}
