/* cvode.c: CVODE's variable-order BDF for y' = f(t, y).
 * SPDX-License-Identifier: BSD-3-Clause */
#include "cvode_calls.h"
#include "cvode_family.h"
#include <math.h>
#include <string.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

typedef stf_cvode cvode;

static const stf_flag flags[] = {
  STF_FLAG(CV_TOO_MUCH_WORK, STEIF_STEP_LIMIT, "too many internal steps",
           "Raise max_steps or loosen the tolerances"),
  STF_FLAG(CV_TOO_MUCH_ACC, STEIF_BASELINE, "more accuracy was asked for than the machine has",
           "Loosen rtol, or raise atol where a component is near zero"),
  STF_FLAG(
    CV_ERR_FAILURE, STEIF_BASELINE,
    "the error test failed repeatedly or the step reached its minimum",
    "There may be a singularity or a discontinuity of f here: look at y, declare breaks, "
    "or loosen the tolerances"),
  STF_FLAG(CV_CONV_FAILURE, STEIF_BASELINE,
           "Newton's iteration failed repeatedly or the step reached its minimum",
           "Check df/dy against differences; a stiff discontinuity of f does this too"),
  STF_FLAG(CV_CONSTR_FAIL, STEIF_INFEASIBLE,
           "a declared constraint was not kept however small the step",
           "The solution leaves .constraint here, or the tolerances are too loose"),
  STF_FLAG(CV_LINIT_FAIL, STEIF_BASELINE, "the linear solver could not be set up",
           "Check storage and bandwidths"),
  STF_FLAG(CV_LSETUP_FAIL, STEIF_BASELINE, "the Jacobian or its factorisation failed",
           "Check the Jacobian callback and its pattern"),
  STF_FLAG(CV_LSOLVE_FAIL, STEIF_BASELINE, "a linear solve failed",
           "Check the Jacobian callback, or use a direct solver"),
  STF_FLAG(CV_RHSFUNC_FAIL, STEIF_CALLBACK, "f asked to stop", "See what f objected to"),
  STF_FLAG(CV_FIRST_RHSFUNC_ERR, STEIF_CALLBACK, "f could not be evaluated at the start",
           "Check the start values"),
  STF_FLAG(CV_REPTD_RHSFUNC_ERR, STEIF_CALLBACK, "f kept failing however small the step",
           "The solution may leave the domain of f here"),
  STF_FLAG(CV_UNREC_RHSFUNC_ERR, STEIF_CALLBACK, "f failed where the step cannot be repeated",
           "The solution may leave the domain of f here"),
  STF_FLAG(CV_MEM_FAIL, STEIF_NO_MEMORY, "memory is short", "Make the problem smaller"),
  STF_FLAG(CV_ILL_INPUT, STEIF_BASELINE, "an argument was rejected",
           "An error weight that is not positive does this: raise atol above 0"),
  STF_FLAG(CV_TOO_CLOSE, STEIF_STEP_SIZE, "the end is too close to the start",
           "Make the interval longer than rounding"),
  {0, 0, NULL, NULL, NULL}};

static int verdict(cvode *s, int flag)
{
  sunrealtype h = 0;
  int order = 0;
  if (flag < 0 && s->memory) {
    s->call->CVodeGetCurrentStep(s->memory, &h);
    s->call->CVodeGetCurrentOrder(s->memory, &order);
  }
  stf_baseline_leave(&s->base);
  return stf_baseline_verdict(&s->base, flag, h, order);
}

static int attach(cvode *s)
{
  stf_baseline *b = &s->base;
  const steif_problem *p = b->run->problem;
  if (s->adams) return s->call->CVodeSetNonlinearSolver(s->memory, s->iteration);
  int flag = s->call->CVodeSetLinearSolver(s->memory, b->solver, b->J);
  if (b->J && stf_baseline_has_jac(b))
    STF_CALL(flag, s->call->CVodeSetJacFn(s->memory, stf_baseline_jac));
  if (!b->J && p->Av)
    STF_CALL(flag, s->call->CVodeSetJacTimes(s->memory, NULL, stf_baseline_jv));
  if (b->preconditioned)
    STF_CALL(flag, s->call->CVodeSetPreconditioner(s->memory, stf_baseline_precsetup,
                                                   stf_baseline_precsolve));
  return flag;
}

