/* watched.c: see watched.h.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "watched.h"
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(out, 0) = 1, NV_Ith_S(out, 1) = -NV_Ith_S(y, 1);
  return 0;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 1, 1) = -1;
  return 0;
}

static const sunrealtype start[] = {0, 1};

steif_problem watched_problem(int events, steif_values event)
{
  return (steif_problem){.name = "watched",
                         .n = 2,
                         .t1 = 2,
                         .y0 = start,
                         .f = f,
                         .jac = jac,
                         .events = events,
                         .event = event};
}

static int notice(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *user)
{
  watched *w = user;
  (void)s, (void)y;
  CU_ASSERT_FATAL(w->count < SEEN);
  w->t[w->count] = t;
  memcpy(w->fired[w->count++], fired, (size_t)w->functions * sizeof *fired);
  return 0;
}

static int observe(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  watched *w = user;
  (void)s;
  if (w->steps >= STEPS) return 0;
  w->step_t[w->steps] = t;
  for (int i = 0; i < 2; i++) w->step_y[w->steps][i] = NV_Ith_S(y, i);
  w->steps++;
  return 0;
}

int watched_run(steif_context *ctx, const steif_problem *p, const char *method, double h,
                watched *w)
{
  steif_options o = steif_defaults();
  *w = (watched){.functions = p->events < FUNCTIONS ? p->events : FUNCTIONS};
  o.rtol = o.atol = 1e-9, o.h = h;
  o.on_event = notice, o.observe = observe, o.observer = w;
  steif_solver *s = smooth_open(ctx, p, method, &o);
  const int code = steif_solve_to(s, p->t1);
  steif_solver_free(&s);
  return code;
}
