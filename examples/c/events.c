/* Events that change the state: a ball falls, bounces, and loses a fifth of its speed each time.
 *
 *   h' = v, v' = -g;  at h = 0, falling:  v becomes -0.8 v.
 *
 * `event` computes the functions whose changes of sign are events, `list` says in which direction, and
 * `bounce` changes the state and asks for a restart from there. The times are located to rounding.
 * Known: bounce k is at T (1 + 2 (e + ... + e^(k-1))), T = sqrt(2/g), e = 0.8.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

static const double g = 9.81, e = 0.8;

static int fall(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(ydot, 1) = -g;
  return 0;
}

static int height(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = NV_Ith_S(y, 0);
  return 0;
}

static int bounce(sunrealtype t, N_Vector y, const int *fired, void *user)
{
  (void)t, (void)fired, (void)user;
  NV_Ith_S(y, 0) = 0;
  NV_Ith_S(y, 1) *= -e;
  return STEIF_RESTART;
}

struct bounces {
  int count;
  double error; /* of the times so far */
};

/* Called at each event before `bounce`; a place to note, print or count. */
static int note(steif_solver *s, sunrealtype t, N_Vector y, const int *fired, void *observer)
{
  struct bounces *b = observer;
  double known = 1;
  (void)s, (void)fired;
  b->count++;
  for (int k = 1; k < b->count; k++) known += 2 * pow(e, k);
  known *= sqrt(2 / g);
  b->error = fmax(b->error, fabs(t - known));
  printf("bounce %d at t = %.12f, known %.12f, speed %.6f\n", b->count, t, known,
         NV_Ith_S(y, 1));
  return 0;
}

int main(void)
{
  static const double start[] = {1, 0};
  static const steif_event list[] = {{.name = "floor", .direction = -1}};
  const steif_problem p = {.name = "ball",
                           .n = 2,
                           .t1 = 3,
                           .y0 = start,
                           .f = fall,
                           .events = 1,
                           .event = height,
                           .event_list = list,
                           .handle_event = bounce};
  struct bounces b = {0};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-10, opt.on_event = note, opt.observer = &b;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &opt);
  const int code = steif_solve_to(s, p.t1);
  if (!code) printf("h(3) = %.12f, known 0.068707460966\n", NV_Ith_S(steif_solution(s), 0));
  puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return code || b.count != 6 || !(b.error < 1e-10);
}
