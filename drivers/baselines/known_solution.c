/* known_solution.c: x(0+) and x(t1) by other means than the baseline that is judged by them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "settings.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>

static double largest(size_t n, const double *x)
{
  double most = 0;
  for (size_t i = 0; x && i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

static bool source(known_solution *k, const char *text)
{
  snprintf(k->source, sizeof k->source, "%s", text);
  return true;
}

static bool closed(steif_context *ctx, const steif_problem *p, double t1, known_solution *k,
                   double *x)
{
  N_Vector v = p->exact ? N_VMake_Serial(p->n, x, steif_sundials(ctx)) : NULL;
  const bool there = v && p->exact(t1, v, NULL, p->user) == 0;
  if (v) N_VDestroy(v);
  return there && source(k, "closed solution");
}

static bool published(const steif_problem *p, double t1, known_solution *k, double *x)
{
  const steif_reference *r = p->reference;
  if (!r || r->t != t1 || (r->count && r->count != p->n) || r->component) return false;
  memcpy(x, r->value, k->n * sizeof *x);
  return source(k, "published");
}

/* x(t1) of a linear system through all its jumps, by radau:s=5 in small parts; trusted where half as many
 * parts agree to a tenth of the tolerance. */
static bool linear(steif_context *ctx, const steif_problem *p, const steif_options *o,
                   known_solution *k, double *x)
{
  enum { ROWS = 16 };
  double t[ROWS], *rows = calloc(ROWS * k->n, sizeof *rows);
  steif_linear_truth how = {0};
  const double span = (o->t1 > 0 ? o->t1 : p->t1) - p->t0;
  bool there = k->pencil && rows;
  for (int i = 0; i < ROWS; i++) t[i] = p->t0 + span * (i + 1) / ROWS;
  if (there)
    there = !steif_linear_exact(ctx, &k->system, p->y0, p->t0, NULL, (size_t)p->break_count,
                                p->breaks, ROWS, t, NULL, rows, &how) &&
            how.accuracy < 0.1 * o->rtol;
  if (there) memcpy(x, rows + (ROWS - 1) * k->n, k->n * sizeof *x);
  free(rows);
  return there && source(k, "radau:s=5 in small parts, after the jump");
}

static bool own_run(steif_context *ctx, const steif_problem *p, const steif_options *given,
                    double t1, known_solution *k, double *x)
{
  steif_options o = *given;
  o.rtol = fmax(1e-3 * o.rtol, 1e-12);
  o.atol *= o.rtol / given->rtol;
  steif_solver *s = steif_solver_new(ctx, p, "auto", &o);
  const bool there = s && steif_solve_to(s, t1) == STEIF_OK;
  if (there) memcpy(x, N_VGetArrayPointer(steif_solution(s)), k->n * sizeof *x);
  steif_solver_free(&s);
  snprintf(k->source, sizeof k->source, "steif's auto, rtol %.0e", o.rtol);
  return there;
}

/* x(0+): the jump of a linear system, else the start. */
static bool jump(steif_context *ctx, const steif_problem *p, known_solution *k, double *x)
{
  steif_impulse i = {0};
  if (!k->pencil) {
    if (p->y0) memcpy(x, p->y0, k->n * sizeof *x);
    return p->y0;
  }
  const steif_linear *l = &k->system;
  const bool there =
    !steif_structure_find(ctx, l->E, l->F, NULL, &k->structure) &&
    !steif_impulse_find(ctx, l->E, l->F, p->y0, p->t0, l->f, l->user, NULL, &k->structure, &i);
  if (there) memcpy(x, i.x_plus, k->n * sizeof *x);
  if (there) k->index = i.index;
  steif_impulse_clear(ctx, &i);
  return there;
}

void known_open(const struct call *call, const steif_problem *p, const steif_options *o,
                known_solution *k)
{
  steif_context *ctx = call->ctx;
  *k = (known_solution){.n = (size_t)p->n, .index = p->dae_index};
  k->slow = calloc(4 * k->n, sizeof *k->slow);
  if (!k->slow) return;
  double *plus = k->slow + 2 * k->n, *end = plus + k->n;
  const double t1 = o->t1 > 0 ? o->t1 : p->t1;
  const bool descriptor = p->y0 && steif_problem_form(ctx, p) == STEIF_DESCRIPTOR;
  k->pencil = descriptor && steif_linear_of(ctx, p, &k->system) == STEIF_OK;
  if (jump(ctx, p, k, plus)) k->plus = plus;
  if (closed(ctx, p, t1, k, end) || published(p, t1, k, end) || linear(ctx, p, o, k, end) ||
      (!k->pencil && own_run(ctx, p, o, t1, k, end)))
    k->end = end;
  k->size_plus = largest(k->n, k->plus);
  k->size_end = largest(k->n, k->end);
  steif_forget(ctx);
}

void known_close(const struct call *call, known_solution *k)
{
  if (k->pencil) steif_structure_clear(call->ctx, &k->structure);
  if (k->system.E) SUNMatDestroy(k->system.E);
  if (k->system.F) SUNMatDestroy(k->system.F);
  free(k->slow);
  *k = (known_solution){0};
}
