/* model.h: a model between its text and a steif_problem: what is declared,
 * blocks of equations, tapes. SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODEL_H
#define STF_MODEL_H

#include "syntax.h"
#include "tape.h"
#include <steif/initial.h>
#include <steif/parameters.h>

enum { STF_UNKNOWNS = 10000000, STF_PASSES_MOST = 100000000 };

enum stf_symbol_kind {
  STF_IS_NOTHING,
  STF_IS_PARAMETER,
  STF_IS_CONST,
  STF_IS_STATE,
  STF_IS_DISCRETE,
  STF_IS_LET,
  STF_IS_FUNCTION,
  STF_IS_TABLE,
  STF_IS_KINDS
};

typedef struct stf_symbol {
  uint8_t kind, visit; /* visit: 1 while its value is looked for, 2 afterwards */
  int32_t word, statement;
  int32_t which;  /* of its kind; a parameter that follows others has -1 */
  bool given;     /* a parameter: from outside */
  bool assigned;  /* a parameter that an event changes: kept in memory ... */
  int32_t memory; /* ... there */
  double value;   /* of parameters and constants */
  /* states */
  int32_t order, first[8]; /* derivatives that occur, at least 1; unknowns 0 .. order-1 */
  uint8_t differentiated;
  uint32_t slope_at; /* where its derivative occurs first */
  int32_t dims, low[STF_DIMENSIONS], count[STF_DIMENSIONS], size;
} stf_symbol;

/* A whole number that depends on loop counters. */
typedef struct stf_affine {
  int64_t c, s[STF_LOOPS];
} stf_affine;

typedef struct stf_binding {
  int32_t word;
  int32_t node; /* of an argument; -1: an index */
  stf_affine at;
} stf_binding;

/* An equation 0 = residual, or slope of its row = value. */
typedef struct stf_equation {
  int32_t statement;              /* -1: the velocity of an unknown */
  int32_t residual, value;        /* nodes; value -1: not explicit */
  int32_t forcing;                /* node of its part of g */
  bool own;                       /* explicit: the row of its unknown */
  int32_t row, stride[STF_LOOPS]; /* of each pass */
  int32_t *slot; /* rows of the passes where they are no multiples of counters */
} stf_equation;

/* A relation g < 0 whose truth is kept in memory and flipped at events. */
typedef struct stf_switch {
  int32_t g;                    /* node */
  int32_t a, stride[STF_LOOPS]; /* place in memory */
  uint32_t at; /* place in the text: g may have been computed elsewhere before */
  uint8_t on;  /* what g depends on */
  bool bare, negated,
    kink;      /* of an expression with "rising" and its like; said of -g; of abs, min, ... */
  int indices; /* bound there, for its name */
  stf_binding index[STF_LOOPS];
} stf_switch;

/* The value of a parameter that is given from outside. */
typedef struct stf_setting {
  char name[STF_NAME_BYTES + 1];
  double value;
} stf_setting;

/* Equations that share loops and a graph. */
typedef struct stf_block {
  stf_formulas graph;
  stf_box box;
  stf_vector equations; /* of stf_equation */
  stf_vector switches;  /* of stf_switch */
} stf_block;

/* Compiled code of a tape: what depends on parameters only is in `space`, slots are those of its stores. */
typedef void (*stf_code_of_tape)(double t, const double *y, const double *yp, const double *p,
                                 const double *memory, const double *space,
                                 const int32_t *const *slots, double *out);

/* One quantity of all blocks: f, F or the entries of a matrix. */
typedef struct stf_quantity {
  stf_vector tapes, spaces; /* stf_tape, double * */
  int64_t size;             /* outputs; 0: the caller has filled them, and tapes add */
  bool assigns, alone;      /* each output is written once; by one tape */
  stf_code_of_tape *code;   /* of each tape; NULL: the machine runs it */
  const int32_t *const **slots;
} stf_quantity;

typedef struct stf_matrix {
  stf_quantity quantity;
  sunindextype *column, *row; /* by columns */
  sunindextype entries;
  sunrealtype *scratch; /* entries, for dense storage */
} stf_matrix;