static int configure(cvode *s)
{
  stf_run *run = s->base.run;
  const steif_options *o = run->options;
  void *m = s->memory;
  int flag = STF_SILENCE(s->call->CVodeSetErrHandlerFn, m, &s->base);
  STF_CALL(flag, s->call->CVodeInit(m, stf_baseline_rhs, run->t, run->y));
  STF_CALL(flag, s->call->CVodeSetUserData(m, s));
  STF_CALL(flag, o->ewt         ? s->call->CVodeWFtolerances(m, stf_baseline_weights)
                 : s->base.atol ? s->call->CVodeSVtolerances(m, o->rtol, s->base.atol)
                                : s->call->CVodeSStolerances(m, o->rtol, o->atol));
  STF_CALL(flag, s->call->CVodeSetMaxOrd(m, s->order));
  if (s->newton > 0) STF_CALL(flag, s->call->CVodeSetNonlinConvCoef(m, s->newton));
  if (s->stald) STF_CALL(flag, s->call->CVodeSetStabLimDet(m, 1));
  if (s->base.constraint) STF_CALL(flag, s->call->CVodeSetConstraints(m, s->base.constraint));
  STF_CALL(flag, s->call->CVodeSetMaxHnilWarns(m, -1));
  if (o->h0 > 0) STF_CALL(flag, s->call->CVodeSetInitStep(m, o->h0));
  if (o->h_max > 0) STF_CALL(flag, s->call->CVodeSetMaxStep(m, o->h_max));
  STF_CALL(flag, attach(s));
  return flag;
}

static int settings(stf_run *run, const steif_spec *spec, cvode *s)
{
  static const char *const keys[] = {"lmm", "order", "stald", "newton", NULL};
  const char *lmm = stf_spec_word(spec, "lmm");
  STEIF_TRY(stf_spec_only(run->ctx, spec, s->keys ? s->keys : keys));
  STEIF_CHECK(!lmm || !strcmp(lmm, "bdf") || !strcmp(lmm, "adams"), run->ctx, STEIF_BAD_INPUT,
              "lmm=%s is not known to cvode: bdf or adams", lmm);
  s->adams = lmm && !strcmp(lmm, "adams");
  const int most = s->adams ? 12 : 5;
  STEIF_TRY(stf_spec_int(run->ctx, spec, "order", 1, most, most, &s->order));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "stald", 0, 1, 0, &s->stald));
  STEIF_TRY(stf_spec_real(run->ctx, spec, "newton", 1e-12, 1, 0, &s->newton));
  STEIF_CHECK(!s->adams || !s->stald, run->ctx, STEIF_BAD_INPUT,
              "stald=1, stability limit detection, is for lmm=bdf");
  return STEIF_OK;
}

static void free_iteration(void *iteration) { SUNNonlinSolFree(iteration); }

static int open_iteration(cvode *s)
{
  stf_run *run = s->base.run;
  STEIF_TRY(stf_clone_gate(run->ctx, run->y));
  s->iteration = SUNNonlinSol_FixedPoint(run->y, 0, steif_sundials(run->ctx));
  STEIF_CHECK(s->iteration, run->ctx, STEIF_NO_MEMORY, "no memory for a fixed-point iteration");
  return stf_pool_adopt(run->pool, s->iteration, free_iteration);
}

static int open_newton(stf_baseline *b)
{
  const bool exact = stf_baseline_has_jac(b);
  STEIF_TRY(stf_baseline_near(b));
  STEIF_TRY(stf_baseline_linear(b, exact));
  return b->J && b->storage != b->run->problem->storage && exact ? stf_baseline_native(b)
                                                                 : STEIF_OK;
}

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  cvode *s = state;
  stf_baseline *b = &s->base;
  if (!s->call) s->call = &stf_cvode_linked;
  STEIF_TRY(settings(run, spec, s));
  STEIF_TRY(stf_baseline_open(b, run, s->call->package, flags));
  STEIF_TRY(stf_baseline_adaptive(b));
  STEIF_TRY(s->adams ? open_iteration(s) : open_newton(b));
  STEIF_TRY(stf_baseline_gate(b));
  stf_baseline_enter(b, run);
  s->memory = s->call->CVodeCreate(s->adams ? CV_ADAMS : CV_BDF, steif_sundials(run->ctx));
  return verdict(s, s->memory ? configure(s) : CV_MEM_FAIL);
}

