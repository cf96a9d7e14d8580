/* integrator.h: the march room inside: the solver object, step control and the list of methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MARCH_H
#define STF_MARCH_H

#include "agree.h"
#include "engine.h"
#include "event.h"
#include "method.h"
#include "repair.h"
#include "consistent_start.h"
#include <steif/krylov.h>

typedef struct stf_switching stf_switching;
typedef struct stf_rounding stf_rounding;
typedef struct stf_saltation stf_saltation;
typedef struct stf_quadratures stf_quadratures;

/* Constant steps h from t0: `whole` of them end at `end`, `rest` > 0 before t1, or at t1 with rest 0. */
typedef struct stf_constant {
  long whole;
  sunrealtype t0, h, rest, end;
} stf_constant;
int stf_constant_steps(steif_context *ctx, sunrealtype h, sunrealtype t0, sunrealtype t1,
                       stf_constant *constant);

/* Where the last look at the pace of a run was taken. */
typedef struct stf_pace {
  long steps, rejected; /* steps: of the next look */
  sunrealtype t;
} stf_pace;

struct steif_solver {
  steif_context *ctx;
  stf_pool *pool;
  const steif_problem *problem, *given; /* given: before the start was repaired */
  steif_problem
    whole; /* the caller's, where his header had a shorter one, or with what was found */
  bool pattern_found;
  const char *spec;           /* as the caller wrote it */
  sunrealtype t1_opened;      /* t1 at first: it may have been extended */
  steif_spec parsed;          /* that of the method in use; of auto its first choice ... */
  const char *chosen;         /* ... which is this; NULL: not auto */
  const steif_method *family; /* before a variant of it took over, and its state */
  void *family_state;
  N_Vector own[2];      /* y and next of the step, which methods exchange with others */
  stf_pool_mark opened; /* what was claimed later belongs to one start */
  steif_problem again;  /* the problem from the last restart on */
  unsigned long long fingerprint; /* of y, y', E and A at the start; 0: not known */
  bool inside;                    /* of a step whose events are being looked at */
  steif_problem semilinear;       /* the problem with its linear part as the matrix */
  const steif_problem *lowered;   /* with an M that varies, as F = 0; NULL: there is none */
  bool mass_of_time;              /* an engine takes M(t) itself */
  stf_repair repair;     /* of its start; the problem in use is its copy where one was made */
  steif_options options; /* complete */
  sunrealtype t1;
  N_Vector serial, shown, dense,
    atols;             /* serial: our own prototype vector, if none was given */
  sunrealtype *floors; /* atols / rtol; NULL without atols */
  sunrealtype t_shown;
  sunrealtype end;      /* the solution is known up to here */
  stf_detector *events; /* of events; NULL: none */
  bool observed;        /* stf_observed */
  bool watched;         /* every step is shown to someone */
  long stretch;         /* steps that an engine makes between two looks at the limits */
  bool finished;        /* by an event */
  bool
    settles; /* unknowns of index 2 over ranks, which have fewer digits in steps, where they are shown */
  bool observer_stopped,
    observer_failed;          /* the observer wishes to stop, and has failed itself */
  stf_step step;              /* a method of ours ... */
  stf_switching *switching;   /* of `auto`, which may change to another; NULL: it will not */
  const steif_engine *engine; /* ... or a baseline */
  void *engine_state;
  stf_run run;
  stf_constant constant; /* h = 0: other steps */
  N_Vector final;        /* at t1, where the last step goes beyond; else NULL */
  long rejected;         /* refused attempts */
  long mesh_at;          /* given steps: intervals of the mesh or grid left behind */
  int next_break;
  sunrealtype h_next, h_old, h_tried, error_old; /* chosen steps */
  bool after_reject, failed;
  stf_pace pace;
  bool constrained;             /* some component has a sign to keep */
  int constraint_moves;         /* steps in a row that a constraint has moved */
  stf_rounding *rounding;       /* of runs near it; NULL: not followed */
  sunrealtype rounded;          /* in tolerances */
  stf_saltation *saltation;     /* derivatives through events and breaks; NULL: none */
  stf_quadratures *quadratures; /* NULL: none */
  stf_start_nodes nodes;        /* of what is recomputed */
  sunrealtype drift, corrected; /* of the solution shown, recomputed; NaN: it was not */
  stf_deferred deferred;        /* and what its callbacks returned */
  bool limit[2], limits_known;  /* stop, late: as ranks agreed at the end of the last step */
  long agreements;              /* sums made to agree */
  struct stf_agreed *agreed;    /* of vectors spread over ranks; NULL: they are not */
  int failure;
  char why[400];               /* the sentence of the failure */
  sunrealtype *invariants;     /* at the start, then room for as many */
  sunrealtype cpu_s, cpu_from; /* of calls before, and when the present one began ... */
  bool running;                /* ... if there is one */
  steif_stats stats;
  steif_krylov_stats krylov;
  char method[240]; /* spec in use; for auto with the reason */
};

