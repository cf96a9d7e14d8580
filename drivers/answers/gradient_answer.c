/* gradient_answer.c: a gradient, its start values and cost, and what differences of runs on its mesh say.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gradient_answer.h"
#include "answers.h"
#include "direction_words.h"
#include "gradient_functional.h"
#include "integration.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct gradient {
  const steif_problem *problem;
  steif_options options;
  struct gradient_functional functional;
  steif_gradient found;
  double *v, *product; /* of second derivatives; NULL: not asked for */
  double *mesh,
    *most; /* for differences; how far parameters may be moved, NULL: as far as any */
  size_t times, room;
  bool checked;
  double disagreement;
};

/* ---- differences ---------------------------------------------------------------------------------- */

static int note(steif_solver *s, double t, N_Vector y, void *user)
{
  struct gradient *a = user;
  (void)s, (void)y;
  if (a->times && !(t > a->mesh[a->times - 1])) return 0; /* an event, seen from both sides */
  return mesh_add(&a->mesh, &a->times, &a->room, t);
}

/* How far each parameter may be moved so that an event that ends the run stays in its step: by its derivatives. */
static int find_shifts(struct call *call, struct gradient *a, double reach)
{
  const int P = a->found.parameters;
  steif_options o = a->options;
  o.sensitivities = 1;
  a->most = malloc(((size_t)P + 1) * sizeof *a->most);
  if (!a->most) return no_memory(call, "the steps of differences", "leave --check out");
  steif_solver *s = steif_solver_new(call->ctx, a->problem, call->word[1], &o);
  const int came = s ? steif_solve_to(s, o.t1) : steif_status(call->ctx);
  for (int k = 0; k < P; k++) {
    double tau = 0; /* where it is not known, steps are as everywhere */
    if (came == STEIF_EVENT && steif_sensitivity_event(s, k, &tau, NULL)) tau = 0;
    a->most[k] = tau != 0 ? reach / fabs(tau) : INFINITY;
  }
  steif_forget(call->ctx);
  steif_solver_free(&s);
  return EXIT_OK;
}

static int find_mesh(struct call *call, struct gradient *a)
{
  steif_options o = a->options;
  o.observe = note, o.observer = a;
  if (note(NULL, a->problem->t0, NULL, a))
    return no_memory(call, "the mesh", "leave --check out");
  steif_solver *s = steif_solver_new(call->ctx, a->problem, call->word[1], &o);
  const int came = s ? steif_solve_to(s, o.t1) : steif_status(call->ctx);
  const double tau = s ? steif_time(s) : 0;
  steif_solver_free(&s);
  if (came != STEIF_EVENT) return came ? fail(call) : EXIT_OK;
  const double reach = event_mesh(&a->mesh, &a->times, a->problem->t0, tau, o.t1);
  return reach < 0 ? no_memory(call, "the mesh", "leave --check out")
                   : find_shifts(call, a, reach);
}

static double scale_of(const steif_parameters *q, int k)
{
  const double p = q->scale ? q->scale[k] : fabs(q->value[k]);
  return p > 0 ? p : 1;
}

/* The gradient by a run on the mesh of the problem found once more, p moved by d v, NULL: p_k by d. */
static int moved(struct call *call, struct gradient *a, const steif_options *o, int k,
                 const double *v, double d, steif_gradient *g)
{
  steif_problem p;
  int code = moved_problem(call, a->problem, k, v, d, &p);
  if (code || (code = gradient_functional_extend(call, &a->functional, &p))) return code;
  *g = (steif_gradient){.memory = a->found.memory};
  a->functional.now = &p;
  if (steif_gradient_find(call->ctx, &p, call->word[1], o, &a->functional.of, g))
    code = fail(call);
  a->functional.now = a->problem;
  steif_problem_clear(call->ctx, &p);
  return code;
}

/* Central differences with d and d / 2, extrapolated, of the values, or with v of the gradients; d within what 4 runs of
 * 15 digits can tell. */
