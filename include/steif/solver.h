/* steif/solver.h: integrate a problem with a method; CVODE, IDA and ARKODE are called the same way.
 *
 *   steif_options opt = steif_defaults();
 *   opt.h = 1e-3;
 *   steif_solver *s = steif_solver_new(ctx, &problem, "radau:s=3", &opt);
 *   if (s && steif_solve_to(s, 10) == STEIF_OK) use(steif_solution(s));
 *   steif_solver_free(&s);
 *
 * Steps. One of three rules decides them, looked at in this order:
 *   mesh      the given times, in order;
 *   h > 0     constant step size, used exactly as it is, never lowered or raised (t1 from the options or the
 *             problem). N = floor((t1 - t0)/h) steps, within 4 rounding errors; where a rest is left,
 *             one-step methods make one shorter step of that length, h_last; BDF and general linear
 *             methods make step N + 1 across t1, where the solution is their interpolant. STEIF_BAD_INPUT
 *             for h > t1 - t0 and for more than 1e9 steps;
 *   otherwise the error estimate of the method, kept below rtol |y| + atol. Methods without an
 *             estimate refuse this.
 * A stage that Newton's iteration cannot solve is never accepted: with prescribed steps the run stops
 * with STEIF_NO_CONVERGENCE and its sentence; with adaptive steps the step is made smaller.
 *
 * Events are times at which a function g_i(t, y) of the problem changes its sign, or arrives at 0.
 * They are looked for on the dense output of every accepted step, of every method alike, and
 * located to 4 rounding errors of t; the reported time is the first one after the sign change.
 * Within a step g is sampled at five Chebyshev points; where the polynomial through them comes
 * back after a change of sign, g itself is asked. Where g at two more points is not that of the
 * polynomial, the parts of the step are halved, at most six times. An odd number of changes between
 * two samples is never missed; an even number is when they lie closer than this tells.
 *   Changes within 128 rounding errors of t are one event.
 *   A function that is 0, at the start or for a while, is silent until it has left 0 and comes
 *   back; leaving is no event. Jumps and poles of g are changes of sign like any other.
 *   NaN stops the run with STEIF_NOT_FINITE and the name of the function.
 * problem.handle_event may change y or f at an event: the step then ends there, dense output keeps the
 * side before, steif_solution shows the one after it, and the integration restarts from it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_SOLVER_H
#define STEIF_SOLVER_H

#include <steif/initial.h>
#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_solver steif_solver;
struct steif_impulse; /* impulse.h */

typedef struct steif_options {
  sunrealtype rtol;         /* relative tolerance, 1e-14 .. 1; 0: 1e-6 */
  sunrealtype atol;         /* absolute tolerance; 0: rtol times the problem's scale */
  const sunrealtype *atols; /* n absolute tolerances instead of atol, NULL: none */
  int (*ewt)(N_Vector y, N_Vector ewt,
             void *user);  /* instead of both, at every adaptive step: a
                               CVEwtFn that fills in 1 / (error allowed in y_i); rtol still says
                               how many digits are meant; user: the problem's */
  sunrealtype h;           /* > 0: constant step size */
  const sunrealtype *mesh; /* mesh_size ascending times, the first is the start */
  size_t mesh_size;
  sunrealtype h0, h_max; /* first and largest adaptive step; 0: automatic, none */
  sunrealtype t1;        /* end; 0: the problem's */
  long max_steps;        /* default 1 000 000 */
  sunrealtype newton; /* Newton stops when the estimated error of the stages is below newton *
                               tolerance; default 1e-4 (collocation), 1e-3 (DIRK, BDF) of
                               rtol |y| + atol with adaptive steps, 1e-3 of
                               1e-10 (|y| + atol/rtol) with prescribed steps */
  int
    iterations; /* most Newton iterations in a stage; default 10 (adaptive), 30 (prescribed) */
  enum steif_storage storage; /* with force_storage: instead of the problem's */
  int force_storage;
  N_Vector like;          /* the kind of vector to clone; NULL: serial */
  const char *start;      /* starting procedure of multistep methods: exact, ramp, constant, cq;
                               NULL: that of the spec, else ramp */
  int suppress_algebraic; /* IDA: leave algebraic components out of the error test */
  int consistent; /* IDA: 1 IDACalcIC(YA_YDP_INIT), 2 IDACalcIC(Y_INIT) first; suppress= and
                               ic= of its spec (method.h) go before both */
  /* Called after every accepted step with the step just made; nonzero stops the run: with the code
   * and sentence of a function of the library that has failed in it, else STEIF_CALLBACK. Before
   * an event is handled, t is the event and y the side before it; when the integration restarts
   * there, once more with the side after it. */
  int (*observe)(steif_solver *s, sunrealtype t, N_Vector y, void *user);
  /* Called at every event before problem.handle_event, which explains `fired`; nonzero stops the run. */
  int (*on_event)(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user);
  /* Called by "descriptor", which auto takes for linear systems of index above 1, where x jumps, at
   * the start too: x(t-), and x(t+) with the impulses; nonzero stops the run. */
  int (*jump)(sunrealtype t, const sunrealtype *before, const struct steif_impulse *impulse,
              void *user);
  void *observer; /* user of these */
  /* Called before the integration restarts after problem.handle_event, and after a break of the problem
   * where steps of our own methods are adaptive, with rtol: make y(t+) of y and find its slope (yp holds 0
   * and may stay so); returns a code. steif_reinitialise (jump.h) fits. NULL: other equations may hold from there on, and
   * y of a DAE whose start may be repaired (initial.h) is put where they do, as at a start: of index 1 unknowns with a
   * derivative stay and the others follow; hidden constraints of index 2 and 3 that appear there make velocities and
   * charges jump by impulses, positions move by 1 % at most. What jumps first is told by steif_initial_used(), and the
   * index of the equations that hold decides on weights. STEIF_BAD_INPUT with the reason where index 2 or 3 has no such
   * state or no unique one. Else y stays, and algebraic components that are then wrong may stop the run. */
  int (*reinitialise)(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                      sunrealtype rtol, N_Vector y, N_Vector yp);
  enum steif_initial
    initial;               /* what is done about an inconsistent start (initial.h); 0: repair */
  const int *attributes;   /* n of enum steif_attribute: what may move then; NULL: guesses */
  sunrealtype max_seconds; /* limit on the wall-clock time of a call; 0: none */
  const volatile int *stop; /* set to nonzero, by a signal handler for example, it lets
                                         the call return STEIF_STOPPED after the step at hand */
  /* Derivatives by the parameters of the problem, carried through every step (sensitivity.h). */
  int sensitivities; /* 1: by all parameters, or by those listed: */
  int active_count;
  const int *active;          /* numbers from 0; NULL: all */
  int untested_sensitivities; /* 1: their errors do not decide on steps */
  int test_quadratures;       /* 1: the errors of problem.quadrature do (quadrature.h) */
  int
    recompute; /* 1: steif_solve_to shows unknowns of index 2 and 3 recomputed (steif_recomputed) */
  int reserved_int;
  void *reserved[12]; /* 0, as in steif_problem */
} steif_options;

