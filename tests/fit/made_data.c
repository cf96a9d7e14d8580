/* made_data.c: measurements with made errors, and the system of Lotka and Volterra.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "made_data.h"
#include "suite.h"

void made_data_open(steif_context *ctx, const steif_problem *problem, size_t times,
                    const double *t, const double *sd, made_data *made)
{
  steif_options o = steif_defaults();
  unsigned long x = 12345;
  size_t j = 0;
  o.rtol = 1e-12, o.t1 = t[times - 1];
  steif_solver *s = steif_solver_new(ctx, problem, "radau:s=5", &o);
  CHECK(s && times * (size_t)problem->n <= MADE);
  for (size_t k = 0; s && k < times; k++) {
    CHECK(steif_solve_to(s, t[k]) == STEIF_OK);
    for (sunindextype i = 0; i < problem->n; i++, j++) {
      x = (1103515245UL * x + 12345UL) % 2147483648UL;
      made->t[j] = t[k], made->component[j] = i, made->sd[j] = sd[i];
      made->value[j] = N_VGetArrayPointer(steif_solution(s))[i] +
                       sd[i] * sqrt(12) * ((double)x / 2147483648.0 - 0.5);
    }
  }
  steif_solver_free(&s);
  made->data = (steif_measurements){.count = j,
                                    .t = made->t,
                                    .value = made->value,
                                    .sd = made->sd,
                                    .component = made->component};
}

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *p = user, *u = N_VGetArrayPointer(y);
  sunrealtype *d = N_VGetArrayPointer(ydot);
  (void)t;
  d[0] = p[0] * u[0] - p[1] * u[0] * u[1];
  d[1] = -p[2] * u[1] + p[3] * u[0] * u[1];
  return 0;
}

static int by_p(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *d = N_VGetArrayPointer(out);
  (void)t, (void)yp, (void)user;
  d[0] = k == 0 ? -u[0] : k == 1 ? u[0] * u[1] : 0;
  d[1] = k == 2 ? u[1] : k == 3 ? -u[0] * u[1] : 0;
  return 0;
}

void prey_open(prey *P, double a, double b, double c, double d)
{
  static const sunrealtype y0[] = {1, 1};
  *P = (prey){.p = {a, b, c, d}};
  P->parameters = (steif_parameters){.count = 4, .value = P->p, .dFdp = by_p};
  P->problem = (steif_problem){.name = "prey",
                               .n = 2,
                               .t1 = 10,
                               .y0 = y0,
                               .f = f,
                               .user = P->p,
                               .parameters = &P->parameters};
}

static const double prey_sd[] = {0.05, 0.05};

void prey_data(steif_context *ctx, made_data *made)
{
  prey P;
  double t[20];
  for (int k = 0; k < 20; k++) t[k] = 0.5 * (k + 1);
  prey_open(&P, 1.5, 1, 3, 1);
  made_data_open(ctx, &P.problem, 20, t, prey_sd, made);
}

const char product[] = "param a = 2, b = 0.5, c = 3\n"
                       "state x = c\n"
                       "x' = -a*b*x\n"
                       "time 0 to 2\n";

/* x = 3 exp(-a b t) with errors of at most 1e-3 and no sign. */
void decay(made_data *made, double rate)
{
  for (size_t j = 0; j < 8; j++) {
    made->t[j] = 0.25 * (double)j, made->component[j] = 0, made->sd[j] = 1e-3;
    made->value[j] = 3 * exp(-rate * made->t[j]) + (j % 3 == 0 ? 1e-3 : -5e-4);
  }
  made->data = (steif_measurements){.count = 8,
                                    .t = made->t,
                                    .value = made->value,
                                    .sd = made->sd,
                                    .component = made->component};
}