/* The structs of the caller, in the solver where his are shorter or longer than ours; and the vectors by which ranks
 * agree before that. */
int stf_take_given(steif_solver *s, const steif_problem *problem, size_t problem_bytes,
                   const steif_options *options, size_t options_bytes);
N_Vector stf_given_like(const steif_problem *p, size_t problem_bytes, const steif_options *o,
                        size_t options_bytes);

/* sizes.c: the caller's struct of so many bytes as one of ours, `own` bytes, in `room`; 0: as in our header.
 * STEIF_UNSUPPORTED: members that we do not know are set. */
int stf_whole(steif_context *ctx, const char *name, const void *given, size_t bytes, size_t own,
              void *room);
/* The same, *whole being the caller's where it is as long as ours, else `room`; NULL stays. */
int stf_whole_problem(steif_context *ctx, const steif_problem *given, size_t bytes,
                      steif_problem *room, const steif_problem **whole);
/* STEIF_BAD_INPUT where one of them is not 0. */
int stf_reserved_check(steif_context *ctx, const char *name, size_t count,
                       void *const *reserved);
#define STF_COUNT(array) (sizeof(array) / sizeof *(array))

/* opening/pattern.c: a pattern for a sparse problem without Jacobian and pattern, by steif_pattern_find; and in the
 * method's name. */
int stf_look_at_pattern(steif_solver *s);
void stf_tell_pattern(steif_solver *s);

/* opening/looks.c, before a method is opened. Without .dae_index the highest of .index is it. */
int stf_look_at_index(steif_solver *s);
/* An M(t) or M(t, y) of M y' = f is looked for: s->problem becomes
 * F(t, y, y') = 0 and *form that, or the engine is told, or STEIF_UNSUPPORTED. */
int stf_look_at_mass(steif_solver *s, int *form, N_Vector y, N_Vector yp);
/* stf_repair_start, and the jump of a linear system. */
int stf_start_repaired(stf_repair *repair);
/* The start of a DAE, for methods of ours with adaptive steps. */
int stf_look_at_start(steif_solver *s, int form);
/* STEIF_SINGULAR: the constant pencil of a DAE is singular at every shift; for steps that are given, since others come
 * with that look at the start. */
int stf_look_at_pencil(steif_solver *s, int form);
int stf_look_at_orders(steif_solver *s);
/* STEIF_UNSUPPORTED: steps pass over breaks where problem.project has to find unknowns of index 2 and more. */
int stf_look_at_breaks(steif_solver *s);

/* Defaults filled in; STEIF_BAD_INPUT names the option that cannot be. `rows`: of absolute tolerances. */
int stf_options_complete(steif_context *ctx, const steif_problem *p, steif_options *o,
                         sunindextype rows);

/* ranks/agreed_calls.c: problem and options checked, the same on all ranks; where vectors are spread over several ranks,
 * they become copies whose callbacks return the same code on all of them. */
int stf_agreed_open(steif_solver *s, const char *method, int *form);
/* While it is made: before sums that follow allocations, of which one may have failed somewhere. */
int stf_agreed_gate(steif_solver *s);
/* The user of options.ewt. */
void *stf_ewt_user(const steif_solver *s);
/* A call of `what` that is given t, and which rank has found wrong with `code`: the same on all. */
int stf_agreed_begin(steif_solver *s, int code, const char *what, sunrealtype t);
/* The code of all ranks at the end of a call or step, with the rank that failed. */
int stf_agreed_end(steif_solver *s, int code);
/* That rank in the sentence, if it names none. */
void stf_agreed_tell(steif_solver *s, int code);

/* One accepted step of a method of ours, not beyond t_stop where step sizes are adaptive: breaks.c, which
 * looks at limits and breaks, and control.c, which decides on step sizes. */
int stf_advance(steif_solver *s, sunrealtype t_stop);
int stf_adaptive_step(steif_solver *s, sunrealtype t_stop);
/* Did a run end since its events crowd together? */
bool stf_event_crowded(const steif_solver *s);
/* Where a run is asked for its solution: STEIF_NOT_CERTIFIED if the errors of low orders have grown since they
 * were made. The run may go on. */
