/* test_forms.c: the four forms through IDA, and constant mass matrices through ARKODE.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ride.h"
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* Put `value` at (i, j); for a sparse matrix entries arrive column after column. */
static void put(SUNMatrix M, sunindextype i, sunindextype j, sunrealtype value)
{
  switch (SUNMatGetID(M)) {
  case SUNMATRIX_DENSE: SM_ELEMENT_D(M, i, j) = value; break;
  case SUNMATRIX_BAND: SM_ELEMENT_B(M, i, j) = value; break;
  default: {
    sunindextype *at = SM_INDEXPTRS_S(M);
    const sunindextype n = SM_COLUMNS_S(M), k = at[j + 1];
    SM_INDEXVALS_S(M)[k] = i, SM_DATA_S(M)[k] = value;
    for (sunindextype c = j + 1; c <= n; c++) at[c] = k + 1;
  }
  }
}

/* Robertson's kinetics with the third equation replaced by the conservation of mass. */
static int rober(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  const sunrealtype *x = NV_DATA_S(y);
  NV_Ith_S(out, 0) = -0.04 * x[0] + 1e4 * x[1] * x[2];
  NV_Ith_S(out, 1) = -NV_Ith_S(out, 0) - 3e7 * x[1] * x[1];
  NV_Ith_S(out, 2) = x[0] + x[1] + x[2] - 1;
  return 0;
}

static int rober_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  rober(t, y, r, user);
  for (int i = 0; i < 3; i++) NV_Ith_S(r, i) = (i < 2 ? NV_Ith_S(yp, i) : 0) - NV_Ith_S(r, i);
  return 0;
}

/* -a df/dy + c diag(1, 1, 0) */
static int rober_matrix(N_Vector y, sunrealtype a, sunrealtype c, SUNMatrix J)
{
  const sunrealtype *x = NV_DATA_S(y);
  const sunrealtype d1 = 1e4 * x[2], d2 = 1e4 * x[1], d3 = 6e7 * x[1];
  if (SUNMatGetID(J) == SUNMATRIX_SPARSE) SUNMatZero(J);
  put(J, 0, 0, 0.04 * a + c), put(J, 1, 0, -0.04 * a), put(J, 2, 0, -a);
  put(J, 0, 1, -d1 * a), put(J, 1, 1, (d1 + d3) * a + c), put(J, 2, 1, -a);
  put(J, 0, 2, -d2 * a), put(J, 1, 2, d2 * a), put(J, 2, 2, -a);
  return 0;
}

static int rober_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                     N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)user, (void)a, (void)b, (void)c;
  CHECK(fabs(NV_Ith_S(fy, 2) - (N_VL1Norm(y) - 1)) < 1e-3); /* fy is f(t, y) */
  return rober_matrix(y, -1, 0, J);
}

static int rober_idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                        SUNMatrix J, void *user, N_Vector a, N_Vector b, N_Vector d)
{
  (void)t, (void)yp, (void)r, (void)user, (void)a, (void)b, (void)d;
  return rober_matrix(y, 1, c, J);
}

static int rober_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  if (SUNMatGetID(E) == SUNMATRIX_SPARSE) SUNMatZero(E);
  put(E, 0, 0, 1), put(E, 1, 1, 1);
  return 0;
}

static int rober_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)yp, (void)user;
  return rober_matrix(y, -1, 0, A);
}

static const sunrealtype rober_y0[] = {1, 0, 0}, rober_yp0[] = {-0.04, 0.04, 0};

static steif_problem rober_mass(int storage)
{
  return (steif_problem){.name = "mass",
                         .n = 3,
                         .t1 = 40,
                         .y0 = rober_y0,
                         .f = rober,
                         .E = rober_E,
                         .jac = rober_jac,
                         .lower = 2,
                         .upper = 2,
                         .nnz = 9,
                         .nnz_E = 2,
                         .storage = (enum steif_storage)storage};
}

static steif_problem rober_implicit(int storage)
{
  steif_problem p = rober_mass(storage);
  p.f = NULL, p.jac = NULL, p.E = NULL;
  p.F = rober_residual, p.idajac = rober_idajac;
  return p;
}

/* The documentation of CVODE and IDA prints 7.158e-01, 9.185e-06, 2.842e-01 at t = 40. */
static void check_rober(const steif_problem *p, const steif_options *more)
{
  steif_options o = more ? *more : ride_defaults();
  o.rtol = 1e-8, o.atol = 1e-12;
  ride r;
  CHECK(ride_whole(&r, p, "ida", &o) == STEIF_OK);
  if (r.code) printf("\n  storage %d: %s", (int)p->storage, ride_says(&r));
  CLOSE(ride_y(&r, 0), 0.7158, 5e-5);
  CLOSE(ride_y(&r, 1), 9.185e-6, 1e-4);
  CLOSE(ride_y(&r, 2), 0.2842, 2e-4);
  CLOSE(ride_y(&r, 0) + ride_y(&r, 1) + ride_y(&r, 2), 1, 1e-9);
  ride_close(&r);
}

