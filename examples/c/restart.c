/* Restart: a run is cut in two, as when a night on a cluster ends, and goes on from a file.
 *
 * What a one-step method needs to go on is t, y and the step size it had come to: three lines of a text
 * file with 17 digits, which give back every bit. Multistep methods go on as well, with a new start.
 * The problem is the Oregonator (R. J. Field and R. M. Noyes, 1974), which goes through sudden pulses;
 * known at t = 360 are the values of the Test Set for IVP Solvers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

static int pulses(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const double s = 77.27, w = 0.161, q = 8.375e-6;
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = s * (c[1] + c[0] * (1 - q * c[0] - c[1]));
  NV_Ith_S(ydot, 1) = (c[2] - (1 + c[0]) * c[1]) / s;
  NV_Ith_S(ydot, 2) = w * (c[0] - c[2]);
  return 0;
}

/* What is kept between two runs. */
struct state {
  double t, h, y[3];
};

static int save(const struct state *x, const char *path)
{
  FILE *file = fopen(path, "w");
  if (!file) return 1;
  const int n =
    fprintf(file, "%.17g %.17g %.17g %.17g %.17g\n", x->t, x->h, x->y[0], x->y[1], x->y[2]);
  return fclose(file) || n < 0;
}

static int load(struct state *x, const char *path)
{
  FILE *file = fopen(path, "r");
  if (!file) return 1;
  const int n = fscanf(file, "%lf %lf %lf %lf %lf", &x->t, &x->h, x->y, x->y + 1, x->y + 2);
  fclose(file);
  return n != 5;
}

/* From x to the time given; the context and the solver are made and freed here, as by a new process. */
static int advance(struct state *x, double until)
{
  const steif_problem p = {
    .name = "oregonator", .n = 3, .t0 = x->t, .t1 = until, .y0 = x->y, .f = pulses};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-9, opt.atol = 1e-9, opt.h0 = x->h;
  steif_context *ctx = steif_context_new(NULL);
  steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &opt);
  const int code = steif_solve_to(s, until);
  printf("to t = %g: %s, %ld steps\n", until, steif_message(ctx), steif_statistics(s)->steps);
  if (!code) {
    struct state end = {steif_time(s), steif_statistics(s)->h_last, {0}};
    for (int i = 0; i < 3; i++) end.y[i] = NV_Ith_S(steif_solution(s), i);
    *x = end;
  }
  steif_solver_free(&s);
  steif_context_free(&ctx);
  return code;
}

int main(void)
{
  static const double known[] = {1.00081487032, 1228.17852155, 132.055494285};
  const char *path = "oregonator.txt";
  struct state x = {0, 0, {1, 2, 3}}, again;
  if (advance(&x, 180) || save(&x, path)) return 1;
  if (load(&again, path) || advance(&again, 360)) return 1;
  int wrong = 0;
  for (int i = 0; i < 3; i++) {
    printf("y%d(360) = %.8f, known %.8f\n", i + 1, again.y[i], known[i]);
    wrong += !(fabs(again.y[i] - known[i]) < 1e-6 * known[i]);
  }
  return wrong;
}