static int differ(struct call *call, struct gradient *a, const steif_options *o, int k,
                  const double *v, double d, double *quotient)
{
  const double by[] = {d / 2, -d / 2, d, -d}, c[] = {8, -8, -1, 1};
  int code = EXIT_OK;
  for (int j = 0; !code && j < 4; j++) {
    steif_gradient g = {0};
    code = moved(call, a, o, k, v, by[j], &g);
    const int count = code ? 0 : v ? g.count * g.parameters : g.count;
    for (int i = 0; i < count; i++) quotient[i] += c[j] / (6 * d) * (v ? g.dp : g.value)[i];
    steif_gradient_free(call->ctx, &g);
  }
  return code;
}

/* The largest difference of entries times scales, in the largest one of a functional; rows of `parameters` numbers, of
 * quotients by columns of `count` ones where `turned`. */
static void disagree(struct gradient *a, const double *found, const double *quotient,
                     bool turned)
{
  const int count = a->found.count, P = a->found.parameters;
  const steif_parameters *q = a->problem->parameters;
  for (int i = 0; i < count; i++) {
    double size = 0, most = 0;
    for (int k = 0; k < P; k++) {
      const double one = found[i * P + k], other = quotient[turned ? k * count + i : i * P + k];
      size = fmax(size, fmax(fabs(one), fabs(other)) * scale_of(q, k));
      most = fmax(most, fabs(one - other) * scale_of(q, k));
    }
    if (size > 0) a->disagreement = fmax(a->disagreement, most / size);
  }
}

/* Of the product, along v: what moves most moves by as much as in `compare`. */
static int compare_product(struct call *call, struct gradient *a, const steif_options *o,
                           double *quotient)
{
  const steif_parameters *q = a->problem->parameters;
  double reach = 0;
  for (int k = 0; k < q->count; k++) reach = fmax(reach, fabs(a->v[k]) / scale_of(q, k));
  if (reach == 0) return EXIT_OK;
  const int code = differ(call, a, o, 0, a->v, 2e-3 / reach, quotient);
  if (!code) disagree(a, a->product, quotient, false);
  return code;
}

static int compare(struct call *call, struct gradient *a, const steif_options *o,
                   const steif_gradient *g)
{
  const steif_parameters *q = a->problem->parameters;
  const size_t count = (size_t)(g->count * g->parameters);
  double *quotient = calloc(2 * count + 1, sizeof *quotient);
  int code = quotient ? EXIT_OK : no_memory(call, "differences", "leave --check out");
  for (int k = 0; !code && k < g->parameters; k++) {
    const double d = fmin(2e-3 * scale_of(q, k), a->most ? a->most[k] : INFINITY);
    code = differ(call, a, o, k, NULL, d, quotient + k * g->count);
  }
  if (!code) disagree(a, g->dp, quotient, true);
  if (!code && a->product) code = compare_product(call, a, o, quotient + count);
  free(quotient);
  return code;
}

static int check(struct call *call, struct gradient *a)
{
  steif_options o = a->options;
  steif_gradient g = {.memory = a->found.memory};
  if (tighten(a->problem, &o)) {
    const int code = compare(call, a, &o, &a->found);
    a->checked = !code;
    return code;
  }
  if (o.h <= 0) {
    const int code = find_mesh(call, a);
    if (code) return code;
    o.mesh = a->mesh, o.mesh_size = a->times;
  }
  int code = EXIT_OK;
  if (steif_gradient_find(call->ctx, a->problem, call->word[1], &o, &a->functional.of, &g))
    code = fail(call);
  if (!code) code = compare(call, a, &o, &g);
  steif_gradient_free(call->ctx, &g);
  a->checked = !code;
  return code;
}

/* ---- the answer ------------------------------------------------------------------------------------ */

static void costs(steif_report *r, const steif_gradient_cost *c)
{
  steif_report_whole(r, "cost.steps", c->steps);
  steif_report_whole(r, "cost.factors", c->factors);
  steif_report_whole(r, "cost.solves", c->solves);
  steif_report_whole(r, "cost.transposed_solves", c->transposed_solves);
  steif_report_whole(r, "cost.recomputed_steps", c->recomputed_steps);
  steif_report_whole(r, "cost.bytes", (long)c->bytes);
}

