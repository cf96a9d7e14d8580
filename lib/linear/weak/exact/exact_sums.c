/* exact_sums.c: <x_h, g> in many digits. In a shaken run what is known to double only, values of f and some
 * tables, is changed by random parts of eps, and there are fewer digits, too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include "measure.h"
#include <math.h>
#include <string.h>

/* Limbs that a shaken run goes without; products of limbs that take minutes. */
enum { FEWER = 2 };
#define MOST_PRODUCTS 1e11

static int check(const stf_measure *w)
{
  const size_t steps = stf_measure_steps(w);
  const double n = w->subject.n;
  int stages;
  STEIF_TRY(stf_recurrence_of(w->ctx, w->query->method, &stages));
  STEIF_CHECK(stages && w->subject.linear.E, w->ctx, STEIF_UNSUPPORTED,
              "runs in many digits are known of be, bdf and Runge-Kutta methods with regular A "
              "on matrices, not of '%s'",
              w->query->method);
  const double limbs = stf_exact_limbs(w->subject.index, steps);
  STEIF_CHECK((double)steps * (stages * n) * (stages * n) * limbs * limbs <= MOST_PRODUCTS,
              w->ctx, STEIF_UNSUPPORTED,
              "%zu steps with %g values are too many for a run in many digits: take larger "
              "ones, or fewer rows",
              steps, stages * n);
  return STEIF_OK;
}

static int limbs_of(const stf_measure *w, bool shaken)
{
  return stf_exact_limbs(w->subject.index, stf_measure_steps(w)) - (shaken ? FEWER : 0);
}

/* Segments one after another, in r->of. */
static int follow(const stf_measure *w, stf_exact_run *r)
{
  for (size_t i = 0; i < w->mesh.count; i++) {
    const stf_segment part = stf_measure_segment(w, i);
    const stf_real from = stf_real_of(part.from), to = stf_real_of(part.to),
                   count = stf_real_of((long double)part.steps);
    stf_longer_segment(&r->of, &part, i);
    r->ends = i + 1 < w->mesh.count ? w->mesh.ends : 0;
    r->h = stf_real_of(part.h);
    if (w->mesh.count > 1) {
      stf_real_subtract(r->limbs, &to, &from, &r->h);
      stf_real_divide(r->limbs, &r->h, &count, &r->h);
    }
    STEIF_TRY(stf_exact_run_make(r));
  }
  return STEIF_OK;
}

/* Paired with g into `out`, or as integrals: one of them is NULL. */
static int run(stf_measure *w, const stf_frame *frame, bool shaken, const stf_spline *g,
               stf_integrals *integrals, long double *out)
{
  const size_t n = (size_t)w->subject.n;
  stf_real *sum = stf_allocate(w->ctx, 2 * n, sizeof *sum);
  if (!sum) return STEIF_NO_MEMORY;
  stf_exact_run r = {.of = stf_measure_longer(w, frame, shaken),
                     .limbs = limbs_of(w, shaken),
                     .g = g,
                     .integrals = integrals,
                     .convention = w->query->convention,
                     .solved = w->cq,
                     .sum = sum,
                     .state = sum + n};
  memset(sum, 0, n * sizeof *sum);
  const int code = follow(w, &r);
  for (size_t m = 0; out && m < n; m++) out[m] = stf_real_value(sum + m);
  stf_release(w->ctx, sum);
  return code;
}

int stf_exact_events(stf_measure *w, bool shaken, stf_events *events)
{
  const stf_frame frame = stf_measure_frame(w);
  stf_integrals s = {.limbs = limbs_of(w, shaken),
                     .n = w->subject.n,
                     .first = w->first,
                     .count = w->count,
                     .most = events->most,
                     .unit = stf_measure_step(w),
                     .events = events};
  events->count = 0;
  STEIF_TRY(check(w));
  STEIF_TRY(stf_integrals_open(w->ctx, &s));
  const int code = run(w, &frame, shaken, NULL, &s, NULL);
  stf_integrals_close(w->ctx, &s);
  return code;
}

int stf_exact_sums(stf_measure *w, const stf_frame *frame, bool shaken, int row)
{
  stf_spline g = {0};
  const stf_subject *s = &w->subject;
  STEIF_TRY(check(w));
  stf_weight given = s->weight;
  given.smooth = NULL;
  int code = stf_spline_open(&given, stf_smooth(s->index),
                             stf_exact_limbs(s->index, stf_measure_steps(w)), false, &g);
  if (!code) code = run(w, frame, shaken, &g, NULL, w->sum + row * s->n);
  stf_spline_close(w->ctx, &g);
  return code;
}
