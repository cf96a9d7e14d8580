/* Many runs in threads: the period of a pendulum for 32 amplitudes, on four threads.
 *
 *   a' = w, w' = -sin a from a = amplitude; a quarter of the period has passed at the first a = 0.
 *
 * The library keeps no global state: with a context of its own each thread may do as it likes. A context
 * made with threads = 1 starts no further threads for its linear algebra.
 * Known: the period is 2 pi / M(1, cos(amplitude/2)), M the arithmetic-geometric mean (C. F. Gauss).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <pthread.h>
#include <stdio.h>
#include <steif/steif.h>

enum { RUNS = 32, THREADS = 4 };
struct share {
  int first;           /* runs first, first + THREADS, ... */
  double period[RUNS]; /* of this thread's runs, 0 elsewhere */
};

static double amplitude(int run) { return 3.0 * (run + 1) / RUNS; }

static int swing(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = NV_Ith_S(y, 1);
  NV_Ith_S(ydot, 1) = -sin(NV_Ith_S(y, 0));
  return 0;
}

static int angle(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)user;
  value[0] = NV_Ith_S(y, 0);
  return 0;
}

static void *work(void *argument)
{
  static const steif_event lowest[] = {{.name = "lowest", .direction = -1, .terminal = 1}};
  struct share *share = argument;
  const steif_setup alone = {.threads = 1};
  steif_context *ctx = steif_context_new(&alone);
  steif_options opt = steif_defaults();
  opt.rtol = 1e-11;
  for (int run = share->first; run < RUNS; run += THREADS) {
    const double start[] = {amplitude(run), 0};
    const steif_problem p = {.name = "swing",
                             .n = 2,
                             .t1 = 100,
                             .y0 = start,
                             .f = swing,
                             .events = 1,
                             .event = angle,
                             .event_list = lowest};
    steif_solver *s = steif_solver_new(ctx, &p, "dopri87", &opt);
    const int code = steif_solve_to(s, 100);
    share->period[run] = code == STEIF_EVENT ? 4 * steif_time(s) : NAN;
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
  return NULL;
}

int main(void)
{
  static struct share share[THREADS];
  pthread_t thread[THREADS];
  double worst = 0;
  for (int k = 0; k < THREADS; k++) {
    share[k].first = k;
    if (pthread_create(&thread[k], NULL, work, &share[k])) return 1;
  }
  for (int k = 0; k < THREADS; k++) pthread_join(thread[k], NULL);
  for (int run = 0; run < RUNS; run++) {
    double a = 1, b = cos(amplitude(run) / 2);
    for (int i = 0; i < 8; i++) {
      const double mean = (a + b) / 2;
      b = sqrt(a * b), a = mean;
    }
    const double period = share[run % THREADS].period[run], error = period - 2 * acos(-1) / a;
    if (run % 8 == 7) printf("amplitude %.3f: period %.10f\n", amplitude(run), period);
    if (!(fabs(error) <= worst)) worst = fabs(error);
  }
  printf("%d runs, largest error of a period %.1e\n", RUNS, worst);
  return !(worst < 1e-7);
}