static void collect(cvode *s)
{
  steif_stats n = {0};
  void *m = s->memory;
  long more = 0;
  s->call->CVodeGetNumSteps(m, &n.steps);
  s->call->CVodeGetNumErrTestFails(m, &n.rejected);
  s->call->CVodeGetNumRhsEvals(m, &n.nfe);
  if (!s->adams) {
    s->call->CVodeGetNumLinRhsEvals(m, &more);
    s->call->CVodeGetNumJacEvals(m, &n.nje);
    s->call->CVodeGetNumLinIters(m, &n.nli);
  }
  n.nfe += more;
  s->call->CVodeGetNumLinSolvSetups(m, &n.nlu);
  s->call->CVodeGetNumNonlinSolvIters(m, &n.newton);
  s->call->CVodeGetNumStepSolveFails(m, &n.newton_fails);
  s->call->CVodeGetLastStep(m, &n.h_last);
  stf_baseline_count(&s->base, &n);
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  cvode *s = state;
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = 0;
  if (s->base.restart)
    flag = s->call->CVodeReInit(s->memory, stf_baseline_renew(&s->base), run->y);
  STF_CALL(flag, s->call->CVodeSetStopTime(s->memory, t_stop));
  STF_CALL(flag, s->call->CVode(s->memory, t_stop, run->y, &run->t, CV_ONE_STEP));
  collect(s);
  return verdict(s, flag);
}

/* The end of the last good step, which may lie beyond the time that was asked for. */
static int last_step(cvode *s, int flag)
{
  stf_run *run = s->base.run;
  sunrealtype tn = run->t;
  s->call->CVodeGetCurrentTime(s->memory, &tn);
  if (flag == CV_TOO_MUCH_WORK) flag = 0;
  if (flag >= 0 && tn <= run->t) return flag;
  if (s->call->CVodeGetDky(s->memory, tn, 0, run->y) >= 0) run->t = tn;
  return flag;
}

static int advance(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps)
{
  cvode *s = state;
  const long left = run->options->max_steps - run->stats.steps;
  if (s->base.restart || !run->stats.steps || run->options->h > 0)
    return step(run, state, t_stop); /* the first step is scaled by all of the interval */
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = s->call->CVodeSetStopTime(s->memory, t_stop);
  STF_CALL(flag, s->call->CVodeSetMaxNumSteps(s->memory, steps < left ? steps : left));
  STF_CALL(flag, s->call->CVode(s->memory, fmin(t, t_stop), run->y, &run->t, CV_NORMAL));
  flag = last_step(s, flag);
  collect(s);
  return verdict(s, flag);
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  cvode *s = state;
  STEIF_TRY(stf_baseline_inside(&s->base, &t));
  stf_baseline_enter(&s->base, run);
  const int flag = s->call->CVodeGetDky(s->memory, t, 0, y);
  return stf_baseline_dense(&s->base, flag, t);
}

static void close(stf_run *run, void *state)
{
  (void)run;
  cvode *s = state;
  if (s->memory) s->call->CVodeFree(&s->memory);
}

const steif_engine steif_engine_cvode = {
  .about =
    "CVODE: variable-order, variable-coefficient BDF in fixed-leading-coefficient form "
    "(Cohen, Hindmarsh, Computers in Physics 10, 1996; SUNDIALS); order=1..5, stald=0|1; "
    "lmm=adams: Adams methods for what is not stiff",
  .forms = STEIF_ODE,
  .size = sizeof(cvode),
  .open = open,
  .step = step,
  .advance = advance,
  .dense = dense,
  .renew = stf_baseline_renewed,
  .close = close,
};
