/* smooth.c: the smooth part of the solution of E x' + F x = f and its pairing with the test function.
 *
 * Closed solutions are taken as they are. Otherwise radau:s=5 with given steps carries the slow part
 * (order 9) on a system of index 1 where the slow projector is at hand, and what it makes of the
 * fast part is thrown away: with the Laurent coefficients at infinity
 *   x_s(t) = Phi_{-1} E x(t) + sum_j Phi_j f^(j)(t),
 * the jump formula at t. It is linear in (x, f, f', ...), so
 *   int x_s g dt = jump formula at (sum_q w_q g(t_q) x(t_q), sum_q w_q g(t_q) f^(j)(t_q)),
 * one application for any number of nodes. The nodes are Gauss's on panels that shrink towards
 * t = 0, where fast modes die away, and are halved until the sums agree.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

enum { OCTAVES = 40, FIRST = 4, PANELS_MOST = 512, PARTS_MOST = 100000 };
static const sunrealtype agreed = 1e-12;

/* ---- nodes --------------------------------------------------------------------------------------- */

/* Panels of [0, 1]: `parts` in [0, 2^-octaves] and in each of its doublings. */
typedef struct panels {
  int octaves, parts;
  size_t count; /* nodes */
} panels;

static panels panels_of(const stf_subject *s, int parts)
{
  panels p = {2, parts, 0};
  while (p.octaves < OCTAVES && ldexp(1, -p.octaves) * 4 * s->structure.radius > 1) p.octaves++;
  p.count = (size_t)(p.octaves + 1) * (size_t)parts * STF_RULE;
  return p;
}

/* Node i with its weight. */
static sunrealtype node(const panels *p, size_t i, sunrealtype *weight)
{
  const int panel = (int)(i / STF_RULE), k = (int)(i % STF_RULE), octave = panel / p->parts;
  const sunrealtype from = octave ? ldexp(1, octave - 1 - p->octaves) : 0;
  const sunrealtype width = (octave ? from : ldexp(1, -p->octaves)) / p->parts;
  *weight = width / 2 * stf_rule_weight[k];
  return from + width * (panel % p->parts + (1 + stf_rule_node[k]) / 2);
}

/* ---- a run through given times -------------------------------------------------------- */

static int carry(stf_subject *s, const sunrealtype *x0, size_t count, const sunrealtype *mesh,
                 int (*take)(steif_solver *solver, sunrealtype t, N_Vector x, void *user),
                 void *user)
{
  steif_problem p;
  const steif_linear *l = s->reduced.linear.E ? &s->reduced.linear : &s->linear;
  STEIF_TRY(steif_linear_problem(s->ctx, l, x0, mesh[0], mesh[count - 1], &p));
  p.dae_index = s->reduced.linear.E ? 1 : s->index;
  steif_options o = steif_defaults();
  o.mesh = mesh, o.mesh_size = count;
  o.observe = take, o.observer = user;
  o.max_steps = (long)count + 1;
  steif_solver *solver = steif_solver_new(s->ctx, &p, "radau:s=5", &o);
  if (!solver) return steif_status(s->ctx);
  const int code = steif_solve_to(solver, mesh[count - 1]);
  steif_solver_free(&solver);
  return code;
}

/* ---- sums over the nodes ------------------------------------------------------------------------- */

typedef struct sums {
  stf_subject *subject;
  panels panels;
  size_t at;          /* nodes taken */
  N_Vector value;     /* room for f or x */
  sunrealtype *x, *f; /* n, and index x n: sums of w g x and w g f^(j) */
} sums;

static void add(const sums *s, sunrealtype factor, sunrealtype *sum)
{
  const sunrealtype *v = N_VGetArrayPointer(s->value);
  for (int i = 0; i < s->subject->n; i++) sum[i] += factor * v[i];
}

/* One node, x there in s->value. */
static int gather(sums *s)
{
  sunrealtype w;
  const stf_subject *q = s->subject;
  const sunrealtype t = node(&s->panels, s->at++, &w), factor = w * steif_test_function(t, 0);
  add(s, factor, s->x);
  for (int j = 0; !q->problem.exact && q->linear.f && j < q->index; j++) {
    const int code = q->linear.f(t, j, s->value, q->linear.user);
    STEIF_CHECK(
      !code, q->ctx, code < 0 ? STEIF_CALLBACK : STEIF_BAD_INPUT,
      "derivative %d of the forcing is not known at t = %g; index %d needs it on [0, 1]", j, t,
      q->index);
    add(s, factor, s->f + j * q->n);
  }
  return STEIF_OK;
}

static int take_node(steif_solver *solver, sunrealtype t, N_Vector x, void *user)
{
  sums *s = user;
  (void)solver, (void)t;
  N_VScale(1, x, s->value);
  return gather(s);
}

