/* closed.c: an engine of the test of extensions: the closed solution of a problem, in one step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "engine.h"

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  (void)state;
  STEIF_TRY(stf_spec_only(run->ctx, spec, (const char *const[]){NULL}));
  STEIF_CHECK(run->problem->exact, run->ctx, STEIF_UNSUPPORTED,
              "problem '%s' has no closed solution", run->problem->name);
  return STEIF_OK;
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  (void)state;
  const int returned = run->problem->exact(t, y, NULL, run->problem->user);
  STEIF_CHECK(returned == 0, run->ctx, STEIF_CALLBACK, "not known at t = %g", t);
  return STEIF_OK;
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  run->stats.h_last = t_stop - run->t;
  run->stats.steps++;
  run->t = t_stop;
  return dense(run, state, t_stop, run->y);
}

static int renew(stf_run *run, void *state)
{
  (void)run, (void)state;
  return STEIF_OK;
}

static void close(stf_run *run, void *state) { (void)run, (void)state; }

const steif_engine steif_engine_closed = {
  .about = "the closed solution",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .size = 1,
  .open = open,
  .step = step,
  .dense = dense,
  .renew = renew,
  .close = close,
};
