/* arkode.c: ARKODE's diagonally implicit Runge-Kutta methods for y' = f and M y' = f, and any
 * diagonally implicit table of this library in them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_ls.h>
#include <math.h>
#include <steif/table.h>

/* Functions common to all of ARKODE's steppers have one name since 7.1. */
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define ARK(name) ARKode##name
#else
#define ARK(name) ARKStep##name
#endif

typedef struct arkode {
  stf_baseline base;
  void *memory;
  SUNMatrix M; /* ARKODE's own copy of the mass matrix */
  SUNLinearSolver mass_solver;
  int order;
  sunrealtype newton;
} arkode;

static const stf_flag flags[] = {
  STF_FLAG(ARK_TOO_MUCH_WORK, STEIF_STEP_LIMIT, "too many internal steps",
           "Raise max_steps or loosen the tolerances"),
  STF_FLAG(ARK_TOO_MUCH_ACC, STEIF_BASELINE, "more accuracy was asked for than the machine has",
           "Loosen rtol, or raise atol where a component is near zero"),
  STF_FLAG(ARK_ERR_FAILURE, STEIF_BASELINE,
           "the error test failed repeatedly or the step reached its minimum",
           "The loose default of its Newton iteration spoils the estimate of stiff components: "
           "try newton=1e-5 in the spec, or another method"),
  STF_FLAG(ARK_CONV_FAILURE, STEIF_BASELINE,
           "Newton's iteration failed repeatedly or the step reached its minimum",
           "Check df/dy against differences; with prescribed steps make h smaller"),
  STF_FLAG(ARK_CONSTR_FAIL, STEIF_INFEASIBLE,
           "a declared constraint was not kept however small the step",
           "The solution leaves .constraint here, or the tolerances are too loose"),
  STF_FLAG(ARK_LINIT_FAIL, STEIF_BASELINE, "the linear solver could not be set up",
           "Check storage and bandwidths"),
  STF_FLAG(ARK_LSETUP_FAIL, STEIF_BASELINE, "the Jacobian or its factorisation failed",
           "Check the Jacobian callback and its pattern"),
  STF_FLAG(ARK_LSOLVE_FAIL, STEIF_BASELINE, "a linear solve failed",
           "Check the Jacobian callback, or use a direct solver"),
  STF_FLAG(ARK_RHSFUNC_FAIL, STEIF_CALLBACK, "f asked to stop", "See what f objected to"),
  STF_FLAG(ARK_FIRST_RHSFUNC_ERR, STEIF_CALLBACK, "f could not be evaluated at the start",
           "Check the start values"),
  STF_FLAG(ARK_REPTD_RHSFUNC_ERR, STEIF_CALLBACK, "f kept failing however small the step",
           "The solution may leave the domain of f here"),
  STF_FLAG(ARK_UNREC_RHSFUNC_ERR, STEIF_CALLBACK, "f failed where the step cannot be repeated",
           "The solution may leave the domain of f here"),
  STF_FLAG(ARK_MASSINIT_FAIL, STEIF_BASELINE, "the mass matrix could not be set up",
           "E must be nonsingular and stored like the Jacobian"),
  STF_FLAG(ARK_MASSSETUP_FAIL, STEIF_BASELINE, "the mass matrix E could not be factored",
           "ARKODE needs a nonsingular E: use ida or a steif method"),
  STF_FLAG(ARK_MASSSOLVE_FAIL, STEIF_BASELINE, "a solve with the mass matrix E failed",
           "ARKODE needs a nonsingular E: use ida or a steif method"),
  STF_FLAG(ARK_MEM_FAIL, STEIF_NO_MEMORY, "memory is short", "Make the problem smaller"),
  STF_FLAG(ARK_ILL_INPUT, STEIF_BASELINE, "an argument was rejected",
           "An error weight that is not positive does this: raise atol above 0"),
  STF_FLAG(ARK_TOO_CLOSE, STEIF_STEP_SIZE, "the end is too close to the start",
           "Make the interval longer than rounding"),
  STF_FLAG(ARK_VECTOROP_ERR, STEIF_BASELINE, "a vector operation failed",
           "A mass matrix that is singular does this: use ida or a steif method"),
  STF_FLAG(ARK_INVALID_TABLE, STEIF_BASELINE, "the table was rejected",
           "It must be diagonally implicit, and embedded unless h is given"),
  {0, 0, NULL, NULL, NULL}};

