/* ida.c: IDA's variable-order BDF for F(t, y, y') = 0 and the forms that lower to it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ida_calls.h"
#include "ida_family.h"
#include "problem.h"
#include <math.h>
#include <stdio.h>

typedef stf_ida ida;

#define INDEX "The system may have an index above 1, or its start values are inconsistent: "

static const stf_flag flags[] = {
  STF_FLAG(IDA_TOO_MUCH_WORK, STEIF_STEP_LIMIT, "too many internal steps",
           "Raise max_steps or loosen the tolerances"),
  STF_FLAG(IDA_TOO_MUCH_ACC, STEIF_BASELINE, "more accuracy was asked for than the machine has",
           "Loosen rtol, or raise atol where a component is near zero"),
  STF_FLAG(
    IDA_ERR_FAIL, STEIF_BASELINE,
    "the error test failed repeatedly or the step reached its minimum",
    INDEX
    "give yp0; try ida:suppress=1, ida:suppress=1,ic=2, or ida:suppress=1,id=index, which "
    "tests the error of components of index 1 only; or use a steif method"),
  STF_FLAG(IDA_CONV_FAIL, STEIF_BASELINE,
           "Newton's iteration failed repeatedly or the step reached its minimum",
           INDEX
           "try ida:suppress=1,id=index, check dF/dy + c dF/dy' against differences, or use a "
           "steif method"),
  STF_FLAG(IDA_CONSTR_FAIL, STEIF_INFEASIBLE,
           "a declared constraint was not kept however small the step",
           "The solution leaves .constraint here, or the tolerances are too loose"),
  STF_FLAG(IDA_LINIT_FAIL, STEIF_BASELINE, "the linear solver could not be set up",
           "Check storage and bandwidths"),
  STF_FLAG(IDA_LSETUP_FAIL, STEIF_BASELINE,
           "dF/dy + c dF/dy' could not be evaluated or factored",
           "Check the Jacobian callback; if s E - A is singular for every s no method helps"),
  STF_FLAG(IDA_LSOLVE_FAIL, STEIF_BASELINE, "a linear solve failed",
           "Check the Jacobian callback, or use a direct solver"),
  STF_FLAG(IDA_RES_FAIL, STEIF_CALLBACK, "the residual asked to stop",
           "See what the callback objected to"),
  STF_FLAG(IDA_REP_RES_ERR, STEIF_CALLBACK, "the residual kept failing however small the step",
           "The solution may leave the domain of the equations here"),
  STF_FLAG(IDA_FIRST_RES_FAIL, STEIF_CALLBACK,
           "the residual could not be evaluated at the start", "Check the start values"),
  STF_FLAG(IDA_LINESEARCH_FAIL, STEIF_BASELINE,
           "IDACalcIC found no consistent start values: its line search failed",
           INDEX "give better y0 and yp0, or use a steif method"),
  STF_FLAG(IDA_NO_RECOVERY, STEIF_BASELINE,
           "IDACalcIC found no consistent start values: callbacks failed on the way",
           "Give better y0 and yp0"),
  STF_FLAG(IDA_BAD_EWT, STEIF_BASELINE, "an error weight is not positive",
           "Raise atol above 0 for components that may vanish"),
  STF_FLAG(IDA_MEM_FAIL, STEIF_NO_MEMORY, "memory is short", "Make the problem smaller"),
  STF_FLAG(IDA_ILL_INPUT, STEIF_BASELINE, "an argument was rejected",
           "Raise atol above 0 for components that may vanish"),
  {0, 0, NULL, NULL, NULL}};

/* The equation that the start values miss by most goes into the message of a failed start. */
static void name_equation(ida *s)
{
  stf_baseline *b = &s->base;
  const stf_run *run = b->run;
  if (run->stats.steps || b->fault.now) return;
  const int seen = stf_lower_residual(run->t, run->y, run->yp, b->start, b);
  b->fault.now = false;
  const sunrealtype *r = stf_array(b->start);
  if (seen || !r) return;
  char name[STEIF_SPEC_WORD];
  sunindextype worst = 0;
  for (sunindextype i = 1; i < run->problem->n; i++)
    if (fabs(r[i]) > fabs(r[worst])) worst = i;
  if (fabs(r[worst]) > sqrt(STF_EPS))
    snprintf(b->detail, sizeof b->detail, "; the start misses equation %s by most, F = %.3g",
             stf_equation(run->problem, worst, name), r[worst]);
  else
    snprintf(b->detail, sizeof b->detail,
             "; the start satisfies the equations, so the index is suspect");
}

static int verdict(ida *s, int flag)
{
  sunrealtype h = 0;
  int order = 0;
  if (flag < 0 && s->memory) {
    s->call->IDAGetCurrentStep(s->memory, &h);
    s->call->IDAGetCurrentOrder(s->memory, &order);
    name_equation(s);
  }
  stf_baseline_leave(&s->base);
  return stf_baseline_verdict(&s->base, flag, h, order);
}

