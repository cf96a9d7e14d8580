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

/* Digits that are not stated are taken for eight. */
static bool published(const steif_problem *p, const steif_options *o, double t1,
                      known_solution *k, double *x)
{
  const steif_reference *r = p->reference;
  if (!r || r->t != t1 || (r->count && r->count != p->n) || r->component) return false;
  if (pow(10, -(r->digits ? r->digits : 8)) > 10 * o->rtol) return false;
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

/* From x(0+), where it is not the start. */
static bool one_run(steif_context *ctx, const steif_problem *p, const steif_options *given,
                    const known_solution *k, double factor, double t1, double *x)
{
  steif_problem q = *p;
  steif_options o = *given;
  if (k->plus && q.y0 && memcmp(k->plus, q.y0, k->n * sizeof *x)) {
    q.y0 = k->plus;
    q.yp0 = NULL;
  }
  o.stop = interruption_poll();
  o.rtol = fmax(factor * o.rtol, 1e-12);
  o.atol *= o.rtol / given->rtol;
  steif_solver *s = steif_solver_new(ctx, &q, "auto", &o);
  const bool there = s && steif_solve_to(s, t1) == STEIF_OK;
  if (there) memcpy(x, N_VGetArrayPointer(steif_solution(s)), k->n * sizeof *x);
  steif_solver_free(&s);
  return there;
}

/* Believed where two tolerances agree to ten of those that are asked for. */
static bool own_run(steif_context *ctx, const steif_problem *p, const steif_options *o,
                    double t1, known_solution *k, double *x)
{
  double apart = 0, *rough = k->slow;
  if (k->pencil || o->rtol < 1e-10 || !one_run(ctx, p, o, k, 1e-2, t1, rough) ||
      !one_run(ctx, p, o, k, 1e-3, t1, x))
    return false;
  for (size_t i = 0; i < k->n; i++) apart = fmax(apart, fabs(x[i] - rough[i]));
  return apart <= 10 * fmax(o->rtol * largest(k->n, x), o->rtol * tolerance_ratio(p, o)) &&
         source(k, "steif's auto, at two tolerances");
}

static bool linear_jump(steif_context *ctx, const steif_problem *p, known_solution *k,
                        double *x)
{
  steif_impulse i = {0};
  const steif_linear *l = &k->system;
  const bool there =
    !steif_structure_find(ctx, l->E, l->F, NULL, &k->structure) &&
    !steif_impulse_find(ctx, l->E, l->F, p->y0, p->t0, l->f, l->user, NULL, &k->structure, &i);
  if (there) memcpy(x, i.x_plus, k->n * sizeof *x);
  if (there) k->index = i.index;
  steif_impulse_clear(ctx, &i);
  return there;
}

/* x(0+): of consistent values they are themselves; of others the jump, where the equations determine it. */
static bool jump(steif_context *ctx, const steif_problem *p, known_solution *k, double *x)
{
  enum { LARGEST = 100 }; /* a second or so */
  steif_jump j = {0};
  if (!p->y0) return false;
  memcpy(x, p->y0, k->n * sizeof *x);
  if (k->pencil) return linear_jump(ctx, p, k, x);
  if (!p->F && !p->E && !p->Ev) return true; /* y' = f */
  const bool there = p->n <= LARGEST && !steif_jump_find(ctx, p, NULL, NULL, &j) && j.unique;
  if (there) memcpy(x, j.y, k->n * sizeof *x);
  steif_jump_clear(&j);
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
  if (closed(ctx, p, t1, k, end) || published(p, o, t1, k, end) || linear(ctx, p, o, k, end) ||
      own_run(ctx, p, o, t1, k, end))
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