/* Of `data` and `fit`; path NULL, fitted 0: not told. */
typedef struct stf_measured {
  const char *path;
  int columns, fitted;
  bool log;
  const char **column;
  double *sd;         /* of each column; 0: not told */
  int32_t *parameter; /* words */
} stf_measured;

typedef struct stf_model {
  steif_context *ctx;
  stf_pool *pool;
  stf_vector settings; /* stf_setting: parameters that are given */
  stf_syntax syntax;
  stf_vector symbols;   /* stf_symbol */
  stf_vector symbol_of; /* int32_t by word: 1 + symbol; 0: none */
  stf_vector names;     /* const char *: declared */
  int32_t parameters, n, discretes, states;
  double *p;         /* parameters */
  stf_vector blocks; /* stf_block *; the first has no loops */
  int form, wished;  /* wished: form statement, or 0 */
  bool linear, autonomous;
  const char *why; /* why not a simpler form */
  stf_matrix A, E;
  stf_quantity f; /* f, F or g */
  stf_quantity events, invariants, outputs;
  stf_quantity output_slopes; /* along a direction; made at the first use */
  stf_feed feed;
  /* memory: discrete values, switches, timers */
  double *memory, *memory_start, *memory_literal;
  double t0, t1;          /* t1: infinite without `time` */
  uint8_t *constraint_of; /* statements: it is a constraint of the problem */
  bool constrained;
  int32_t memories, switches, timers, invariant_count, output_count, integrand_count;
  uint8_t *switch_used, *switch_open; /* switches; used: enum stf_use of reactions.h */
  stf_vector breaks;                  /* double */
  int break_count;                    /* of them inside the interval, sorted */
  stf_block *event_block;
  struct stf_reactions *reactions;
  steif_event *event_list;
  uint8_t *event_sort; /* enum stf_event_sort of reactions.h */
  double *event_values[2];
  double
    piece; /* time for which what depends on time alone stays as it is, half of it; infinite: not known */
  double *event_shift, *event_range; /* of each relation: see event_values.c */
  double *event_slope, slope_at; /* y' at the event at slope_at, for other forms than y' = f */
  stf_measured measured;
  steif_reference reference;
  sunindextype *reference_component;
  int *constraint;
  stf_lookup *lookups; /* tables, then three that belong to each: see table_wave.c */
  int32_t tables;
  sunrealtype *y0, *yp0;
  sunrealtype *slope; /* n: where `state x' = ...` begins to look for yp0; NULL: nowhere */
  uint8_t *start;     /* n: '=', '~' or 0 */
  char moved[600];    /* guesses that the start found is away from; "": none */
  int32_t *owner;     /* n: symbol of each unknown */
  const char **unknown, **equation;
  steif_names problem_names;
  stf_sweep sweep;
  stf_vector partials;
  steif_parameters given; /* those that are no whole numbers: the first of p */
  const char **parameter_name;
  const char *varying; /* a discrete value that depends on y, t or p; NULL: none does */
  double *break_slope; /* of each break by each parameter in `given`; NULL: not asked for yet */
  struct stf_products *products;
  struct stf_integrands *integrands; /* NULL: none */
  void *library;                     /* of compiled code; NULL: none */
} stf_model;

static inline stf_symbol *stf_symbol_at(const stf_model *m, int32_t i)
{
  return STF_AT(m->symbols, stf_symbol, i);
}
static inline const stf_statement *stf_statement_at(const stf_model *m, int32_t i)
{
  return STF_AT(m->syntax.statements, stf_statement, i);
}
static inline const char *stf_named(const stf_model *m, int32_t word)
{
  return stf_word_text(&m->syntax.words, word);
}
/* The symbol of a word; NULL: it is not declared. */
stf_symbol *stf_symbol_of(const stf_model *m, int32_t word);

/* declare.c: symbols, values of parameters (those of m->settings and of the spec), sizes, numbers of
 * unknowns. */
