/* price.c: a baseline called through steif against a direct program, in turns.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "direct.h"
#include "kernels.h"
#include "timing.h"
#include <math.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <stdio.h>

/* Seconds and steps of a whole run through steif. */
static sunrealtype through_steif(steif_context *ctx, const steif_problem *p, const char *method,
                                 const steif_options *o, long *steps)
{
  const sunrealtype from = stf_now();
  steif_solver *s = steif_solver_new(ctx, p, method, o);
  const int code = s ? steif_solve_to(s, p->t1) : STEIF_BAD_INPUT;
  *steps = code ? -1 : steif_statistics(s)->steps;
  steif_solver_free(&s);
  return stf_now() - from;
}

static sunrealtype direct_seconds(SUNContext sun, const steif_problem *p, direct_run *run,
                                  sunrealtype rtol, long *steps)
{
  const sunrealtype from = stf_now();
  *steps = run(sun, p, rtol);
  return stf_now() - from;
}

static int ascending(const void *x, const void *y)
{
  const double a = *(const double *)x, b = *(const double *)y;
  return (a > b) - (a < b);
}

/* Medians of the times and of the ratios of neighbours, which a busy machine disturbs alike. */
static int measure(steif_context *ctx, const steif_problem *p, const char *method,
                   direct_run *run, steif_bench_row *row)
{
  enum { LEAST = 15, MOST = 401 };
  static double mine[MOST], theirs[MOST], ratio[MOST];
  steif_options o = steif_defaults();
  sunrealtype spent = 0;
  int count = 0;
  o.rtol = row->rtol;
  for (; count < LEAST || (count < MOST && spent < 0.3); count++) {
    long steps, expected;
    mine[count] = through_steif(ctx, p, method, &o, &steps);
    theirs[count] = direct_seconds(steif_sundials(ctx), p, run, row->rtol, &expected);
    STEIF_CHECK(steps > 0 && steps == expected, ctx, STEIF_NOT_CERTIFIED,
                "%s on %s makes %ld steps through steif and %ld in the direct program", method,
                p->name, steps, expected);
    ratio[count] = mine[count] / theirs[count];
    spent += mine[count] + theirs[count];
  }
  qsort(mine, (size_t)count, sizeof *mine, ascending);
  qsort(theirs, (size_t)count, sizeof *theirs, ascending);
  qsort(ratio, (size_t)count, sizeof *ratio, ascending);
  row->step_s = mine[0];
  row->floor_s = theirs[0];
  row->ratio = ratio[count / 2];
  return STEIF_OK;
}

int stf_bench_price(steif_context *ctx, const char *problem, const char *method,
                    steif_bench_row *row)
{
  steif_problem p;
  STEIF_TRY(steif_problem_find(ctx, problem, &p));
  row->n = p.n;
  row->atol = row->rtol * (p.rtol_scale > 0 ? p.rtol_scale : 1);
  direct_run *run = method[0] == 'i'   ? direct_ida
                    : method[0] == 'a' ? direct_arkode
                                       : direct_cvode;
  const int code = measure(ctx, &p, method, run, row);
  steif_problem_clear(ctx, &p);
  return code;
}
