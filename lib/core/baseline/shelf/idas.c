/* idas.c: IDA's BDF with forward sensitivities, by IDAS.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "slope_columns.h"
#include "ida_family.h"
#include <idas/idas.h>

#ifndef STEIF_IDAS_LIBRARY
#define STEIF_IDAS_LIBRARY ""
#define STEIF_IDAS_PATH ""
#endif

extern const steif_engine steif_engine_ida;

#define CALLS(X)                                                                               \
  X(IDASensInit)                                                                               \
  X(IDASensEEtolerances)                                                                       \
  X(IDASetSensErrCon)                                                                          \
  X(IDASetSensParams)                                                                          \
  X(IDAGetSensDky1)                                                                            \
  X(IDAGetSensStats)                                                                           \
  X(IDAGetSensNumNonlinSolvIters)
#define MEMBER(name) __typeof__(name) *name;

typedef struct idas {
  stf_ida ida; /* first: its functions are those of ida */
  struct {
    CALLS(MEMBER)
  } call;
  stf_slope_columns columns;
  N_Vector *slope;
  int staggered, test;
  bool exact;
  long sweeps; /* of the iteration for derivatives, each over all columns */
} idas;

#define LOAD(name) STEIF_TRY(stf_library_function(&library, #name, &s->call.name));

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  static const char *const keys[] = {"order",  "suppress",  "ic",   "id",
                                     "newton", "staggered", "test", NULL};
  idas *s = state;
  stf_library library;
  s->ida.keys = keys;
  STEIF_TRY(stf_spec_int(run->ctx, spec, "staggered", 0, 1, 0, &s->staggered));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "test", 0, 1, !run->options->untested_sensitivities,
                         &s->test));
  STEIF_TRY(stf_library_open(run->ctx, run->pool, "IDAS", STEIF_IDAS_LIBRARY, STEIF_IDAS_PATH,
                             &library));
  if (!(s->ida.call = stf_ida_load(run, &library))) return steif_status(run->ctx);
  CALLS(LOAD)
  return steif_engine_ida.open(run, state, spec);
}

static int residuals(int count, sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *S,
                     N_Vector *Sp, N_Vector *out, void *user, N_Vector tmp1, N_Vector tmp2,
                     N_Vector tmp3)
{
  (void)count, (void)r, (void)tmp1, (void)tmp2, (void)tmp3;
  return stf_slope_residual(&((idas *)user)->columns, t, y, yp, S, Sp, out);
}

static int carry(stf_run *run, void *state)
{
  idas *s = state;
  void *m = s->ida.memory;
  const stf_engine_columns *c = &run->columns;
  const int way = s->staggered ? IDA_STAGGERED : IDA_SIMULTANEOUS;
  STEIF_TRY(stf_slope_open(&s->columns, &s->ida.base, &s->exact));
  if (!(s->slope = stf_pool_vectors(run->pool, c->count, run->like))) return STEIF_NO_MEMORY;
  if (s->exact) STEIF_TRY(stf_slope_start(&s->columns, c->S, s->slope));
  stf_baseline_enter(&s->ida.base, run);
  int flag = s->call.IDASensInit(m, c->count, way, s->exact ? residuals : NULL, c->S, s->slope);
  STF_CALL(flag, s->call.IDASetSensParams(m, c->value, c->scale, c->parameter));
  STF_CALL(flag, s->call.IDASensEEtolerances(m));
  STF_CALL(flag, s->call.IDASetSensErrCon(m, s->test));
  return stf_baseline_dense(&s->ida.base, flag, run->t);
}

static int carried(stf_run *run, void *state, sunrealtype t, int column, N_Vector out)
{
  idas *s = state;
  STEIF_TRY(stf_baseline_inside(&s->ida.base, &t));
  stf_baseline_enter(&s->ida.base, run);
  return stf_baseline_dense(&s->ida.base,
                            s->call.IDAGetSensDky1(s->ida.memory, t, 0, column, out), t);
}

/* The package counts an iteration over all columns as one solve, and its own differences apart. */
static void count(stf_run *run, idas *s)
{
  long evaluations = 0, more = 0, fails, setups;
  void *m = s->ida.memory;
  if (!run->columns.count) return;
  s->sweeps = run->stats.newton;
  if (s->staggered) s->call.IDAGetSensNumNonlinSolvIters(m, &s->sweeps);
  s->call.IDAGetSensStats(m, &evaluations, &more, &fails, &setups);
  run->stats.nsolve = run->stats.newton + run->columns.count * s->sweeps;
  run->stats.nfe += more;
}

static void cost(const stf_run *run, void *state, steif_sensitivity_cost *spent)
{
  const idas *s = state;
  *spent = (steif_sensitivity_cost){.columns = run->columns.count,
                                    .tested = s->test,
                                    .sweeps = s->sweeps,
                                    .jacobians = s->exact ? s->columns.made : 0};
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  STEIF_TRY(stf_slope_unbroken(state));
  const int code = steif_engine_ida.step(run, state, t_stop);
  count(run, state);
  return code;
}

static int advance(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps)
{
  STEIF_TRY(stf_slope_unbroken(state));
  const int code = steif_engine_ida.advance(run, state, t, t_stop, steps);
  count(run, state);
  return code;
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  return steif_engine_ida.dense(run, state, t, y);
}

static void close(stf_run *run, void *state)
{
  if (((idas *)state)->ida.call) steif_engine_ida.close(run, state);
}

const steif_engine steif_engine_idas = {
  .about =
    "IDAS: IDA with derivatives by parameters (Serban, Petra, Hindmarsh; SUNDIALS); as ida, "
    "and staggered=0|1, test=0|1: do errors of derivatives count, as "
    "options.untested_sensitivities says where it is not given; its own default is 0",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .size = sizeof(idas),
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
