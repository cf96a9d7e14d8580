/* Residuals and matrices of the four forms against values worked out by hand.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fixture.h"

/* f = (t + 2 y0 y1, y0 - 3 y1^2), df/dy = [2 y1, 2 y0; 1, -6 y1], M = [2 1; 0 0]. */
typedef struct calls {
  int f, jac, E, F, idajac, room, spoil, other;
} calls;

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  calls *c = user;
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1);
  c->f++;
  NV_Ith_S(out, 0) = t + 2 * u * v, NV_Ith_S(out, 1) = u - 3 * v * v;
  return c->spoil;
}

static int jac(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
               N_Vector b, N_Vector d)
{
  (void)t, (void)fy, (void)a, (void)b, (void)d;
  calls *c = user;
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1);
  c->jac++;
  SM_ELEMENT_D(J, 0, 0) = 2 * v, SM_ELEMENT_D(J, 0, 1) = 2 * u;
  SM_ELEMENT_D(J, 1, 0) = 1, SM_ELEMENT_D(J, 1, 1) = -6 * v;
  return c->spoil;
}

static int mass(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp;
  ((calls *)user)->E++;
  SM_ELEMENT_D(E, 0, 0) = 2, SM_ELEMENT_D(E, 0, 1) = 1;
  return 0;
}

static const double at[] = {0.7, -1.3}, slope[] = {0.4, 2.5};

static steif_problem pair(calls *user)
{
  return (steif_problem){
    .name = "pair", .n = 2, .t0 = 0.25, .t1 = 1, .y0 = at, .yp0 = slope, .f = f, .user = user};
}

/* At t = 0.25: f = (0.25 - 1.82, 0.7 - 5.07) = (-1.57, -4.37). */
static void residual_of_the_ode_form(void)
{
  calls c = {0};
  fixture s;
  const steif_problem p = pair(&c);
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CLOSE(NV_Ith_S(s.yp, 0), -1.57, 1e-15); /* the slope given is f itself */
  NV_Ith_S(s.yp, 0) = slope[0], NV_Ith_S(s.yp, 1) = slope[1];
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 0), 1.97, 1e-15);
  CLOSE(NV_Ith_S(s.r, 1), 6.87, 1e-15);
  CHECK(s.system.E == NULL);
  fixture_close(&s);
}

/* M y' = (0.8 + 2.5, 0). */
static void residual_of_the_mass_form(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.E = mass, p.jac = jac;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 0), 4.87, 1e-15);
  CLOSE(NV_Ith_S(s.r, 1), 4.37, 1e-15);
  CLOSE(SM_ELEMENT_D(s.system.A, 1, 1), 7.8, 1e-15);
  for (int i = 0; i < 3; i++) CHECK(!stf_system_linearise(&s.system, 0.25, s.y, s.yp));
  CHECK(c.E == 1 && c.jac == 4 && s.system.nje == 4); /* M is constant: filled once */
  fixture_close(&s);
}

/* F = (y0' y1 + sin t - y0, y0' y1' + y1); F_y = [-1, y0'; 0, 1], F_y' = [y1, 0; y1', y0']. */
static int F(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, void *user)
{
  const double u = NV_Ith_S(y, 0), v = NV_Ith_S(y, 1), du = NV_Ith_S(yp, 0),
               dv = NV_Ith_S(yp, 1);
  ((calls *)user)->F++;
  NV_Ith_S(r, 0) = du * v + sin(t) - u, NV_Ith_S(r, 1) = du * dv + v;
  return 0;
}

static int idajac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                  SUNMatrix J, void *user, N_Vector d, N_Vector e, N_Vector g)
{
  (void)t, (void)r, (void)d, (void)e, (void)g;
  const double v = NV_Ith_S(y, 1), du = NV_Ith_S(yp, 0), dv = NV_Ith_S(yp, 1);
  ((calls *)user)->idajac++;
  SM_ELEMENT_D(J, 0, 0) = -1 + c * v, SM_ELEMENT_D(J, 0, 1) = du;
  SM_ELEMENT_D(J, 1, 0) = c * dv, SM_ELEMENT_D(J, 1, 1) = 1 + c * du;
  return 0;
}