static void rober_in_every_form(void)
{
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    const steif_problem mass = rober_mass(storage);
    steif_problem implicit = rober_implicit(storage);
    check_rober(&mass, NULL);
    check_rober(&implicit, NULL);
    implicit.idajac = NULL, implicit.E = rober_E, implicit.A = rober_A;
    check_rober(&implicit, NULL);
    steif_problem differences = mass;
    differences.jac = NULL;
    if (storage != STEIF_SPARSE) check_rober(&differences, NULL);
    implicit.E = NULL, implicit.A = NULL, implicit.yp0 = rober_yp0;
    if (storage != STEIF_SPARSE) check_rober(&implicit, NULL);
  }
}

static void algebraic_components_are_found(void)
{
  steif_options o = ride_defaults();
  o.suppress_algebraic = 1;
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    const steif_problem mass = rober_mass(storage);
    steif_problem implicit = rober_implicit(storage);
    check_rober(&mass, &o);
    check_rober(&implicit, &o);
    N_Vector id;
    ride r;
    CHECK(ride_open(&r, &implicit, "ida", &o) == STEIF_OK);
    id = N_VClone(r.run.y);
    for (int way = 0; way < 2; way++) { /* from the Jacobian, from differences */
      N_VConst(7, id);
      if (way) implicit.idajac = NULL, ((stf_baseline *)r.state)->E = NULL;
      CHECK(stf_start_id(r.state, "E", id) == STEIF_OK);
      CHECK(NV_Ith_S(id, 0) == 1 && NV_Ith_S(id, 1) == 1 && NV_Ith_S(id, 2) == 0);
    }
    N_VDestroy(id);
    ride_close(&r);
  }
}

/* E x' = A x + g with E = diag(1, 0), A = [-2 1; 1 -3], g = (0, sin t): x2 = (x1 + sin t) / 3
 * and x1' = -5/3 x1 + sin(t) / 3. */
static int index1_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  if (SUNMatGetID(E) == SUNMATRIX_SPARSE) SUNMatZero(E);
  put(E, 0, 0, 1);
  return 0;
}

static int index1_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  if (SUNMatGetID(A) == SUNMATRIX_SPARSE) SUNMatZero(A);
  put(A, 0, 0, -2), put(A, 1, 0, 1), put(A, 0, 1, 1), put(A, 1, 1, -3);
  return 0;
}

static int index1_g(sunrealtype t, int derivative, N_Vector g, void *user)
{
  (void)user;
  if (derivative) return 1;
  NV_Ith_S(g, 0) = 0, NV_Ith_S(g, 1) = sin(t);
  return 0;
}

static int index1_Ev(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                     void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  NV_Ith_S(out, 0) = NV_Ith_S(x, 0), NV_Ith_S(out, 1) = 0;
  return 0;
}

static int index1_Av(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out,
                     void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  const sunrealtype a = NV_Ith_S(x, 0), b = NV_Ith_S(x, 1);
  NV_Ith_S(out, 0) = b - 2 * a, NV_Ith_S(out, 1) = a - 3 * b;
  return 0;
}

/* x1 with x1(0) = 1: a particular solution (5/3 sin t - cos t) / (3 + 25/3) and the rest. */
static sunrealtype index1_exact(sunrealtype t)
{
  const sunrealtype d = 3 * (1 + 25.0 / 9);
  return (5.0 / 3 * sin(t) - cos(t)) / d + (1 + 1 / d) * exp(-5.0 / 3 * t);
}

static void descriptor_of_index_one(void)
{
  const sunrealtype good[] = {1, 1.0 / 3}, bad[] = {1, -0.41};
  steif_options o = ride_defaults(), c = o;
  c.consistent = 1;
  for (int storage = STEIF_DENSE; storage <= STEIF_KRYLOV; storage++) {
    const bool krylov = storage == STEIF_KRYLOV;
    steif_problem p = {.name = "index 1",
                       .n = 2,
                       .t1 = 1.9,
                       .y0 = good,
                       .g = index1_g,
                       .storage = (enum steif_storage)storage,
                       .lower = 1,
                       .upper = 1,
                       .nnz = 4,
                       .nnz_E = 1};
    if (krylov)
      p.Ev = index1_Ev, p.Av = index1_Av;
    else
      p.E = index1_E, p.A = index1_A;
    for (int start = 0; start < 2; start++) {
      p.y0 = start ? bad : good;
      ride r;
      CHECK(ride_whole(&r, &p, "ida", start ? &c : &o) == STEIF_OK);
      if (r.code) printf("\n  storage %d: %s", storage, ride_says(&r));
      CLOSE(ride_y(&r, 0), index1_exact(1.9), 2e-4);
      CLOSE(ride_y(&r, 1), (index1_exact(1.9) + sin(1.9)) / 3, 2e-4);
      ride_close(&r);
    }
  }
}

