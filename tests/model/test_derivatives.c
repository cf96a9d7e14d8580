/* test_derivatives.c: the entries of E and A of many models against central differences of f and F at
 * random points, and no entry outside the pattern.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Right-hand sides that use every function, three unknowns x, y, z > 0. */
static const char *const sides[] = {
  "sin(x*y) + cos(z)^2 - tan(x/5)",
  "asin(x/9) + acos(y/9) + atan(z) + atan2(x, y + z)",
  "sinh(x/3) + cosh(y/3)*tanh(z)",
  "asinh(x) + acosh(y + 2) + atanh(z/9)",
  "exp(-x) + expm1(y/2) + log(z) + log10(x + 1) + log1p(y)",
  "sqrt(x*y) + cbrt(z + x) + erf(y/2)",
  "abs(x - 9)*y + sign(z)*x + min(x, y + 9) + max(z, y - 9)",
  "hypot(x, y) + mod(z, 100) + ramp(x)*y + step(x)*z + floor(x + 0.5)*y",
  "x^2 + y^3 + z^4 + x^5 + y^-1 + z^0.5 + 2^x + x^y",
  "if x > 9 then sqrt(x - 9) else x*y*z",
  "if x < 9 and y < 9 then x/y else log(-x)",
  "-x^2*-y + (x - y - z) - x/y/z + a*x*y + a^2*z",
  "q + f(x, y)*g(z) + sum(k in 1:4: k*x^k)*y + t*x",
};

static double difference(steif_problem *p, N_Vector y, N_Vector f, N_Vector w, int i, int j,
                         double t)
{
  const double before = NV_Ith_S(y, j), h = 1e-5 * (1 + fabs(before));
  double value[2];
  for (int k = 0; k < 2; k++) {
    NV_Ith_S(y, j) = k ? before - h : before + h;
    if (p->F)
      CHECK(p->F(t, y, w, f, p->user) == 0);
    else
      CHECK(p->f(t, y, f, p->user) == 0);
    value[k] = NV_Ith_S(f, i);
  }
  NV_Ith_S(y, j) = before;
  return (value[0] - value[1]) / (2 * h);
}

static void check_at_random(fixture *s)
{
  const int n = (int)s->p.n;
  SUNMatrix J = SUNDenseMatrix(n, n, steif_sundials(s->ctx));
  N_Vector y = N_VNew_Serial(n, steif_sundials(s->ctx)), f = N_VClone(y), w = N_VClone(y);
  unsigned long long seed = 12345;
  for (int turn = 0; turn < 5; turn++) {
    for (int i = 0; i < n; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      NV_Ith_S(y, i) = 0.5 + 2 * (double)(seed >> 40) / (1 << 24);
      NV_Ith_S(w, i) = NV_Ith_S(y, i) - 1.5;
    }
    SUNMatZero(J);
    if (s->p.jac)
      s->p.jac(0.3, y, f, J, s->p.user, NULL, NULL, NULL);
    else
      s->p.A(0.3, y, w, J, s->p.user);
    const double sign = s->p.F ? -1 : 1;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        const double wanted = sign * difference(&s->p, y, f, w, i, j, 0.3);
        CLOSE_FLOOR(SM_ELEMENT_D(J, i, j), wanted, 2e-7, 1);
      }
  }
  N_VDestroy(y), N_VDestroy(f), N_VDestroy(w);
  SUNMatDestroy(J);
}

static void of_all_functions(void)
{
  char text[1000];
  fixture s;
  for (size_t i = 0; i < sizeof sides / sizeof *sides; i++)
    for (int form = 0; form < 3; form++) {
      static const char *const left[] = {"z'", "a*z'", "z' + z'^3*x"};
      snprintf(text, sizeof text,
               "param a = 0.7\nstate x = 1, y = 1, z = 1\nlet q = x*y + a\nfunction f(u, v) = "
               "u*v + g(u)\n"
               "function g(u) = exp(-u)/(1 + u^2)\nx' = y\ny' = -x\n%s = %s\ntime 0 to 1\n",
               left[form], sides[i]);
      const int code = fixture_text(&s, text, "");
      if (code) printf("\n  %s: %s", sides[i], steif_message(s.ctx));
      CHECK(code == STEIF_OK);
      if (!code) check_at_random(&s);
      fixture_close(&s);
    }
}

/* The branch that is not taken may have no derivative: it must not spoil the other. */
static void of_a_branch_alone(void)
{
  fixture s;
  CU_ASSERT_FATAL(
    fixture_text(&s,
                 "state x = 1, y = 1\nx' = if noevent(y) > 9 then sqrt(y - 9) else y^2\n"
                 "y' = 2*x*(if y > 9 then log(y - 9) else 3*x)\ntime 0 to 1\n",
                 "") == STEIF_OK);
  check_at_random(&s);
  fixture_close(&s);
}

/* The same entries from blocks of loops and from equations written one by one. */
static void of_loops(void)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_example(&s, "brusselator.steif:n=20") == STEIF_OK);
  check_at_random(&s);
  CHECK(s.p.nnz == 8 * 20 - 4);
  fixture_close(&s);
  CU_ASSERT_FATAL(
    fixture_text(
      &s,
      "param n = 9 whole\nstate u[i in 1:n, j in 1:n] = 1\n"
      "boundary u[0, j in 1:n] = 0, u[n+1, j in 1:n] = u[n, j], u[i in 1:n, 0] = u[i, n]\n"
      "let q[i, j] = u[i, j]^2\nfor i in 1:n\nfor j in 1:n-1\n"
      "u[i,j]' = u[i-1,j] + i*u[i+1,j]*u[i,j+1] - q[i,j] + u[i,j-1]\nend\n"
      "u[i,n]' = -u[i,n]^3\nend\ntime 0 to 1\n",
      "") == STEIF_OK);
  check_at_random(&s);
  fixture_close(&s);
}

CU_TestInfo tests_of_derivatives[] = {{"all functions, three forms", of_all_functions},
                                      {"branches", of_a_branch_alone},
                                      {"loops", of_loops},
                                      CU_TEST_INFO_NULL};
