/* smooth_times.c: the smooth part of the solution of E x' + F x = f at given times.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "subject.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

/* Parts of an interval between two times: many for few times, which may lie far apart. */
enum { FEW = 512, PARTS = 8, PARTS_OF_MANY = 2, PARTS_MOST = 100000 };

int stf_subject_carry(stf_subject *s, const sunrealtype *x0, size_t count,
                      const sunrealtype *mesh,
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
  if (s->reduced.linear.E ||
      s->index <= 1) { /* the algebraic part is solved for in every step */
    memcpy(w->x + w->at / w->parts * (size_t)s->n, N_VGetArrayPointer(x),
           (size_t)s->n * sizeof *w->x);
    return 0;
  }
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
  w.parts = (size_t)fmin(fmax(ceil(wanted), count > FEW ? PARTS_OF_MANY : PARTS),
                         fmax(1, PARTS_MOST / (double)count));
  const size_t steps = (count - 1) * w.parts;
  sunrealtype *mesh = stf_allocate(s->ctx, steps + 1, sizeof *mesh);
  if (!mesh) return STEIF_NO_MEMORY;
  for (size_t i = 0; i <= steps; i++) {
    const size_t k = i / w.parts < count - 1 ? i / w.parts : count - 2;
    mesh[i] = t[k] + (t[k + 1] - t[k]) * (double)(i - k * w.parts) / (double)w.parts;
  }
  const int code = stf_subject_carry(s, x, steps + 1, mesh, take_time, &w);
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

int stf_subject_segment(stf_subject *s, size_t i, size_t count, const sunrealtype *t,
                        sunrealtype *x)
{
  if (count < 2 || s->jumps == 0) return stf_subject_smooth(s, count, t, x);
  const sunrealtype *start = i ? s->jump[i - 1].at.x_plus : s->impulse.x_plus;
  memcpy(x, start, (size_t)s->n * sizeof *x);
  stf_sides_step(&s->sides, t[0], i < s->jumps ? s->jump[i].t : t[count - 1], 0);
  const int code = stf_subject_follow(s, count, t, x);
  stf_sides_step(&s->sides, 0, 0, 0);
  return code;
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
