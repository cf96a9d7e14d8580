/* passage.c: jumps of E x' + F x = f and the smooth solution between them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "passage.h"
#include "run_scale.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/method.h>
#include <steif/table.h>
#include <string.h>

/* -- the jump ---------------------------------------------------------------------------- */

static int left_of(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const stf_passage *p = user;
  return p->linear.f(t < p->end ? t : p->before, derivative, g, p->linear.user);
}

static void charge(stf_passage *p, const steif_pencil_stats *more)
{
  p->cost.factors += more->factors, p->cost.refactors += more->refactors;
  p->cost.solves += more->solves;
}

static int keep_factors(stf_passage *p, sunrealtype radius)
{
  STEIF_TRY(stf_smooth_flow_open(p->ctx, &p->linear, p->analysis, &p->structure,
                                 radius > 0 ? radius : p->structure.radius, &p->through));
  charge(p, steif_pencil_statistics(p->through.circle->scaled.pencil));
  return STEIF_OK;
}

/* x(t+) and the impulses of p->x = x(t-). */
static int jump(stf_passage *p, sunrealtype t)
{
  steif_impulse i = {0};
  const steif_linear *l = &p->linear;
  int code = steif_impulse_find(p->ctx, l->E, l->F, p->x, t, l->f, l->user, p->analysis,
                                &p->structure, &i);
  if (!code && p->jump && p->jump(t, p->x, &i, p->user))
    code = STEIF_FAIL(p->ctx, STEIF_CALLBACK, "the output stopped the run at t = %.12g", t);
  if (!code) memcpy(p->x, i.x_plus, (size_t)i.n * sizeof *p->x);
  if (!code && p->settles && stf_circle_kept(&p->structure) && !p->through.ctx)
    code = keep_factors(p, i.radius);
  charge(p, &i.cost);
  steif_impulse_clear(p->ctx, &i);
  return code;
}

/* What the method missed the constraints by would be taken for a jump, and differentiated; and
 * what it makes of unknowns of index k, of which errors of size tol / h^(k-1) are let pass,
 * follows from the slow part and f. */
int stf_passage_settle(stf_passage *p, sunrealtype t, sunrealtype *x)
{
  steif_impulse i = {0};
  const steif_linear *l = &p->cut;
  if (p->through.ctx) return stf_smooth_flow_state(&p->through, t, l->f, l->user, x);
  const int code =
    steif_impulse_find(p->ctx, l->E, l->F, x, t, l->f, l->user, p->analysis, &p->structure, &i);
  if (!code) memcpy(x, i.x_plus, (size_t)i.n * sizeof *x);
  charge(p, &i.cost);
  steif_impulse_clear(p->ctx, &i);
  return code;
}

/* -- a segment --------------------------------------------------------------------------- */

/* In a first step far below the time scales of the system an unknown of index k would be its
 * rounding errors times h^(1-k). */
static sunrealtype first_step(const stf_passage *p, sunrealtype from)
{
  if (p->options.h0 > 0 || !p->index) return p->options.h0;
  const sunrealtype rate = p->structure.radius, span = p->end - from;
  return fmin(1e-3 * span, rate > 0 ? 1e-2 / rate : p->end);
}

/* For itself `auto` would find this run again; high unknowns of large systems are
 * collocation's. */
static const char *method_of(const stf_passage *p)
{
  return p->index && !strcmp(p->method, "auto") ? "radau:s=3" : p->method;
}

/* States that have vanished at a jump but for rounding are no measure. */
#define VANISHED 1e-8

/* Of the states after the jump at `from`, and of all before. */
static int measure(stf_passage *p, sunrealtype from, sunrealtype before)
{
  sunrealtype scale;
  if (p->options.atol > 0 || p->options.atols) return STEIF_OK;
  STEIF_TRY(stf_run_scale(p->ctx, &p->cut, p->x, from, p->end, &scale));
  p->scale = fmin(fmax(fmax(scale, p->scale), VANISHED * before), 1);
  p->problem.rtol_scale = p->scale;
  return STEIF_OK;
}

