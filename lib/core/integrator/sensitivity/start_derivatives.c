/* start_derivatives.c: dy0/dp where the start has to fulfil equations: starts that were repaired, and hidden constraints.
 *
 * C(y0, p) is the consistent start nearest to y0. Along (S0, e_k) its derivative is S0 where S0 fulfils the
 * constraints differentiated, hidden ones too, and else what the start of a run has: it is found by central differences
 * of two lengths, extrapolated.
 *
 * Of index 1 the start may be consistent for one value of p alone, and the solution jumps for others: so does S, to
 * what the equations differentiated ask for, E S held. With (E/h - A) d(h) = A S0 - F_p, a step of backward Euler,
 * d(h) = jump + c h + O(h^2): the jump is 2 d(h/2) - d(h) of a short h. Two lengths have to agree. The same behind an
 * event, where algebraic unknowns of y follow the others, and behind a break.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "saltation.h"
#include <math.h>
#include <steif/pencil.h>
#include <string.h>

static const sunrealtype exact = 1e-13; /* tolerance of C: what would move by less stays */

/* out = C(y0 + x S0, p_k + x), S0 of the given start. */
static int consistent(steif_solver *s, N_Vector S0, int k, sunrealtype x, sunrealtype *y0,
                      N_Vector out)
{
  const steif_parameters *q = s->problem->parameters;
  const sunrealtype *from = s->given->y0, *along = stf_array(S0), p = q->value[k];
  for (sunindextype i = 0; i < s->problem->n; i++) y0[i] = from[i] + x * along[i];
  steif_problem here = *s->given;
  here.y0 = y0;
  stf_pool *pool = stf_pool_new(s->ctx);
  if (!pool) return STEIF_NO_MEMORY;
  stf_repair repair = {.ctx = s->ctx,
                       .pool = pool,
                       .given = &here,
                       .attribute = s->options.attributes,
                       .rtol = exact,
                       .atol = exact * s->step.system.scale};
  int code = stf_set_parameter(s, k, p + x);
  if (!code) code = stf_start_repaired(&repair);
  if (!code) memcpy(stf_array(out), repair.problem.y0, (size_t)here.n * sizeof *y0);
  stf_pool_free(&pool);
  const int back = stf_set_parameter(s, k, p);
  return code ? code : back;
}

/* out = dC along (S0, e_k), work: two more vectors. */
static int differences(steif_solver *s, N_Vector S0, int k, sunrealtype *y0, N_Vector out,
                       N_Vector work)
{
  const steif_parameters *q = s->problem->parameters;
  const sunrealtype typical = q->scale ? q->scale[k] : fabs(q->value[k]);
  const sunrealtype d = (typical > 0 ? typical : 1) / 256;
  static const sunrealtype by[] = {1, -1, 2, -2}, weight[] = {8, -8, -1, 1};
  N_VConst(0, out);
  for (int j = 0; j < 4; j++) {
    STEIF_TRY(consistent(s, S0, k, by[j] * d / 2, y0, work));
    N_VLinearSum(weight[j] / (6 * d), work, 1, out, out);
  }
  return STEIF_OK;
}

/* Components with a derivative are read by the first step. */
static int compare(steif_solver *s, int k, N_Vector S0, N_Vector found)
{
  const steif_problem *p = s->problem;
  const sunrealtype *a = stf_array(S0), *b = stf_array(found);
  const sunrealtype size = fmax(N_VMaxNorm(S0), N_VMaxNorm(found));
  char name[STEIF_SPEC_WORD];
  for (sunindextype i = 0; i < p->n; i++)
    STEIF_CHECK(
      (p->index && p->index[i] >= p->dae_index) ||
        fabs(a[i] - b[i]) <= 1e-5 * fabs(b[i]) + 1e-6 * size,
      s->ctx, STEIF_UNSUPPORTED,
      "dy0/dp of parameter %d of problem '%s' is off its hidden constraints: that of %s is "
      "%.6g, and %.6g lies on them: give parameters.start",
      k + 1, p->name, stf_unknown(p, i, name), a[i], b[i]);
  return STEIF_OK;
}

/* ---- jumps of index 1, of starts that were not repaired, and behind events --------------------- */

/* Columns at a point, and room for as many more. */
typedef struct stf_point_columns {
  sunrealtype t;
  N_Vector y, yp;
  N_Vector *S, *found, *before;
} stf_point_columns;

/* out_k += weight d_k(h), h = 1/shift. STEIF_RETRY: singular there. */
static int add_step(stf_carry *T, const stf_point_columns *c, sunrealtype shift,
                    sunrealtype weight, N_Vector *out)
{
  steif_pencil *p = T->step->system.pencil;
  const int code = steif_pencil_factor(p, 1, &(steif_shift){shift, 0});
  if (code) return code == STEIF_SINGULAR ? STEIF_RETRY : code;
  for (int k = 0; k < T->count; k++) {
    STEIF_TRY(stf_carry_residual(T, 0, k, c->S[k], NULL, T->work));
    STEIF_TRY(steif_pencil_solve(p, 0, 1, &T->work, NULL));
    N_VLinearSum(1, out[k], weight, T->work, out[k]);
  }
  return STEIF_OK;
}