int stf_check_reached(const steif_solver *s);
int stf_fixed_step(steif_solver *s);
/* sliding.c, when step.count has come to pace.steps: STEIF_STEP_SIZE where most steps are rejected, the run would
 * not end within max_steps, and a corner of f or F lies within the tolerance. */
int stf_corner_check(steif_solver *s);

/* All that depends on the start, which is in s->step.y: opened after the system of equations, and again by
 * a restart. */
int stf_run_begin(steif_solver *s);
/* What becomes of the rest of the interval, t1: a shorter step, a whole one across t1, whose place s->final then
 * is; or STEIF_BAD_INPUT. */
int stf_rest_open(steif_solver *s, const stf_constant *constant, sunrealtype t1);

/* Is there more to do after a step than to go on? */
bool stf_observed(const steif_solver *s);

/* Constraints: kept at the start, and s->constrained: there are any; kept by the trial, which may be moved within the
 * tolerance: STEIF_RETRY asks for a smaller step. */
int stf_constraint_open(steif_solver *s);
int stf_constraint_keep(steif_solver *s, sunrealtype h, int tries);

/* s->rounding where it may matter; after a step, what has become of rounding errors. */
int stf_rounding_open(steif_solver *s);
int stf_rounding_step(steif_solver *s);
/* What this has cost. */
void stf_rounding_count(const steif_solver *s, steif_stats *sum);
void stf_rounding_keep(steif_solver *s, stf_image *m);

/* output/recomputed.c: are unknowns of index 2 and 3 recomputed for output; that of the solution shown. */
bool stf_recomputes(const steif_solver *s);
bool stf_recomputes_at(const steif_solver *s, sunrealtype t);
int stf_recompute_shown(steif_solver *s);
/* y at t, and y', on the constraints of the mode behind an event: dense output is off them by a tolerance, which short
 * steps would divide by h, and unknowns of index 2 and 3 without a derivative belong to the mode before. *known: they
 * are found, all others stay within some tolerances and no index is another one; else y is left alone. */
int stf_recompute_mode(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, bool *known);
/* output/settled.c: does problem.project put y in its place; y at t; that of the step behind a break; where s->settles,
 * what is shown at t_shown; and to the observer, at the end of a step. */
bool stf_settled_by(const steif_solver *s);
/* t on that side of a break where the step lies that shows it. */
sunrealtype stf_side(const steif_solver *s, sunrealtype t);
int stf_settle(const steif_solver *s, sunrealtype t, N_Vector y);
int stf_settle_break(steif_solver *s);
int stf_settle_shown(steif_solver *s);
int stf_settle_observed(steif_solver *s);
/* events/modes.c: y at t, where a mode of a DAE begins, behind an event or a break: put where its equations hold, and
 * y' too where it is *known; the index of the mode is that of s->problem from then on. */
int stf_mode_place(steif_solver *s, sunrealtype t, N_Vector y);
int stf_mode_begin(steif_solver *s, sunrealtype t, N_Vector y, N_Vector yp, bool *known);
/* y where it will be put when the mode begins. */
int stf_mode_show(steif_solver *s, sunrealtype t, N_Vector y);
int stf_mode_exactly(steif_solver *s, sunrealtype t, N_Vector y);
/* sensitivity/saltation.c: S+ through that jump, from y (n values) behind the reaction; and where y moves by errors alone. */
int stf_saltation_place(steif_solver *s, const sunrealtype *y);
int stf_saltation_recompute(steif_solver *s, const sunrealtype *y);
void stf_mode_keep(steif_solver *s, stf_image *m);
/* breaks.c: at a break, before the next step, what holds after it is shown. */
int stf_break_shown(steif_solver *s);
/* What y_j may err by. */
sunrealtype stf_allowed(const steif_solver *s, const sunrealtype *y, size_t j);

/* Derivatives by parameters, where options.sensitivities asks for them. */
int stf_sensitivity_open(steif_solver *s);
/* Derivatives of F that carry S, once more in the second half of a run (probe.h). */
int stf_probe_later(steif_solver *s);
/* engine_columns.c: the same of an engine that carries them. */
int stf_engine_carry(steif_solver *s);
int stf_engine_carried(steif_solver *s, sunrealtype t, int k, N_Vector dy);
/* probe_starts.c: STEIF_BAD_INPUT where dy0/dp_k of y' = f is given, and is not the derivative of problem.start. */
int stf_probe_start(steif_context *ctx, const steif_problem *p, int k, N_Vector given);
/* saltation.c: them through events and breaks, s->saltation, where there are any. Another event has come, at t; before
 * handle_event is called there; after it, when the run restarts; and when the next step begins. Before and after break i. */
