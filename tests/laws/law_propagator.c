/* law_propagator.c: one step of a method on y' = lambda y is its propagator M(h lambda), so a
 * wrong coefficient in either place shows.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "laws.h"
#include <complex.h>

static const double points[][2] = {{-1.37, 0}, {-0.41, 2.63}, {-53.1, 17.9}, {0.23, -0.71}};

enum { MOST = 8 };

static double complex value(N_Vector y) { return NV_Ith_S(y, 0) + I * NV_Ith_S(y, 1); }

/* The characteristic polynomial of M (r x r), sum_j c_j x^j, by the recurrence of Faddeev and
 * Leverrier. */
static void characteristic(int r, const sunrealtype *M, double complex *c)
{
  double complex A[MOST * MOST], N[MOST * MOST] = {0}, B[MOST * MOST];
  for (int i = 0; i < r * r; i++) A[i] = M[2 * i] + I * M[2 * i + 1];
  c[r] = 1;
  for (int m = 1; m <= r; m++) { /* N <- A N + c 1, c = -trace (A N) / m */
    for (int i = 0; i < r; i++) N[i * r + i] += c[r - m + 1];
    double complex trace = 0;
    for (int i = 0; i < r; i++)
      for (int j = 0; j < r; j++) {
        B[i * r + j] = 0;
        for (int l = 0; l < r; l++) B[i * r + j] += A[i * r + l] * N[l * r + j];
        trace += i == j ? B[i * r + j] : 0;
      }
    c[r - m] = -trace / m;
    memcpy(N, B, sizeof N);
  }
}

/* Values at equal steps satisfy the recurrence of M's characteristic polynomial (Cayley,
 * Hamilton). The first one behind the start may be no linear function of the history alone. */
static void one(steif_context *ctx, const char *method, const double z[2])
{
  char spec[64];
  steif_problem p;
  sunrealtype M[2 * MOST * MOST];
  double complex y[2 * MOST], c[MOST + 1];
  int r = 0;
  snprintf(spec, sizeof spec, "dahlquist:re=%.17g,im=%.17g", z[0], z[1]);
  CU_ASSERT_FATAL(!steif_problem_find(ctx, spec, &p));
  CHECK(!steif_method_propagator(ctx, method, z, &r, M) && r <= MOST);
  characteristic(r, M, c);
  steif_options o = steif_defaults();
  const int steps = r + 3;
  o.h = 1, o.t1 = steps;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  if (!s) printf("\n  %s: %s", method, steif_message(ctx));
  CU_ASSERT_FATAL(s != NULL);
  for (int i = 1; i <= steps; i++) {
    CHECK(!steif_solve_step(s));
    y[i] = value(steif_solution(s));
  }
  double complex left = 0;
  double size = 0;
  for (int j = 0; j <= r; j++) {
    left += c[j] * y[steps - r + j];
    size = fmax(size, fmax(1, cabs(c[j])) * cabs(y[steps - r + j]));
  }
  if (cabs(left) > 4e-12 * size) printf("\n  %s at z = %g%+gi", method, z[0], z[1]);
  CLOSE_FLOOR(cabs(left), 0, 4e-12, size); /* the 12-stage split costs 2 digits */
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
}

static void steps_are_propagators(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int m = 0; m < law_method_count; m++)
    for (int i = 0; i < 4; i++) one(ctx, law_methods[m], points[i]);
  steif_method_info info;
  int seen = 0;
  for (size_t m = 0; steif_method_at(ctx, m, &info) == STEIF_OK; m++) {
    if (strcmp(info.family, "glm")) continue;
    for (int i = 0; i < 4; i++) one(ctx, info.name, points[i]);
    seen++;
  }
  CHECK(seen > 12);
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_law_propagator[] = {
  {"a step on the test equation is M(h lambda)", steps_are_propagators}, CU_TEST_INFO_NULL};
