/* method.h: the method room inside: what a family of methods provides, and the running state.
 *
 * An attempt is pure: attempt(s, h) reads accepted history and writes trial vectors only (s->next,
 * s->error, trial parts of the private state); another attempt simply overwrites them. commit alone
 * turns the trial into history; it leaves the new solution in s->y. Factors and Jacobians are not
 * history.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_METHOD_H
#define STF_METHOD_H

#include "newton.h"
#include <steif/method.h>
#include <steif/solver.h>

typedef struct stf_step stf_step;

/* The rest of an interval that constant steps leave: one shorter step; a whole step across the end, and
 * dense output of the order of the method; or there is no way. */
enum stf_rest { STF_REST_SHORTER, STF_REST_ACROSS, STF_REST_NONE };

enum stf_trait {
  STF_ADAPTIVE = 1,     /* fills s->error */
  STF_MULTISTEP = 2,    /* keeps history: steps given at open */
  STF_EXPLICIT = 4,     /* needs neither matrices nor, for given steps, weights */
  STF_SEMILINEAR = 8,   /* the matrix is the constant linear part of a semilinear problem */
  STF_UNCORRECTED = 16, /* nothing corrects the rounding of its linear solves */
  STF_VARYING_MASS =
    32 /* takes M(t, y) y' = f(t, y) although it does not take F(t, y, y') = 0 */
};

/* Where a family takes its coefficients from: the tables of one kind. Its specs are PREFIX:TABLE, or TABLE
 * alone where there is no prefix. */
typedef struct stf_tables {
  enum steif_table_kind kind;
  const char *prefix, *example; /* example: for those who leave the table out */
} stf_tables;

/* A spec for the list of methods, which ascends in `place`, from 0 to STF_PLACES - 1. */
enum { STF_PLACES = 10 };
typedef struct stf_example {
  const char *spec;
  int place;
} stf_example;

/* What a method says of its error and proposes for the length of steps, filled in by open, attempt and
 * commit. The integrator alone decides on it. */
typedef struct stf_control {
  sunrealtype tolerance;    /* of the norm of s->error */
  int order;                /* q: s->error = O(h^(q + 1)) */
  sunrealtype safety;       /* h_next = safety (tolerance / error)^(1/(q + 1)) h ... */
  sunrealtype shrink, grow; /* ... within these factors of h ... */
  sunrealtype keep; /* ... and h where the factor lies in 1 .. keep: matrices stay factored */
  sunrealtype bias; /* > 1: of the error after a rejection, instead of safety */
  sunrealtype next; /* > 0: factor of h for the next step, instead of all these */
  sunrealtype
    between; /* estimated error between the ends of the step over what it may be there; 0: not known */
  sunrealtype rate;  /* of what is between, where one step does not show it (between.c) */
  sunrealtype retry; /* > 0: factor of h after STEIF_RETRY, for one attempt */
  sunrealtype
    accumulated; /* what is remembered of the errors of all steps, growth taken out, in tolerances; 0: not known */
  sunrealtype reached; /* the same with growth: the error at the end of the last step */
} stf_control;
/* The usual one, but for tolerance and order. */
extern const stf_control stf_control_usual;

/* How a family carries derivatives by parameters through its steps (carry.h). */
struct stf_carry;
typedef struct stf_carrier_size {
  int points; /* where matrices are made in a step */
  int stages; /* solved for together */
  int kept,
    trial; /* vectors of a column that are kept, and that an attempt fills; equal without commit */
  int missed; /* and where the start of the sweeps learns from the last: stages, else 0 */
} stf_carrier_size;
typedef struct stf_carrier {
  int (*check)(const stf_step *s); /* NULL: all that the family takes is served */
  stf_carrier_size (*size)(const stf_step *s);
  int (*open)(struct stf_carry *T); /* claims what else it needs; NULL: nothing */
  /* From T->S to T->next through the attempt just made, whose stages are there; with adaptive steps T->error
   * and T->tolerance too. */
  int (*carry)(struct stf_carry *T, sunrealtype h);
  /* r_k := M^{-1} r_k, M in factors for the step h; M made anew at (t, Y, Yp). NULL where nothing is solved. */
  int (*apply)(stf_step *s, sunrealtype h, int count, N_Vector *const *r,
               N_Vector *const *other);
  int (*renew)(stf_step *s, sunrealtype t, sunrealtype h, N_Vector Y, N_Vector Yp);
  void (*commit)(struct stf_carry *T); /* NULL: S <- next, kept <-> trial */
  int (*dense)(struct stf_carry *T, int k, sunrealtype t, N_Vector S);
} stf_carrier;
/* apply and renew of families that use s->newton. */
int stf_newton_carry_apply(stf_step *s, sunrealtype h, int count, N_Vector *const *r,
                           N_Vector *const *other);