static void rows(steif_report *r, const struct gradient *a)
{
  const steif_parameters *q = a->problem->parameters;
  const int P = a->found.parameters;
  for (int j = 0; j < a->found.count * P; j++) {
    const int k = j % P;
    char own[STEIF_SPEC_WORD];
    snprintf(own, sizeof own, "p%d", k + 1);
    steif_report_row(r, "rows");
    if (a->found.count > 1) steif_report_text(r, "rows.of", a->functional.label[j / P]);
    steif_report_text(r, "rows.parameter", q->name ? q->name[k] : own);
    steif_report_real(r, "rows.p", q->value[k]);
    steif_report_real(r, "rows.gradient", a->found.dp[j]);
    steif_report_real(r, "rows.scaled", a->found.dp[j] * scale_of(q, k));
    if (a->product) steif_report_real(r, "rows.product", a->product[j]);
  }
}

/* One functional as a list, several as rows of a matrix. */
static void lists(steif_report *r, const struct gradient *a, const char *name, size_t columns,
                  const double *x)
{
  if (a->found.count == 1)
    steif_report_list(r, name, columns, x);
  else
    steif_report_matrix(r, name, (size_t)a->found.count, columns, x);
}

static void fill(steif_report *r, const struct call *call, const void *result)
{
  const struct gradient *a = result;
  const steif_gradient *g = &a->found;
  const size_t P = (size_t)g->parameters;
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  if (g->count == 1) {
    steif_report_real(r, "value", g->value[0]);
    steif_report_real(r, "error_estimate", g->error_estimate[0]);
  } else {
    steif_report_list(r, "value", (size_t)g->count, g->value);
    steif_report_list(r, "error_estimate", (size_t)g->count, g->error_estimate);
  }
  if (P) {
    steif_report_list(r, "p", P, a->problem->parameters->value);
    lists(r, a, "gradient", P, g->dp);
  }
  if (a->product) {
    steif_report_list(r, "v", P, a->v);
    lists(r, a, "product", P, a->product);
  }
  lists(r, a, "lambda0", (size_t)g->n, g->dy0);
  rows(r, a);
  costs(r, &g->cost);
  if (a->checked) steif_report_real(r, "disagreement", a->disagreement);
}

static int differentiate_twice(struct call *call, struct gradient *a)
{
  const steif_problem *p = a->problem;
  const size_t P = p->parameters ? (size_t)p->parameters->count : 0;
  a->v = calloc(P + 1, sizeof *a->v);
  a->product = calloc((size_t)a->functional.of.count * P + 1, sizeof *a->product);
  if (!a->v || !a->product) return no_memory(call, "a direction", "leave --hessian out");
  const int code = direction_read(call, p, "--hessian", a->v);
  if (code) return code;
  steif_direction *d = steif_direction_new(call->ctx, p, a->v, NULL);
  const int found = d ? steif_hessian_product(call->ctx, d, call->word[1], &a->options,
                                              &a->functional.of, &a->found, a->product, NULL)
                      : steif_status(call->ctx);
  steif_direction_free(&d);
  return found ? fail(call) : EXIT_OK;
}

static int find(struct call *call, struct gradient *a)
{
  if (given(call, "--hessian")) return differentiate_twice(call, a);
  return steif_gradient_find(call->ctx, a->problem, call->word[1], &a->options,
                             &a->functional.of, &a->found)
           ? fail(call)
           : EXIT_OK;
}

int gradient_answer(struct call *call, const steif_problem *p)
{
  struct gradient a = {.problem = p, .options = options_of(call)};
  if (a.options.t1 == 0) a.options.t1 = p->t1;
  a.found.memory = (size_t)whole_or(call, "--memory", 0);
  int code = gradient_functional_open(call, p, &a.functional);
  a.problem = a.functional.now;
  progress(call, "%s on %s", call->word[1], p->name);
  if (!code) code = find(call, &a);
  if (!code && given(call, "--check"))
    code =
      a.found.parameters
        ? check(call, &a)
        : bad_usage(call, "--check is by parameters, and problem '%s' has none", call->word[0]);
  if (!code) code = present_result(call, fill, &a);
  steif_gradient_free(call->ctx, &a.found);
  gradient_functional_close(call, &a.functional);
  free(a.mesh), free(a.most), free(a.v), free(a.product);
  return code;
}