static int through_nodes(sums *s)
{
  sunrealtype w;
  const size_t count = s->panels.count;
  sunrealtype *mesh = stf_allocate(s->subject->ctx, count + 1, sizeof *mesh);
  if (!mesh) return STEIF_NO_MEMORY;
  mesh[0] = 0;
  for (size_t i = 0; i < count; i++) mesh[i + 1] = node(&s->panels, i, &w);
  const int code = carry(s->subject, s->subject->impulse.x_plus, count + 1, mesh, take_node, s);
  stf_release(s->subject->ctx, mesh);
  return code;
}

static int closed_nodes(sums *s)
{
  sunrealtype w;
  const steif_problem *p = &s->subject->problem;
  for (size_t i = 0; i < s->panels.count; i++) {
    const sunrealtype t = node(&s->panels, i, &w);
    STEIF_CHECK(!p->exact(t, s->value, NULL, p->user), s->subject->ctx, STEIF_CALLBACK,
                "the closed solution of '%s' failed at t = %g", p->name, t);
    STEIF_TRY(gather(s));
  }
  return STEIF_OK;
}

/* The sums as if they were derivatives of f at one time. */
static int summed(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const sums *s = user;
  (void)t;
  if (derivative >= s->subject->index) return 1;
  memcpy(N_VGetArrayPointer(g), s->f + derivative * s->subject->n,
         (size_t)s->subject->n * sizeof(sunrealtype));
  return 0;
}

static int integrate(stf_subject *s, int parts, sums *sum, sunrealtype *value)
{
  const size_t n = (size_t)s->n;
  sum->panels = panels_of(s, parts), sum->at = 0;
  memset(sum->x, 0, n * (1 + (size_t)s->index) * sizeof *sum->x);
  STEIF_TRY(s->problem.exact ? closed_nodes(sum) : through_nodes(sum));
  if (s->problem.exact) return memcpy(value, sum->x, n * sizeof *value), STEIF_OK;
  steif_impulse i = {0};
  const int code =
    steif_impulse_find(s->ctx, s->linear.E, s->linear.F, sum->x, 0, s->linear.f ? summed : NULL,
                       sum, NULL, &s->structure, &i);
  if (!code) memcpy(value, i.x_plus, n * sizeof *value);
  steif_impulse_clear(s->ctx, &i);
  return code;
}

static sunrealtype apart(int n, const sunrealtype *a, const sunrealtype *b, sunrealtype *size)
{
  sunrealtype most = 0;
  *size = 0;
  for (int i = 0; i < n; i++)
    most = fmax(most, fabs(a[i] - b[i])), *size = fmax(*size, fabs(a[i]));
  return most;
}

/* Halve the panels until two sums agree, or get no closer. */
static int refine(stf_subject *s, sums *sum, sunrealtype *value, sunrealtype *finer,
                  sunrealtype *accuracy)
{
  sunrealtype size;
  *accuracy = INFINITY;
  STEIF_TRY(integrate(s, FIRST, sum, value));
  for (int parts = 2 * FIRST; parts <= PANELS_MOST; parts *= 2) {
    STEIF_TRY(integrate(s, parts, sum, finer));
    const sunrealtype d = apart(s->n, finer, value, &size);
    if (d > *accuracy / 2) break;
    *accuracy = d;
    memcpy(value, finer, (size_t)s->n * sizeof *value);
    if (d <= agreed * size) break;
  }
  return STEIF_OK;
}

/* ---- the pairing ---------------------------------------------------------------------------------- */

static int pair_block(stf_subject *s, sunrealtype *value)
{
  for (int m = 0; m < s->n; m++) STEIF_TRY(stf_block_pair(&s->block, m, 0, value + m));
  return STEIF_OK;
}

static int pair_smooth(stf_subject *s, sunrealtype *value, sunrealtype *accuracy)
{
  sums sum = {.subject = s};
  const size_t n = (size_t)s->n;
  STEIF_CHECK(s->problem.t0 == 0, s->ctx, STEIF_UNSUPPORTED,
              "the test function begins at t = 0, problem '%s' at %g", s->problem.name,
              s->problem.t0);
  sunrealtype *work = stf_allocate(s->ctx, n * (2 + (size_t)s->index), sizeof *work);
  sum.value = N_VNew_Serial(s->n, steif_sundials(s->ctx));
  if (work) sum.x = work, sum.f = work + n;
  int code = work && sum.value ? STEIF_OK
                               : STEIF_FAIL(s->ctx, STEIF_NO_MEMORY,
                                            "no memory to integrate %d unknowns", s->n);
  if (!code) code = refine(s, &sum, value, work + n * (1 + (size_t)s->index), accuracy);
  if (sum.value) N_VDestroy(sum.value);
  stf_release(s->ctx, work);
  return code;
}