/* [2 1; 1 3] y' = [-7 2; 1 -400] y */
static int coupled(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  (void)t, (void)user;
  const sunrealtype *x = NV_DATA_S(y);
  NV_Ith_S(out, 0) = -7 * x[0] + 2 * x[1];
  NV_Ith_S(out, 1) = x[0] - 400 * x[1];
  return 0;
}

/* The same by hand: y' = [2 1; 1 3]^{-1} f. */
static int uncoupled(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  coupled(t, y, out, user);
  const sunrealtype a = NV_Ith_S(out, 0), b = NV_Ith_S(out, 1);
  NV_Ith_S(out, 0) = (3 * a - b) / 5, NV_Ith_S(out, 1) = (2 * b - a) / 5;
  return 0;
}

static int coupled_jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user,
                       N_Vector a, N_Vector b, N_Vector c)
{
  (void)t, (void)y, (void)fy, (void)user, (void)a, (void)b, (void)c;
  if (SUNMatGetID(J) == SUNMATRIX_SPARSE) SUNMatZero(J);
  put(J, 0, 0, -7), put(J, 1, 0, 1), put(J, 0, 1, 2), put(J, 1, 1, -400);
  return 0;
}

static int coupled_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  if (SUNMatGetID(E) == SUNMATRIX_SPARSE) SUNMatZero(E);
  put(E, 0, 0, 2), put(E, 1, 0, 1), put(E, 0, 1, 1), put(E, 1, 1, 3);
  return 0;
}

static void coupled_mass_matrix(void)
{
  const sunrealtype y0[] = {1.3, -0.7};
  steif_options o = ride_defaults(), dense = o;
  o.rtol = o.atol = dense.rtol = dense.atol = 1e-8;
  dense.force_storage = 1, dense.storage = STEIF_DENSE;
  const steif_problem plain = {.name = "plain", .n = 2, .t1 = 0.6, .y0 = y0, .f = uncoupled};
  ride reference;
  CHECK(ride_whole(&reference, &plain, "cvode", &o) == STEIF_OK);
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++)
    for (int k = 0; k < 4; k++) {
      const steif_problem p = {.name = "coupled",
                               .n = 2,
                               .t1 = 0.6,
                               .y0 = y0,
                               .f = coupled,
                               .jac = coupled_jac,
                               .E = coupled_E,
                               .nnz = 4,
                               .nnz_E = 4,
                               .lower = 1,
                               .upper = 1,
                               .storage = (enum steif_storage)storage};
      ride r;
      CHECK(ride_whole(&r, &p, k < 2 ? "ida" : "arkode", k % 2 ? &dense : &o) == STEIF_OK);
      if (r.code) printf("\n  storage %d, %d: %s", storage, k, ride_says(&r));
      for (int i = 0; i < 2; i++) CLOSE_FLOOR(ride_y(&r, i), ride_y(&reference, i), 1e-5, 1e-2);
      ride_close(&r);
    }
  ride_close(&reference);
}

static void slopes_solve_the_mass_matrix(void)
{
  const sunrealtype y0[] = {1.3, -0.7};
  for (int storage = STEIF_DENSE; storage <= STEIF_SPARSE; storage++) {
    const steif_problem p = {.name = "coupled",
                             .n = 2,
                             .t1 = 0.6,
                             .y0 = y0,
                             .f = coupled,
                             .jac = coupled_jac,
                             .E = coupled_E,
                             .nnz = 4,
                             .nnz_E = 4,
                             .lower = 1,
                             .upper = 1,
                             .storage = (enum steif_storage)storage};
    ride r;
    CHECK(ride_open(&r, &p, "ida", NULL) == STEIF_OK);
    /* f = (-10.5, 281.3), E^{-1} f = (-62.56, 114.62) */
    CLOSE(NV_Ith_S(r.run.yp, 0), -62.56, 1e-13);
    CLOSE(NV_Ith_S(r.run.yp, 1), 114.62, 1e-13);
    ride_close(&r);
  }
}

static void singular_mass_is_not_for_arkode(void)
{
  const steif_problem p = {.name = "rober",
                           .n = 3,
                           .t1 = 40,
                           .y0 = rober_y0,
                           .f = rober,
                           .E = rober_E,
                           .jac = rober_jac};
  ride r;
  CHECK(ride_whole(&r, &p, "arkode", NULL) == STEIF_BASELINE);
  CHECK(strstr(ride_says(&r), "t = 0") && strstr(ride_says(&r), "ida"));
  ride_close(&r);
  CHECK(ride_open(&r, &p, "cvode", NULL) == STEIF_UNSUPPORTED);
  ride_close(&r);
}

CU_TestInfo tests_of_forms[] = {
  {"Robertson in mass and implicit form", rober_in_every_form},
  {"algebraic components are found", algebraic_components_are_found},
  {"a descriptor system of index one, also from a wrong start", descriptor_of_index_one},
  {"a coupled mass matrix equals its inverse", coupled_mass_matrix},
  {"slopes at the start solve the mass matrix", slopes_solve_the_mass_matrix},
  {"a singular mass matrix is not for ARKODE", singular_mass_is_not_for_arkode},
  CU_TEST_INFO_NULL};