int stf_saltation_open(steif_solver *s);
void stf_saltation_forget(steif_solver *s, sunrealtype t);
int stf_saltation_before(steif_solver *s, sunrealtype t);
int stf_saltation_after(steif_solver *s, sunrealtype t);
void stf_saltation_renew(steif_solver *s);
int stf_saltation_break(steif_solver *s, int i);
int stf_saltation_broken(steif_solver *s);

/* quadrature.c: s->quadratures where the problem has some; what the last step adds up to s->end; and before and after
 * an event at t whose time has these derivatives. */
int stf_quadrature_open(steif_solver *s);
int stf_quadrature_step(steif_solver *s);
int stf_quadrature_to(steif_solver *s, sunrealtype t);
/* The larger of *e and their errors in the attempt, in tolerances. */
int stf_quadrature_test(steif_solver *s, sunrealtype h, sunrealtype *e);
/* *i: an integrand that is another where y_j moves by a part of its size, -1: none; j = -1: all of index 2 and 3. */
int stf_quadrature_reads(steif_solver *s, sunrealtype t, N_Vector y, sunindextype j, int *i);
/* unfit_integrands.c: STEIF_UNSUPPORTED where an integrand reads what the method knows badly, or at a jump of y at t what has
 * an impulse there. */
int stf_quadrature_orders(steif_solver *s);
int stf_quadrature_impulses(steif_solver *s, sunrealtype t, N_Vector y, const bool *algebraic,
                            const int *index);
int stf_quadrature_before(steif_solver *s, sunrealtype t, N_Vector y);
int stf_quadrature_after(steif_solver *s, sunrealtype t, N_Vector y, const sunrealtype *tau);

/* The invariants at the start. */
int stf_drift_open(steif_solver *s);

/* Does the last step end after t1? The solution at t1 is then in s->final. */
bool stf_beyond(const steif_solver *s);

/* Show y at t to the observer; what it wishes is kept. */
void stf_observe(steif_solver *s, sunrealtype t, N_Vector y);

/* Processor seconds so far, those of the present call among them. */
sunrealtype stf_cpu_seconds(const steif_solver *s);

/* The solution at the end of what is known. */
N_Vector stf_last(const steif_solver *s);

/* Dense output of the last step as the method made it, unchecked. */
int stf_dense(steif_solver *s, sunrealtype t, N_Vector y);

/* Weights of the norm at step.y. */
int stf_weigh(const steif_solver *s);

/* First length of a chosen step. */
sunrealtype stf_first_step(const steif_solver *s);

/* Two methods for `auto`, whose first choice, `name`, is open; and a look, before a step, at which of
 * them is to make it. */
int stf_switching_open(steif_solver *s, const char *name);
int stf_switching_look(steif_solver *s);
/* A constraint has refused a step: its length is no verdict on the method. Nothing where there is no other. */
void stf_switching_constrained(steif_solver *s);
/* After a step that failed: dense output of the one before is asked of who made it. */
void stf_switching_stay(steif_solver *s);
/* Back to the implicit method, before the other one goes. */
void stf_switching_leave(steif_solver *s);
/* The method in use becomes that of the image; its own state is kept with the step. */
void stf_switching_keep(steif_solver *s, stf_image *m);

/* The methods that `auto` chooses among, numbers of Radau and Rosenbrock methods being their orders, and
 * the explicit one that it may switch to. */
enum stf_auto_method {
  STF_AUTO_DESCRIPTOR,
  STF_AUTO_RADAU5,
  STF_AUTO_RADAU9,
  STF_AUTO_RADAU13,
  STF_AUTO_RODAS4,
  STF_AUTO_RODAS4P2,
  STF_AUTO_RODAS5P,
  STF_AUTO_BDF,
  STF_AUTO_EXPLICIT
};
extern const char *const stf_auto_methods[]; /* their specs */
/* One of them, or what takes its place where derivatives are carried. */
const char *stf_carrying(const char *method);
/* The spec that `auto` stands for, and a sentence why. */
const char *stf_choose(const steif_problem *p, const steif_options *o, int form, char *why,
                       size_t room);

/* method_names.c: the engine of that name, NULL for none; the family of any other spec, which says itself
 * what is its own, and the table that the spec names, new: NULL for families without. */
const steif_engine *stf_engine_find(const char *name);
int stf_method_find(steif_context *ctx, const steif_spec *spec, const steif_method **method,
                    steif_table **table);

#endif