static int verdict(arkode *s, int flag)
{
  sunrealtype h = 0;
  if (flag < 0 && s->memory) ARK(GetCurrentStep)(s->memory, &h);
  stf_baseline_leave(&s->base);
  return stf_baseline_verdict(&s->base, flag, h, s->order);
}

/* --- the mass matrix --- */

static int mass(sunrealtype t, SUNMatrix M, void *user, N_Vector tmp1, N_Vector tmp2,
                N_Vector tmp3)
{
  (void)tmp1, (void)tmp2, (void)tmp3;
  stf_baseline *b = user;
  if (b->run->mass_of_time && stf_fill_mass(b, t)) return -1;
  if (b->storage == STEIF_SPARSE) return SUNMatCopy(b->E, M);
  stf_matrix_add(M, 1, b->E);
  return 0;
}

static int open_mass(arkode *s)
{
  stf_baseline *b = &s->base;
  const steif_problem *p = b->run->problem;
  if (b->run->form != STEIF_MASS) return STEIF_OK;
  STEIF_CHECK(
    b->storage != STEIF_KRYLOV && p->E, b->run->ctx, STEIF_UNSUPPORTED,
    "ARKODE takes a mass matrix as entries only (.E with dense, band or sparse storage)");
  STEIF_TRY(stf_lower_mass(b));
  s->M = stf_matrix_new(b->run, b->storage, p->nnz_E ? p->nnz_E : p->n);
  if (!s->M) return steif_status(b->run->ctx);
  s->mass_solver = stf_baseline_solver(b, s->M);
  return s->mass_solver ? STEIF_OK : steif_status(b->run->ctx);
}

/* --- the table --- */

static int take_table(arkode *s, const steif_table *t)
{
  steif_context *ctx = s->base.run->ctx;
  const bool given = s->base.run->options->h > 0;
  STEIF_CHECK(t->kind == STEIF_DIRK, ctx, STEIF_UNSUPPORTED,
              "table '%s' is not diagonally implicit: ARKODE cannot run it", t->name);
  STEIF_CHECK(given || t->bhat, ctx, STEIF_UNSUPPORTED,
              "table '%s' has no embedded weights: give h for constant steps", t->name);
  sunrealtype c[STEIF_STAGES], A[STEIF_STAGES * STEIF_STAGES], b[STEIF_STAGES], d[STEIF_STAGES];
  for (int i = 0; i < t->s; i++) {
    b[i] = t->b[i], d[i] = t->bhat ? t->bhat[i] : 0, c[i] = 0;
    for (int j = 0; j < t->s; j++) c[i] += A[i * t->s + j] = t->A[i * t->s + j];
    if (t->c) c[i] = t->c[i];
  }
  ARKodeButcherTable B = ARKodeButcherTable_Create(t->s, t->order, t->bhat ? t->order_hat : 0,
                                                   c, A, b, t->bhat ? d : NULL);
  STEIF_CHECK(B, ctx, STEIF_NO_MEMORY, "no memory for table '%s'", t->name);
  const int flag = ARKStepSetTables(s->memory, B->q, B->p, B, NULL);
  ARKodeButcherTable_Free(B);
  s->order = t->order;
  STEIF_CHECK(flag >= 0, ctx, STEIF_BASELINE, "ARKODE rejected table '%s' (flag %d): %s",
              t->name, flag, s->base.said);
  return STEIF_OK;
}

static int choose_table(arkode *s, const steif_spec *spec)
{
  steif_context *ctx = s->base.run->ctx;
  const char *name = stf_spec_word(spec, "table");
  if (!name) {
    const int flag = ARK(SetOrder)(s->memory, s->order);
    STEIF_CHECK(flag >= 0, ctx, STEIF_BASELINE, "ARKODE rejected order %d", s->order);
    return STEIF_OK;
  }
  STEIF_CHECK(!stf_spec_word(spec, "order"), ctx, STEIF_BAD_INPUT,
              "give arkode an order or a table (%s), not both", name);
  steif_table *table = steif_table_new(ctx, name);
  if (!table) return steif_status(ctx);
  const int code = take_table(s, table);
  steif_table_free(ctx, &table);
  return code;
}

/* --- opening --- */

