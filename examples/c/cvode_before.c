/* Before: a program for CVODE, as its guide writes it. What it becomes with steif: cvode_after.c.
 *
 * Robertson's kinetics, stiff; known are the values of the Test Set for IVP Solvers at t = 1e11.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

static int f(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)user;
  NV_Ith_S(ydot, 0) = -0.04 * c[0] + 1e4 * c[1] * c[2];
  NV_Ith_S(ydot, 2) = 3e7 * c[1] * c[1];
  NV_Ith_S(ydot, 1) = -NV_Ith_S(ydot, 0) - NV_Ith_S(ydot, 2);
  return 0;
}

static int jacobian(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix J, void *user, N_Vector a,
                    N_Vector b, N_Vector d)
{
  const sunrealtype *c = N_VGetArrayPointer(y);
  (void)t, (void)fy, (void)user, (void)a, (void)b, (void)d;
  SM_ELEMENT_D(J, 0, 0) = -0.04;
  SM_ELEMENT_D(J, 0, 1) = 1e4 * c[2];
  SM_ELEMENT_D(J, 0, 2) = 1e4 * c[1];
  SM_ELEMENT_D(J, 1, 0) = 0.04;
  SM_ELEMENT_D(J, 1, 1) = -1e4 * c[2] - 6e7 * c[1];
  SM_ELEMENT_D(J, 1, 2) = -1e4 * c[1];
  SM_ELEMENT_D(J, 2, 1) = 6e7 * c[1];
  return 0;
}

int main(void)
{
  SUNContext sun;
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &sun)) return 1;
#else
  if (SUNContext_Create(NULL, &sun)) return 1;
#endif
  N_Vector y = N_VNew_Serial(3, sun);
  NV_Ith_S(y, 0) = 1, NV_Ith_S(y, 1) = 0, NV_Ith_S(y, 2) = 0;
  SUNMatrix J = SUNDenseMatrix(3, 3, sun);
  SUNLinearSolver solver = SUNLinSol_Dense(y, J, sun);
  void *cvode = CVodeCreate(CV_BDF, sun);
  sunrealtype t;
  int code = CVodeInit(cvode, f, 0, y);
  if (!code) code = CVodeSStolerances(cvode, 1e-8, 1e-20);
  if (!code) code = CVodeSetLinearSolver(cvode, solver, J);
  if (!code) code = CVodeSetJacFn(cvode, jacobian);
  if (!code) code = CVodeSetMaxNumSteps(cvode, 100000);
  if (!code) code = CVode(cvode, 1e11, y, &t, CV_NORMAL);
  const double y1 = NV_Ith_S(y, 0);
  printf("code %d, y1 = %.6e, known 2.083340e-08\n", code, y1);
  CVodeFree(&cvode);
  SUNLinSolFree(solver);
  SUNMatDestroy(J);
  N_VDestroy(y);
  SUNContext_Free(&sun);
  return code || !(fabs(y1 / 2.083340149701e-8 - 1) < 1e-4);
}
