/* input.h: shared inside the room: the scan of Matrix Market files, Taylor
 * arithmetic and programs in it.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_INPUT_H
#define STF_INPUT_H

#include "base.h"
#include "text.h"
#include <steif/input.h>

/* ---- matrices -------------------------------------------------------------------------------- */

enum stf_symmetry { STF_GENERAL, STF_SYMMETRIC, STF_SKEW };
typedef struct stf_market {
  bool array, pattern, integer;
  enum stf_symmetry symmetry;
  sunindextype rows, columns, entries; /* entries: as stored in the file */
} stf_market;
/* Read all of the file once: header, sizes, syntax of each line, count of the entries. */
int stf_market_scan(steif_context *ctx, const char *path, FILE *file, stf_market *market);

/* Entry k of column j: row and value, for the storages of this room. */
sunindextype stf_input_column(SUNMatrix M, sunindextype j);
void stf_input_entry(SUNMatrix M, sunindextype j, sunindextype k, sunindextype *row,
                     sunrealtype *value);
sunindextype stf_input_rows(SUNMatrix M);
sunindextype stf_input_columns(SUNMatrix M);
/* Dense or compressed by columns, finite; `name` for the sentence. */
int stf_input_check(steif_context *ctx, SUNMatrix M, const char *name);

/* Refuse a matrix of a file that has not so many rows and columns; why: "the size of E". */
int stf_input_sized(steif_context *ctx, const char *path, const char *name, SUNMatrix M,
                    sunindextype rows, sunindextype columns, const char *why);
/* A variable of a MATLAB file that need not be there; a failure only when it is and cannot be
 * read. */
int stf_input_variable(steif_context *ctx, const char *path, const char *name, SUNMatrix *M);
/* A failure when a .mat file is not whole, or its variables claim more entries than it can have. */
int stf_mat_check(steif_context *ctx, const char *path);
/* mat_hdf5.c: does a file begin as HDF5 does; a matrix of one, as steif_matrix_read_mat has it. */
bool stf_hdf5_is(const char *path);
SUNMatrix stf_hdf5_matrix(steif_context *ctx, const char *path, const char *name, int *found);
/* B of f = B u in the rows of E, of a .mat file; *B NULL where there is none. */
int stf_input_read(steif_context *ctx, const char *path, SUNMatrix *B);
/* The texts of a cell array or the rows of a character array, without blanks at their ends, in the
 * pool; *text NULL when the file has no such variable. */
int stf_input_texts(steif_context *ctx, stf_pool *pool, const char *path, const char *name,
                    size_t *count, const char ***text);

/* ---- Taylor arithmetic: c[k] = u^(k)(t) / k!, k = 0 .. n ------------------------------------- */

enum { STF_ORDER = 64 };
typedef struct stf_series {
  sunrealtype c[STF_ORDER + 1];
} stf_series;

void stf_series_constant(int n, sunrealtype value, stf_series *u);
void stf_series_times(int n, const stf_series *a, const stf_series *b, stf_series *u);
/* NULL, or why there is no series. u is neither a nor b nor w. */
const char *stf_series_over(int n, const stf_series *a, const stf_series *b, stf_series *u);
const char *stf_series_power(int n, const stf_series *a, sunrealtype exponent, stf_series *u);
/* a^exponent by squaring; w: two series of scratch. */
const char *stf_series_whole(int n, const stf_series *a, long exponent, stf_series *u,
                             stf_series w[2]);
const char *stf_series_log(int n, const stf_series *a, stf_series *u);
const char *stf_series_abs(int n, const stf_series *a, stf_series *u);
void stf_series_exp(int n, const stf_series *a, stf_series *u);
/* sign -1: sine and cosine, +1: sinh and cosh. */
void stf_series_waves(int n, const stf_series *a, int sign, stf_series *sine,
                      stf_series *cosine);