static int attach(arkode *s)
{
  stf_baseline *b = &s->base;
  void *m = s->memory;
  int flag = ARK(SetLinearSolver)(m, b->solver, b->J);
  if (b->J && stf_baseline_has_jac(b)) STF_CALL(flag, ARK(SetJacFn)(m, stf_baseline_jac));
  if (!b->J && b->run->problem->Av) STF_CALL(flag, ARK(SetJacTimes)(m, NULL, stf_baseline_jv));
  if (b->preconditioned)
    STF_CALL(flag, ARK(SetPreconditioner)(m, stf_baseline_precsetup, stf_baseline_precsolve));
  if (s->M) {
    STF_CALL(flag, ARK(SetMassLinearSolver)(m, s->mass_solver, s->M, b->run->mass_of_time));
    STF_CALL(flag, ARK(SetMassFn)(m, mass));
  }
  return flag;
}

/* Constant steps, the last one as short as t1 asks for, and a Newton iteration at the level of rounding,
 * so that the result is that of the table: 1e-2 of weights of 1e-10 relative. */
static int constant_steps(arkode *s)
{
  const sunrealtype tight = 1e-10;
  void *m = s->memory;
  int flag = ARK(SetFixedStep)(m, s->base.run->options->h);
  STF_CALL(flag, ARK(SStolerances)(m, tight, tight));
  STF_CALL(flag, ARK(SetNonlinConvCoef)(m, 1e-2));
  STF_CALL(flag, ARK(SetMaxNonlinIters)(m, 20));
  STF_CALL(flag, ARK(SetDeltaGammaMax)(m, tight)); /* the last step has its own matrices */
  return flag;
}

static int configure(arkode *s)
{
  const stf_run *run = s->base.run;
  const steif_options *o = run->options;
  void *m = s->memory;
  int flag = STF_SILENCE(ARKStepSetErrHandlerFn, m, &s->base);
  STF_CALL(flag, ARK(SetUserData)(m, s));
  STF_CALL(flag, o->ewt         ? ARK(WFtolerances)(m, stf_baseline_weights)
                 : s->base.atol ? ARK(SVtolerances)(m, o->rtol, s->base.atol)
                                : ARK(SStolerances)(m, o->rtol, o->atol));
  STF_CALL(flag, ARK(SetMaxHnilWarns)(m, -1));
  if (s->base.constraint) STF_CALL(flag, ARK(SetConstraints)(m, s->base.constraint));
  if (o->h0 > 0) STF_CALL(flag, ARK(SetInitStep)(m, o->h0));
  if (o->h_max > 0) STF_CALL(flag, ARK(SetMaxStep)(m, o->h_max));
  STF_CALL(flag, attach(s));
  if (o->h > 0) STF_CALL(flag, constant_steps(s));
  if (s->newton > 0) STF_CALL(flag, ARK(SetNonlinConvCoef)(m, s->newton));
  if (run->problem->linear && s->base.J && stf_baseline_has_jac(&s->base))
    STF_CALL(flag, ARK(SetLinear)(m, 0)); /* one Newton iteration is exact */
  return flag;
}

static int prepare(stf_run *run, arkode *s, const steif_spec *spec)
{
  stf_baseline *b = &s->base;
  STEIF_TRY(
    stf_spec_only(run->ctx, spec, (const char *const[]){"order", "table", "newton", NULL}));
  STEIF_TRY(stf_spec_int(run->ctx, spec, "order", 2, 5, 4, &s->order));
  STEIF_TRY(stf_spec_real(run->ctx, spec, "newton", 1e-12, 1, 0, &s->newton));
  STEIF_TRY(stf_baseline_open(b, run, "ARKODE", flags));
  STEIF_TRY(stf_baseline_near(b));
  STEIF_TRY(stf_baseline_linear(b, stf_baseline_has_jac(b)));
  if (b->J && b->storage != run->problem->storage && stf_baseline_has_jac(b))
    STEIF_TRY(stf_baseline_native(b));
  return open_mass(s);
}

