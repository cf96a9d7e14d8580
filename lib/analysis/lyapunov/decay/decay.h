/* decay.h: the room of step verdicts inside: leading exponents of a method at a step, and of the equation.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DECAY_H
#define STF_DECAY_H

#include "decay_thresholds.h"
#include "lyapunov_thresholds.h"
#include "variation.h"
#include <steif/decay.h>

/* The leading exponent +- error; the most that ln |w| rises. steps: in all. */
typedef struct stf_rate {
  sunrealtype value, error, rise;
  long steps;
} stf_rate;

/* What steps are measured on. */
typedef struct stf_question {
  steif_context *ctx;
  const steif_problem *problem;
  const char *method;                /* of the numbers */
  const char *exact;                 /* of the equation */
  sunrealtype t1, transient, period; /* period 0: none, or not linear */
  bool linear, found;                /* found: the period was looked for */
  sunrealtype off; /* A(t + period) - A(t) of a period found: exponents are not known better */
  const volatile int *stop;
} stf_question;

/* periods.c: by the map over q periods in m steps, twice in a row: the error is how far the two are apart.
 * No rise. */
int stf_rate_of_periods(const stf_question *q, const char *method, long turns, long steps,
                        stf_rate *rate);
/* rates.c: by QR with steps h to t1, and the rise. */
int stf_rate_of_run(const stf_question *q, const char *method, sunrealtype h, sunrealtype t1,
                    stf_rate *rate);
/* h = turns periods / steps with turns <= STF_TURNS_MOST: true. */
bool stf_commensurate(const stf_question *q, sunrealtype h, long *turns, long *steps);
/* Of the numbers at h, by periods where they fit, and the rise by a run. */
int stf_rate_of_step(const stf_question *q, sunrealtype h, stf_rate *rate);
/* Of the equation. error infinite: not converged. */
int stf_rate_of_equation(const stf_question *q, sunrealtype h, stf_rate *rate);

/* equation_rise.c: of x' = A(t) x over all directions, to t1, with steps h of the flow. */
int stf_equation_rise(const stf_question *q, sunrealtype h, sunrealtype t1, sunrealtype *rise);

/* step_search.c: h_good, h_bad, least, most, tail of d, whose lambda and rise are known. */
int stf_step_search(const stf_question *q, sunrealtype h, steif_decay *d);

/* decay_sentence.c: the verdict and its sentence; then what the search has found. */
void stf_decay_judge(sunrealtype h, steif_decay *d);
void stf_decay_tell(const stf_question *q, steif_decay *d);

#endif
