/* many_digits.c: the smooth parts between the breaks of f, at given times, to many digits: radau:s=5 (order
 * 9) in parts of the steps between the times, on the system of index 1 where there is one; else what
 * it makes of the fast part is thrown away, x(t) = Phi_{-1} E x(t) + sum_j Phi_j f^(j)(t). Twice as
 * many parts tell how many digits.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "demand.h"
#include "reduce.h"
#include <steif/runs.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum { PARTS = 4, PARTS_MOST = 200000 };

/* One segment: rows `from` .. `to` - 1 of the times lie in it. */
typedef struct truth {
  steif_context *ctx;
  const steif_linear *linear;
  const steif_analysis *analysis;
  steif_structure structure;
  stf_demand demand;
  stf_reduced reduced;
  sunindextype n;
  const sunrealtype *t;
  sunrealtype *x;                       /* rows of n */
  sunrealtype *now, start, end, before; /* x at the start of the segment, then at its end */
  size_t from, to, at, parts;
} truth;

static int left_of(sunrealtype t, int derivative, N_Vector g, void *user)
{
  const truth *w = user;
  return w->linear->f(t < w->end ? t : w->before, derivative, g, w->linear->user);
}

/* `now` as a smooth solution has it; at the start of a segment with f from the right. */
static int settle(truth *w, sunrealtype t, bool right, sunrealtype *x)
{
  steif_impulse i;
  const steif_linear *l = w->linear;
  STEIF_TRY(steif_impulse_find(w->ctx, l->E, l->F, x, t, l->f ? right ? l->f : left_of : NULL,
                               right ? l->user : w, w->analysis, &w->structure, &i));
  memcpy(x, i.x_plus, (size_t)w->n * sizeof *x);
  steif_impulse_clear(w->ctx, &i);
  return STEIF_OK;
}

/* Of every `parts` steps the last ends at one of the times, or at the end. */
static int take(steif_solver *solver, sunrealtype t, N_Vector x, void *user)
{
  truth *w = user;
  const size_t row = w->from + w->at / w->parts;
  (void)solver;
  if (++w->at % w->parts) return 0;
  sunrealtype *to = row < w->to ? w->x + row * (size_t)w->n : w->now;
  memcpy(to, N_VGetArrayPointer(x), (size_t)w->n * sizeof *to);
  const bool direct = w->reduced.linear.E || w->structure.index == 0 || w->structure.index == 1;
  return direct ? 0 : settle(w, t, false, to);
}

/* From w->now at w->start through the rows and on to the end. */
static int follow(truth *w, size_t parts)
{
  const bool beyond = w->to == w->from || w->t[w->to - 1] < w->end;
  const size_t stops = w->to - w->from + beyond, steps = stops * parts;
  const steif_linear cut = {w->linear->E, w->linear->F, w->linear->f ? left_of : NULL, w};
  steif_problem p;
  sunrealtype *mesh = stf_allocate(w->ctx, steps + 1, sizeof *mesh), last = w->start;
  if (!mesh) return STEIF_NO_MEMORY;
  mesh[0] = last;
  for (size_t k = 0; k < stops; k++) {
    const sunrealtype next = w->from + k < w->to ? w->t[w->from + k] : w->end;
    for (size_t i = 1; i <= parts; i++)
      mesh[k * parts + i] = i < parts ? last + (next - last) * (double)i / (double)parts : next;
    last = next;
  }
  w->at = 0, w->parts = parts, w->reduced.from = &cut;
  const steif_linear *l = w->reduced.linear.E ? &w->reduced.linear : &cut;
  int code = steif_linear_problem(w->ctx, l, w->now, w->start, w->end, &p);
  p.dae_index = w->reduced.linear.E ? 1 : w->structure.index;
  steif_options o = steif_defaults();
  o.mesh = mesh, o.mesh_size = steps + 1, o.max_steps = (long)steps + 1;
  o.observe = take, o.observer = w;
  steif_solver *solver = code ? NULL : steif_solver_new(w->ctx, &p, "radau:s=5", &o);
  if (!code) code = solver ? steif_solve_to(solver, w->end) : steif_status(w->ctx);
  steif_solver_free(&solver);
  stf_release(w->ctx, mesh);
  if (!code && !beyond)
    memcpy(w->now, w->x + (w->to - 1) * (size_t)w->n, (size_t)w->n * sizeof *w->now);
  return code;
}

