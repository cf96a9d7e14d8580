/* smooth.c: the smooth part of the solution of E x' + F x = f and its pairing with the test function.
 *
 * Closed solutions are taken as they are. Otherwise radau:s=5 with prescribed steps carries the slow part
 * (order 9) on a system of index 1 where the slow projector is at hand, and what it makes of the
 * fast part is thrown away: with the Laurent coefficients at infinity
 *   x_s(t) = Phi_{-1} E x(t) + sum_j Phi_j f^(j)(t),
 * the jump formula at t. It is linear in (x, f, f', ...), so
 *   int x_s g dt = jump formula at (sum_q w_q g(t_q) x(t_q), sum_q w_q g(t_q) f^(j)(t_q)),
 * one application for any number of nodes. The nodes are Gauss's on panels that shrink towards
 * the start, where fast modes die away, and are halved until the sums agree. At each break of f the
 * smooth solution before it takes the place of x(0-): the jump formula gives x on its other side and
 * its impulses.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

/* eps in what the pencil gives of x(0-), at least. */
#define FOUND 16
enum { OCTAVES = 40, FIRST = 4, PANELS_MOST = 512 };
static const sunrealtype agreed = 1e-12;

/* ---- nodes --------------------------------------------------------------------------------------- */

/* Panels of [from, to]: `parts` in its first part 2^-octaves and in each of its doublings. */
typedef struct panels {
  sunrealtype from, to;
  int octaves, parts;
  size_t count; /* nodes */
} panels;

static panels panels_of(const stf_subject *s, sunrealtype from, sunrealtype to, int parts)
{
  panels p = {from, to, 2, parts, 0};
  const sunrealtype wanted = 4 * s->structure.radius * (to - from);
  while (p.octaves < OCTAVES && ldexp(1, -p.octaves) * wanted > 1) p.octaves++;
  p.count = (size_t)(p.octaves + 1) * (size_t)parts * STF_RULE;
  return p;
}

/* Node i with its weight. */
static sunrealtype node(const panels *p, size_t i, sunrealtype *weight)
{
  const int panel = (int)(i / STF_RULE), k = (int)(i % STF_RULE), octave = panel / p->parts;
  const sunrealtype from = octave ? ldexp(1, octave - 1 - p->octaves) : 0;
  const sunrealtype width = (octave ? from : ldexp(1, -p->octaves)) / p->parts;
  *weight = width / 2 * stf_rule_weight[k] * (p->to - p->from);
  return p->from +
         (p->to - p->from) * (from + width * (panel % p->parts + (1 + stf_rule_node[k]) / 2));
}

/* ---- sums over the nodes ------------------------------------------------------------------------- */

typedef struct sums {
  stf_subject *subject;
  panels panels;
  size_t at;                /* nodes taken */
  const sunrealtype *start; /* x at the beginning of the panels, from the right, ... */
  sunrealtype *end;         /* ... and at their end, from the left; NULL: not wanted */
  N_Vector value;           /* room for f or x */
  sunrealtype *x, *f;       /* n, and index x n: sums of w g x and w g f^(j) */
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
  const sunrealtype t = node(&s->panels, s->at++, &w);
  long double g;
  STEIF_TRY(stf_weight_at(&q->weight, t, 0, &g));
  const sunrealtype factor = w * (sunrealtype)g;
  add(s, factor, s->x);
  for (int j = 0; !q->problem.exact && q->linear.f && j < q->index; j++) {
    const int code = q->linear.f(t, j, s->value, q->linear.user);
    STEIF_CHECK(
      !code, q->ctx, code < 0 ? STEIF_CALLBACK : STEIF_BAD_INPUT,
      "derivative %d of the forcing is not known at t = %g; index %d needs it up to t = %g", j,
      t, q->index, (double)q->weight.t1);
    add(s, factor, s->f + j * q->n);
  }
  return STEIF_OK;
}

/* Behind the nodes comes the end. */
static int take_node(steif_solver *solver, sunrealtype t, N_Vector x, void *user)
{
  sums *s = user;
  (void)solver, (void)t;
  if (s->at == s->panels.count) {
    memcpy(s->end, N_VGetArrayPointer(x), (size_t)s->subject->n * sizeof *s->end);
    return 0;
  }
  N_VScale(1, x, s->value);
  return gather(s);
}

