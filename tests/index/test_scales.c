/* test_scales.c: verdicts do not depend on units; index scaling makes the matrix of a step
 * as well conditioned at h = 1e-10 as at 1e-2.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "evidence.h"
#include "singular_values.h"
#include "models/models.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <steif/solver.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { LARGEST = 27 };

/* r_i F_i(a t, c_j y_j, c_j y_j'/a) of the problem inside. */
typedef struct scaled {
  stf_point inner;
  double a, r[LARGEST], c[LARGEST], size[LARGEST], y0[LARGEST], yp0[LARGEST];
} scaled;

static void inside(const scaled *s, N_Vector y, N_Vector yp, double *Y, double *Yp)
{
  for (size_t j = 0; j < s->inner.n; j++) {
    Y[j] = s->c[j] * NV_Ith_S(y, j);
    Yp[j] = s->c[j] * NV_Ith_S(yp, j) / s->a;
  }
}

static int residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  scaled *s = user;
  double Y[LARGEST] = {0}, Yp[LARGEST] = {0}, R[LARGEST];
  inside(s, y, yp, Y, Yp);
  const int code = stf_point_residual(&s->inner, s->a * t, Y, Yp, R);
  for (size_t i = 0; i < s->inner.n && !code; i++) NV_Ith_S(r, i) = s->r[i] * R[i];
  return code;
}

static int fill(char which, sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, scaled *s)
{
  double Y[LARGEST] = {0}, Yp[LARGEST] = {0}, E[LARGEST * LARGEST], B[LARGEST * LARGEST];
  const size_t n = s->inner.n;
  inside(s, y, yp, Y, Yp);
  const int code = stf_point_matrices(&s->inner, s->a * t, Y, Yp, E, B);
  for (size_t j = 0; j < n && !code; j++)
    for (size_t i = 0; i < n; i++)
      SUNDenseMatrix_Column(M, (sunindextype)j)[i] =
        s->r[i] * s->c[j] * (which == 'E' ? E[j * n + i] / s->a : -B[j * n + i]);
  return code;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return fill('E', t, y, yp, M, user);
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  return fill('A', t, y, yp, M, user);
}

static int find(steif_context *ctx, const char *name, steif_problem *p)
{
  const model *m = model_find(name);
  if (!m) return steif_problem_find(ctx, name, p);
  *p = model_problem(m, 1);
  return 0;
}

static void verdict_in_units(const char *name, unsigned seed, int index, const char *numbers)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p;
  steif_diagnosis d;
  static scaled s;
  CHECK(!find(ctx, name, &p));
  s = (scaled){.a = 1e-6};
  CU_ASSERT_FATAL(!stf_point_open(ctx, &p, NULL, &s.inner));
  for (size_t j = 0; j < s.inner.n; j++) {
    s.r[j] = pow(10, 6 * stf_point_random(&seed));
    s.c[j] = pow(10, 6 * stf_point_random(&seed));
    s.size[j] = s.inner.floor[j] / s.c[j];
    s.y0[j] = s.inner.y0[j] / s.c[j], s.yp0[j] = s.a * s.inner.yp0[j] / s.c[j];
  }
  const steif_problem q = {.name = name,
                           .n = p.n,
                           .t0 = p.t0 / s.a,
                           .t1 = p.t1 / s.a,
                           .y0 = s.y0,
                           .yp0 = s.yp0,
                           .F = residual,
                           .E = fill_E,
                           .A = fill_A,
                           .user = &s};
  const int code = steif_diagnose(ctx, &q, &(steif_point){.size = s.size}, &d);
  if (code || d.index != index)
    printf("\n  %s, %u: %s", name, seed, code ? steif_message(ctx) : d.message);
  CHECK(code == STEIF_OK && d.index == index && d.confidence == STEIF_SURE);
  for (size_t j = 0; !code && numbers[j]; j++) {
    if (d.number[j] != numbers[j] - '0')
      printf("\n  %s, unknown %zu is %d: %s", name, j, d.number[j], d.message);
    CHECK(d.number[j] == numbers[j] - '0');
  }
  steif_diagnosis_clear(&d);
  stf_point_close(&s.inner);
  if (!model_find(name)) steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
}

static void units_do_not_matter(void)
{
  for (unsigned k = 1; k <= 6; k++) {
    verdict_in_units("pendulum3", 17 * k, 3, "11223");
    verdict_in_units("caraxis", 29 * k, 3, "1111222233");
    verdict_in_units("transamp", 31 * k, 1, "11111111");
    verdict_in_units("mnacv", 37 * k, 2, "112");
    verdict_in_units("jay3", 41 * k, 3, "11223");
    verdict_in_units("over5", 43 * k, 2, "11222");
  }
  verdict_in_units("andrews", 5, 3, "111111122222223333333333333");
}

/* cond_2 of E/h - A with rows multiplied by h^-q and columns by h^(number - 1), h in units
 * of tau, and rows then divided by their largest entry. */