/* What a run has cost. nli: iterations of GMRES, and then nlu is how often a preconditioner was made.
 * cpu_s counts processor seconds inside solve calls (all threads). */
typedef struct steif_stats {
  long steps, rejected, nfe, nje, nlu, nsolve, newton, newton_fails, nli;
  sunrealtype h_last, cpu_s;
  sunrealtype rounding; /* errors by rounding so far, in tolerances: an estimate of their size,
                           made where absolute tolerances lie below 8 rounding errors of the largest
                           component at the start (chosen implicit steps), else 0. Above 1 the
                           tolerance is out of reach in double precision. */
} steif_stats;

/* Programs compiled with these headers run with later libraries of the same SOVERSION: structs grow at their end
 * only, first in the room reserved there, and the functions that keep a problem or options are told by macros
 * how long these were in the caller's header. Through a pointer to the function, or from
 * another language: as in the header of the library (layout.h), which 0 bytes stand for. */
STEIF_EXPORT steif_options steif_defaults(void);
STEIF_EXPORT void steif_defaults_sized(size_t bytes, steif_options *options);
static inline steif_options steif_defaults_here(void)
{
  steif_options options;
  steif_defaults_sized(sizeof options, &options);
  return options;
}
#define steif_defaults() steif_defaults_here()

/* NULL with the message set: unknown method (the nearest is named), form not accepted, bad values,
 * start values that are not finite. options NULL: defaults. */
STEIF_EXPORT steif_solver *steif_solver_new(steif_context *ctx, const steif_problem *problem,
                                            const char *method, const steif_options *options);
STEIF_EXPORT steif_solver *steif_solver_new_sized(size_t problem_bytes, size_t options_bytes,
                                                  steif_context *ctx,
                                                  const steif_problem *problem,
                                                  const char *method,
                                                  const steif_options *options);
#define STEIF_SIZES sizeof(steif_problem), sizeof(steif_options)
#define steif_solver_new(...) steif_solver_new_sized(STEIF_SIZES, __VA_ARGS__)
STEIF_EXPORT void steif_solver_free(steif_solver **s);

/* What the solver did about its start; never NULL for a solver. */
STEIF_EXPORT const steif_repair *steif_initial_used(const steif_solver *s);

/* Advance until t and put the solution there (dense output between steps). STEIF_EVENT: a terminal
 * event came first, its time and solution are shown. After STEIF_TIME_LIMIT, STEIF_STOPPED and a
 * stop by observe or notice the run may go on by another call. */
