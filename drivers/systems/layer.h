/* layer.h: an initial layer, its errors, and another integrator on the same system.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef LAYER_H
#define LAYER_H

#include "curves.h"
#include "descriptor.h"

struct layer {
  size_t k, steps; /* k: components, of a Jordan block its index */
  double h;
  char problem[96];                /* "jordan:k=3,case=N-inc", "ut5" */
  const struct descriptor *system; /* instead of the problem; NULL */
  double *t, *error, *x, *exact;   /* one block, begins at t; rows 0 .. steps */
  steif_layer_result result;
};

/* Take room and measure; the context has the sentence when it fails. Then layer_free. */
int layer_measure(steif_context *ctx, struct layer *l, const char *method, const char *start);
void layer_free(struct layer *l);
/* Measure, report, draw and free it: an exit code. */
int layer_follow(struct call *call, struct layer *l);
/* Another integrator on the same system: its largest deviation from the exact smooth part. */
outcome layer_against(steif_context *ctx, const struct layer *l, const char *method,
                      double rtol, double *error);
/* The errors of the steps as one more curve. */
void layer_errors(const struct layer *l, const char *label, error_curves *errors);
#define LAYER_ERROR "error against the smooth part"
/* They alone as the picture asked for. */
int layer_plot(const struct call *call, const struct layer *l, const char *method);

#endif