int stf_declare(stf_model *m, const steif_spec *spec);
/* Is the value of a statement made of numbers alone? */
bool stf_literal(const stf_model *m, const stf_statement *s);
/* A value among those that are given, in place of the former one of that name. */
int stf_setting_add(steif_context *ctx, stf_vector *settings, const char *name, double value);
int stf_number_unknowns(stf_model *m);
/* check.c: every name that is used is known. */
int stf_check_names(stf_model *m);
/* Is the word an index of a sum in the expression? */
bool stf_summed(const stf_model *m, const stf_expression *e, int32_t word);
/* What names of other languages are here: dx for the derivative of a state x, functions and constants; NULL: nothing
 * known. */
const char *stf_elsewhere(const stf_model *m, const char *name, char *room, size_t size);
/* Complaints: the name alone on the left of an equation is not declared; the name of a call is no function. */
int stf_undeclared(stf_model *m, const stf_code *c, const char *name);
void stf_no_function(stf_model *m, const stf_statement *s, const stf_code *c,
                     const stf_symbol *f);

/* builder.c: expressions into nodes. */
typedef struct stf_builder {
  stf_model *m;
  stf_formulas *g;
  bool numeric;      /* parameters are numbers and there are no unknowns but those
                   that have started */
  bool events;       /* relations are frozen between events, unless `literal` */
  bool times;        /* ... those of time alone too */
  bool clock;        /* there is time alone: when a condition changes must be known */
  bool kink;         /* the relation is that of a kink */
  bool bare, turned; /* what a switch that is made now says of itself */
  int literal;
  stf_block *block;                                    /* of switches */
  int32_t range_low[STF_LOOPS], range_high[STF_LOOPS]; /* of its counters */
  stf_vector switch_of;                                /* 1 + switch of each node g */
  stf_vector turns;                         /* g of kinks at unknown times, int32_t */
  bool fallback;                            /* an index needs its passes one by one */
  int dims;                                 /* loops whose counters stand in indices */
  int32_t low[STF_LOOPS], high[STF_LOOPS];  /* passes in which all indices exist */
  const uint8_t *started;                   /* n; NULL: none */
  stf_vector stack, frames, bindings, memo; /* memo: 1 + node of each symbol */
} stf_builder;
/* event_pieces.c: something changes where x, of time alone, has moved on by `size`; the least distance of nodes. */
void stf_note_piece(stf_builder *b, int32_t x, double size);
double stf_lookup_spacing(const stf_lookup *l);
int stf_builder_open(stf_builder *b, stf_model *m, stf_formulas *g, bool numeric);
void stf_builder_close(stf_builder *b);
int stf_bind_node(stf_builder *b, int32_t word, int32_t node);
int stf_bind_index(stf_builder *b, int32_t word, const stf_affine *at);
int stf_build(stf_builder *b, const stf_expression *e, int32_t *node);
/* A number now: of parameters, constants and bound indices. */
int stf_value(stf_builder *b, const stf_expression *e, double *value);
/* elements.c: an index, and what an element stands for: a leaf or an expression
 * to be entered. */
int stf_index(stf_builder *b, const stf_expression *e, uint32_t at, stf_affine *index);
int stf_element(stf_builder *b, const stf_code *c);
int stf_state_leaf(stf_builder *b, const stf_symbol *s, int primes, const stf_affine *component,
                   uint32_t at);
/* of builder.c, for elements.c: an expression in a scope of its own; memo:
 * symbol or -1. */
int stf_enter(stf_builder *b, const stf_expression *e, int32_t memo, size_t scope);
size_t stf_scope(const stf_builder *b);
int stf_push_node(stf_builder *b, int32_t node);

/* switches.c: relations and functions with kinks or jumps. */
int32_t stf_relation(stf_builder *b, int kind, int32_t left, int32_t right);
/* The table `which` of node x, with breaks and events where it has kinks or jumps; -1: no memory. */
int32_t stf_table_value(stf_builder *b, int32_t x, int32_t which);
/* table_wave.c: made at the first use; STEIF_NO_MEMORY. */
int stf_table_wave(stf_model *m, int32_t which);
int32_t stf_kinked(stf_builder *b, int kind, int32_t a, int32_t c);
/* loops.c: the equations. */
int stf_build_blocks(stf_model *m);
/* form.c: explicit rows, the form, rows of the others. */
int stf_deduce_form(stf_model *m);
/* The value of a node that depends on parameters only. */
int stf_fixed_value(stf_model *m, const stf_formulas *g, int32_t node, double *value);
/* counting.c: as many equations as unknowns, each with one of its own; taken_by: rows that are explicit. */
int stf_count_equations(stf_model *m, const int32_t *taken_by);
/* blame.c: why row `row` of f or F has no value. */
typedef struct stf_blame {
  uint32_t at;
  char what[400];
} stf_blame;
bool stf_find_blame(stf_model *m, const stf_feed *feed, int32_t row, stf_blame *blame);
/* matrices.c: tapes of f and the matrices. */
int stf_build_tapes(stf_model *m);
/* quantity.c */
int stf_compile_quantity(stf_model *m, const stf_block *block, const stf_vector *stores,
                         stf_quantity *q);
