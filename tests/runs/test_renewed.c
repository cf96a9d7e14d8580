/* test_renewed.c: chosen steps on large sparse systems: unknowns of every index at every step.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "impulse/systems.h"
#include <stdlib.h>
#include <steif/runs.h>

/* Rows of a run. */
enum { ROWS = 512 };
typedef struct rows {
  size_t n, count;
  double t[ROWS], *x;
} rows;

static int keep(sunrealtype t, N_Vector x, void *user)
{
  rows *r = user;
  CU_ASSERT_FATAL(r->count < ROWS);
  r->t[r->count] = t;
  memcpy(r->x + r->count++ * r->n, N_VGetArrayPointer(x), r->n * sizeof(double));
  return 0;
}

/* Largest error of an unknown at any step over its largest size, or a thousandth of that of the
 * largest unknown; the solution by radau:s=5 in parts of these steps. */
static double error_most(steif_context *ctx, const steif_linear *l, const double *x0, rows *r)
{
  steif_linear_truth truth;
  double *x = malloc(r->count * r->n * sizeof *x), most = 0, all = 0;
  CU_ASSERT_FATAL(
    x && !steif_linear_exact(ctx, l, x0, 0, NULL, 0, NULL, r->count, r->t, r->x, x, &truth));
  for (size_t i = 0; i < r->count * r->n; i++) all = fmax(all, fabs(x[i]));
  for (size_t i = 0; i < r->n; i++) {
    double size = 1e-3 * all, off = 0;
    for (size_t k = 0; k < r->count; k++) {
      size = fmax(size, fabs(x[k * r->n + i]));
      off = fmax(off, fabs(r->x[k * r->n + i] - x[k * r->n + i]));
    }
    most = fmax(most, off / size);
  }
  free(x);
  return most;
}

/* Index 3 and 2, from inconsistent values; errors as multiples of rtol. At 1e-10 a step of
 * bdf cannot be seen to be worse than 3e-12, and 200 of them add: bdf may say so. */
static void unknowns_of_every_index(void)
{
  static const struct {
    const char *system, *method;
    double rtol, t1, most;
  } row[] = {
    {"springs:n=200", "bdf", 1e-6, 1, 0.3},
    {"springs:n=200", "bdf", 1e-10, 1, 40},
    {"springs:n=200", "radau:s=3", 1e-6, 1, 0.3},
    {"springs:n=200", "radau:s=3", 1e-10, 1, 1},
    {"springs:n=200", "radau:s=5", 1e-6, 1, 0.3},
    {"springs:n=200", "radau:s=5", 1e-10, 1, 1},
    {"ladder:n=120", "bdf", 1e-6, 1e-5, 0.3},
    {"ladder:n=120", "bdf", 1e-10, 1e-5, 40},
    {"ladder:n=120", "radau:s=3", 1e-10, 1e-5, 2},
    {"ladder:n=120", "gauss:s=3", 1e-6, 1e-5, 0.3},
    {"ladder:n=120", "gauss:s=3", 1e-10, 1e-5, 1},
    {"stokes:m=12", "radau:s=5", 1e-6, 2e-4, 0.3},
    {"stokes:m=12", "bdf", 1e-10, 2e-4, 40},
    {"stokes:m=12", "gauss:s=3", 1e-10, 2e-4, 1},
  };
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    steif_linear l;
    CU_ASSERT_FATAL(!steif_problem_find(ctx, row[i].system, &p) &&
                    !steif_linear_of(ctx, &p, &l));
    steif_options o = steif_defaults();
    o.t1 = row[i].t1, o.rtol = row[i].rtol;
    rows *r = calloc(1, sizeof *r);
    r->n = (size_t)p.n, r->x = malloc(ROWS * r->n * sizeof *r->x);
    CU_ASSERT_FATAL(r->n > 400 && r->x);
    const steif_linear_output out = {.step = keep, .user = r};
    const int code = steif_linear_run(ctx, &l, p.y0, 0, row[i].method, &o, NULL, 0, NULL, &out);
    CHECK(!code || (code == STEIF_NOT_CERTIFIED && row[i].most > 10));
    const double error = error_most(ctx, &l, p.y0, r) / row[i].rtol;
    const bool good = error < row[i].most && r->t[0] > 1e-7 * o.t1;
    CHECK(good);
    if (!good)
      printf("\n  %s, %s, %g: first step %.1e, error %.2e rtol", row[i].system, row[i].method,
             row[i].rtol, r->t[0], error);
    free(r->x), free(r);
    SUNMatDestroy(l.E), SUNMatDestroy(l.F);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

CU_TestInfo tests_of_renewed[] = {
  {"unknowns of every index keep the tolerance at every step", unknowns_of_every_index},
  CU_TEST_INFO_NULL};