static void implicit_matrices(fixture *s, double tolerance)
{
  const double E[2][2] = {{at[1], 0}, {slope[1], slope[0]}},
               A[2][2] = {{1, -slope[0]}, {0, -1}};
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      CLOSE_FLOOR(SM_ELEMENT_D(s->system.E, i, j), E[i][j], tolerance, 1);
      CLOSE_FLOOR(SM_ELEMENT_D(s->system.A, i, j), A[i][j], tolerance, 1);
    }
}

static void ida_jacobian_separates(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.f = NULL, p.F = F, p.idajac = idajac;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  implicit_matrices(&s, 4e-16);
  CHECK(c.idajac == 2 && c.F == 2 && /* one looks at the start */
        s.system.nfe == 1 && s.system.nje == 1);
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 0), 0.4 * -1.3 + sin(0.25) - 0.7, 1e-15);
  CLOSE(NV_Ith_S(s.r, 1), 0.4 * 2.5 - 1.3, 1e-15);
  fixture_close(&s);
}

/* c is as large as J(0): entries of very different size lose nothing. */
static int steep(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix J,
                 void *user, N_Vector d, N_Vector e, N_Vector g)
{
  (void)t, (void)y, (void)yp, (void)r, (void)user, (void)d, (void)e, (void)g;
  SM_ELEMENT_D(J, 0, 0) = 3.7e9 + c * 1.1, SM_ELEMENT_D(J, 1, 1) = 0.2 + c * 5.3e-3;
  return 0;
}

static int flat(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix J,
                void *user, N_Vector d, N_Vector e, N_Vector g)
{
  (void)t, (void)y, (void)yp, (void)r, (void)user, (void)d, (void)e, (void)g;
  SM_ELEMENT_D(J, 0, 0) = SM_ELEMENT_D(J, 1, 1) = 0.77 * c; /* F_y = 0 */
  return 0;
}

static void separation_fits_its_size(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.f = NULL, p.F = F, p.idajac = steep;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CLOSE(SM_ELEMENT_D(s.system.E, 0, 0), 1.1, 1e-15);
  CLOSE(SM_ELEMENT_D(s.system.E, 1, 1), 5.3e-3, 1e-14);
  CLOSE(SM_ELEMENT_D(s.system.A, 0, 0), -3.7e9, 1e-16);
  fixture_close(&s);
  p.idajac = flat;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CLOSE(SM_ELEMENT_D(s.system.E, 1, 1), 0.77, 1e-16);
  CHECK(SM_ELEMENT_D(s.system.A, 0, 0) == 0);
  fixture_close(&s);
}

static void implicit_form_by_differences(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.f = NULL, p.F = F;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  implicit_matrices(&s, 1e-7);
  CHECK(c.F == 7); /* at the start; twice: once at the point and once per column */
  fixture_close(&s);
}

/* A sparse IDA Jacobian; with `other` its pattern moves with c, with `room` it overstates. */
static int sparse_jac(sunrealtype t, sunrealtype c, N_Vector y, N_Vector yp, N_Vector r,
                      SUNMatrix J, void *user, N_Vector d, N_Vector e, N_Vector g)
{
  (void)t, (void)y, (void)yp, (void)r, (void)d, (void)e, (void)g;
  const calls *k = user;
  const sunindextype last = k->room ? k->room : 3;
  SM_INDEXPTRS_S(J)[0] = 0, SM_INDEXPTRS_S(J)[1] = 2, SM_INDEXPTRS_S(J)[2] = last;
  SM_INDEXVALS_S(J)[0] = 0, SM_INDEXVALS_S(J)[1] = 1;
  SM_INDEXVALS_S(J)[2] = k->other && c > 0 ? 0 : 1;
  SM_DATA_S(J)[0] = 2.1 + c, SM_DATA_S(J)[1] = -0.6, SM_DATA_S(J)[2] = 3.3 + 0.5 * c;
  return 0;
}

static void sparse_ida_jacobian_separates(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.f = NULL, p.F = F, p.idajac = sparse_jac, p.nnz = 3;
  p.nnz_E = 2; /* of E alone; the callback fills three entries into it */
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_SPARSE));
  CLOSE(fixture_element(s.system.A, 0, 0), -2.1, 1e-16);
  CLOSE(fixture_element(s.system.A, 1, 0), 0.6, 1e-16);
  CLOSE(fixture_element(s.system.E, 0, 0), 1, 1e-15);
  CLOSE(fixture_element(s.system.E, 1, 1), 0.5, 1e-15);
  CHECK(fixture_element(s.system.E, 1, 0) == 0);
  fixture_close(&s);
  c.other = 1;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "must not depend on c");
  c.other = 0, c.room = 11;
  fixture_refused(&p, STEIF_SPARSE, STEIF_BAD_INPUT, "11 entries into room for 3");
}