/* How far `found` is from `before`, in parts of S, of itself, and of y over p. */
static sunrealtype apart(const stf_carry *T, const stf_point_columns *c, int k)
{
  const sunrealtype least = N_VMaxNorm(c->y) / T->scale[k];
  const sunrealtype size = fmax(least, fmax(N_VMaxNorm(c->S[k]), N_VMaxNorm(c->found[k])));
  N_VLinearSum(1, c->found[k], -1, c->before[k], T->work);
  return size > 0 ? N_VMaxNorm(T->work) / size : 0;
}

static int extrapolate(stf_carry *T, const stf_point_columns *c, sunrealtype shift,
                       N_Vector *found)
{
  for (int k = 0; k < T->count; k++) N_VConst(0, found[k]);
  STEIF_TRY(add_step(T, c, shift, -1, found));
  return add_step(T, c, 2 * shift, 2, found);
}

static void follow(const stf_carry *T, const stf_point_columns *c)
{
  for (int k = 0; k < T->count; k++) N_VLinearSum(1, c->S[k], 1, c->found[k], c->S[k]);
}

/* Lengths are 64 apart, their errors 4096; a second time for what rounding has left of the first. */
static int jump(steif_solver *s, stf_carry *T, const stf_point_columns *c)
{
  sunrealtype shift = 1e3 / (s->t1 - s->problem->t0);
  STEIF_TRY(stf_carry_point(T, 0, c->t, c->y, c->yp));
  STEIF_TRY(extrapolate(T, c, shift, c->before));
  for (int attempt = 0; attempt < 7; attempt++) {
    sunrealtype most = 0;
    shift *= 64;
    STEIF_TRY(extrapolate(T, c, shift, c->found));
    for (int k = 0; k < T->count; k++) {
      most = fmax(most, apart(T, c, k));
      N_VScale(1, c->found[k], c->before[k]);
    }
    if (most > 1e-6) continue;
    follow(T, c);
    STEIF_TRY(extrapolate(T, c, shift, c->found));
    follow(T, c);
    return STEIF_OK;
  }
  return STEIF_OK;
}

static bool may_jump(const steif_solver *s)
{
  const stf_system *system = &s->step.system;
  return system->form != STEIF_ODE && !system->linear && !system->krylov && s->step.adaptive;
}

/* The index of a mode is that of the equations that hold now. */
static bool jumps(const steif_solver *s) { return may_jump(s) && s->problem->dae_index == 1; }

int stf_start_jumps(steif_solver *s, stf_carry *T)
{
  const stf_step *step = &s->step;
  const stf_point_columns c = {.t = step->t,
                               .y = step->y,
                               .yp = step->yp,
                               .S = T->S,
                               .found = T->next,
                               .before = T->before};
  if (!jumps(s) || s->options.initial == STEIF_AS_GIVEN || s->repair.report.moved > 0)
    return STEIF_OK;
  const int code = jump(s, T, &c);
  return code == STEIF_RETRY ? STEIF_OK : code;
}

int stf_saltation_jumps(steif_solver *s, sunrealtype t, N_Vector y)
{
  const stf_saltation *w = s->saltation;
  const stf_point_columns c = {
    .t = t, .y = y, .yp = w->after, .S = w->jump, .found = w->found, .before = w->found_before};
  if (!w->found || !jumps(s)) return STEIF_OK;
  const int code = jump(s, s->step.carry, &c);
  return code == STEIF_RETRY ? STEIF_OK : code;
}

int stf_saltation_jumps_claim(steif_solver *s)
{
  stf_saltation *w = s->saltation;
  const int count = stf_columns(s);
  if (count == 0 || !may_jump(s)) return STEIF_OK;
  w->found = stf_pool_vectors(s->pool, count, s->step.y);
  w->found_before = stf_pool_vectors(s->pool, count, s->step.y);
  return w->found && w->found_before ? STEIF_OK : STEIF_NO_MEMORY;
}

/* ---- starts that were repaired, and hidden constraints ---------------------------------------- */

int stf_start_derivatives(steif_solver *s, stf_carry *T)
{
  const steif_problem *p = s->problem;
  const bool repaired = s->repair.report.moved > 0;
  const bool descriptor = s->step.system.form == STEIF_DESCRIPTOR;
  const bool jumps = descriptor && s->repair.pool && s->repair.policy == STEIF_REPAIR;
  const bool hidden = p->dae_index > (jumps ? 0 : 1) && p->n <= STEIF_DIAGNOSE_LARGEST;
  if (!s->given->y0 || s->given->start || (descriptor && !jumps) || !(repaired || hidden))
    return STEIF_OK;
  sunrealtype *y0 = stf_pool_array(s->pool, (size_t)p->n, sizeof *y0);
  if (!y0) return STEIF_NO_MEMORY;
  for (int k = 0; k < T->count; k++) {
    N_Vector S0 = T->S[k], found = T->next[k];
    const int code = differences(s, S0, T->parameter[k], y0, found, T->work);
    if (code == STEIF_RETRY && !repaired && p->parameters->start) continue;
    STEIF_CHECK(
      code != STEIF_RETRY, s->ctx, STEIF_UNSUPPORTED,
      "the derivative of the start of problem '%s' by parameter %d was not found: starts "
      "near it are not repaired; give a consistent start and parameters.start",
      p->name, T->parameter[k] + 1);
    STEIF_TRY(code);
    if (!repaired && !jumps) STEIF_TRY(compare(s, T->parameter[k], S0, found));
    if (repaired || jumps) N_VScale(1, found, S0);
  }
  return STEIF_OK;
}
