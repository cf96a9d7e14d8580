/* A partial differential equation on a grid: diffusion in the logarithm w of a concentration.
 *
 *   w' = div grad w + |grad w|^2 on the unit square, w = log 2 on its edge;
 * on a grid of N x N points, with e^w the concentration that moves between neighbours,
 *   w_ij' = sum over the four neighbours k of (e^(w_k - w_ij) - 1) / dx^2.
 * The Jacobian is not written down: steif_pattern_find sees which unknowns each equation holds, and
 * differences by groups of columns then cost a handful of evaluations instead of N^2.
 * Known: e^w = 2 + e^(-q t) sin(pi x) sin(pi y) solves the equations of the grid, q = 8 sin^2(pi dx/2)/dx^2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

enum { N = 60 };
static const double pi = 3.14159265358979323846, dx = 1.0 / (N + 1);

static int diffusion(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *w = N_VGetArrayPointer(y);
  sunrealtype *d = N_VGetArrayPointer(ydot);
  const double edge = log(2);
  (void)t, (void)user;
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      const int k = i + N * j;
      const double near[] = {i ? w[k - 1] : edge, i < N - 1 ? w[k + 1] : edge,
                             j ? w[k - N] : edge, j < N - 1 ? w[k + N] : edge};
      d[k] = 0;
      for (int m = 0; m < 4; m++) d[k] += expm1(near[m] - w[k]) / (dx * dx);
    }
  return 0;
}

static double known(int i, int j, double t)
{
  const double q = 8 * pow(sin(pi * dx / 2) / dx, 2);
  return log(2 + exp(-q * t) * sin(pi * dx * (i + 1)) * sin(pi * dx * (j + 1)));
}

int main(void)
{
  static double start[N * N];
  for (int k = 0; k < N * N; k++) start[k] = known(k % N, k / N, 0);
  steif_problem p = {.name = "logarithm",
                     .n = N * N,
                     .t1 = 0.1,
                     .y0 = start,
                     .f = diffusion,
                     .storage = STEIF_SPARSE};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-8;
  steif_context *ctx = steif_context_new(NULL);
  steif_pattern *pattern;
  steif_solver *s = NULL;
  double error = INFINITY;
  if (steif_pattern_find(ctx, &p, &pattern) == STEIF_OK) {
    p.pattern = pattern;
    printf("%d unknowns, %lld entries in df/dy\n", N * N, (long long)pattern->column[p.n]);
    s = steif_solver_new(ctx, &p, "auto", &opt);
  }
  if (steif_solve_to(s, p.t1) == STEIF_OK) {
    error = 0;
    for (int k = 0; k < N * N; k++)
      error = fmax(error, fabs(NV_Ith_S(steif_solution(s), k) - known(k % N, k / N, p.t1)));
    printf("%ld steps, %ld evaluations, largest error %.1e\n", steif_statistics(s)->steps,
           steif_statistics(s)->nfe, error);
  }
  puts(steif_message(ctx));
  steif_solver_free(&s);
  steif_pattern_free(ctx, &pattern);
  steif_context_free(&ctx);
  return !(error < 1e-6);
}
