/* The solution between the steps: an orbit of eccentricity 0.6, recorded whole and asked anywhere.
 *
 *   q'' = -q/|q|^3 from perihelion, one revolution.
 *
 * steif_record keeps every step as a polynomial; steif_record_at then gives y(t) at any time of the run, as
 * often as wanted. The solver chooses its steps as if nobody asked.
 * Known: J. Kepler's equation u - e sin u = t gives q = (cos u - e, sqrt(1 - e^2) sin u).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

static const double ecc = 0.6;

static int gravity(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *z = N_VGetArrayPointer(y);
  const double cube = pow(hypot(z[0], z[1]), 3);
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = z[2];
  NV_Ith_S(ydot, 1) = z[3];
  NV_Ith_S(ydot, 2) = -z[0] / cube;
  NV_Ith_S(ydot, 3) = -z[1] / cube;
  return 0;
}

static void kepler(double t, double *q)
{
  double u = t;
  for (int i = 0; i < 50; i++) u -= (u - ecc * sin(u) - t) / (1 - ecc * cos(u));
  q[0] = cos(u) - ecc;
  q[1] = sqrt(1 - ecc * ecc) * sin(u);
}

int main(void)
{
  const double start[] = {1 - ecc, 0, 0, sqrt((1 + ecc) / (1 - ecc))}, t1 = 2 * acos(-1);
  const steif_problem p = {.name = "orbit", .n = 4, .t1 = t1, .y0 = start, .f = gravity};
  steif_context *ctx = steif_context_new(NULL);
  steif_record *r = steif_record_new(ctx, p.n, 8);
  steif_options opt = steif_defaults();
  opt.rtol = 1e-10, opt.observe = steif_record_step, opt.observer = r;
  steif_solver *s = steif_solver_new(ctx, &p, "dopri87", &opt);
  double error = INFINITY;
  if (r && steif_solve_to(s, t1) == STEIF_OK) {
    enum { POINTS = 1000 };
    const double *ends;
    error = 0;
    for (int i = 0; i <= POINTS; i++) {
      const double t = t1 * i / POINTS;
      double y[4], q[2];
      if (steif_record_at(r, t, y, NULL) != STEIF_OK) break;
      kepler(t, q);
      error = fmax(error, hypot(y[0] - q[0], y[1] - q[1]));
      if (i % 250 == 0) printf("t = %.4f: q = (%+.8f, %+.8f)\n", t, y[0], y[1]);
    }
    printf("%zu steps; largest error at %d times: %.1e\n", steif_record_steps(r, &ends), POINTS,
           error);
  }
  puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_record_free(&r);
  steif_context_free(&ctx);
  return !(error < 1e-7);
}