int stf_newton_carry_renew(stf_step *s, sunrealtype t, sunrealtype h, N_Vector Y, N_Vector Yp);

/* The step just committed, as its transpose needs it. */
enum stf_trace_kind { STF_TRACE_COLLOCATION, STF_TRACE_CHAIN, STF_TRACE_BDF };
typedef struct stf_trace {
  enum stf_trace_kind kind;
  N_Vector *Y, *Yp; /* chains of the table's stages: F(t_i, Y_i, Yp_i) = 0 */
  int order;        /* BDF: h y'(t) = sum of alpha_j past_j over j <= order, past_0 = y ... */
  const sunrealtype *alpha;
  N_Vector *past;
  const sunrealtype *t; /* their times */
  N_Vector between;     /* ... or two halves with this in the middle; NULL: one step */
} stf_trace;

typedef struct steif_method {
  const char *about;
  unsigned forms, traits;
  /* How users call it. Is a spec of this name one of the family's? NULL: those of `tables` only; variants
   * have neither. Examples 0, 1, ... are listed, .spec NULL past the end; tables are listed without. */
  bool (*owns)(const char *name);
  const stf_tables *tables;
  stf_example (*example)(size_t i);
  /* The family that is to make the steps of this opened system; NULL: this one. */
  const struct steif_method *(*variant)(const stf_step *s);
  size_t size; /* private state, zeroed by the frame */
  int (*open)(stf_step *s, const steif_spec *spec, const steif_table *table);
  int (*attempt)(stf_step *s, sunrealtype h); /* STEIF_RETRY: try a smaller h */
  void (*commit)(stf_step *s);
  /* y(t) inside the last step, from what was committed; or, of families whose dense output evaluates f, by
   * the other slot. */
  int (*dense)(const stf_step *s, sunrealtype t, N_Vector y);
  int (*dense_by_f)(stf_step *s, sunrealtype t, N_Vector y);
  int (*stages)(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
                N_Vector **X); /* NULL: none */
  /* The same of an attempt that has succeeded, before its commit. */
  int (*trial)(const stf_step *s, int *count, const sunrealtype **c, const sunrealtype **b,
               N_Vector **X);
  /* All of the private state that later steps, dense output and stages depend on, part by part (image.h),
   * but what stf_step, system and newton hold. NULL: runs cannot be saved. */
  void (*keep)(stf_step *s, stf_image *m);
  /* r and M(z), r x r pairs by rows; M NULL: r only. NULL: steps are no function of z. */
  int (*propagator)(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                    const sunrealtype z[2], int *r, sunrealtype *M);
  /* order, stages, claims of *info from the spec, and refusal of bad parameters. */
  int (*describe)(steif_context *ctx, const steif_spec *spec, const steif_table *table,
                  steif_method_info *info);
  /* The method as a general linear one; NULL: that of its table, or none. */
  int (*general)(steif_context *ctx, const steif_spec *spec, steif_glm *glm);
  const stf_carrier *carrier; /* NULL: derivatives by parameters are not carried */
  /* NULL: gradients are not pulled back. Of an opened step without a past, only the kind. */
  int (*trace)(const stf_step *s, stf_trace *trace);
} steif_method;

struct stf_step {
  steif_context *ctx;
  stf_pool *pool;
  const steif_problem *problem;
  const steif_options *options;
  const steif_method *method;
  void *state;
  steif_table *table; /* of this method; NULL for multistep */
  stf_system system;
  stf_newton newton;
  sunrealtype t0, t, h; /* start; time of y; length of the last step (0: none yet) */
  sunrealtype h_equal;  /* > 0: all steps have this length */
  enum stf_rest rest;   /* said by open */
  long count;           /* accepted steps */
  N_Vector y, yp;       /* accepted; yp: slope (start, or last implicit slope) */
  /* absolute: stages solved for Y, not for Y - y_n: what rounding makes of E (Y - y_n)/h does not matter to the limits
   * that prescribed steps show, and spoils algebraic unknowns in short ones where constraints are mixed into rows of E. */
  bool yp_known, adaptive, absolute;
  bool rejected;          /* this attempt repeats one that was refused ... */
  int tries;              /* ... this many times */
  bool restart;           /* the next step follows a discontinuity: no history before t */
  bool crossed;           /* ... at a time that depends on y: errors move it, and jump there */
  bool end_slope_known;   /* stf_hermite has the slope at the end of the last step */
  sunrealtype h_try;      /* of the trial */
  sunrealtype error_norm; /* of error; < 0: not known. Methods that know it set it */
  N_Vector next, error, weights;
  stf_control control;     /* what the attempt says of `error` */
  long factors, solves;    /* made by a family without the pencil */
  struct stf_carry *carry; /* derivatives by parameters; NULL: none */
  int undamped;            /* attempts of this step rejected for undamped components */
  sunrealtype undamped_start, undamped_end; /* their deviations there, in tolerances */
  const char
    *no_multipliers; /* of a method that does not find those of index 3, its name; else NULL */
};