int stf_subject_pair(stf_subject *s, sunrealtype *value, sunrealtype *accuracy, char *how,
                     size_t room)
{
  *accuracy = 0;
  if (s->block.k) {
    snprintf(how, room, "closed formulas");
    return pair_block(s, value);
  }
  STEIF_TRY(pair_smooth(s, value, accuracy));
  for (int i = 0; i < s->impulse.count; i++)
    for (int m = 0; m < s->n; m++)
      value[m] += (i % 2 ? -1 : 1) * s->impulse.c[i * s->n + m] * steif_test_function(0, i);
  snprintf(how, room, "impulses of the pencil and %s, to %.1e",
           s->problem.exact ? "the closed smooth solution by Gauss quadrature"
                            : "the smooth part by radau:s=5 from x(0+) and Gauss quadrature",
           *accuracy);
  return STEIF_OK;
}

/* ---- the smooth part at given times --------------------------------------------------------------- */

typedef struct walk {
  stf_subject *subject;
  size_t parts, at;
  const sunrealtype *t;
  sunrealtype *x;
} walk;

/* Of every `parts` steps the last ends at one of the times. */
static int take_time(steif_solver *solver, sunrealtype t, N_Vector x, void *user)
{
  walk *w = user;
  stf_subject *s = w->subject;
  (void)solver;
  if (++w->at % w->parts) return 0;
  steif_impulse i = {0};
  const int code = steif_impulse_find(s->ctx, s->linear.E, s->linear.F, N_VGetArrayPointer(x),
                                      t, s->linear.f, s->linear.user, NULL, &s->structure, &i);
  if (!code)
    memcpy(w->x + w->at / w->parts * (size_t)s->n, i.x_plus, (size_t)s->n * sizeof *w->x);
  steif_impulse_clear(s->ctx, &i);
  return code;
}

int stf_subject_follow(stf_subject *s, size_t count, const sunrealtype *t, sunrealtype *x)
{
  walk w = {.subject = s, .t = t, .x = x};
  const sunrealtype wanted =
    4 * s->structure.radius * (t[count - 1] - t[0]) / (double)(count - 1);
  w.parts = (size_t)fmin(fmax(ceil(wanted), 8), fmax(1, PARTS_MOST / (double)count));
  const size_t steps = (count - 1) * w.parts;
  sunrealtype *mesh = stf_allocate(s->ctx, steps + 1, sizeof *mesh);
  if (!mesh) return STEIF_NO_MEMORY;
  for (size_t i = 0; i <= steps; i++) {
    const size_t k = i / w.parts < count - 1 ? i / w.parts : count - 2;
    mesh[i] = t[k] + (t[k + 1] - t[k]) * (double)(i - k * w.parts) / (double)w.parts;
  }
  const int code = carry(s, x, steps + 1, mesh, take_time, &w);
  stf_release(s->ctx, mesh);
  return code;
}

static int closed_times(stf_subject *s, size_t count, const sunrealtype *t, sunrealtype *x)
{
  N_Vector like = N_VMake_Serial(s->n, x, steif_sundials(s->ctx));
  STEIF_CHECK(like, s->ctx, STEIF_NO_MEMORY, "no memory for a vector");
  int code = 0;
  for (size_t i = 1; i < count && !code; i++) {
    N_VSetArrayPointer(x + i * (size_t)s->n, like);
    code = s->problem.exact(t[i], like, NULL, s->problem.user);
  }
  N_VDestroy(like);
  STEIF_CHECK(!code, s->ctx, STEIF_CALLBACK, "the closed solution of '%s' failed",
              s->problem.name);
  return STEIF_OK;
}

int stf_subject_smooth(stf_subject *s, size_t count, const sunrealtype *t, sunrealtype *x)
{
  for (size_t i = 0; s->block.k && i < count; i++)
    STEIF_TRY(stf_block_series(&s->block, t[i], 0, false, x + i * (size_t)s->n));
  if (s->block.k) return STEIF_OK;
  memcpy(x, s->impulse.x_plus, (size_t)s->n * sizeof *x);
  if (count < 2) return STEIF_OK;
  return s->problem.exact ? closed_times(s, count, t, x) : stf_subject_follow(s, count, t, x);
}

int stf_subject_before(stf_subject *s, sunrealtype t, sunrealtype *x)
{
  if (s->block.k) return stf_block_series(&s->block, t, 0, false, x);
  steif_impulse i = {0};
  const steif_linear *l = &s->linear;
  STEIF_TRY(steif_impulse_find(s->ctx, l->E, l->F, s->impulse.x_plus, t, l->f, l->user, NULL,
                               &s->structure, &i));
  memcpy(x, i.x_plus, (size_t)s->n * sizeof *x);
  steif_impulse_clear(s->ctx, &i);
  return STEIF_OK;
}