STEIF_EXPORT int steif_solve_to(steif_solver *s, sunrealtype t);
/* Advance by one accepted step. */
STEIF_EXPORT int steif_solve_step(steif_solver *s);

/* The spec in use; for "auto" what it chose and why, in one sentence. On y' = f(t, y) with matrices "auto"
 * may change between an implicit and an explicit method on the way: then since when, and what it
 * expects to save. */
STEIF_EXPORT const char *steif_method_used(const steif_solver *s);

/* Of a solver that could not be made, s NULL: NULL, NaN, zeros; steps and values give STEIF_BAD_INPUT. */
STEIF_EXPORT N_Vector steif_solution(steif_solver *s); /* at the time last asked for */
STEIF_EXPORT sunrealtype steif_time(const steif_solver *s);
STEIF_EXPORT const steif_stats *steif_statistics(steif_solver *s);

/* Components of index 2 and 3 (velocities, multipliers) are controlled through h^(index - 1) only: *error is
 * the largest error of theirs in the solution shown, in tolerances rtol |y_i| + atol_i: its distance from a second
 * run from the start, by auto for a hundredth of the tolerance (1e-13 at least), recomputed (below); that run has errors of
 * its own there, so below one tolerance it tells little. It costs what that run costs, mostly less than the first, and
 * calls what the problem calls; what the problem remembers is put back by its begin and restore.
 * NaN: not known, or there are no such components. With at most STEIF_DIAGNOSE_LARGEST unknowns, adaptive
 * steps of steif's own methods, serial vectors, without options.ewt, rtol above 5e-13; not where events are handled or
 * begin is set and the problem has no save, nor where the second run would take more than four times the steps. */
STEIF_EXPORT int steif_hidden_error(steif_solver *s, sunrealtype *error);

/* The solution inside the last step. STEIF_BAD_INPUT outside of it. Steps chosen by the tolerance are no longer than the
 * next term of its polynomial allows, 5 tolerances, which filtered estimates of stiff and algebraic unknowns do not
 * see. On u = sin 3t, algebraic or stiff, these were in between within one tolerance by BDF, some ten by collocation of three
 * stages and more, thirty by Rosenbrock methods, some hundred by others, and dirk:hw43 to order 2 only; components of index 2
 * and 3: see steif_recompute. */
STEIF_EXPORT int steif_dense(steif_solver *s, sunrealtype t, N_Vector y);

/* drift[k] = I_k at the solution shown - I_k at the start, of the problem's first *count invariants;
 * *count becomes how many these are. */
STEIF_EXPORT int steif_drift_now(steif_solver *s, int *count, sunrealtype *drift);

/* The solution shown on all constraints of a DAE, hidden ones too: components of index 1 move as little as
 * possible, in tolerances, and unknowns of index 2 and 3 are computed from them. Methods have lower orders for
 * the latter; computed so they are as good as the former: the multiplier of a pendulum by radau:s=3 has order 5
 * instead of 2. *drift: the largest movement of a component of index 1 (problem.index, or as found at the
 * start), *corrected: that of the others, both in tolerances, NULL: not wanted. y may be the vector shown. Codes
 * of steif_consistent (consistent.h); a diagnosis, and some thousand evaluations. STEIF_UNSUPPORTED: vectors over
 * ranks. */
STEIF_EXPORT int steif_recompute(steif_solver *s, N_Vector y, sunrealtype *drift,
                                 sunrealtype *corrected);

/* The same without the diagnosis, at a tenth of its cost, is done with what steif_output shows, and with
 * options.recompute steif_solve_to (the program asks for both): of DAEs of index 2 and 3 with at most
 * STEIF_DIAGNOSE_LARGEST unknowns and a regular structure, by steif's own methods with adaptive steps. Some hundred
 * evaluations and decompositions of matrices of order n a point. Steps, observers and steif_dense have y as the
 * method has it. *drift and *corrected are those of the solution last shown; *corrected is how far the method was off in
 * unknowns of index 2 and 3. NaN: nothing was recomputed, or components of index 1 would have moved by more than
 * 10 tolerances, or a time between two breaks so close that differences in between have no digits. At a break they tell of
 * the side that is shown. */
STEIF_EXPORT int steif_recomputed(const steif_solver *s, sunrealtype *drift,
                                  sunrealtype *corrected);
/* The solution shown, or steif_dense, with unknowns of index 2 and 3 recomputed. */
STEIF_EXPORT int steif_output(steif_solver *s, sunrealtype t, N_Vector y);

/* Stage values of the last step of a Runge-Kutta method: vectors X_i at t_n + c_i h with quadrature
 * weights b_i (b = NULL: a general linear method, which has none); *count = 0 for methods without
 * stages. The vectors are the solver's. */
STEIF_EXPORT int steif_stages(steif_solver *s, int *count, const sunrealtype **c,
                              const sunrealtype **b, N_Vector **X);

#ifdef __cplusplus
}
#endif
#endif