/* E = [0 1; 0 0], A = [0.3 -2; 1 4], g = (t, 5 t). */
static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix E, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(E, 0, 1) = 1;
  return 0;
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix A, void *user)
{
  (void)t, (void)y, (void)yp, (void)user;
  SM_ELEMENT_D(A, 0, 0) = 0.3, SM_ELEMENT_D(A, 0, 1) = -2;
  SM_ELEMENT_D(A, 1, 0) = 1, SM_ELEMENT_D(A, 1, 1) = 4;
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)user;
  if (derivative) return 1;
  NV_Ith_S(out, 0) = t, NV_Ith_S(out, 1) = 5 * t;
  return 0;
}

/* A y = (0.21 + 2.6, 0.7 - 5.2); E y' = (2.5, 0); g = (0.25, 1.25). */
static void residual_of_the_descriptor_form(void)
{
  fixture s;
  steif_problem p = pair(NULL);
  p.f = NULL, p.E = fill_E, p.A = fill_A;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 0), 2.5 - 2.81, 1e-14);
  CLOSE(NV_Ith_S(s.r, 1), 4.5, 1e-15);
  CHECK(s.system.nfe == 0); /* no g to evaluate */
  fixture_close(&s);
  p.g = g;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 0), 2.5 - 2.81 - 0.25, 1e-14);
  CLOSE(NV_Ith_S(s.r, 1), 4.5 - 1.25, 1e-15);
  s.system.weight = 3; /* Gregory's weights of convolution quadrature */
  CHECK(!stf_system_residual(&s.system, 0.25, s.y, s.yp, s.r));
  CLOSE(NV_Ith_S(s.r, 1), 4.5 - 3.75, 1e-15);
  fixture_close(&s);
}

static void linear_systems_are_linearised_once(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.linear = 1, p.jac = jac;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  for (int i = 0; i < 5; i++) CHECK(!stf_system_linearise(&s.system, i, s.y, s.yp));
  CHECK(s.system.linear && s.system.nje == 1 && c.jac == 1);
  fixture_close(&s);
  p.linear = 0;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  for (int i = 0; i < 5; i++) CHECK(!stf_system_linearise(&s.system, i, s.y, s.yp));
  CHECK(s.system.nje == 6 && c.jac == 7);
  fixture_close(&s);
  p = pair(NULL), p.f = NULL, p.E = fill_E, p.A = fill_A; /* linear without being told so */
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  for (int i = 0; i < 5; i++) CHECK(!stf_system_linearise(&s.system, i, s.y, s.yp));
  CHECK(s.system.linear && s.system.nje == 1);
  fixture_close(&s);
}

static void callbacks_are_named_in_sentences(void)
{
  calls c = {0};
  fixture s;
  steif_problem p = pair(&c);
  p.jac = jac;
  CU_ASSERT_FATAL(!fixture_open(&s, &p, STEIF_DENSE));
  c.spoil = 1;
  CHECK(stf_system_rhs(&s.system, 0.31, s.y, s.r) == STEIF_RETRY);
  CHECK(steif_status(s.ctx) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(s.ctx), "f of problem 'pair' could not be evaluated at t = 0.31"));
  c.spoil = -4;
  CHECK(stf_system_residual(&s.system, 0.31, s.y, s.yp, s.r) == STEIF_CALLBACK);
  CHECK(strstr(steif_message(s.ctx), "stopped the run at t = 0.31 (it returned -4)"));
  fixture_close(&s);
}

CU_TestInfo tests_of_system[] = {
  {"residual of the ode form", residual_of_the_ode_form},
  {"residual of the mass form", residual_of_the_mass_form},
  {"an IDA Jacobian separates into E and A", ida_jacobian_separates},
  {"the separation fits the size of its matrix", separation_fits_its_size},
  {"the implicit form by differences", implicit_form_by_differences},
  {"a sparse IDA Jacobian separates", sparse_ida_jacobian_separates},
  {"residual of the descriptor form", residual_of_the_descriptor_form},
  {"linear systems are linearised once", linear_systems_are_linearised_once},
  {"callbacks are named in sentences", callbacks_are_named_in_sentences},
  CU_TEST_INFO_NULL};
