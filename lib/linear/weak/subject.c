/* subject.c: a descriptor system beside its solution: found by name, or put together.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <string.h>

static int jordan(stf_subject *s)
{
  const steif_problem *p = &s->problem;
  s->index = (int)p->n;
  return stf_block_open(&s->block, s->ctx, (int)p->n, p->g, p->user, p->y0);
}

/* Structure and start. */
static int analyse(stf_subject *s)
{
  const steif_linear *l = &s->linear;
  STEIF_CHECK(s->problem.y0, s->ctx, STEIF_BAD_INPUT,
              "x(0-) is missing: give the %d start values", s->n);
  STEIF_TRY(steif_structure_find(s->ctx, l->E, l->F, NULL, &s->structure));
  STEIF_TRY(steif_impulse_find(s->ctx, l->E, l->F, s->problem.y0, s->problem.t0, l->f, l->user,
                               NULL, &s->structure, &s->impulse));
  s->index = s->impulse.index;
  STEIF_TRY(stf_apart_open(s->ctx, l, &s->structure, &s->apart));
  return stf_reduced_open(s->ctx, l, &s->structure, false, &s->reduced);
}

static int find(stf_subject *s, const char *spec)
{
  STEIF_CHECK(spec, s->ctx, STEIF_BAD_INPUT,
              "no problem was named: give one such as \"jordan:k=3,case=H-inc\"");
  STEIF_TRY(steif_problem_find(s->ctx, spec, &s->problem));
  s->named = true, s->n = (int)s->problem.n;
  const bool block = !strncmp(spec, "jordan", 6) && (!spec[6] || spec[6] == ':'),
             matrices = s->problem.storage == STEIF_DENSE || s->problem.storage == STEIF_SPARSE;
  if (matrices || !block) STEIF_TRY(steif_linear_of(s->ctx, &s->problem, &s->linear));
  return block ? jordan(s) : analyse(s);
}

static int adopt(stf_subject *s, const steif_linear *linear, const sunrealtype *x0)
{
  s->linear = *linear;
  s->sides = (stf_sides){.f = linear->f, .user = linear->user};
  if (linear->f) s->linear.f = stf_sides_force, s->linear.user = &s->sides;
  STEIF_TRY(steif_linear_problem(s->ctx, &s->linear, x0, 0, 1, &s->problem));
  s->n = (int)s->problem.n;
  return analyse(s);
}

int stf_subject_open(steif_context *ctx, const char *spec, const steif_linear *linear,
                     const sunrealtype *x0, stf_subject *s)
{
  *s = (stf_subject){.ctx = ctx, .weight = stf_weight_of(ctx, NULL)};
  const int code = linear ? adopt(s, linear, x0) : find(s, spec);
  if (code) stf_subject_close(s);
  return code;
}

void stf_subject_close(stf_subject *s)
{
  if (!s->ctx) return;
  stf_block_close(&s->block);
  for (size_t i = 0; i < s->jumps; i++) steif_impulse_clear(s->ctx, &s->jump[i].at);
  stf_release(s->ctx, s->jump);
  steif_impulse_clear(s->ctx, &s->impulse);
  steif_structure_clear(s->ctx, &s->structure);
  stf_reduced_close(&s->reduced);
  stf_apart_close(&s->apart);
  if (s->named && s->linear.E) SUNMatDestroy(s->linear.E), SUNMatDestroy(s->linear.F);
  if (s->named) steif_problem_clear(s->ctx, &s->problem);
  *s = (stf_subject){0};
}

stf_apart *stf_subject_apart(stf_subject *s, const char *method, const char *start)
{
  const bool exact = start ? !strcmp(start, "exact") : !!strstr(method, "start=exact");
  return s->apart.linear.E && !exact ? &s->apart : NULL;
}