/* sign +1: tan, -1: tanh; w = 1 + sign u^2. */
const char *stf_series_tan(int n, const stf_series *a, int sign, stf_series *u, stf_series *w);
void stf_series_atan(int n, const stf_series *a, stf_series *u, stf_series *w);

/* ---- programs: expressions in postfix order -------------------------------------------------- */

enum stf_operation {
  STF_NUMBER,
  STF_TIME,
  STF_ADD,
  STF_SUBTRACT,
  STF_MULTIPLY,
  STF_DIVIDE,
  STF_MIN,
  STF_MAX,
  STF_NEGATE,
  STF_POWER,       /* a^b */
  STF_POWER_WHOLE, /* a^number, a whole number */
  STF_POWER_REAL,  /* a^number */
  STF_SIN,
  STF_COS,
  STF_TAN,
  STF_EXP,
  STF_LOG,
  STF_SQRT,
  STF_SINH,
  STF_COSH,
  STF_TANH,
  STF_ATAN,
  STF_ABS,
  STF_STEP,
  STF_RAMP
};

typedef struct stf_instruction {
  enum stf_operation operation;
  int place; /* of its name in the text */
  sunrealtype
    number;   /* value, exponent, or the breakpoint of step and ramp, and of abs, min and
                         max of what is linear in t (NaN: of others) */
  int rising; /* at the breakpoint: of t - c (1), of c - t (0) */
} stf_instruction;

typedef struct stf_program {
  stf_instruction *code;
  int length, depth; /* depth: series needed at once */
} stf_program;

enum { STF_SCRATCH = 4 }; /* series that run needs beyond the depth */

/* Where a text is from, for sentences. */
typedef struct stf_source {
  const char *name; /* a path, or NULL */
  long line;        /* 1, 2, ...; of a text: the number of the expression */
} stf_source;

/* Parse text[0 .. length-1] into code, which has room for `length + 1` instructions. */
int stf_program_parse(steif_context *ctx, const stf_source *source, const char *text,
                      size_t length, stf_program *program);
/* Series of order n at t in stack[0]; stack: depth + STF_SCRATCH series. NULL, or what failed;
 * *place is the instruction's place in the text. */
const char *stf_program_run(const stf_program *program, sunrealtype t, int n, stf_series *stack,
                            int *place);
/* What instruction k, an abs, min or max, asks the sign of at t: the argument, or the difference of the
 * two; NaN where it has no value. */
sunrealtype stf_program_switch(const stf_program *program, int k, sunrealtype t,
                               stf_series *stack);

/* ---- functions ------------------------------------------------------------------------------- */

typedef struct stf_samples {
  sunindextype count; /* of times */
  int points;
  sunrealtype t0, h;
  sunrealtype *value;   /* count x inputs by rows */
  sunrealtype *weights; /* points */
} stf_samples;

struct steif_function {
  steif_context *ctx;
  stf_pool *pool;
  sunindextype n, inputs; /* components of f and of u */
  stf_program *program;   /* one for each input */
  stf_source *source;
  stf_series *stack;
  sunrealtype *u;             /* values of the inputs; NULL when f = u */
  sunindextype *column, *row; /* B by columns */
  sunrealtype *entry;
  sunrealtype *breaks; /* ascending */
  size_t break_count;
  stf_samples samples; /* points > 0: instead of programs */
};

/* An empty function of n components with its pool; NULL with the message set. */
steif_function *stf_function_new(steif_context *ctx, sunindextype n);

/* f = B u from now on: inputs and u have the columns of B. */
int stf_function_input(steif_function *f, SUNMatrix B);

/* The inputs at t, by the samples; as steif_function_value. */
int stf_samples_value(steif_function *f, sunrealtype t, int derivative, sunrealtype *u);
/* Weights of the derivative d at x of the polynomial through the nodes 0 .. m-1. */
void stf_samples_weights(sunrealtype x, int m, int d, sunrealtype *weights);

#endif
