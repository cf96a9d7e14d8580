/* test_derivatives.c: the entries of E and A of many models against differences of F at random points: all
 * derivatives that differ from 0 are in the pattern, and nothing else is.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"
#include <stdlib.h>
#include <math.h>
#include <steif/model.h>
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

enum { MOST = 100 }; /* unknowns */
static int models;   /* that were compared */

/* F(t, y, y') = E y' - f(t, y) of any form: the first of its Taylor coefficients. */
static void residual(fixture *s, double t, const double *point, double *F)
{
  CHECK(!steif_model_taylor(s->ctx, &s->p, t, 0, point, F));
}

/* dF/d(component j of y, y'), of fourth order; point: y, then y'. */
static void difference(fixture *s, double t, double *point, int j, double size, double *column)
{
  const int n = (int)s->p.n;
  const double before = point[j], step[] = {2e-4 * size, 1e-4 * size};
  double F[2][MOST];
  for (int k = 0; k < n; k++) column[k] = 0;
  for (int turn = 0; turn < 2; turn++) {
    for (int side = 0; side < 2; side++) {
      point[j] = side ? before - step[turn] : before + step[turn];
      residual(s, t, point, F[side]);
    }
    point[j] = before;
    for (int k = 0; k < n; k++)
      column[k] += (turn ? 4. : -1.) / 3 * (F[0][k] - F[1][k]) / (2 * step[turn]);
  }
}

/* Places of the pattern, and those of them at which an entry has differed from 0. */
typedef struct places {
  bool stored[MOST * MOST], met[MOST * MOST];
} places;

/* Entries of A = -dF/dy or E = dF/dy' at a point, dense by columns. */
static void entries(fixture *s, double t, N_Vector y, N_Vector yp, bool of_E, double *dense,
                    places *at)
{
  const steif_problem *p = &s->p;
  const int n = (int)p->n;
  SUNMatrix M =
    SUNSparseMatrix(n, n, of_E ? p->nnz_E : p->nnz, CSC_MAT, steif_sundials(s->ctx));
  N_Vector f = N_VClone(y);
  CHECK(!(of_E     ? p->E(t, y, yp, M, p->user)
          : p->jac ? p->jac(t, y, f, M, p->user, NULL, NULL, NULL)
                   : p->A(t, y, yp, M, p->user)));
  for (int j = 0; j < n; j++)
    for (sunindextype k = SUNSparseMatrix_IndexPointers(M)[j];
         k < SUNSparseMatrix_IndexPointers(M)[j + 1]; k++) {
      const int place = (int)SUNSparseMatrix_IndexValues(M)[k] + j * n;
      dense[place] += SUNSparseMatrix_Data(M)[k];
      at->stored[place] = true;
      at->met[place] = at->met[place] || SUNSparseMatrix_Data(M)[k] != 0;
    }
  N_VDestroy(f);
  SUNMatDestroy(M);
}

/* All n x n derivatives at one point, so that none outside the pattern differs from 0. */
static void compare(fixture *s, double t, N_Vector y, N_Vector yp, bool of_E, places *at)
{
  static double dense[MOST * MOST];
  double point[2 * MOST], column[MOST], largest = 1;
  const int n = (int)s->p.n;
  if (of_E && !s->p.E) return;
  memset(dense, 0, sizeof dense);
  memcpy(point, N_VGetArrayPointer(y), (size_t)n * sizeof *point);
  memcpy(point + n, N_VGetArrayPointer(yp), (size_t)n * sizeof *point);
  entries(s, t, y, yp, of_E, dense, at);
  residual(s, t, point, column);
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(column[i]));
  for (int j = 0; j < n; j++) {
    const int moved = of_E ? n + j : j;
    const double size = fmax(1e-3, fabs(point[moved]));
    difference(s, t, point, moved, size, column);
    for (int i = 0; i < n; i++)
      CLOSE_FLOOR(dense[i + j * n], of_E ? column[i] : -column[i], 1e-6,
                  fmax(1, 1e-5 * largest / size));
  }
}