static int through_nodes(sums *s)
{
  sunrealtype w;
  const panels *p = &s->panels;
  stf_subject *q = s->subject;
  sunrealtype *mesh = stf_allocate(q->ctx, p->count + 2, sizeof *mesh);
  if (!mesh) return STEIF_NO_MEMORY;
  mesh[0] = p->from;
  for (size_t i = 0; i < p->count; i++) mesh[i + 1] = node(p, i, &w);
  mesh[p->count + 1] = p->to;
  stf_sides_step(&q->sides, p->from, p->to, 0);
  const int code =
    stf_subject_carry(q, s->start, p->count + 1 + (s->end != NULL), mesh, take_node, s);
  stf_sides_step(&q->sides, 0, 0, 0);
  stf_release(q->ctx, mesh);
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

/* Between two breaks. */
static int integrate(stf_subject *s, int parts, sums *sum, sunrealtype *value)
{
  const size_t n = (size_t)s->n;
  sum->panels = panels_of(s, sum->panels.from, sum->panels.to, parts);
  sum->at = 0;
  memset(sum->x, 0, n * (1 + (size_t)s->index) * sizeof *sum->x);
  STEIF_TRY(s->problem.exact ? closed_nodes(sum) : through_nodes(sum));
  if (s->problem.exact || s->index == 0) { /* all of x is smooth */
    memcpy(value, sum->x, n * sizeof *value);
    return STEIF_OK;
  }
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

/* Does a panel, the longest, hold more than f changes that its nodes could see? */
static bool too_long(const stf_subject *s, const panels *p)
{
  return s->rate * (p->to - p->from) / (2 * p->parts) > STF_RULE;
}

/* Halve the panels until two sums agree, or get no closer; every step of a run adds an eps. What changes
 * within a panel is seen by neither sum. */
static int refine(stf_subject *s, sums *sum, sunrealtype *value, sunrealtype *finer,
                  sunrealtype *accuracy)
{
  sunrealtype size = 0;
  *accuracy = INFINITY;
  STEIF_TRY(integrate(s, FIRST, sum, value));
  for (int parts = 2 * FIRST; parts <= PANELS_MOST; parts *= 2) {
    STEIF_TRY(integrate(s, parts, sum, finer));
    const sunrealtype d = apart(s->n, finer, value, &size);
    if (d > *accuracy / 2 && !too_long(s, &sum->panels)) break;
    *accuracy = d;
    memcpy(value, finer, (size_t)s->n * sizeof *value);
    if (d <= agreed * size && !too_long(s, &sum->panels)) break;
  }
  if (too_long(s, &sum->panels)) *accuracy = INFINITY;
  if (s->structure.finite > 0 && !s->problem.exact)
    *accuracy = fmax(*accuracy, 4 * STF_EPS * (double)sum->panels.count * size);
  return STEIF_OK;
}

/* ---- the pairing ---------------------------------------------------------------------------------- */

static int pair_block(stf_subject *s, sunrealtype *value)
{
  for (int m = 0; m < s->n; m++) STEIF_TRY(stf_block_pair(&s->block, m, 0, value + m));
  return STEIF_OK;
}

/* x(t-) of the smooth solution at break b, its fast part found anew, and what happens there. */
static int jump(stf_subject *s, size_t b, sunrealtype *x)
{
  const steif_linear *l = &s->linear;
  stf_jump *j = s->jump + b;
  steif_impulse before = {0};
  j->t = s->sides.breaks[b];
  stf_sides_step(&s->sides, b ? s->sides.breaks[b - 1] : 0, j->t, 0);
  int code = steif_impulse_find(s->ctx, l->E, l->F, x, j->t, l->f, l->user, NULL, &s->structure,
                                &before);
  stf_sides_step(&s->sides, j->t, 2 * j->t, 0);
  if (!code)
    code = steif_impulse_find(s->ctx, l->E, l->F, before.x_plus, j->t, l->f, l->user, NULL,
                              &s->structure, &j->at);
  stf_sides_step(&s->sides, 0, 0, 0);
  if (!code) s->jumps = b + 1;
  steif_impulse_clear(s->ctx, &before);
  return code;
}

/* Breaks inside the interval of the test function. */
static size_t breaks_of(const stf_subject *s)
{
  size_t count = 0;
  while (count < s->sides.count && s->sides.breaks[count] < s->weight.t1) count++;
  return count;
}

/* Segment by segment; part and finer: n values each, end: n more. */
static int segments(stf_subject *s, sums *sum, sunrealtype *value, sunrealtype *part,
                    sunrealtype *accuracy)
{
  const size_t n = (size_t)s->n, count = breaks_of(s);
  sunrealtype *finer = part + n, *end = finer + n, error;
  s->jump = stf_allocate(s->ctx, count + 1, sizeof *s->jump);
  if (!s->jump) return STEIF_NO_MEMORY;
  *accuracy = 0;
  memset(value, 0, n * sizeof *value);
  for (size_t b = 0; b <= count; b++) {
    sum->panels.from = b ? s->sides.breaks[b - 1] : 0;
    sum->panels.to = b < count ? s->sides.breaks[b] : (sunrealtype)s->weight.t1;
    sum->start = b ? s->jump[b - 1].at.x_plus : s->impulse.x_plus;
    sum->end = b < count ? end : NULL;
    STEIF_TRY(refine(s, sum, part, finer, &error));
    *accuracy += error;
    for (size_t m = 0; m < n; m++) value[m] += part[m];
    if (b < count) STEIF_TRY(jump(s, b, end));
  }
  return STEIF_OK;
}

static int pair_smooth(stf_subject *s, sunrealtype *value, sunrealtype *accuracy)
{
  sums sum = {.subject = s};
  const size_t n = (size_t)s->n;
  STEIF_CHECK(s->problem.t0 == 0, s->ctx, STEIF_UNSUPPORTED,
              "the test function begins at t = 0, problem '%s' at %g", s->problem.name,
              s->problem.t0);
  sunrealtype *work = stf_allocate(s->ctx, n * (4 + (size_t)s->index), sizeof *work);
  sum.value = N_VNew_Serial(s->n, steif_sundials(s->ctx));
  if (work) sum.x = work, sum.f = work + n;
  int code = work && sum.value ? STEIF_OK
                               : STEIF_FAIL(s->ctx, STEIF_NO_MEMORY,
                                            "no memory to integrate %d unknowns", s->n);
  if (!code) code = segments(s, &sum, value, work + n * (1 + (size_t)s->index), accuracy);
  if (sum.value) N_VDestroy(sum.value);
  stf_release(s->ctx, work);
  return code;
}

/* sum_i (-1)^i c_i g^(i)(t), and what rounding of c_i and the two ways to find x(t+) leave open. */
static int pair_impulses(stf_subject *s, sunrealtype t, const steif_impulse *i,
                         sunrealtype *value, sunrealtype *accuracy)
{
  long double g[STF_DERIVATIVES];
  sunrealtype open = 0;
  STEIF_CHECK(i->count < STF_DERIVATIVES, s->ctx, STEIF_UNSUPPORTED,
              "index %d takes too many derivatives of the test function", s->index);
  STEIF_TRY(stf_weight_at(&s->weight, t, i->count, g));
  for (int q = 0; q < i->count; q++)
    for (int m = 0; m < s->n; m++) {
      const sunrealtype term = (q % 2 ? -1 : 1) * i->c[q * s->n + m] * (sunrealtype)g[q];
      value[m] += term;
      open = fmax(open, fabs(term));
    }
  *accuracy += open * fmax(4 * STF_EPS, isfinite(i->estimate) ? i->estimate : 0);
  return STEIF_OK;
}

static sunrealtype largest(const sunrealtype *x, size_t count)
{
  sunrealtype most = 0;
  for (size_t i = 0; x && i < count; i++) most = fmax(most, fabs(x[i]));
  return most;
}

/* Of x(t+) and of impulses c_i / t1^(i + 1), times what is open of them. */
static sunrealtype rounding_of(const stf_subject *s, const steif_impulse *impulse,
                               sunrealtype size)
{
  const size_t n = (size_t)s->n;
  sunrealtype units = 1;
  size = fmax(size, largest(impulse->x_plus, n));
  for (int i = 0; i < impulse->count; i++) {
    units /= (sunrealtype)s->weight.t1;
    size = fmax(size, units * largest(impulse->c + (size_t)i * n, n));
  }
  return size * fmax(FOUND * STF_EPS, isfinite(impulse->estimate) ? impulse->estimate : 0);
}

sunrealtype stf_subject_rounding(const stf_subject *s)
{
  const sunrealtype size = largest(s->problem.y0, (size_t)s->n);
  if (s->block.k) return 4 * STF_EPS * size;
  sunrealtype most = rounding_of(s, &s->impulse, size);
  for (size_t b = 0; b < s->jumps; b++) most = fmax(most, rounding_of(s, &s->jump[b].at, 0));
  return most;
}

/* |g^(i)(0)| t1^(i + 1), i = 0 .. index - 2, and i = 0 at least. */
static int weigh_start(const stf_subject *s, sunrealtype *weight)
{
  long double g[STF_DERIVATIVES], units = s->weight.t1;
  const int last = s->index > 2 ? s->index - 2 : 0;
  *weight = 0;
  STEIF_TRY(stf_weight_at(&s->weight, 0, last, g));
  for (int i = 0; i <= last; i++, units *= s->weight.t1)
    *weight += (sunrealtype)(fabsl(g[i]) * units);
  return STEIF_OK;
}

int stf_subject_pair(stf_subject *s, sunrealtype *value, sunrealtype *accuracy, char *how,
                     size_t room)
{
  *accuracy = 0;
  if (s->block.k) {
    snprintf(how, room, "closed formulas");
    s->block.weight = s->weight;
    return pair_block(s, value);
  }
  STEIF_TRY(pair_smooth(s, value, accuracy));
  const sunrealtype smooth = *accuracy;
  char known[32] = "not known: f changes too fast";
  if (isfinite(smooth)) snprintf(known, sizeof known, "to %.1e", smooth);
  sunrealtype weight;
  STEIF_TRY(weigh_start(s, &weight));
  *accuracy += weight * stf_subject_rounding(s);
  STEIF_TRY(pair_impulses(s, 0, &s->impulse, value, accuracy));
  for (size_t b = 0; b < s->jumps; b++)
    STEIF_TRY(pair_impulses(s, s->jump[b].t, &s->jump[b].at, value, accuracy));
  snprintf(how, room, "impulses of the pencil%s and %s, %s",
           s->jumps ? ", also at breaks of f," : "",
           s->problem.exact ? "the closed smooth solution by Gauss quadrature"
                            : "the smooth part by radau:s=5 from x(0+) and Gauss quadrature",
           known);
  return STEIF_OK;
}
