/* tape.h: nodes of a graph as instructions for a machine of registers.
 *
 * What depends on parameters only is computed once for each set of them, what
 * is the same for all passes of the loops once for each call, both in scalar
 * registers; the rest in registers of STF_LANES values, an instruction for as
 * many passes of the innermost loop at a time.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TAPE_H
#define STF_TAPE_H

#include "graph.h"

enum { STF_PASSES = 64 }; /* of one instruction */

typedef struct stf_step_code {
  int32_t kind, to, a, b, c;
} stf_step_code;

typedef struct stf_load {
  int32_t kind, to, a, stride[STF_LOOPS];
} stf_load;

/* Where output k goes: to a + stride . counters, or to slot[pass] where there
 * are slots. */
typedef struct stf_store {
  int32_t from; /* register */
  uint8_t wide; /* of lanes */
  int32_t a, stride[STF_LOOPS];
  const int32_t *slot;
} stf_store;

/* The loops around: counter d runs from low to low + count - 1. */
typedef struct stf_box {
  int dims;
  int32_t low[STF_LOOPS], count[STF_LOOPS];
} stf_box;

typedef struct stf_tape {
  stf_vector code;           /* stf_step_code, scalar; the first `fixed` of parameters only */
  stf_vector wide;           /* stf_step_code, on lanes */
  stf_vector numbers;        /* stf_load: kind NUMBER, a: into `values` */
  stf_vector values;         /* double */
  stf_vector loads;          /* stf_load, scalar; the first `parameters` of them once */
  stf_vector wide_loads;     /* stf_load */
  stf_vector broadcasts;     /* stf_step_code: to a lane register from a scalar one, a */
  stf_vector stores;         /* stf_store */
  size_t fixed, fixed_loads; /* of code and loads: those of parameters only, which come first */
  size_t state_loads;        /* then loads of unknowns, up to here */
  stf_vector at;             /* const double *: values of each lane register */
  int32_t registers, lanes;  /* scalar registers, lane registers */
  bool assigns;              /* stores write, they do not add */
  stf_box box;
} stf_tape;

typedef struct stf_lookup stf_lookup;

/* What a run reads. */
typedef struct stf_feed {
  double t;
  const double *y, *yp, *p, *memory;
  const double *along[4]; /* direction of y, y', p; weights of rows */
  const stf_lookup *lookups;
} stf_feed;

/* Outputs are nodes with a destination (`from` is the node). */
int stf_tape_compile(const stf_formulas *g, const stf_box *box, size_t count,
                     const stf_store *outputs, stf_tape *tape);
/* fuse.c: products and the sums that need them as one instruction. */
int stf_tape_fuse(steif_context *ctx, stf_tape *tape);
void stf_tape_free(steif_context *ctx, stf_tape *tape);
/* Doubles of workspace; numbers and what parameters determine into it. */
size_t stf_tape_space(const stf_tape *tape);
void stf_tape_prepare(const stf_tape *tape, const stf_feed *feed, double *space);
/* Add the outputs to `out`, or write them there. */
void stf_tape_run(const stf_tape *tape, const stf_feed *feed, double *space, double *out);

/* tables.c */
struct stf_lookup {
  int kind; /* 0 linear, 1 cubic, 2 steps */
  bool error;
  size_t count;
  const double *x, *y, *slope; /* slopes at the nodes, cubic */
};
double stf_lookup_value(const stf_lookup *l, double x);
double stf_lookup_slope(const stf_lookup *l, double x);

#endif
