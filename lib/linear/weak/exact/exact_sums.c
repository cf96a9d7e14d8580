/* exact_sums.c: <x_h, g> in many digits, twice: what is known to double only, values of f and some tables, is
 * changed by random parts of eps in the second run, which has fewer digits, too.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exact_run.h"
#include "measure.h"
#include <math.h>

/* Derivatives of g that are right at knots beyond those that the index asks for, and at least; limbs that
 * the second run goes without; products of limbs that take minutes. */
enum { BEYOND = 3, SMOOTH = 8, FEWER = 2 };
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

static int run(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps,
               const stf_spline *g, bool shaken, stf_real *sum)
{
  stf_subject *s = &w->subject;
  const int limbs = stf_exact_limbs(s->index, steps);
  stf_exact_run r = {.of = {.ctx = w->ctx,
                            .linear = apart ? &apart->linear : &s->linear,
                            .sides = s->sides.count ? &s->sides : NULL,
                            .closed = s->problem.exact ? &s->problem : NULL,
                            .method = w->query->method,
                            .start = w->query->start,
                            .x0 = apart ? apart->z0 : s->problem.y0,
                            .n = s->n,
                            .h = h,
                            .steps = steps,
                            .shaken = shaken},
                     .limbs = shaken ? limbs - FEWER : limbs,
                     .g = g,
                     .convention = w->query->convention,
                     .solved = w->cq,
                     .sum = sum};
  STEIF_TRY(stf_exact_run_make(&r));
  for (int m = 0; m < s->n; m++) w->sum[(shaken ? s->n : 0) + m] = stf_real_value(sum + m);
  return STEIF_OK;
}

int stf_exact_sums(stf_measure *w, stf_apart *apart, sunrealtype h, size_t steps,
                   long double *defect)
{
  stf_spline g = {0};
  stf_subject *s = &w->subject;
  const int smooth = (int)fmax(s->index + BEYOND, SMOOTH);
  STEIF_TRY(check(w, steps));
  if (apart) stf_apart_enter(apart, s->n, s->problem.y0, apart->z0);
  stf_real *sum = stf_allocate(w->ctx, (size_t)s->n, sizeof *sum);
  int code = sum ? STEIF_OK : STEIF_NO_MEMORY;
  if (!code) code = stf_spline_open(&s->weight, smooth, stf_exact_limbs(s->index, steps), &g);
  *defect = g.defect;
  for (int shaken = 0; shaken < 2 && !code; shaken++)
    code = run(w, apart, h, steps, &g, shaken, sum);
  stf_spline_close(w->ctx, &g);
  stf_release(w->ctx, sum);
  return code;
}
