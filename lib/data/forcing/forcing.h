/* forcing.h: shared inside the room: a function of time by expressions or by samples.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_FORCING_H
#define STF_FORCING_H

#include "model.h"
#include "series.h"
#include <steif/forcing.h>

typedef struct stf_samples {
  sunindextype count; /* of times */
  int points;
  sunrealtype t0, h;
  sunrealtype *value;   /* count x inputs by rows */
  sunrealtype *weights; /* points */
} stf_samples;

/* Expressions in t as nodes of one graph, in the language of models. */
typedef struct stf_expressions {
  stf_model *model; /* without unknowns: texts, words, breaks */
  stf_formulas graph;
  stf_vector roots;   /* int32_t: of the inputs, then what abs, min and max ask the sign of */
  stf_vector lists;   /* int32_t: nodes that root 0 needs, root 1, ... */
  size_t *from;       /* of each root in `lists`, and its end */
  int32_t *at;        /* by node */
  stf_series *series; /* of the longest list ... */
  double *value;      /* ... and values alone */
  bool lines;         /* of a file, not of a text with ';' */
} stf_expressions;

struct steif_function {
  steif_context *ctx;
  stf_pool *pool;
  sunindextype n, inputs;     /* components of f and of u */
  sunrealtype *u;             /* values of the inputs; NULL when f = u */
  sunindextype *column, *row; /* B by columns */
  sunrealtype *entry;
  sunrealtype *breaks; /* ascending */
  size_t break_count;
  stf_expressions *expressions; /* NULL: samples */
  stf_samples samples;
};

/* An empty function of n components with its pool; NULL with the message set. */
steif_function *stf_function_new(steif_context *ctx, sunindextype n);
/* f = B u from now on: inputs and u have the columns of B. */
int stf_function_input(steif_function *f, SUNMatrix B);

/* expressions_of_time.c: the expressions of a file (path) or of a text with ';' (path NULL), and their breaks. */
int stf_expressions_read(steif_function *f, const char *path, const char *text);
void stf_expressions_free(steif_function *f);
/* The series of a root at t, in *c; a recoverable failure where it has none. */
int stf_expressions_series(steif_function *f, size_t root, sunrealtype t, int order,
                           const sunrealtype **c);

/* The inputs at t, by the samples; as steif_function_value. */
int stf_samples_value(steif_function *f, sunrealtype t, int derivative, sunrealtype *u);
/* Weights of the derivative d at x of the polynomial through the nodes 0 .. m-1. */
void stf_samples_weights(sunrealtype x, int m, int d, sunrealtype *weights);

#endif
