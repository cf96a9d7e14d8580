/* steif/failure.h: why did a run stop.
 *
 *   steif_failure why;
 *   if (!s || steif_solve_to(s, t1) < 0)
 *     if (!steif_failure_find(ctx, &problem, "auto", &options, &why)) puts(why.message);
 *
 * The run is made once more with its accepted points kept, which it is not asked to do when it
 * may succeed, and ends where it ended before; steif_explain (diagnose.h) then looks for the cause.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_FAILURE_H
#define STEIF_FAILURE_H

#include <steif/diagnose.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STEIF_WORST = 5 };

typedef struct steif_failure {
  int code;                  /* enum steif_code of the run */
  sunrealtype t, h;          /* last accepted time; length of the last attempt from there, 0: none */
  int order;                 /* of its error estimate; 0: not known */
  long steps;                /* accepted */
  int count;                 /* components named, those with the largest error first: */
  struct {
    sunindextype component;  /* 0-based */
    sunrealtype error;       /* estimate of the last attempt that came to have one ... */
    sunrealtype allowed;     /* ... 1 / weight, times h^(1 - index) as in the error test */
    sunrealtype residual;    /* of the equation of that number at t */
  } worst[STEIF_WORST];
  steif_cause cause;         /* with more than STEIF_DIAGNOSE_LARGEST unknowns only of values
                                that are not finite, blow-up, jumps, tolerance and ringing; with
                                Krylov storage STEIF_CAUSE_UNKNOWN */
  char message[2 * STEIF_SENTENCE]; /* all of it */
} steif_failure;

/* STEIF_BAD_INPUT when the run does not fail. The observers of the options are not called. */
STEIF_EXPORT int steif_failure_find(steif_context *ctx, const steif_problem *problem,
                                    const char *method, const steif_options *options,
                                    steif_failure *failure);

#ifdef __cplusplus
}
#endif
#endif
