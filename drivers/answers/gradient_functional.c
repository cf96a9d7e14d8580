/* gradient_functional.c: functionals of gradients, values and slopes.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "gradient_functional.h"
#include "answers.h"
#include <stdlib.h>
#include <string.h>

static int scratch(struct gradient_functional *f, N_Vector y)
{
  if (f->out) return 0;
  f->first = N_VClone(y), f->none = N_VClone(y), f->out = N_VClone(y);
  if (!f->first || !f->none || !f->out) return -1;
  N_VConst(0, f->first), N_VConst(0, f->none);
  N_VGetArrayPointer(f->first)[0] = 1;
  return 0;
}

static int value(struct gradient_functional *f, int at_end, int i, double t, N_Vector y,
                 double *g)
{
  const struct asked *a = &f->asked[at_end][i];
  if (a->is_sum) {
    *g = sum_at(&a->sum, N_VGetArrayPointer(y));
    return 0;
  }
  if (f->expressions) {
    *g = f->all[a->number];
    return 0;
  }
  if (scratch(f, y)) return -1;
  return expression_value(f->now->parameters, &a->model, t, y, f->out, g);
}

static int values(struct gradient_functional *f, int at_end, double t, N_Vector y, double *g)
{
  int code = f->expressions ? steif_model_integrand_values(t, y, f->all, f->now->user) : 0;
  for (int i = 0; !code && i < f->of.count; i++) code = value(f, at_end, i, t, y, &g[i]);
  return code;
}

static int integrand(double t, N_Vector y, double *g, void *user)
{
  return values(user, 0, t, y, g);
}

static int end(double t, N_Vector y, double *g, void *user) { return values(user, 1, t, y, g); }

/* Of the model F = y' - f, whose products with the first unit vector are -df_1/dy and -df_1/dp. */
static int slopes(double t, N_Vector y, int i, int at_end, N_Vector dy, double *dp, void *user)
{
  struct gradient_functional *f = user;
  const struct asked *a = &f->asked[at_end][i];
  if (a->is_sum) {
    sum_slope(&a->sum, N_VGetArrayPointer(y), N_VGetArrayPointer(dy));
    return 0;
  }
  if (f->expressions) return steif_model_integrand_slopes(f->now, t, y, a->number, dy, dp);
  if (scratch(f, y) || expression_follow(f->now->parameters, &a->model)) return -1;
  const int code =
    steif_model_adjoint(f->ctx, &a->model, t, y, f->none, f->first, dy, NULL, dp);
  N_VScale(-1, dy, dy);
  for (int k = 0; dp && k < f->now->parameters->count; k++) dp[k] = -dp[k];
  return code;
}

/* Values at the end are those of the branches there. */
static int add_expression(struct call *call, struct gradient_functional *f, int at_end,
                          const char *text, struct asked *a)
{
  const size_t room = strlen(text) + sizeof "noevent()";
  char *to = malloc(room);
  if (!to) return no_memory(call, "the functionals", "ask for fewer");
  snprintf(to, room, at_end ? "noevent(%s)" : "%s", text);
  a->number = f->expressions;
  f->expression[f->expressions++] = to;
  return EXIT_OK;
}

/* What the sum parser takes it takes, the language all else. */
static int read_asked(struct call *call, const steif_problem *p, struct gradient_functional *f,
                      int at_end, const char *text, struct asked *a)
{
  bool kinks = false;
  a->is_sum = sum_read(p, text, &a->sum);
  if (a->is_sum) return EXIT_OK;
  if (is_model(p)) return add_expression(call, f, at_end, text, a);
  const int code = at_end ? EXIT_OK : expression_kinks(call, p, text, &kinks);
  if (kinks && !code)
    return bad_usage(call,
                     "'%s' has kinks, which gradients of '%s', no model, do not meet: leave "
                     "--adjoint out, or write noevent(...) around it and trust the steps",
                     text, p->name);
  return code ? code : expression_open(call, p, text, &a->model);
}

/* "int y1; int y3" or "y1; y2", the second after what was asked before. */
static int read_all(struct call *call, const steif_problem *p, struct gradient_functional *f,
                    int at_end, const char *text)
{
  char *copy = strdup(text);
  int count = 0, code = copy ? EXIT_OK : no_memory(call, "the functionals", "ask for fewer");
  f->asked[at_end] = calloc(FUNCTIONALS, sizeof *f->asked[at_end]);
  if (!code && !f->asked[at_end]) code = no_memory(call, "the functionals", "ask for fewer");
  for (char *part = code ? NULL : strtok(copy, ";"); !code && part; part = strtok(NULL, ";")) {
    part += strspn(part, " ");
    if (count == FUNCTIONALS) code = bad_usage(call, "more than %d functionals", FUNCTIONALS);
    if (!code && !at_end && strncmp(part, "int ", 4))
      code = bad_usage(call, "--functional '%s': an integral is written 'int y1'", part);
    if (!code && !f->label[count] && !(f->label[count] = strdup(part)))
      code = no_memory(call, "the functionals", "ask for fewer");
    if (!code)
      code =
        read_asked(call, p, f, at_end, at_end ? part : part + 4, &f->asked[at_end][count++]);
  }
  free(copy);
  if (!code && f->of.count && count != f->of.count)
    code = bad_usage(call, "%d integrals and %d values at the end: give as many of both",
                     f->of.count, count);
  f->of.count = count;
  return code;
}

int gradient_functional_open(struct call *call, const steif_problem *p,
                             struct gradient_functional *f)
{
  const char *integral = word_of(call, "--functional"), *last = word_of(call, "--end");
  f->now = p, f->ctx = call->ctx;
  f->of = (steif_functional){.slopes = slopes, .user = f};
  int code = integral ? read_all(call, p, f, 0, integral) : EXIT_OK;
  if (!code && last) code = read_all(call, p, f, 1, last);
  if (integral) f->of.integrand = integrand;
  if (last) f->of.end = end;
  if (code || !f->expressions) return code;
  code =
    integrands_open(call, p, f->expressions, (const char *const *)f->expression, &f->extended);
  f->now = &f->extended;
  return code;
}

int gradient_functional_extend(struct call *call, const struct gradient_functional *f,
                               steif_problem *p)
{
  steif_problem own;
  if (!f->expressions) return EXIT_OK;
  const int code =
    integrands_open(call, p, f->expressions, (const char *const *)f->expression, &own);
  steif_problem_clear(call->ctx, p);
  if (!code) *p = own;
  return code;
}

void gradient_functional_close(struct call *call, struct gradient_functional *f)
{
  for (int at_end = 0; at_end < 2; at_end++) {
    for (int i = 0; f->asked[at_end] && i < FUNCTIONALS; i++)
      if (f->asked[at_end][i].model.user)
        steif_problem_clear(call->ctx, &f->asked[at_end][i].model);
    free(f->asked[at_end]);
  }
  for (int i = 0; i < FUNCTIONALS; i++) free(f->label[i]);
  for (int i = 0; i < f->expressions; i++) free(f->expression[i]);
  if (f->extended.user) steif_problem_clear(call->ctx, &f->extended);
  if (f->first) N_VDestroy(f->first);
  if (f->none) N_VDestroy(f->none);
  if (f->out) N_VDestroy(f->out);
}
