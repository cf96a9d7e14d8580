/* What "auto" picks, by storage, cost of an LU, tolerance and index.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/analysis.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/steif.h>
#include <stdlib.h>
#include <string.h>

static bool picks(const char *problem, double rtol, enum steif_storage storage,
                  const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_options o = steif_defaults();
  o.rtol = rtol;
  if (storage != STEIF_DENSE) o.force_storage = 1, o.storage = storage;
  CU_ASSERT_FATAL(!steif_problem_find(ctx, problem, &p));
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
  const size_t length = strlen(method);
  const char *used = s ? steif_method_used(s) : steif_message(ctx);
  const bool good = s && !strncmp(used, method, length) && used[length] == ' ';
  if (!good) printf("\n  %s at %g: %s", problem, rtol, used);
  steif_solver_free(&s);
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return good;
}

static void chains_take_rosenbrock(void)
{
  CHECK(picks("medakzo", 1e-4, STEIF_SPARSE, "rodas5p"));
  CHECK(picks("medakzo", 1e-6, STEIF_SPARSE, "rodas5p"));
  CHECK(picks("medakzo", 1e-8, STEIF_SPARSE, "radau:s=5"));
  CHECK(picks("heat:n=50", 1e-3, STEIF_BAND, "rodas5p"));
  CHECK(picks("heat:n=50", 1e-5, STEIF_BAND, "radau:s=5"));
}

static void grids_keep_one_matrix(void)
{
  CHECK(picks("bruss2d:n=32", 1e-3, STEIF_SPARSE, "radau:s=3"));
  CHECK(picks("bruss2d:n=32", 1e-4, STEIF_SPARSE, "radau:s=3"));
  CHECK(picks("bruss2d:n=32", 1e-5, STEIF_SPARSE, "radau:s=5"));
  CHECK(picks("bruss2d:n=32", 1e-6, STEIF_SPARSE, "radau:s=5"));
  CHECK(picks("heat2d:n=64", 1e-6, STEIF_SPARSE, "rodas5p"));
}

/* u' = u_xx + u_yy + u (1 - u) on the unit square, known by its pattern. */
static int side;
static int diffusion(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  const int m = side;
  const double *u = NV_DATA_S(y), c = (m + 1.0) * (m + 1.0);
  (void)t, (void)user;
  for (int k = 0; k < m * m; k++) {
    double sum = -4 * u[k];
    if (k >= m) sum += u[k - m];
    if (k < m * (m - 1)) sum += u[k + m];
    if (k % m) sum += u[k - 1];
    if (k % m < m - 1) sum += u[k + 1];
    NV_Ith_S(out, k) = c * sum + u[k] * (1 - u[k]);
  }
  return 0;
}

static double *bulge(int m)
{
  const double pi = 3.14159265358979;
  double *y0 = malloc((size_t)(m * m) * sizeof *y0);
  side = m;
  for (int k = 0; k < m * m; k++)
    y0[k] = sin(pi * (k / m + 1.0) / (m + 1)) * sin(pi * (k % m + 1.0) / (m + 1));
  return y0;
}

static bool diffuses_by(int m, double rtol, const char *method)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_pattern *pattern = NULL;
  double *y0 = bulge(m);
  steif_problem p = {.name = "diffusion", .n = m * m, .t1 = 0.1, .y0 = y0, .f = diffusion};
  CU_ASSERT_FATAL(y0 && !steif_pattern_find(ctx, &p, &pattern));
  p.pattern = pattern, p.storage = STEIF_SPARSE;
  steif_options o = steif_defaults();
  o.rtol = rtol;
  steif_solver *s = steif_solver_new(ctx, &p, "auto", &o);
  const bool good = s && !strncmp(steif_method_used(s), method, strlen(method));
  if (!good) printf("\n  m = %d at %g: %s", m, rtol, s ? steif_method_used(s) : "");
  steif_solver_free(&s);
  steif_pattern_free(ctx, &pattern);
  free(y0);
  steif_context_free(&ctx);
  return good;
}