/* f or F of the tapes is that of the series. */
static void same_residual(fixture *s, double t, N_Vector y, N_Vector yp)
{
  double point[2 * MOST] = {0}, F[MOST];
  const int n = (int)s->p.n;
  N_Vector f = N_VClone(y);
  memcpy(point, N_VGetArrayPointer(y), (size_t)n * sizeof *point);
  if (s->p.F) memcpy(point + n, N_VGetArrayPointer(yp), (size_t)n * sizeof *point);
  residual(s, t, point, F);
  if (s->p.F) CHECK(!s->p.F(t, y, yp, f, s->p.user));
  if (s->p.f) CHECK(!s->p.f(t, y, f, s->p.user));
  for (int i = 0; i < n && (s->p.f || s->p.F); i++)
    CLOSE_FLOOR(NV_Ith_S(f, i), s->p.F ? F[i] : -F[i], 1e-12, 1);
  N_VDestroy(f);
}

/* Random points in 0.5 .. 2.5, or (near) about the start; exact: each place of the patterns is met at one of them. */
static void check_points(fixture *s, bool near, bool exact)
{
  static places at[2];
  const int n = (int)s->p.n;
  const double t = s->p.t0 + (near ? 3e-3 : 0.3) * (s->p.t1 - s->p.t0);
  N_Vector y = N_VNew_Serial(n, steif_sundials(s->ctx)), yp = N_VClone(y);
  unsigned long long seed = 12345;
  CU_ASSERT_FATAL(n <= MOST);
  memset(at, 0, sizeof at);
  for (int turn = 0; turn < 5; turn++) {
    for (int i = 0; i < n; i++) {
      seed = seed * 6364136223846793005u + 1442695040888963407u;
      const double part = (double)(seed >> 40) / (1 << 24), y0 = s->p.y0[i];
      NV_Ith_S(y, i) = near ? y0 + 1e-2 * (part + 0.01) * (y0 != 0 ? y0 : 1) : 0.5 + 2 * part;
      NV_Ith_S(yp, i) = part - 0.3;
    }
    same_residual(s, t, y, yp);
    for (int of_E = 0; of_E < 2; of_E++) compare(s, t, y, yp, of_E, at + of_E);
  }
  for (int of_E = 0; exact && of_E < 2; of_E++)
    for (int k = 0; k < n * n; k++) CHECK(at[of_E].met[k] == at[of_E].stored[k]);
  models++;
  N_VDestroy(y), N_VDestroy(yp);
}

static void check_at_random(fixture *s) { check_points(s, false, true); }

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
  check_points(&s, false, false);
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

