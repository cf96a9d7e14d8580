/* taylor_run.c: a program in Taylor arithmetic, on a stack of series.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <math.h>
#include <string.h>

static void copy(int n, const stf_series *a, stf_series *u)
{
  memcpy(u->c, a->c, (size_t)(n + 1) * sizeof *u->c);
}

/* Right limits: step(t - c) is 1 at t = c, step(c - t) is 0 there. */
static bool active(const stf_instruction *i, sunrealtype t)
{
  return i->rising ? t >= i->number : t < i->number;
}

/* a^b = exp(b log a), a > 0. */
static const char *power(int n, const stf_series *a, const stf_series *b, stf_series *u,
                         stf_series *w)
{
  if (!(a->c[0] > 0))
    return "a power of a number that is not positive, the exponent not constant";
  stf_series_log(n, a, u);
  stf_series_times(n, u, b, w);
  stf_series_exp(n, w, u);
  return NULL;
}

/* The two series on top, a and b, into a. */
static const char *two(enum stf_operation operation, int n, stf_series *a, const stf_series *b,
                       stf_series *w)
{
  const char *wrong = NULL;
  switch (operation) {
  case STF_ADD:
    for (int k = 0; k <= n; k++) a->c[k] += b->c[k];
    return NULL;
  case STF_SUBTRACT:
    for (int k = 0; k <= n; k++) a->c[k] -= b->c[k];
    return NULL;
  case STF_MULTIPLY: stf_series_times(n, a, b, w); break;
  case STF_DIVIDE: wrong = stf_series_over(n, a, b, w); break;
  default: wrong = power(n, a, b, w, w + 1); break;
  }
  if (!wrong) copy(n, w, a);
  return wrong;
}

/* The smaller or larger of the two series on top, into a; at a breakpoint that to its right. */
static const char *extreme(const stf_instruction *i, sunrealtype t, int n, stf_series *a,
                           const stf_series *b)
{
  const bool known = !isnan(i->number), equal = a->c[0] == b->c[0];
  if (!known && equal && n > 0) return "the derivative of min or max where both are equal";
  const bool larger = known ? active(i, t) : a->c[0] > b->c[0];
  if (larger == (i->operation == STF_MIN)) copy(n, b, a);
  return NULL;
}

/* The series on top. */
static const char *one(const stf_instruction *i, sunrealtype t, int n, stf_series *a,
                       stf_series *w)
{
  const char *wrong = NULL;
  const stf_series *u = w;
  switch (i->operation) {
  case STF_NEGATE:
    for (int k = 0; k <= n; k++) a->c[k] = -a->c[k];
    return NULL;
  case STF_RAMP:
    if (!active(i, t)) stf_series_constant(n, 0, a);
    return NULL;
  case STF_POWER_WHOLE: wrong = stf_series_whole(n, a, (long)i->number, w, w + 1); break;
  case STF_POWER_REAL: wrong = stf_series_power(n, a, i->number, w); break;
  case STF_SQRT: wrong = stf_series_power(n, a, 0.5, w); break;
  case STF_LOG: wrong = stf_series_log(n, a, w); break;
  case STF_ABS:
    if (isnan(i->number)) {
      wrong = stf_series_abs(n, a, w);
      break;
    }
    for (int k = 0; k <= n && !active(i, t); k++) a->c[k] = -a->c[k];
    return NULL;
  case STF_EXP: stf_series_exp(n, a, w); break;
  case STF_SIN: stf_series_waves(n, a, -1, w, w + 1); break;
  case STF_COS: stf_series_waves(n, a, -1, w + 1, w); break;
  case STF_SINH: stf_series_waves(n, a, 1, w, w + 1); break;
  case STF_COSH: stf_series_waves(n, a, 1, w + 1, w); break;
  case STF_TAN: wrong = stf_series_tan(n, a, 1, w, w + 1); break;
  case STF_TANH: wrong = stf_series_tan(n, a, -1, w, w + 1); break;
  default: stf_series_atan(n, a, w, w + 1); break;
  }
  if (!wrong) copy(n, u, a);
  return wrong;
}

const char *stf_program_run(const stf_program *program, sunrealtype t, int n, stf_series *stack,
                            int *place)
{
  stf_series *top = stack - 1, *w = stack + program->depth;
  for (int k = 0; k < program->length; k++) {
    const stf_instruction *i = program->code + k;
    const char *wrong = NULL;
    switch (i->operation) {
    case STF_NUMBER: stf_series_constant(n, i->number, ++top); break;
    case STF_STEP: stf_series_constant(n, active(i, t), ++top); break;
    case STF_TIME:
      stf_series_constant(n, t, ++top);
      if (n > 0) top->c[1] = 1;
      break;
    case STF_ADD:
    case STF_SUBTRACT:
    case STF_MULTIPLY:
    case STF_DIVIDE:
    case STF_POWER:
      top--;
      wrong = two(i->operation, n, top, top + 1, w);
      break;
    case STF_MIN:
    case STF_MAX:
      top--;
      wrong = extreme(i, t, n, top, top + 1);
      break;
    default: wrong = one(i, t, n, top, w); break;
    }
    if (wrong) {
      *place = i->place;
      return wrong;
    }
  }
  return NULL;
}

/* Series on the stack before instruction k. */
static int height(const stf_program *program, int k)
{
  int count = 0;
  for (int i = 0; i < k; i++) {
    const enum stf_operation o = program->code[i].operation;
    const bool pushes = o == STF_NUMBER || o == STF_TIME || o == STF_STEP;
    count += pushes - (o >= STF_ADD && o <= STF_POWER && o != STF_NEGATE);
  }
  return count;
}

sunrealtype stf_program_switch(const stf_program *program, int k, sunrealtype t,
                               stf_series *stack)
{
  int place;
  const stf_program before = {program->code, k, program->depth};
  if (stf_program_run(&before, t, 0, stack, &place)) return NAN;
  const stf_series *top = stack + height(program, k) - 1;
  return program->code[k].operation == STF_ABS ? top->c[0] : top[-1].c[0] - top->c[0];
}
