/* engine.h: what a baseline integrator provides to be called like a method of ours.
 *
 * The frame (lib/march/solver.c) owns the run; an engine is one const vtable. Its private state of
 * `size` bytes is zeroed before open and passed to every call; close must accept a half-opened one.
 * Failures go through stf_fail with the sentence of what the integrator said.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ENGINE_H
#define STF_ENGINE_H

#include "agree.h"
#include "base.h"
#include <steif/sensitivity.h>

/* Derivatives by parameters that an engine carries; count 0: none. */
typedef struct stf_engine_columns {
  int count;
  int *parameter;     /* numbers, from 0 */
  sunrealtype *value; /* of all parameters of the problem, where its callbacks read them */
  sunrealtype *scale; /* count */
  N_Vector *S;        /* at the start */
} stf_engine_columns;

/* The run as an engine sees it. */
typedef struct stf_run {
  steif_context *ctx;
  stf_pool *pool; /* lives as long as the solver */
  const steif_problem *problem;
  int form;                     /* enum steif_form */
  const steif_options *options; /* complete: defaults filled in, t1 > t0 */
  void *user;                   /* of the callbacks in options */
  bool mass_of_time;            /* M of the mass form depends on t */
  N_Vector like;                /* vector to clone */
  stf_deferred *deferred;     /* of vectors that are spread over ranks: see stf_deferred_gate */
  sunrealtype t;              /* time of y */
  N_Vector y, yp;             /* in: start values (yp 0 where not known); out: after a step */
  steif_stats stats;          /* the engine keeps it current after every step */
  stf_engine_columns columns; /* set before `carry` */
} stf_run;

typedef struct steif_engine {
  const char *family; /* NULL: "baseline" */
  const char *about;  /* one sentence with a citation */
  unsigned forms;     /* enum steif_form accepted */
  size_t size;
  /* spec parameters are the engine's own: refuse unknown ones with stf_spec_only. */
  int (*open)(stf_run *run, void *state, const steif_spec *spec);
  /* One internal step, not beyond t_stop; sets run->t and run->y. */
  int (*step)(stf_run *run, void *state, sunrealtype t_stop);
  /* Up to `steps` internal steps in one call of the package, until one ends at t or later, none beyond
   * t_stop >= t; run->t and run->y are those of the last step. NULL: by `step`, one after another. */
  int (*advance)(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps);
  /* The solution at a time inside the last step. */
  int (*dense)(stf_run *run, void *state, sunrealtype t, N_Vector y);
  /* The next step begins anew from (run->t, run->y); run->yp holds slopes, or 0 where unknown. */
  int (*renew)(stf_run *run, void *state);
  /* For starts of other methods: x := x(t+) of a linear system from x(t-), n values; *certified: it is. NULL: no. */
  int (*jump)(steif_context *ctx, const steif_problem *problem, sunrealtype t, sunrealtype *x,
              bool *certified);
  void (*close)(stf_run *run, void *state);
  /* Carry the columns from the start on; column i at a time of the last step; what they have cost. NULL: no. */
  int (*carry)(stf_run *run, void *state);
  int (*carried)(stf_run *run, void *state, sunrealtype t, int column, N_Vector out);
  void (*cost)(const stf_run *run, void *state, steif_sensitivity_cost *cost);
  bool mass_of_time; /* M(t) y' = f(t, y) is taken in the mass form */
} steif_engine;

/* Filled by the shelf of the baseline room. */
typedef struct stf_engine_entry {
  const char *name;
  const steif_engine *item;
} stf_engine_entry;
extern const stf_engine_entry stf_engine_shelf[];
extern const size_t stf_engine_count;

/* steif_solve_step without its processor time, which the system takes longer to tell than a small step
 * lasts. */
int stf_step_untimed(steif_solver *s);

#endif