static double condition(stf_point *point, const steif_diagnosis *d, double tau, double h)
{
  const size_t n = point->n;
  double *M = stf_allocate(point->ctx, 5 * n * n + 2 * n, sizeof *M);
  double *E = M + n * n, *U = M + 3 * n * n, *VT = M + 4 * n * n, *s = M + 5 * n * n,
         *top = s + n;
  CHECK(!stf_point_matrices(point, point->t, point->y0, point->yp0, E, E + n * n));
  for (size_t k = 0; k < n * n; k++) {
    const size_t i = k % n, j = k / n;
    M[k] =
      (E[k] / (h * tau) + E[n * n + k]) * pow(h, -d->derivatives[i]) * pow(h, 1 - d->number[j]);
    top[i] = fmax(top[i], fabs(M[k]));
  }
  for (size_t k = 0; k < n * n; k++) M[k] /= top[k % n];
  CHECK(!stf_point_svd(point->ctx, n, n, M, s, U, VT));
  const double cond = s[0] / s[n - 1];
  stf_release(point->ctx, M);
  return cond;
}

static void index_scaling_bounds_the_condition(void)
{
  static const struct {
    const char *name;
    double tau, most;
  } rows[] = {{"pendulum3", 1, 1e3},
              {"caraxis", .1, 1e5},
              {"andrews", 1e-2, 1e5},
              {"fekete", 1, 1e3},
              {"stokes:m=8", 1e-2, 1e4}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    steif_context *ctx = steif_context_new(NULL);
    steif_problem p;
    steif_diagnosis d;
    stf_point point;
    double low = INFINITY, high = 0;
    CHECK(!steif_problem_find(ctx, rows[k].name, &p));
    CHECK(!steif_diagnose(ctx, &p, NULL, &d));
    CU_ASSERT_FATAL(!stf_point_open(ctx, &p, NULL, &point));
    for (int e = -10; e <= -2; e += 2) {
      const double cond = condition(&point, &d, rows[k].tau, pow(10, e));
      low = fmin(low, cond), high = fmax(high, cond);
    }

    CHECK(high < rows[k].most && high <= 2 * low);
    stf_point_close(&point);
    steif_diagnosis_clear(&d);
    steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
  }
}

/* Q' = -G U, 0 = Q - C U + C sin t: of index 1 for every C > 0, a charge in coulombs beside volts, of whose size the
 * problem says nothing. With a source at the capacitor, j in Q' = -G U - j and 0 = U - sin t, of index 2. */
static double capacity;

static int charge(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  const sunrealtype *u = N_VGetArrayPointer(y);
  const bool loop = user != NULL;
  NV_Ith_S(r, 0) = -1e-9 * u[1] - (loop ? u[2] : 0);
  NV_Ith_S(r, 1) = u[0] - capacity * (u[1] - (loop ? 0 : sin(t)));
  if (loop) NV_Ith_S(r, 2) = u[1] - sin(t);
  return 0;
}

static int slopes(sunrealtype t, N_Vector y, N_Vector r, SUNMatrix J, void *user, N_Vector a,
                  N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)r, (void)a, (void)b, (void)c;
  SM_ELEMENT_D(J, 0, 1) = -1e-9, SM_ELEMENT_D(J, 1, 0) = 1, SM_ELEMENT_D(J, 1, 1) = -capacity;
  if (user) SM_ELEMENT_D(J, 0, 2) = -1, SM_ELEMENT_D(J, 2, 1) = 1;
  return 0;
}

static int first_row(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 0) = 1;
  return 0;
}

static void small_charges_are_no_rounding(void)
{
  static const double y0[] = {0, 0, 0};
  steif_context *ctx = steif_context_new(NULL);
  static int loop = 1;
  for (int k = 0; k <= 20; k++) {
    capacity = pow(10, -k);
    for (int n = 2; n <= 3; n++) {
      const steif_problem p = {.name = "charge",
                               .n = n,
                               .t1 = 1,
                               .y0 = y0,
                               .f = charge,
                               .jac = slopes,
                               .E = first_row,
                               .user = n == 3 ? &loop : NULL};
      steif_diagnosis d;
      CHECK(steif_diagnose(ctx, &p, NULL, &d) == STEIF_OK);
      CHECK(d.index == n - 1 && d.freedom == 3 - n);
      if (d.index != n - 1) printf("\n  C = %g: %s", capacity, d.message);
      for (int j = 0; j < n; j++) CHECK(d.number[j] == (j == 2 ? 2 : 1));
      steif_diagnosis_clear(&d);
      steif_options o = steif_defaults();
      steif_solver *s = steif_solver_new(ctx, &p, "radau:s=3", &o);
      CHECK(s && steif_solve_to(s, 1) == STEIF_OK);
      steif_solver_free(&s);
    }
  }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_scales[] = {
  {"units do not matter", units_do_not_matter},
  {"small charges are no rounding", small_charges_are_no_rounding},
  {"index scaling bounds the condition", index_scaling_bounds_the_condition},
  CU_TEST_INFO_NULL};