static int open(stf_run *run, void *state, const steif_spec *spec)
{
  arkode *s = state;
  STEIF_TRY(prepare(run, s, spec));
  STEIF_TRY(stf_baseline_gate(&s->base));
  stf_baseline_enter(&s->base, run);
  s->memory = ARKStepCreate(NULL, stf_baseline_rhs, run->t, run->y, steif_sundials(run->ctx));
  STEIF_TRY(verdict(s, s->memory ? configure(s) : ARK_MEM_FAIL));
  stf_baseline_enter(&s->base, run);
  const int code = choose_table(s, spec);
  stf_baseline_leave(&s->base);
  return code;
}

/* --- stepping --- */

static void collect(arkode *s)
{
  steif_stats n = {0};
  void *m = s->memory;
  long more = 0, explicit_part = 0;
  ARK(GetNumSteps)(m, &n.steps);
  ARK(GetNumErrTestFails)(m, &n.rejected);
  ARKStepGetNumRhsEvals(m, &explicit_part, &n.nfe);
  ARK(GetNumLinRhsEvals)(m, &more);
  n.nfe += more;
  ARK(GetNumJacEvals)(m, &n.nje);
  ARK(GetNumLinSolvSetups)(m, &n.nlu);
  ARK(GetNumNonlinSolvIters)(m, &n.newton);
  ARK(GetNumStepSolveFails)(m, &n.newton_fails);
  ARK(GetNumLinIters)(m, &n.nli);
  ARK(GetLastStep)(m, &n.h_last);
  stf_baseline_count(&s->base, &n);
}

static int step(stf_run *run, void *state, sunrealtype t_stop)
{
  arkode *s = state;
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = 0;
  if (s->base.restart)
    flag =
      ARKStepReInit(s->memory, NULL, stf_baseline_rhs, stf_baseline_renew(&s->base), run->y);
  STF_CALL(flag, ARK(SetStopTime)(s->memory, t_stop));
  STF_CALL(flag, ARK(Evolve)(s->memory, t_stop, run->y, &run->t, ARK_ONE_STEP));
  collect(s);
  return verdict(s, flag);
}

/* The end of the last good step, which may lie beyond the time that was asked for. */
static int last_step(arkode *s, int flag)
{
  stf_run *run = s->base.run;
  sunrealtype tn = run->t;
  ARK(GetCurrentTime)(s->memory, &tn);
  if (flag == ARK_TOO_MUCH_WORK) flag = 0;
  if (flag >= 0 && tn <= run->t) return flag;
  if (ARK(GetDky)(s->memory, tn, 0, run->y) >= 0) run->t = tn;
  return flag;
}

static int advance(stf_run *run, void *state, sunrealtype t, sunrealtype t_stop, long steps)
{
  arkode *s = state;
  const long left = run->options->max_steps - run->stats.steps;
  if (s->base.restart || !run->stats.steps || run->options->h > 0)
    return step(run, state, t_stop); /* the first step is scaled by all of the interval */
  STEIF_TRY(stf_baseline_ready(&s->base, run, &t_stop));
  int flag = ARK(SetStopTime)(s->memory, t_stop);
  STF_CALL(flag, ARK(SetMaxNumSteps)(s->memory, steps < left ? steps : left));
  STF_CALL(flag, ARK(Evolve)(s->memory, fmin(t, t_stop), run->y, &run->t, ARK_NORMAL));
  flag = last_step(s, flag);
  collect(s);
  return verdict(s, flag);
}

static int dense(stf_run *run, void *state, sunrealtype t, N_Vector y)
{
  arkode *s = state;
  STEIF_TRY(stf_baseline_inside(&s->base, &t));
  stf_baseline_enter(&s->base, run);
  const int flag = ARK(GetDky)(s->memory, t, 0, y);
  return stf_baseline_dense(&s->base, flag, t);
}

static void close(stf_run *run, void *state)
{
  (void)run;
  arkode *s = state;
  if (s->memory) ARK(Free)(&s->memory);
}

const steif_engine steif_engine_arkode = {
  .about =
    "ARKODE: diagonally implicit Runge-Kutta methods of orders 2 to 5 (Reynolds, Gardner, "
    "Woodward, Chinomona, ACM TOMS 49, 2023; SUNDIALS); order=2..5 or table=NAME, newton=C",
  .forms = STEIF_ODE | STEIF_MASS,
  .size = sizeof(arkode),
  .open = open,
  .step = step,
  .advance = advance,
  .dense = dense,
  .renew = stf_baseline_renewed,
  .close = close,
  .mass_of_time = true,
};
