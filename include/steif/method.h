/* steif/method.h: the methods there are; how they are named and what they claim.
 *
 * A method is a family with parameters: be, bdf:p=1..6, dirk:TABLE, gauss:s=, radau:s=, radau1a:s=,
 * lobatto3c:s=, euler, rk4, dopri87 (explicit, of order 8, for what is not stiff: chooses its steps);
 * general linear methods glm:TABLE (glm:nord22, glm:ab,p=3, glm:file=PATH: glm.h); the baselines cvode,
 * ida, arkode; and auto, which chooses by size, storage, index and tolerance (steif_method_used tells
 * what and why).
 *
 * Splitting methods, symplectic at a constant step size, for separable problems (.positions of problem.h):
 * symeuler:first=p|q, verlet:first=kick|drift, yoshida4, suzuki4, yoshida6, kahanli6, suzuki6, suzuki8,
 * kahanli8 (compositions of verlet, with the same first=); pefrl, blanesmoan6; rkn6 and rkn11 have their
 * order only where T is quadratic in p, which is not checked. compensated=1 keeps what rounding takes
 * from the sums (theirs by default in runs of 10000 steps and more; also of gauss:s= with prescribed steps):
 * rounding then grows like the root of the number of steps.
 *
 * Exponential methods take y' = L y + N(t, y) and are exact for N = 0. With prescribed steps and a constant
 * L, that of the problem (.L of problem.h) or df/dy at the start: exp-euler (ETD1), exp-midpoint,
 * exp-trapezoidal (ETD2RK), etd2 (two steps), etdrk4 (Cox and Matthews), krogstad, hochost4. With
 * adaptive steps and L = df/dy at every step: exprb32, exprb43. For stiff L the order may fall to the
 * stiff order, which 'steif list methods' names. phi functions of h L (phi.h) are matrices for dense
 * L and small n, else rational or polynomial Krylov spaces and Taylor series with an error below that
 * of the step: any vector serves.
 *
 * Baselines, with the settings of their own packages:
 *   cvode:order=1..5,stald=0|1,newton=C    BDF; stald: stability limit detection; newton: coefficient of
 *                   the convergence test; lmm=adams with order=1..12: fixed-point iteration, no matrix
 *   arkode:order=2..5,newton=C             DIRK; table=NAME instead of the order: a table of steif
 *   ida:suppress=0|1,id=E|index|ones,ic=0|1|2,order=1..5,newton=C
 * Of sparse problems without entries they take the pattern, with steif's own differences.
 * suppress=1 leaves components with id_j = 0 out of IDA's error test (IDASetSuppressAlg). id_j = 1 where
 * column j of E = dF/dy' is not 0 (E, the default), where the perturbation index of component j is 1
 * (index: problem.index, else steif_diagnose), or everywhere (ones). ic=1, 2: IDACalcIC with YA_YDP_INIT, Y_INIT
 * first and again after breaks and events. What IDA can do, with the right setting for each:
 *   index 1   by default from consistent starts; from others with suppress=1 or ic=1
 *   index 2   suppress=1; the default crawls or fails
 *   index 3, 4  many, not all, from consistent starts with suppress=1,id=index: no error of a component of
 *             higher index is tested, and it may be 100 to 50 000 times rtol
 *   starts that are not consistent, index above 1: with ic=2 it may run and return success, but x(0+) is
 *             wrong wherever the jump is more than a projection of algebraic components, and what remembers
 *             the jump stays wrong. No setting gives impulses.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_METHOD_H
#define STEIF_METHOD_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What is claimed of one method; every claim is checked by the tests. */
typedef struct steif_method_info {
  char name[STEIF_SPEC_WORD]; /* "radau:s=3" */
  const char *family, *about;
  int order, stages; /* 0: not one number (baselines) */
  unsigned claims;   /* enum steif_claim of table.h */
  unsigned forms;    /* enum steif_form accepted */
  int adaptive;      /* has an error estimate to choose steps by */
} steif_method_info;

/* Line i of the list: the parameter values that people use; STEIF_BAD_INPUT past the end leaves the
 * message alone. */
STEIF_EXPORT int steif_method_at(steif_context *ctx, size_t i, steif_method_info *info);
STEIF_EXPORT int steif_method_find(steif_context *ctx, const char *spec,
                                   steif_method_info *info);

/* One step of the method on y' = lambda y as a matrix: with z = h lambda, history maps to history
 * by M(z), r x r, by rows, entries (re, im). r = 1 for Runge-Kutta (M = R), p for BDF, k for general
 * linear methods. M NULL asks for r only. z infinite gives the limit. STEIF_UNSUPPORTED for splitting methods, whose step on
 * y' = lambda y is no function of z. */
STEIF_EXPORT int steif_method_propagator(steif_context *ctx, const char *spec,
                                         const sunrealtype z[2], int *r, sunrealtype *M);

#ifdef __cplusplus
}
#endif
#endif