void stf_quantity_run(const stf_model *m, const stf_quantity *q, const stf_feed *feed,
                      double *out);
/* What parameters determine, anew. */
void stf_quantity_prepare(const stf_model *m, const stf_quantity *q);
/* All tapes are there: how many outputs they write. */
int stf_quantity_close(stf_model *m, stf_quantity *q, int64_t size);
void stf_quantity_free(const stf_model *m, stf_quantity *q);
/* starts.c: start values. */
int stf_build_start(stf_model *m);
/* The names of the indices of a state statement, bound to those of element k. */
int stf_bind_element(stf_builder *b, const stf_statement *said, const stf_symbol *s, int32_t k);
/* problem.c of this room */
int stf_name_unknowns(stf_model *m);
/* equation_names.c: of models that are not large; of others they are NULL. */
int stf_name_equations(stf_model *m);
/* fulfilled_start.c */
enum steif_attribute stf_kind_of_start(const stf_model *m, size_t i);
/* t1 - t0, or 1 where the text has no `time`. */
double stf_span(const stf_model *m);
/* A number of parameters and constants only; the failure is told. */
int stf_number_of(stf_model *m, const stf_expression *e, double *value);
/* extras.c: breaks, reference, invariants, constraints. */
int stf_build_constraints(stf_model *m);
/* measured.c: what is said of measurements. */
int stf_find_measured(stf_model *m);
int stf_finish(stf_model *m, steif_problem *problem);
/* m->output_slopes is there. */
int stf_output_slopes(stf_model *m);
/* The unknown that a statement names, "u[3]" or "x'". */
int stf_component(stf_model *m, stf_builder *b, const stf_statement *s, int32_t *component);
/* fulfilled_start.c: start values that fulfil the equations, and the index. */
int stf_consistent_start(stf_model *m, steif_problem *problem);
struct steif_request;
struct steif_start;
/* sought_start.c: the start from a guess, with conditions that hold at it; m's are as they are there, or lost. */
int stf_start_near(stf_model *m, const steif_problem *problem,
                   const struct steif_request *request, const sunrealtype *from,
                   struct steif_start *start);
/* The same from m->y0, or from guesses near it. STEIF_BAD_INPUT where values after '=' would have to move. */
int stf_sought_start(stf_model *m, const steif_problem *problem,
                     const struct steif_request *request, struct steif_start *start);
/* other_start.c: rejects guesses between two solutions about as near, of which y is one; says so of components
 * without a guess. */
int stf_other_start(stf_model *m, const steif_problem *problem,
                    const struct steif_request *request, const sunrealtype *y);
/* table_file.c */
int stf_read_tables(stf_model *m);
/* given_parameters.c: members of the problem about its parameters. */
int stf_parameter_members(stf_model *m, steif_problem *problem);
/* model_problem.c: relations as they are at the point of the feed. */
void stf_take_literally(const stf_model *m, stf_feed *feed);
/* Members and callbacks. */
int stf_model_fill(stf_model *m, steif_problem *problem);
/* An empty model, without statements. */
int stf_model_new(steif_context *ctx, stf_model **model);
void stf_model_free(stf_model *m);
/* native.c: compiled code is given up. */
void stf_native_free(stf_model *m);
/* model_file.c: the same text with another value of one parameter; stf_model_close ends it. */
int stf_model_moved(const stf_model *m, const char *name, double value, steif_problem *problem);

#endif