/* As many parts as resolve the eigenvalues, within bounds. */
static size_t parts_of(const truth *w)
{
  sunrealtype longest = 0, last = w->start;
  for (size_t k = w->from; k <= w->to; k++) {
    const sunrealtype next = k < w->to ? w->t[k] : w->end;
    longest = fmax(longest, next - last), last = next;
  }
  const sunrealtype wanted = ceil(w->structure.radius * longest);
  const sunrealtype most = PARTS_MOST / (double)(w->to - w->from + 1);
  return (size_t)fmax(PARTS, fmin(wanted, most));
}

static int segments(truth *w, size_t factor, const sunrealtype *x0, sunrealtype t0,
                    size_t count, size_t break_count, const sunrealtype *breaks)
{
  memcpy(w->now, x0, (size_t)w->n * sizeof *x0);
  w->start = t0, w->to = 0;
  for (size_t k = 0; k <= break_count && w->to < count; k++) {
    w->end = k < break_count ? breaks[k] : w->t[count - 1];
    w->before = nextafter(w->end, w->start);
    for (w->from = w->to; w->to < count && w->t[w->to] <= w->end;) w->to++;
    STEIF_TRY(settle(w, w->start, true, w->now));
    STEIF_TRY(follow(w, factor * parts_of(w)));
    w->start = w->end;
  }
  return STEIF_OK;
}

static sunrealtype apart(size_t count, const sunrealtype *a, const sunrealtype *b)
{
  sunrealtype most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(a[i] - (b ? b[i] : 0)));
  return most;
}

static int run(truth *w, const sunrealtype *x0, sunrealtype t0, size_t count,
               size_t break_count, const sunrealtype *breaks, sunrealtype *accuracy)
{
  const size_t n = (size_t)w->n;
  sunrealtype *first = w->now + n, *x = w->x + (count - 1) * n;
  const steif_linear *l = w->linear;
  STEIF_TRY(steif_structure_find(w->ctx, l->E, l->F, w->analysis, &w->structure));
  w->demand.finite = w->structure.finite;
  STEIF_TRY(stf_reduced_open(w->ctx, l, &w->structure, false, &w->reduced));
  STEIF_TRY(segments(w, 1, x0, t0, count, break_count, breaks));
  memcpy(first, x, n * sizeof *first);
  STEIF_TRY(segments(w, 2, x0, t0, count, break_count, breaks));
  *accuracy = apart(n, x, first) / fmax(apart(n, x, NULL), DBL_MIN);
  return STEIF_OK;
}

int steif_linear_exact(steif_context *ctx, const steif_linear *given, const sunrealtype *x0,
                       sunrealtype t0, const steif_analysis *analysis, size_t break_count,
                       const sunrealtype *breaks, size_t count, const sunrealtype *t,
                       const sunrealtype *made, sunrealtype *x, steif_linear_truth *out)
{
  steif_problem p;
  STEIF_CHECK(count > 0 && t && x && out, ctx, STEIF_BAD_INPUT,
              "times and room for values are needed, one is NULL or there are none");
  STEIF_CHECK(t[0] > t0, ctx, STEIF_BAD_INPUT, "t = %.17g is not after t0 = %.17g", t[0], t0);
  STEIF_TRY(steif_linear_problem(ctx, given, x0, t0, t[count - 1], &p));
  truth w = {.ctx = ctx, .analysis = analysis, .n = p.n, .t = t, .x = x};
  w.demand = stf_demand_of(ctx, given, analysis);
  const steif_linear linear = stf_demand_linear(&w.demand);
  w.linear = &linear;
  const size_t n = (size_t)p.n, last = (count - 1) * n;
  w.now = stf_allocate(ctx, 2 * n, sizeof *w.now);
  if (!w.now) return STEIF_NO_MEMORY;
  *out = (steif_linear_truth){0};
  const int code = run(&w, x0, t0, count, break_count, breaks, &out->accuracy);
  const sunrealtype size = code ? 1 : fmax(apart(count * n, x, NULL), DBL_MIN);
  if (!code && made) {
    out->end = apart(n, made + last, x + last) / size;
    out->most = apart(count * n, made, x) / size;
  }
  stf_reduced_close(&w.reduced);
  steif_structure_clear(ctx, &w.structure);
  stf_release(ctx, w.now);
  stf_demand_close(&w.demand);
  return code;
}