static int precsetup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                     void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  const long failures = stf_failures(base->run->ctx);
  if (!p->precsetup) return 0;
  return stf_baseline_tells(base, failures, p->precsetup(t, y, yp, r, c, p->user));
}

static int precsolve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                     sunrealtype c, sunrealtype delta, void *user)
{
  stf_baseline *base = user;
  const steif_problem *p = base->run->problem;
  const long failures = stf_failures(base->run->ctx);
  return stf_baseline_tells(base, failures, p->precsolve(t, y, yp, r, b, z, c, delta, p->user));
}

static int attach(ida *s)
{
  stf_baseline *b = &s->base;
  const steif_problem *p = b->run->problem;
  int flag = s->call->IDASetLinearSolver(s->memory, b->solver, b->J);
  if (b->J && stf_lower_has_jac(b))
    STF_CALL(flag, s->call->IDASetJacFn(s->memory, stf_lower_jac));
  if (!b->J && p->Av) STF_CALL(flag, s->call->IDASetJacTimes(s->memory, NULL, stf_lower_jv));
  if (b->preconditioned)
    STF_CALL(flag, s->call->IDASetPreconditioner(s->memory, precsetup, precsolve));
  return flag;
}

static int configure(ida *s)
{
  stf_run *run = s->base.run;
  const steif_options *o = run->options;
  void *m = s->memory;
  int flag = STF_SILENCE(s->call->IDASetErrHandlerFn, m, &s->base);
  STF_CALL(flag, s->call->IDAInit(m, stf_lower_residual, run->t, run->y, run->yp));
  STF_CALL(flag, s->call->IDASetUserData(m, s));
  STF_CALL(flag, o->ewt         ? s->call->IDAWFtolerances(m, stf_baseline_weights)
                 : s->base.atol ? s->call->IDASVtolerances(m, o->rtol, s->base.atol)
                                : s->call->IDASStolerances(m, o->rtol, o->atol));
  STF_CALL(flag, s->call->IDASetMaxOrd(m, s->order));
  if (s->newton > 0) STF_CALL(flag, s->call->IDASetNonlinConvCoef(m, s->newton));
  if (s->base.constraint) STF_CALL(flag, s->call->IDASetConstraints(m, s->base.constraint));
  if (o->h0 > 0) STF_CALL(flag, s->call->IDASetInitStep(m, o->h0));
  if (o->h_max > 0) STF_CALL(flag, s->call->IDASetMaxStep(m, o->h_max));
  STF_CALL(flag, attach(s));
  return flag;
}

/* IDACalcIC where it was asked for, at the start and where the integration restarts. */
static int consistent(ida *s)
{
  stf_run *run = s->base.run;
  if (!s->ic) return 0;
  int flag =
    s->call->IDACalcIC(s->memory, s->ic == 1 ? IDA_YA_YDP_INIT : IDA_Y_INIT, run->options->t1);
  STF_CALL(flag, s->call->IDAGetConsistentIC(s->memory, run->y, run->yp));
  return flag;
}

/* What the spec leaves open is taken from the options. */
static int settings(stf_run *run, const steif_spec *spec, ida *s)
{
  const steif_options *o = run->options;
  static const char *const keys[] = {"order", "suppress", "ic", "id", "newton", NULL};
  STEIF_CHECK(o->consistent >= 0 && o->consistent <= 2, run->ctx, STEIF_BAD_INPUT,
              "options.consistent = %d must be 0, 1 (IDACalcIC with YA_YDP_INIT) or 2 (Y_INIT)",
              o->consistent);
  STEIF_TRY(stf_spec_only(run->ctx, spec, s->keys ? s->keys : keys));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "order", 1, 5, 5, &s->order));
  STEIF_TRY(
    stf_spec_int(run->ctx, spec, "suppress", 0, 1, o->suppress_algebraic != 0, &s->suppress));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "ic", 0, 2, o->consistent, &s->ic));
  STEIF_TRY(stf_spec_real(run->ctx, spec, "newton", 1e-12, 1, 0, &s->newton));
  s->id = stf_spec_word(spec, "id");
  STEIF_CHECK(!s->id || s->suppress || s->ic == 1, run->ctx, STEIF_BAD_INPUT,
              "id=%s has no effect in IDA unless suppress=1 or ic=1: add one of them", s->id);
  if (!s->id) s->id = "E";
  return STEIF_OK;
}

