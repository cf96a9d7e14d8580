/* functional.c: an integrand written in t, unknowns and parameters of a problem, as its quadrature. Of a model it is one
 * more expression of its text, whose kinks and jumps are events; of other problems the output of a small model with the
 * same names, with branches as they are at each point: right where they meet without a jump and the error of the
 * quadrature is tested.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "integration.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { UNKNOWNS = 1000, LINE = 128 };

static bool is_name(const char *text)
{
  if (!text || !isalpha((unsigned char)*text)) return false;
  for (; *text; text++)
    if (!isalnum((unsigned char)*text) && *text != '_') return false;
  return true;
}

static void name_unknown(const steif_problem *p, sunindextype i, char *room)
{
  const char *given = p->names && p->names->unknown ? p->names->unknown[i] : NULL;
  if (is_name(given))
    snprintf(room, LINE, "%.100s", given);
  else
    snprintf(room, LINE, "y%lld", (long long)i + 1);
}

static void name_parameter(const steif_parameters *q, int k, char *room)
{
  if (q->name && is_name(q->name[k]))
    snprintf(room, LINE, "%.100s", q->name[k]);
  else
    snprintf(room, LINE, "p%d", k + 1);
}

/* The model as text; to be freed. The expression is the slope of the first unknown, its branches events or not. */
static char *write_model(const steif_problem *p, const char *expression, bool events)
{
  const steif_parameters *q = p->parameters;
  const int P = q ? q->count : 0;
  const size_t lines = (size_t)p->n * 2 + (size_t)P + 4;
  char *text = malloc(lines * 2 * LINE + strlen(expression)), *at = text, name[LINE];
  if (!text) return NULL;
  for (int k = 0; k < P; k++) {
    name_parameter(q, k, name);
    at += sprintf(at, "param %s = %.17g\n", name, q->value[k]);
  }
  for (sunindextype i = 0; i < p->n; i++) {
    name_unknown(p, i, name);
    at += sprintf(at, "state %s = 0\n%s' = %s(%s)\n", name, name, i || events ? "" : "noevent",
                  i ? "0" : expression);
  }
  sprintf(at, "time %.17g to %.17g\n", p->t0, p->t1);
  return text;
}

static int parse(struct call *call, const steif_problem *p, const char *expression, bool events,
                 steif_problem *model)
{
  char *text = write_model(p, expression, events);
  if (!text) return no_memory(call, "the functional", "leave it out");
  const int code = steif_model_parse(call->ctx, text, "functional", NULL, model);
  free(text);
  if (code) return fail(call);
  if (model->f) return EXIT_OK;
  steif_problem_clear(call->ctx, model);
  return bad_usage(call, "'%s' has slopes of unknowns in it: integrands are of unknowns alone",
                   expression);
}

int expression_open(struct call *call, const steif_problem *p, const char *expression,
                    steif_problem *model)
{
  if (p->n > UNKNOWNS)
    return bad_usage(call, "'%s': expressions are of at most %d unknowns, sums of them of any",
                     expression, UNKNOWNS);
  return parse(call, p, expression, false, model);
}

/* Is each event of the model where a function bends that does not jump? */
static bool bends(const steif_problem *model)
{
  static const char *const function[] = {"abs(", "min(", "max(", "ramp("};
  bool all = model->break_count == 0;
  for (int i = 0; i < model->events; i++) {
    bool one = false;
    for (size_t k = 0; k < sizeof function / sizeof *function; k++)
      one = one || !strncmp(model->event_list[i].name, function[k], strlen(function[k]));
    all = all && one;
  }
  return all;
}

int expression_kinks(struct call *call, const steif_problem *p, const char *expression,
                     bool *kinks)
{
  steif_problem model;
  const int code = parse(call, p, expression, true, &model);
  if (code) return code;
  *kinks = model.events > 0 || model.break_count > 0;
  const bool smooth = bends(&model);
  steif_problem_clear(call->ctx, &model);
  if (smooth) return EXIT_OK;
  return bad_usage(
    call,
    "'%s' jumps, or has a kink in t: where, is found of models alone, and '%s' is "
    "none; write it as a model (steif problem %s --model shows how one looks), or "
    "noevent(...) around what jumps, and trust the steps",
    expression, p->name, p->name);
}

int expression_follow(const steif_parameters *from, const steif_problem *model)
{
  const steif_parameters *to = model->parameters;
  bool moved = false;
  for (int k = 0; from && k < from->count; k++) {
    moved = moved || to->value[k] != from->value[k];
    to->value[k] = from->value[k];
  }
  return moved && to->moved(model->user) ? -1 : 0;
}

int expression_value(const steif_parameters *from, const steif_problem *model, double t,
                     N_Vector y, N_Vector out, double *value)
{
  if (expression_follow(from, model)) return -1;
  const int code = model->f(t, y, out, model->user);
  *value = N_VGetArrayPointer(out)[0];
  return code;
}

/* With the parameters that the problem has now. */
static int integrand(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  struct functional *f = user;
  if (!f->out && !(f->out = N_VClone(y))) return -1;
  return expression_value(f->problem.parameters, &f->model, t, y, f->out, value);
}

bool is_model(const steif_problem *p) { return steif_model_attribute(p, 0) >= 0; }

int integrands_open(struct call *call, const steif_problem *p, int count,
                    const char *const *expression, steif_problem *model)
{
  if (p->n > UNKNOWNS)
    return bad_usage(call, "'%s': expressions are of at most %d unknowns, sums of them of any",
                     *expression, UNKNOWNS);
  if (steif_model_integrands(call->ctx, p, count, expression, model)) return fail(call);
  model->t1 = p->t1;
  return EXIT_OK;
}

/* Of a problem that is no model. */
static int open_other(struct call *call, const steif_problem *p, const char *expression,
                      struct functional *f)
{
  int code = expression_kinks(call, p, expression, &f->kinks);
  if (!code) code = expression_open(call, p, expression, &f->model);
  if (code) return code;
  f->problem = *p;
  f->quadrature = (steif_quadrature){.count = 1, .value = integrand, .user = f};
  f->problem.quadrature = &f->quadrature;
  return EXIT_OK;
}

int functional_open(struct call *call, const steif_problem *p, struct functional *f)
{
  const char *expression = word_of(call, "--functional");
  if (strncmp(expression, "int ", 4))
    return bad_usage(call, "--functional is 'int ' and an expression, such as 'int y3^2'");
  if (!p->parameters) return bad_usage(call, "--functional needs a problem with parameters");
  expression += 4;
  if (!is_model(p)) return open_other(call, p, expression, f);
  const int code = integrands_open(call, p, 1, &expression, &f->model);
  if (code) return code;
  f->problem = f->model;
  f->quadrature = (steif_quadrature){.count = 1,
                                     .value = steif_model_integrand_values,
                                     .slope = steif_model_integrand_along,
                                     .user = f->model.user};
  f->problem.quadrature = &f->quadrature;
  return EXIT_OK;
}

void functional_close(struct call *call, struct functional *f)
{
  if (f->model.user) steif_problem_clear(call->ctx, &f->model);
  if (f->out) N_VDestroy(f->out);
}
