/* native.h: the tapes of a model as C, for the compiler of the system.
 *
 * Loops stay loops. Only numbers, indices and a fixed list of functions get into the code, no name or
 * text of the model: see c_tape.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NATIVE_H
#define STF_NATIVE_H

#include "model.h"

/* A text that grows; after the first failure it stays as it is. */
typedef struct stf_writer {
  steif_context *ctx;
  stf_vector text; /* char */
  int code;
} stf_writer;
void stf_write(stf_writer *w, const char *format, ...) STEIF_PRINTF(2, 3);
/* Text as it stands, of any length. */
void stf_write_text(stf_writer *w, const char *text);
/* A number that is read again as it is. */
void stf_write_number(stf_writer *w, double value);
/* Text of the model within a comment: printable ASCII without marks that end it. */
void stf_write_plain(stf_writer *w, const char *text);
/* ... as a string, in quotes. */
void stf_write_string(stf_writer *w, const char *text);
/* The text with its end; NULL where memory was short. */
const char *stf_written(stf_writer *w);

/* How values come into a function. */
typedef struct stf_dialect {
  const char *name;  /* "f": functions f_0, f_1, ... of the tapes */
  bool standalone;   /* parameters' part is computed there and slots are arrays of the text */
  const char *store; /* before the functions: "static " */
  long most;         /* statements; longer tapes are left out; 0: any */
} stf_dialect;

/* c_tape.c: what all functions need; and a function for each tape:
 * void NAME(double t, const double *y, const double *yp, const double *p, const double *m,
 *           const double *r, const int *const *slot, double *out) */
void stf_write_functions(stf_writer *w, const stf_model *m, size_t count,
                         const stf_quantity *const *quantities);
/* Returns how many functions. */
size_t stf_write_quantity(stf_writer *w, const stf_dialect *d, const stf_quantity *q);
/* c_events.c: g, conditions and assignments, before f; what is done at events, after it. */
void stf_write_event_values(stf_writer *w, const stf_model *m);
void stf_write_events(stf_writer *w, const stf_model *m);
/* c_problem.c: the model as a program. */
void stf_write_problem(stf_writer *w, const stf_model *m, const steif_problem *p);

/* c_event_rules.c: parts of the C text of a model with events, in their order. */
extern const char stf_c_state[], stf_c_relations[], stf_c_rules[], stf_c_turning[],
  stf_c_handling[], stf_c_moving[], stf_c_slope[];

#endif