static int identify(ida *s, N_Vector *id)
{
  stf_run *run = s->base.run;
  if (!s->suppress && s->ic != 1) return STEIF_OK;
  *id = stf_pool_vector(run->pool, run->like);
  return *id ? stf_start_id(&s->base, s->id, *id) : STEIF_NO_MEMORY;
}

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  ida *s = state;
  stf_baseline *b = &s->base;
  N_Vector id = NULL;
  if (!s->call) s->call = &stf_ida_linked;
  STEIF_TRY(settings(run, spec, s));
  STEIF_TRY(stf_baseline_open(b, run, s->call->package, flags));
  STEIF_TRY(stf_baseline_adaptive(b));
  if (!(b->start = stf_pool_vector(run->pool, run->like))) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_lower_open(b));
  STEIF_TRY(stf_start_slopes(b));
  STEIF_TRY(identify(s, &id));
  STEIF_TRY(stf_baseline_gate(b));
  stf_baseline_enter(b, run);
  s->memory = s->call->IDACreate(steif_sundials(run->ctx));
  int flag = s->memory ? configure(s) : IDA_MEM_FAIL;
  if (id) STF_CALL(flag, s->call->IDASetId(s->memory, id));
  if (s->suppress) STF_CALL(flag, s->call->IDASetSuppressAlg(s->memory, 1));
  STF_CALL(flag, consistent(s));
  return verdict(s, flag);
}

static void collect(ida *s)
{
  steif_stats n = {0};
  void *m = s->memory;
  long more = 0;
  s->call->IDAGetNumSteps(m, &n.steps);
  s->call->IDAGetNumErrTestFails(m, &n.rejected);
  s->call->IDAGetNumResEvals(m, &n.nfe);
  s->call->IDAGetNumLinResEvals(m, &more);
  n.nfe += more;
  s->call->IDAGetNumJacEvals(m, &n.nje);
  s->call->IDAGetNumLinSolvSetups(m, &n.nlu);
  s->call->IDAGetNumNonlinSolvIters(m, &n.newton);
  s->call->IDAGetNumStepSolveFails(m, &n.newton_fails);
  s->call->IDAGetNumLinIters(m, &n.nli);
  s->call->IDAGetLastStep(m, &n.h_last);
  stf_baseline_count(&s->base, &n);
}

/* Behind a break or an event; y' is found where the form tells it and it is not known. */
static int renew(ida *s)
{
  stf_run *run = s->base.run;
  run->t = stf_baseline_renew(&s->base);
  if (stf_start_slopes(&s->base)) return IDA_FIRST_RES_FAIL;
  int flag = s->call->IDAReInit(s->memory, run->t, run->y, run->yp);
  STF_CALL(flag, consistent(s));
  return flag;
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  ida *s = state;
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = 0;
  if (s->base.restart) flag = renew(s);
  STF_CALL(flag, s->call->IDASetStopTime(s->memory, t_stop));
  STF_CALL(flag, s->call->IDASolve(s->memory, t_stop, &run->t, run->y, run->yp, IDA_ONE_STEP));
  collect(s);
  return verdict(s, flag);
}

/* The end of the last good step, which may lie beyond the time that was asked for. */
static int last_step(ida *s, int flag)
{
  stf_run *run = s->base.run;
  sunrealtype tn = run->t;
  s->call->IDAGetCurrentTime(s->memory, &tn);
  if (flag == IDA_TOO_MUCH_WORK) flag = 0;
  if (flag >= 0 && tn <= run->t) return flag;
  if (s->call->IDAGetDky(s->memory, tn, 0, run->y) >= 0 &&
      s->call->IDAGetDky(s->memory, tn, 1, run->yp) >= 0)
    run->t = tn;
  return flag;
}

static int advance(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps)
{
  ida *s = state;
  const long left = run->options->max_steps - run->stats.steps;
  if (s->base.restart || !run->stats.steps || run->options->h > 0)
    return step(run, state, t_stop); /* the first step is scaled by all of the interval */
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = s->call->IDASetStopTime(s->memory, t_stop);
  STF_CALL(flag, s->call->IDASetMaxNumSteps(s->memory, steps < left ? steps : left));
  STF_CALL(flag,
           s->call->IDASolve(s->memory, fmin(t, t_stop), &run->t, run->y, run->yp, IDA_NORMAL));
  flag = last_step(s, flag);
  collect(s);
  return verdict(s, flag);
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  ida *s = state;
  STEIF_TRY(stf_baseline_inside(&s->base, &t));
  stf_baseline_enter(&s->base, run);
  const int flag = s->call->IDAGetDky(s->memory, t, 0, y);
  return stf_baseline_dense(&s->base, flag, t);
}

static void close(stf_run *run, void *state)
{
  (void)run;
  ida *s = state;
  if (s->memory) s->call->IDAFree(&s->memory);
}

const steif_engine steif_engine_ida = {
  .about = "IDA: variable-order, variable-coefficient BDF for DAEs (Hindmarsh et al., ACM TOMS "
           "31, 2005; SUNDIALS); suppress=0|1, id=E|index|ones, ic=0|1|2, order=1..5: by "
           "default for index 0 and 1, suppress=1 for index 2, and id=index for many of index "
           "3 and 4 from consistent starts",
  .forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
  .size = sizeof(ida),
  .open = open,
  .step = step,
  .advance = advance,
  .dense = dense,
  .renew = stf_baseline_renewed,
  .close = close,
};
