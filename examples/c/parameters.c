/* An ODE with parameters: the chain of reactions A -> B -> C, solved for several rates.
 *
 *   A' = -k1 A,   B' = k1 A - k2 B,   C' = k2 B,   A(0) = 1, the others 0.
 *
 * The rates are members of a struct that every callback receives as `user`: set them, make a solver,
 * solve, and start again with others. With k2 = 1e6 k1 the problem is stiff, and an explicit method would
 * need millions of steps. The closed solution is H. Bateman's (1910): B = k1/(k2 - k1) (e^-k1t - e^-k2t).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>
#include <sunmatrix/sunmatrix_dense.h>

struct rates {
  double k1, k2;
};

static int reaction(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const struct rates *k = user;
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t;
  NV_Ith_S(ydot, 0) = -k->k1 * c[0];
  NV_Ith_S(ydot, 1) = k->k1 * c[0] - k->k2 * c[1];
  NV_Ith_S(ydot, 2) = k->k2 * c[1];
  return 0;
}

/* df/dy, optional: without it, differences are taken. */
static int jacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector d)
{
  const struct rates *k = user;
  (void)t, (void)y, (void)fy, (void)a, (void)b, (void)d;
  SM_ELEMENT_D(J, 0, 0) = -k->k1;
  SM_ELEMENT_D(J, 1, 0) = k->k1;
  SM_ELEMENT_D(J, 1, 1) = -k->k2;
  SM_ELEMENT_D(J, 2, 1) = k->k2;
  return 0;
}

int main(void)
{
  static const double start[] = {1, 0, 0}, k2[] = {0.3, 10, 1e6};
  struct rates k = {.k1 = 1};
  const steif_problem p = {
    .name = "chain", .n = 3, .t1 = 2, .y0 = start, .f = reaction, .jac = jacobian, .user = &k};
  steif_options opt = steif_defaults();
  opt.rtol = 1e-9, opt.atol = 1e-15;
  steif_context *ctx = steif_context_new(NULL);
  int wrong = 0;
  for (int i = 0; i < 3; i++) {
    k.k2 = k2[i];
    steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &opt);
    if (steif_solve_to(s, p.t1) != STEIF_OK) {
      puts(steif_message(ctx));
      return 1;
    }
    const double B = NV_Ith_S(steif_solution(s), 1);
    const double known = k.k1 / (k.k2 - k.k1) * (exp(-k.k1 * 2) - exp(-k.k2 * 2));
    printf("k2 = %-8g B(2) = %.10e, known %.10e, %ld steps\n", k.k2, B, known,
           steif_statistics(s)->steps);
    wrong += !(fabs(B - known) < 1e-7 * known);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
  return wrong;
}
