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

/* Scalar registers at, at + 1, ... and as many neighbours in an array: from a of the array of `kind`, or to a
 * of the output. */
typedef struct stf_stretch {
  int32_t kind, at, a, count;
} stf_stretch;

typedef struct stf_load {
  int32_t kind, to, a, stride[STF_LOOPS];
} stf_load;

/* Where an output of passes goes: to a + stride . counters, or to slot[pass] where there are slots. */
typedef struct stf_store {
  int32_t from; /* register of lanes */
  int32_t a, stride[STF_LOOPS];
  const int32_t *slot;
} stf_store;

/* The loops around: counter d runs from low to low + count - 1. */
typedef struct stf_box {
  int dims;
  int32_t low[STF_LOOPS], count[STF_LOOPS];
} stf_box;

/* Scalar registers: numbers, loads and values of parameters only, loads, values. */
typedef struct stf_tape {
  stf_vector numbers;        /* double, of the first registers */
  stf_vector loads;          /* stf_stretch, scalar */
  stf_vector code;           /* int32_t: scalar instructions, encode.c */
  stf_vector results;        /* stf_stretch: outputs without loops */
  stf_vector wide_loads;     /* stf_load */
  stf_vector broadcasts;     /* stf_step_code: to a lane register from a scalar one, a */
  stf_vector wide;           /* stf_step_code, on lanes */
  stf_vector stores;         /* stf_store */
  size_t fixed, fixed_loads; /* of code and loads: those of parameters only, which come first */
  stf_vector at;             /* const double *: values of each lane register */
  int32_t registers, lanes;  /* scalar registers, lane registers */
  int64_t operations;        /* of one evaluation, loops counted as often as they are passed */
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
void stf_tape_free(steif_context *ctx, stf_tape *tape);
/* Doubles of workspace; numbers and what parameters determine into it. */
size_t stf_tape_space(const stf_tape *tape);
void stf_tape_prepare(const stf_tape *tape, const stf_feed *feed, double *space);
/* Add the outputs to `out`, or write them there. */
void stf_tape_run(const stf_tape *tape, const stf_feed *feed, double *space, double *out);

/* encode.c: the scalar instruction at a word of `code`, and where the next one begins; *factors: registers of the
 * products that it adds, s->c of them, or NULL. */
const int32_t *stf_tape_decode(const int32_t *word, stf_step_code *s, const int32_t **factors);
/* passes.c: how many passes a box has, and the value a + stride . counters in pass k. */
int64_t stf_passes(const stf_box *box);
int32_t stf_at_pass(const stf_box *box, int64_t k, int32_t a, const int32_t *stride);

/* tables.c */
/* The last: lines y[i] + slope[i] (x - x[i]), which need not meet. The others by their numbers in the language. */
enum stf_table_kind { STF_LINEAR_TABLE, STF_CUBIC_TABLE, STF_STEPS_TABLE, STF_LINES_TABLE };
struct stf_lookup {
  int kind;
  bool error;
  size_t count;
  const double *x, *y, *slope; /* slopes at the nodes, cubic and lines */
};
double stf_lookup_value(const stf_lookup *l, double x);
double stf_lookup_slope(const stf_lookup *l, double x);

#endif
