/* steif/failure.h: why did a run stop, and is a Jacobian right.
 *
 *   steif_failure why;
 *   if (!s || steif_solve_to(s, t1) < 0)
 *     if (!steif_failure_find(ctx, &problem, "auto", &options, &why)) puts(why.message);
 *
 * steif_failure_find makes the run once more with its accepted points kept, which it is not asked to
 * do when it may succeed, and ends where it ended before; steif_explain then looks for the cause, the
 * first of an ordered list. Most causes are looked for with dense matrices and serve
 * n <= STEIF_DIAGNOSE_LARGEST.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_FAILURE_H
#define STEIF_FAILURE_H

#include <steif/index.h>
#include <steif/solver.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Causes of a failure. They are looked for in this order: EVENTS that crowd together at the end, GROWTH beyond
 * 1e100 times the start, values that are not finite at the point, noise that spoils a Jacobian made by differences
 * (a limit of ACCURACY), BLOW_UP over more than two decades, values not finite along the step, IMPASSE, JUMP after
 * t0, JACOBIAN, SINGULAR, START, INDEX, ACCURACY (not of prescribed steps), STIFF, RINGING. */
enum steif_cause_kind {
  STEIF_CAUSE_UNKNOWN,
  STEIF_CAUSE_NOT_FINITE,
  STEIF_CAUSE_BLOW_UP,
  STEIF_CAUSE_IMPASSE,
  STEIF_CAUSE_JUMP,
  STEIF_CAUSE_JACOBIAN,
  STEIF_CAUSE_SINGULAR,
  STEIF_CAUSE_ACCURACY,
  STEIF_CAUSE_STIFF,
  STEIF_CAUSE_START,
  STEIF_CAUSE_RINGING,
  STEIF_CAUSE_INDEX,
  STEIF_CAUSE_GROWTH,
  STEIF_CAUSE_EVENTS
};

/* What the stepper knows. The point of the inquiry is the last accepted one. */
typedef struct steif_history {
  sunrealtype h;             /* the step that failed */
  size_t count;              /* accepted points kept, oldest first, the last one included; */
  const sunrealtype *t;      /* count times; the last dozen steps unthinned */
  const sunrealtype *y, *yp; /* count x n by rows */
  long steps;                /* accepted in all; 0 or 1: the start is under suspicion */
  sunrealtype t0;
  sunrealtype rtol, atol;
  const sunrealtype *atols; /* n instead of atol; NULL: none */
  const sunrealtype *error; /* n: last error estimate; NULL: not known */
  int explicit_method;      /* its steps may be held by stability */
  int prescribed;           /* steps are: no tolerance was to be met */
  int weighted;             /* norms scale component j by h^(number_j - 1) */
  const char *method;       /* for the sentence; NULL: "the method" */
  int
    restarted; /* the run went on at the last point after an event or break: its start is under suspicion */
} steif_history;

typedef struct steif_cause {
  enum steif_cause_kind kind;
  sunrealtype t;                  /* of the event; NaN when there is none */
  sunindextype equation, unknown; /* 0-based, -1: none named */
  /* blow-up: exponent, growth; impasse: growth, misfit; jump: size, median increment;
   * Jacobian: given, measured; singular: reciprocal condition; accuracy: noise, in weights
   * (in increments where it spoils a Jacobian by differences); stiff: h |lambda|, |lambda|;
   * start: move, in weights; growth: since the start, time for a factor of ten; ringing: share of sign changes, amplitude in weights; index:
   * index, number of the unknown */
  sunrealtype value[2];
  char message[STEIF_SENTENCE];
} steif_cause;

/* 0 also when the cause is unknown: the sentence then holds the numbers. */
STEIF_EXPORT int steif_explain(steif_context *ctx, const steif_problem *problem,
                               const steif_point *inquiry, const steif_history *scene,
                               steif_cause *cause);
/* The same for the Jacobian alone, before the first step: STEIF_CAUSE_JACOBIAN or
 * STEIF_CAUSE_UNKNOWN (nothing wrong found). */
STEIF_EXPORT int steif_check_jacobian(steif_context *ctx, const steif_problem *problem,
                                      const steif_point *inquiry, steif_cause *cause);

enum { STEIF_WORST = 5 };

typedef struct steif_failure {
  int code;         /* enum steif_code of the run */
  sunrealtype t, h; /* last accepted time; length of the last attempt from there, 0: none */
  int order;        /* of its error estimate; 0: not known */
  long steps;       /* accepted */
  int count;        /* components named, those with the largest error first: */
  struct {
    sunindextype component; /* 0-based */
    sunrealtype error;      /* estimate of the last attempt that came to have one ... */
    sunrealtype allowed;    /* ... 1 / weight, times h^(1 - index) as in the error test */
    sunrealtype residual;   /* of the equation of that number at t */
  } worst[STEIF_WORST];
  steif_cause cause; /* with more than STEIF_DIAGNOSE_LARGEST unknowns only of values
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