static sunrealtype largest(const stf_passage *p)
{
  sunrealtype most = 0;
  for (sunindextype i = 0; i < p->n; i++) most = fmax(most, fabs(p->x[i]));
  return most;
}

int stf_passage_begin(stf_passage *p, sunrealtype from, sunrealtype to)
{
  const bool low = p->reduced.linear.E;
  p->end = to, p->before = nextafter(to, from);
  p->cut = (steif_linear){p->linear.E, p->linear.F, p->linear.f ? left_of : NULL, p};
  p->reduced.from = &p->cut;
  steif_solver_free(&p->solver);
  const sunrealtype before = largest(p);
  STEIF_TRY(jump(p, from));
  STEIF_TRY(steif_linear_problem(p->ctx, low ? &p->reduced.linear : &p->cut, p->x, from, to,
                                 &p->problem));
  p->problem.index = p->index;
  p->problem.dae_index = p->index ? p->structure.index : 1;
  if (p->name) p->problem.name = p->name;
  STEIF_TRY(measure(p, from, before));
  steif_options o = p->options;
  o.t1 = to, o.h0 = first_step(p, from);
  p->solver = steif_solver_new(p->ctx, &p->problem, method_of(p), &o);
  return p->solver ? STEIF_OK : steif_status(p->ctx);
}

/* -- opening ----------------------------------------------------------------------------- */

/* Does the method carry errors of algebraic unknowns along, |R(inf)| > 0? */
static int keeps(stf_passage *p, bool *yes)
{
  steif_method_info info;
  const bool hushed = stf_silence(p->ctx, true);
  const int code = steif_method_find(p->ctx, p->method, &info);
  stf_silence(p->ctx, hushed);
  *yes = !code && (info.claims & STEIF_A_STABLE) &&
         !(info.claims & (STEIF_L_STABLE | STEIF_STIFFLY_ACCURATE));
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

/* Given steps show what the method makes of the system as it is. Chosen ones need errors that
 * mean something: of a system of index 1, or of unknowns judged by their index. */
static int lower(stf_passage *p)
{
  bool slope;
  const bool chosen = !(p->options.h > 0) && !p->options.mesh;
  STEIF_TRY(keeps(p, &slope));
  if (chosen)
    STEIF_TRY(stf_reduced_open(p->ctx, &p->linear, &p->structure, slope, &p->reduced));
  if (p->reduced.linear.E) return STEIF_OK;
  p->settles = chosen && p->structure.index > 1;
  return stf_component_index(p->ctx, &p->linear, p->analysis, &p->structure, &p->index);
}

static int open(stf_passage *p, const sunrealtype *x0)
{
  const steif_linear *l = p->given;
  p->demand = stf_demand_of(p->ctx, l, p->analysis);
  p->linear = stf_demand_linear(&p->demand);
  STEIF_TRY(steif_structure_find(p->ctx, l->E, l->F, p->analysis, &p->structure));
  p->demand.finite = p->structure.finite;
  charge(p, &p->structure.cost);
  p->n = p->structure.n;
  p->x = stf_allocate(p->ctx, (size_t)p->n, sizeof *p->x);
  if (!p->x) return STEIF_NO_MEMORY;
  memcpy(p->x, x0, (size_t)p->n * sizeof *p->x);
  return lower(p);
}

int stf_passage_open(stf_passage *p, const sunrealtype *x0)
{
  const int code = open(p, x0);
  if (code) stf_passage_close(p);
  return code;
}

void stf_passage_close(stf_passage *p)
{
  if (!p->ctx) return;
  steif_solver_free(&p->solver);
  stf_demand_close(&p->demand);
  steif_structure_clear(p->ctx, &p->structure);
  stf_reduced_close(&p->reduced);
  stf_smooth_flow_close(&p->through);
  stf_release(p->ctx, p->index);
  stf_release(p->ctx, p->x);
  p->index = NULL, p->x = NULL;
}
