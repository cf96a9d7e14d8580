/* cvodes.c: CVODE's BDF with forward sensitivities, by CVODES.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_columns.h"
#include "cvode_family.h"
#include <cvodes/cvodes.h>

#ifndef STEIF_CVODES_LIBRARY
#define STEIF_CVODES_LIBRARY ""
#define STEIF_CVODES_PATH ""
#endif

extern const steif_engine steif_engine_cvode;

#define CALLS(X)                                                                               \
  X(CVodeSensInit)                                                                             \
  X(CVodeSensEEtolerances)                                                                     \
  X(CVodeSetSensErrCon)                                                                        \
  X(CVodeSetSensParams)                                                                        \
  X(CVodeGetSensDky1)                                                                          \
  X(CVodeGetSensStats)                                                                         \
  X(CVodeGetSensNumNonlinSolvIters)
#define MEMBER(name) __typeof__(name) *name;

typedef struct cvodes {
  stf_cvode cvode; /* first: its functions are those of cvode */
  struct {
    CALLS(MEMBER)
  } call;
  stf_slope_columns columns;
  int staggered, test;
  bool exact;
  long sweeps; /* of the iteration for derivatives, each over all columns */
} cvodes;

#define LOAD(name) STEIF_TRY(stf_library_function(&library, #name, &s->call.name));

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  static const char *const keys[] = {"lmm",       "order", "stald", "newton",
                                     "staggered", "test",  NULL};
  cvodes *s = state;
  stf_library library;
  s->cvode.keys = keys;
  STEIF_TRY(stf_spec_int(run->ctx, spec, "staggered", 0, 1, 0, &s->staggered));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "test", 0, 1, !run->options->untested_sensitivities,
                         &s->test));
  STEIF_TRY(stf_library_open(run->ctx, run->pool, "CVODES", STEIF_CVODES_LIBRARY,
                             STEIF_CVODES_PATH, &library));
  if (!(s->cvode.call = stf_cvode_load(run, &library))) return steif_status(run->ctx);
  CALLS(LOAD)
  return steif_engine_cvode.open(run, state, spec);
}

static int slopes(int count, sunrealtype t, N_Vector y, N_Vector fy, N_Vector *S, N_Vector *out,
                  void *user, N_Vector tmp1, N_Vector tmp2)
{
  (void)count, (void)tmp1, (void)tmp2;
  return stf_slope_rhs(&((cvodes *)user)->columns, t, y, fy, S, out);
}

static int carry(stf_run *run, void *state)
{
  cvodes *s = state;
  void *m = s->cvode.memory;
  const stf_engine_columns *c = &run->columns;
  const int way = s->staggered ? CV_STAGGERED : CV_SIMULTANEOUS;
  STEIF_TRY(stf_slope_open(&s->columns, &s->cvode.base, &s->exact));
  stf_baseline_enter(&s->cvode.base, run);
  int flag = s->call.CVodeSensInit(m, c->count, way, s->exact ? slopes : NULL, c->S);
  STF_CALL(flag, s->call.CVodeSetSensParams(m, c->value, c->scale, c->parameter));
  STF_CALL(flag, s->call.CVodeSensEEtolerances(m));
  STF_CALL(flag, s->call.CVodeSetSensErrCon(m, s->test));
  return stf_baseline_dense(&s->cvode.base, flag, run->t);
}

static int carried(stf_run *run, void *state, sunrealtype t, int column, N_Vector out)
{
  cvodes *s = state;
  STEIF_TRY(stf_baseline_inside(&s->cvode.base, &t));
  stf_baseline_enter(&s->cvode.base, run);
  return stf_baseline_dense(&s->cvode.base,
                            s->call.CVodeGetSensDky1(s->cvode.memory, t, 0, column, out), t);
}

/* The package counts an iteration over all columns as one solve, and its own differences apart. */
static void count(stf_run *run, cvodes *s)
{
  long evaluations = 0, more = 0, fails, setups;
  void *m = s->cvode.memory;
  if (!run->columns.count) return;
  s->sweeps = run->stats.newton;
  if (s->staggered) s->call.CVodeGetSensNumNonlinSolvIters(m, &s->sweeps);
  s->call.CVodeGetSensStats(m, &evaluations, &more, &fails, &setups);
  run->stats.nsolve = run->stats.newton + run->columns.count * s->sweeps;
  run->stats.nfe += more;
}

static void cost(const stf_run *run, void *state, steif_sensitivity_cost *spent)
{
  const cvodes *s = state;
  *spent = (steif_sensitivity_cost){.columns = run->columns.count,
                                    .tested = s->test,
                                    .sweeps = s->sweeps,
                                    .jacobians = s->exact ? s->columns.made : 0};
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  STEIF_TRY(stf_slope_unbroken(state));
  const int code = steif_engine_cvode.step(run, state, t_stop);
  count(run, state);
  return code;
}

static int advance(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps)
{
  STEIF_TRY(stf_slope_unbroken(state));
  const int code = steif_engine_cvode.advance(run, state, t, t_stop, steps);
  count(run, state);
  return code;
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  return steif_engine_cvode.dense(run, state, t, y);
}

static void close(stf_run *run, void *state)
{
  if (((cvodes *)state)->cvode.call) steif_engine_cvode.close(run, state);
}

const steif_engine steif_engine_cvodes = {
  .about =
    "CVODES: CVODE with derivatives by parameters (Serban, Hindmarsh, ASME IDETC 2005; "
    "SUNDIALS); as cvode, and staggered=0|1, test=0|1: do errors of derivatives count, as "
    "options.untested_sensitivities says where it is not given; its own default is 0",
  .forms = STEIF_ODE,
  .size = sizeof(cvodes),
  .open = open,
  .step = step,
  .advance = advance,
  .dense = dense,
  .renew = stf_baseline_renewed,
  .close = close,
  .carry = carry,
  .carried = carried,
  .cost = cost,
};
