/* exact_sums.c: <x_h, g> in many digits. In a shaken run what is known to double only, values of f and some
 * tables, is changed by random parts of eps, and there are fewer digits, too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include "measure.h"
#include <math.h>

/* Limbs that a shaken run goes without; products of limbs that take minutes. */
enum { FEWER = 2 };
#define MOST_PRODUCTS 1e11

static int check(const stf_measure *w, size_t steps)
{
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

static int run(stf_measure *w, const stf_frame *frame, sunrealtype h, size_t steps, bool shaken,
               const stf_spline *g, long double *out)
{
  const int limbs = stf_exact_limbs(w->subject.index, steps);
  stf_real *sum = stf_allocate(w->ctx, (size_t)w->subject.n, sizeof *sum);
  if (!sum) return STEIF_NO_MEMORY;
  stf_exact_run r = {.of = stf_measure_longer(w, frame, h, steps, shaken),
                     .limbs = shaken ? limbs - FEWER : limbs,
                     .g = g,
                     .convention = w->query->convention,
                     .solved = w->cq,
                     .sum = sum};
  const int code = stf_exact_run_make(&r);
  for (int m = 0; m < w->subject.n; m++) out[m] = stf_real_value(sum + m);
  stf_release(w->ctx, sum);
  return code;
}

int stf_exact_sums(stf_measure *w, const stf_frame *frame, sunrealtype h, size_t steps,
                   bool shaken, int row)
{
  stf_spline g = {0};
  const stf_subject *s = &w->subject;
  STEIF_TRY(check(w, steps));
  stf_weight given = s->weight;
  given.smooth = NULL;
  int code =
    stf_spline_open(&given, stf_smooth(s->index), stf_exact_limbs(s->index, steps), false, &g);
  if (!code) code = run(w, frame, h, steps, shaken, &g, w->sum + row * s->n);
  stf_spline_close(w->ctx, &g);
  return code;
}
