/* A large problem without matrices: GMRES with a preconditioner of your own.
 *
 *   u' = u_xx + 0.01 u_yy on a grid of N x N points: strong coupling along x, weak along y.
 *
 * With storage STEIF_KRYLOV no Jacobian is stored; products are differences of f. `prepare` factors P, which
 * has the coupling along x only: N tridiagonal systems, near to c - df/dy. `solve` applies it.
 * Known: sin(pi x) sin(pi y) e^(-q t), q = (1 + 0.01) 4 sin^2(pi dx/2)/dx^2, solves the equations of the grid.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>

enum { N = 80 };
static const double pi = 3.14159265358979323846, dx = 1.0 / (N + 1), weak = 0.01;
struct factor {
  double pivot[N], off; /* of the tridiagonal matrix, the same for every line */
};

static int diffusion(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *d = N_VGetArrayPointer(ydot);
  (void)t, (void)user;
  for (int j = 0; j < N; j++)
    for (int i = 0; i < N; i++) {
      const int k = i + N * j;
      const double x = (i ? u[k - 1] : 0) + (i < N - 1 ? u[k + 1] : 0),
                   z = (j ? u[k - N] : 0) + (j < N - 1 ? u[k + N] : 0);
      d[k] = (x + weak * z - 2 * (1 + weak) * u[k]) / (dx * dx);
    }
  return 0;
}

static int prepare(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c,
                   void *user)
{
  struct factor *P = user;
  (void)t, (void)y, (void)yp, (void)r;
  P->off = -1 / (dx * dx);
  for (int i = 0; i < N; i++)
    P->pivot[i] = c - 2 * (1 + weak) * P->off - (i ? P->off * P->off / P->pivot[i - 1] : 0);
  return 0;
}

static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  const struct factor *P = user;
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  N_VScale(1, b, z);
  for (int j = 0; j < N; j++) {
    sunrealtype *line = N_VGetArrayPointer(z) + N * j;
    for (int i = 1; i < N; i++) line[i] -= P->off / P->pivot[i - 1] * line[i - 1];
    line[N - 1] /= P->pivot[N - 1];
    for (int i = N - 2; i >= 0; i--) line[i] = (line[i] - P->off * line[i + 1]) / P->pivot[i];
  }
  return 0;
}

int main(void)
{
  static double start[N * N];
  for (int k = 0; k < N * N; k++)
    start[k] = sin(pi * dx * (k % N + 1)) * sin(pi * dx * (k / N + 1));
  const double q = (1 + weak) * 4 * pow(sin(pi * dx / 2) / dx, 2), decayed = exp(-q * 0.1);
  struct factor P;
  steif_problem p = {.name = "layers", .n = N * N, .t1 = 0.1, .y0 = start, .f = diffusion};
  p.storage = STEIF_KRYLOV, p.user = &P;
  steif_options opt = steif_defaults();
  opt.rtol = 1e-7;
  steif_context *ctx = steif_context_new(NULL);
  double error = 0;
  long iterations[2] = {0};
  for (int with = 0; with < 2; with++) {
    if (with) p.precsetup = prepare, p.precsolve = solve;
    steif_solver *s = steif_solver_new(ctx, &p, "bdf", &opt);
    if (steif_solve_to(s, p.t1) != STEIF_OK) return puts(steif_message(ctx)), 1;
    for (int k = 0; k < N * N; k++)
      error = fmax(error, fabs(NV_Ith_S(steif_solution(s), k) - decayed * start[k]));
    iterations[with] = steif_statistics(s)->nli;
    steif_solver_free(&s);
  }
  printf("GMRES iterations: %ld without, %ld with; error %.1e\n", iterations[0], iterations[1],
         error);
  steif_context_free(&ctx);
  return !(error < 1e-5) || iterations[1] * 2 > iterations[0];
}