typedef struct stf_method_entry {
  const char *name;
  const steif_method *item;
} stf_method_entry;
extern const stf_method_entry stf_method_shelf[];
extern const size_t stf_method_count;

/* Solve stages with the factors at hand: prepares them, renews a stale Jacobian, and repeats a
 * refused solve with a new Jacobian and Z = 0, and when the step is given once more with a new
 * Jacobian in every iteration, before giving up. */
int stf_solve_stages(stf_step *s, const stf_stages *stages);

/* Variants: collocation with all shifts in vector lanes, where `serves` is true of the opened system, and BDF
 * with chosen steps. */
bool stf_interleaved_serves(const stf_step *s);
extern const steif_method steif_method_irk_interleaved;
extern const steif_method steif_method_bdf_adaptive;
/* Of Rosenbrock methods, with y' as an unknown of its own. */
extern const steif_method steif_method_rosenbrock_slopes;
struct stf_rodas;
int stf_rodas_inside(const stf_step *s, const struct stf_rodas *r, sunrealtype t,
                     N_Vector before, N_Vector end, N_Vector *u, N_Vector y);
/* Collocation, which starting procedures use. */
extern const steif_method steif_method_irk;

/* The largest eigenvalues of J by six steps of power iteration with J^2 from v, which is overwritten
 * with w and work: omega if they are near +-i omega, for J^2 v = -omega^2 v whatever the norm, else 0.
 * Of the ode form and the matrices at hand. */
int stf_oscillation(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *omega);

/* The spectral radius of J, by the same power iteration; is an eigenvalue of that size real? */
int stf_spectral_radius(stf_step *s, N_Vector v, N_Vector w, N_Vector work, sunrealtype *radius,
                        bool *real);

/* step_image.c: what the method in use remembers, and the step with its system; stf_step_keep before. */
void stf_method_keep(stf_step *s, stf_image *m);
void stf_step_keep(stf_step *s, stf_image *m);

/* Stages of order 1 beside others have unknowns of index 2 and 3 to a few digits only (Hairer and Wanner, Solving ODEs II,
 * VII.4). */
static inline bool stf_low_stages(const steif_table *T)
{
  return T && T->stage_order < 2 && T->s > 1;
}
/* Does the method in use find the multipliers of the index that s->problem has now (error/error_estimate.c)? */
int stf_check_mode_index(const stf_step *s);

/* y <-> next. */
void stf_swap(stf_step *s);

/* Forms y' = f(t, y) and M y' = f(t, y): df/dt at (t_n, y_n) by differences inside a step of length
 * h, from f there; `work` is lost. Nothing is done where the problem is autonomous. */
int stf_slope_in_time(stf_step *s, sunrealtype h, N_Vector f, N_Vector slope, N_Vector work);

/* y = the cubic through both ends of the last step of y' = f(t, y) with their slopes; that of the
 * end, f(t, y), is made in `end` the first time. */
int stf_hermite(stf_step *s, sunrealtype t, N_Vector before, N_Vector slope, N_Vector end,
                N_Vector y);

/* propagator, or the sentence that there is none. */
int stf_propagate(steif_context *ctx, const steif_method *method, const steif_spec *spec,
                  const steif_table *table, const sunrealtype z[2], int *r, sunrealtype *M);
/* One r x r complex number as a propagator. */
void stf_propagate_scalar(const sunrealtype R[2], int *r, sunrealtype *M);

/* Weights of differentiation at node 0 of the polynomial through nodes 0 .. k (distinct): a[j],
 * and of its value at x (value may be NULL). */
void stf_differentiate(int k, const sunrealtype *node, sunrealtype *a);
void stf_interpolate(int k, const sunrealtype *node, sunrealtype x, sunrealtype *value);

#endif