/* Nobody has given it: it is found, 5 m^2 - 4 m entries, and the run is that with it. */
static void patterns_are_found_where_none_is_given(void)
{
  static const char *const methods[] = {"auto", "radau:s=3", "bdf", "dirk:hw43", "cvode"};
  steif_context *ctx = steif_context_new(NULL);
  steif_pattern *pattern = NULL;
  double *y0 = bulge(10), end[2];
  side = 10;
  steif_problem p = {.name = "diffusion", .n = 100, .t1 = 0.1, .y0 = y0, .f = diffusion};
  CU_ASSERT_FATAL(y0 && !steif_pattern_find(ctx, &p, &pattern));
  p.storage = STEIF_SPARSE;
  for (int m = 0; m < 5; m++)
    for (int given = 0; given < 2; given++) {
      p.pattern = given ? pattern : NULL;
      steif_solver *s = steif_solver_new(ctx, &p, methods[m], NULL);
      CU_ASSERT_FATAL(s && !steif_solve_to(s, 0.1));
      const char *told = strstr(steif_method_used(s), "[pattern found: 460 entries]");
      CHECK(m == 0 || (told != NULL) == !given); /* auto may have turned to dopri87 */
      end[given] = NV_Ith_S(steif_solution(s), 55);
      steif_solver_free(&s);
      CHECK(!given || end[1] == end[0]);
    }
  static double many[30000];
  p.pattern = NULL, p.n = 30000, p.y0 = many; /* too many evaluations to do that unasked */
  CHECK(!steif_solver_new(ctx, &p, "auto", NULL) && steif_status(ctx) == STEIF_BAD_INPUT);
  steif_pattern_free(ctx, &pattern);
  free(y0);
  steif_context_free(&ctx);
}

/* Explicit steps take 150 and 570 steps by stability, radau:s=5 7 to 12 by accuracy: measured side by side,
 * explicit ones cost two thirds of the others for 900 unknowns at 1e-8, and twice as much for 3,600. */
static void diffusion_takes_what_is_cheapest(void)
{
  CHECK(diffuses_by(30, 1e-3, "radau:s=3"));
  CHECK(diffuses_by(30, 1e-8, "dopri87"));
  CHECK(diffuses_by(60, 1e-3, "radau:s=3"));
  CHECK(diffuses_by(60, 1e-5, "radau:s=5"));
  CHECK(diffuses_by(60, 1e-8, "radau:s=5"));
  /* two substances that react: explicit steps cost 0.28 of those of radau:s=5 */
  CHECK(picks("bruss2d:n=22", 1e-8, STEIF_SPARSE, "dopri87"));
}

/* Not stiff, or so little that an LU costs more than the steps that stability asks for. */
static void little_stiffness_takes_explicit_steps(void)
{
  CHECK(picks("plei", 1e-3, STEIF_DENSE, "dopri87"));
  CHECK(picks("plei", 1e-9, STEIF_DENSE, "dopri87"));
  CHECK(picks("bruss2d:n=12", 1e-6, STEIF_SPARSE, "dopri87"));
  CHECK(picks("heat2d:n=16", 1e-6, STEIF_SPARSE, "dopri87"));
}

static void small_systems_take_lanes(void)
{
  CHECK(picks("vdpol", 1e-3, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("ringmod", 1e-2, STEIF_DENSE, "radau:s=5"));
  CHECK(picks("ringmod", 1e-3, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("hires", 1e-7, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("caraxis", 1e-7, STEIF_DENSE, "radau:s=7"));
}

/* e5 has atol 1e-23 beside components of 1e-3: their rounding is larger. */
static void few_digits_take_rosenbrock(void)
{
  CHECK(picks("vdpol", 1e-2, STEIF_DENSE, "rodas5p"));
  CHECK(picks("hires", 1e-1, STEIF_DENSE, "rodas4"));
  CHECK(picks("hires", 1e-4, STEIF_DENSE, "rodas5p"));
  CHECK(picks("hires", 1e-5, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("transamp", 1e-1, STEIF_DENSE, "rodas4p2"));
  CHECK(picks("transamp", 1e-2, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("e5", 1e-1, STEIF_DENSE, "radau:s=5"));
}

static void medium_dense_systems_take_collocation(void)
{
  CHECK(picks("beam", 1e-6, STEIF_DENSE, "radau:s=5"));
  CHECK(picks("beam", 1e-7, STEIF_DENSE, "radau:s=7"));
  CHECK(picks("fekete", 1e-4, STEIF_DENSE, "radau:s=3"));
  CHECK(picks("fekete", 1e-6, STEIF_DENSE, "radau:s=5"));
}

CU_TestInfo tests_of_auto[] = {
  {"patterns are found", patterns_are_found_where_none_is_given},
  {"diffusion takes what is cheapest", diffusion_takes_what_is_cheapest},
  {"chains take Rosenbrock", chains_take_rosenbrock},
  {"grids keep one matrix", grids_keep_one_matrix},
  {"little stiffness takes explicit steps", little_stiffness_takes_explicit_steps},
  {"medium dense systems take collocation", medium_dense_systems_take_collocation},
  {"few digits take Rosenbrock", few_digits_take_rosenbrock},
  {"small systems take lanes", small_systems_take_lanes},
  CU_TEST_INFO_NULL,
};
