/* verdict_case.h: a verdict of weak convergence on a random system, against runs in many digits in canonical
 * coordinates: nothing of the analysis of pencils is shared, nor the coordinates, nor the solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef VERDICT_CASE_H
#define VERDICT_CASE_H

#include "planted_system.h"

/* A method as it is asked for. */
typedef struct asked_method {
  const char *method, *start; /* "bdf:p=2", "cq" or NULL */
  enum steif_convention convention;
} asked_method;
const asked_method *asked_method_at(int i); /* NULL after the last */

enum { VERDICT_ROWS = 5, VERDICT_MOST = 512 };
enum verdict_outcome {
  VERDICT_RIGHT,
  VERDICT_OPEN,
  VERDICT_FALSE, /* converges, or not, against the truth */
  VERDICT_ORDER, /* converges with an order that is another one for smaller steps, or for most g */
  VERDICT_ERROR_BAR, /* an error of a usable row is outside twice its rounding level */
  VERDICT_FAILED,
  VERDICT_OUTCOMES
};
const char *verdict_outcome_name(enum verdict_outcome outcome);

typedef struct verdict_case {
  long seed;
  int method, component; /* of asked_method_at; STEIF_ALL */
  const char *g;
  double h;
  planted_system system;
  steif_weak_row row[VERDICT_ROWS];
  steif_weak_result result;
  double truth; /* order of convergence as h tends to 0; infinite: exact */
  double off;   /* the largest error of a usable row over its level */
  enum verdict_outcome outcome;
} verdict_case;

/* What is known of methods from runs of Jordan blocks, filled as it is asked for. */
typedef struct method_orders {
  double impulse[64][SYSTEM_MOST]; /* of method i on impulses of order q; 0: not yet known */
} method_orders;

/* Case number `seed`: drawn, measured and judged. */
int verdict_case_run(steif_context *ctx, long seed, method_orders *known, verdict_case *c);
void verdict_case_free(verdict_case *c);

/* Orders, NAN where two rows do not show one: on impulses of order q, and of a component from a consistent
 * start. */
int method_order_on_impulse(steif_context *ctx, int method, int q, method_orders *known,
                            double *order);
int method_order_without(steif_context *ctx, int method, const planted_system *s, int component,
                         double *order);
/* <z_m, g> of the run in canonical coordinates, in many digits. */
int canonical_run(steif_context *ctx, int method, const steif_linear *plain,
                  const sunrealtype *z0, int index, const stf_weight *g, double h, size_t steps,
                  long double *z);

#endif
