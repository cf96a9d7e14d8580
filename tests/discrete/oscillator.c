/* oscillator.c: the damped oscillator that all tables of errors are about.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "oscillator.h"
#include <math.h>
#include <stdlib.h>

static const double damping = 0.5;

/* a times the solution from (1, 0) plus b times that from (0, 1). */
static void free_motion(double k, double a, double b, double t, double h[2])
{
  const double al = damping / 2, w = sqrt(k - al * al), e = exp(-al * t);
  const double two = e * sin(w * t) / w, one = e * cos(w * t) + al * two;
  h[0] = a * one + b * two;
  h[1] = -a * k * two + b * (one - damping * two);
}

void exact(double k, enum drive drive, double t, double h[2])
{
  const double c = damping, d = (k - 4) * (k - 4) + 4 * c * c, a = (k - 4) / d, b = -2 * c / d;
  double p[2] = {0, 0}, start[2] = {-1, 0};
  if (drive == ONE) start[0] = p[0] = 1 / k;
  if (drive == RAMP) {
    p[0] = t / k - c / (k * k), p[1] = 1 / k;
    start[0] = -c / (k * k), start[1] = 1 / k;
  }
  if (drive == SINE) {
    p[0] = a * sin(2 * t) + b * cos(2 * t), p[1] = 2 * a * cos(2 * t) - 2 * b * sin(2 * t);
    start[0] = b, start[1] = 2 * a;
  }
  free_motion(k, -start[0], -start[1], t, h);
  h[0] += p[0], h[1] += p[1];
}

steif_state_space oscillator(double k, double A[4])
{
  static const double B[] = {0, 1}, C[] = {1, 0};
  A[0] = 0, A[1] = -k, A[2] = 1, A[3] = -damping;
  return (steif_state_space){.n = 2, .m = 1, .p = 1, .A = A, .B = B, .C = C};
}

static int input(double t, double *u, void *drive)
{
  const double value[] = {0, 1, t, sin(2 * t)};
  *u = value[*(enum drive *)drive];
  return 0;
}

static double compare(double k, enum drive drive, double dt, long steps, enum size of,
                      const double *h)
{
  double most = 0, x[2];
  for (long j = 0; j <= steps; j++) {
    exact(k, drive, (double)j * dt, x);
    const double e = h[2 * j] - x[0], v = h[2 * j + 1] - x[1];
    const double size[] = {fabs(e), hypot(e, v), fmax(fabs(e), fabs(v))};
    most = fmax(most, size[of]);
  }
  return most;
}

double worst(const char *scheme, double k, enum drive drive, double dt, enum size of,
             change_fn change)
{
  const long steps = lround(4 / dt);
  const double h0[] = {drive == NOTHING, 0};
  double A[4], room[4], most = NAN, *h = calloc((size_t)steps + 1, 2 * sizeof *h);
  steif_context *ctx = steif_context_new(NULL);
  const steif_state_space s = oscillator(k, A);
  steif_discrete d = {0};
  if (h && ctx && steif_c2d(ctx, &s, scheme, dt, &d) == STEIF_OK) {
    if (change) change(&d, room);
    if (steif_discrete_run(ctx, &d, input, &drive, 0, h0, steps, h) == STEIF_OK)
      most = compare(k, drive, dt, steps, of, h);
  }
  steif_discrete_clear(ctx, &d);
  steif_context_free(&ctx);
  free(h);
  return most;
}