/* Constructs of the language, each in a model. */
static const char *const constructs[] = {
  "state x = 2, x' = 0\nx'' = -x^3 - 0.1*x'\n",
  "state x = 2, x' = 1, x'' = 1, y = 1\nx''' = -x*x'*x'' + y\ny' = x''^2\n",
  "state x = 1, y, z\nx' = y*z\n0 = x - y^3\n0 = z + exp(z) - x\n",
  "param a = 3\nstate x = 1, y = 2, i ~ 0\n2*x' + a*y' = i\nx' - y' = x*y\n0 = i - x*y^2\n",
  "state x = 1, y = 1\nx*x' + y' = sin(y)\nx'^2 + y' = 4*x\n",
  "state x = 1, v ~ 0, l\nform descriptor\nx' = v + l\nv' = -3*x + cos(t)\n0 = x - 2*l + t^2\n",
  "table f = (0, 1), (1, 3), (3, 2), (9, 5) cubic\nstate x = 1, y = 1\nx' = f(y)\n"
  "y' = f(x + t/9)*y\n",
  "table f = (0, 1), (9, 3) linear\ntable g = (0, 1), (9, 3) steps outside hold\n"
  "state x = 1, y = 1\nx' = f(x*y)\ny' = g(x)*y\n",
  "param n = 6 whole\nstate u[i in 1:n] = 1, s\nboundary u[0] = u[n], u[n+1] = u[1]\n"
  "for i in 1:n\nu[i]' = u[i-1]*u[i+1] - u[i]^2 + s\nend\n0 = s - sum(i in 1:n: i*u[i]^2)\n",
  "param n = 5 whole\nstate u[i in 1:n, j in 1:n] = 1\nboundary u[0, j in 1:n] = t, u[n+1, j "
  "in "
  "1:n] = u[n-1, j], u[i in 1:n, 0] = u[i, n], u[i in 1:n, n+1] = u[i, 1]\nfor i in 1:n\nfor j "
  "in 1:n\nu[i,j]' = u[i-1,j] + u[i+1,j]^2 + u[i,j-1] + u[i,j+1] - 4*u[i,j] + u[i,j]*u[i,j-1]\n"
  "end\nend\n",
  "param n = 3 whole\nstate w[i in 1:n, j in 1:n, k in 1:n] = 1\nboundary w[0, j in 1:n, k in "
  "1:n] = 2\nfor i in 1:n\nfor j in 1:n\nfor k in 1:n\nw[i,j,k]' = w[i-1,j,k]*w[i,j,k] - "
  "k*w[i,mod(j, n) + 1,k]^2\nend\nend\nend\n",
  "param n = 8 whole\nstate u[i in 1:n] = 1, v[1:n] ~ 1\nfor i in 1:n\nv[i] = u[i]^2 + "
  "v[i]^3/9\nend\nfor i in 1:div(n, 2)\nu[i]' = v[2*i] - u[n+1-i]\nu[i+4]' = "
  "-u[i+4]*v[i]\nend\n",
  "discrete on = 2\nstate x = 1, y = 1\nx' = on*x*y\ny' = if x > 9 then 1 else x^on - y\n"
  "when x > 9: on = 3\nat 8: y = 1\nevery 9: x = 1\n",
  "function h(a, b) = k(a)*b + a^2\nfunction k(a) = sqrt(a) + tanh(a)\nlet p = h(x, y), q = "
  "h(p, x)\nstate x = 1, y = 1\nx' = p*q\ny' = smooth(max(x, y + 9)) + noevent(abs(x))*q\n",
};

static void of_constructs(void)
{
  char text[1000];
  for (size_t i = 0; i < sizeof constructs / sizeof *constructs; i++) {
    fixture s;
    snprintf(text, sizeof text, "%stime 0 to 1\n", constructs[i]);
    const int code = fixture_text(&s, text, "");
    if (code) printf("\n  %s: %s", constructs[i], steif_message(s.ctx));
    CHECK(code == STEIF_OK);
    if (!code) check_at_random(&s);
    fixture_close(&s);
  }
}

/* The examples about their starts, where not every term has an effect yet. */
static void of_examples(void)
{
  static const char *const names[] = {
    "akzo.steif",    "bounce.steif",     "brusselator.steif:n=12",
    "caraxis.steif", "converter.steif",  "hunters.steif",
    "lotka.steif",   "orego.steif",      "pendulum.steif",
    "reactor.steif", "rober.steif",      "transamp.steif",
    "vdpol.steif",   "vdpol.steif:eps=0"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    fixture s;
    CU_ASSERT_FATAL(fixture_example(&s, names[i]) == STEIF_OK);
    check_points(&s, true, false);
    fixture_close(&s);
  }
  CHECK(models >= 40);
}

CU_TestInfo tests_of_derivatives[] = {{"all functions, three forms", of_all_functions},
                                      {"branches", of_a_branch_alone},
                                      {"loops", of_loops},
                                      {"constructs", of_constructs},
                                      {"examples, and how many in all", of_examples},
                                      CU_TEST_INFO_NULL};
