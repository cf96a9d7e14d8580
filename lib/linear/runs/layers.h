/* layers.h: equal steps of one method from x(0-) or, at another length, once more through a
 * layer.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LAYERS_H
#define STF_LAYERS_H

#include "apart.h"
#include <steif/runs.h>

/* Values beyond the order that differences and interpolation take. */
enum { STF_BEYOND = 2 };

/* Rows of values, oldest first: those up to `kept` are part of the solution, the others on
 * trial. It stays where it is until it is closed. */
typedef struct stf_layers {
  steif_linear linear; /* what is run; first: the problem's callbacks get this as `user` */
  steif_context *ctx;
  const char *method;
  steif_options options;
  const sunrealtype *x0; /* x(0-) */
  sunrealtype t0, t1;
  int n, index;
  int order, past;    /* of errors outside of layers; values a step needs */
  int width, opening; /* steps of a layer; of the first one */
  stf_apart apart;
  steif_problem problem; /* of the solver */
  steif_solver *solver;
  sunrealtype h;
  int room, count, kept;
  int valid,
    clean; /* first row outside the first layer; of the present length outside its own */
  sunrealtype *t, *x, *start; /* rows; start: n more */
  N_Vector g;
  steif_layers_stats stats;
} stf_layers;

int stf_layers_open(steif_context *ctx, const steif_linear *linear, const sunrealtype *x0,
                    sunrealtype t0, const char *method, const steif_options *options,
                    const steif_analysis *analysis, stf_layers *layers);
void stf_layers_close(stf_layers *layers);

/* From x(0-) with steps h (which divide the way to t1): the rows of the first layer. */
int stf_layers_begin(stf_layers *layers, sunrealtype h);
/* Is what is kept long enough for steps h to run through a layer up to its end? */
bool stf_layers_fit(const stf_layers *layers, sunrealtype h);
/* Steps h from the last row kept on, which it reaches anew from so far before it that the
 * layer is behind them; rows on trial are dropped. */
int stf_layers_change(stf_layers *layers, sunrealtype h);
/* One more row. */
int stf_layers_step(stf_layers *layers);
/* The last `rows` are kept, older ones than changes need forgotten. */
void stf_layers_keep(stf_layers *layers);

#endif
