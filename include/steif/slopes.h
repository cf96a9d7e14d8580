/* steif/slopes.h: derivatives of x(0+) and of the impulses of E x' + F x = f.
 *
 * Let E, F, x(0-) and f depend on a number p. With R(s) = (s E + F)^{-1} and X = R b, where b = E x(0-) + the
 * transform of f, x(0+) and c_i are coefficients of X at s = infinity (impulse.h). Their derivatives are
 * those of
 *   X_p = R (b_p - (s E_p + F_p) X),
 * that is x(0+) and the impulses of S = dx/dp in the system of twice the size
 *   [ E    0 ] x'   [ F    0 ] x     f                x(0-)
 *   [ E_p  E ] S' + [ F_p  F ] S  =  f_p,     from    x_p(0-).
 * It is analysed as any other, with the same certificates and error estimates (impulse.h).
 *
 * They exist only where the structure stays: the expansion of R (s E_p + F_p) R must end where that of R does,
 * which it does if and only if the system of twice the size has the index of the first. Otherwise p changes the index
 * or the number of finite eigenvalues: x(0+) is not differentiable (a singular perturbation). That test sees
 * first order only; so pencils at values of p nearby are analysed, too, on both sides. The degrees of det(s E + F) and of
 * the adjugate are largest for almost all p: one pencil with more finite eigenvalues, or with as many and a larger
 * index, says that the structure does not stay; one with less of them lies at a singular value of p itself and
 * says nothing, so that another is taken.
 *
 *   steif_impulse_direction d = {.E = dE};                       // dF = 0, x(0-) and f stay
 *   if (!steif_impulse_slope_find(ctx, &system, x0, 0, NULL, NULL, &d, &slope) && slope.exists)
 *     use(slope.x_plus, slope.c);
 *   steif_impulse_slope_clear(ctx, &slope);
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_SLOPES_H
#define STEIF_SLOPES_H

#include <steif/impulse.h>
#include <steif/parameters.h>

#ifdef __cplusplus
extern "C" {
#endif

/* E and F at another p, as new matrices that the caller destroys; `by` is the step of p in units of its size, at most 1/16
 * either way. Codes of steif. */
typedef int (*steif_pencil_nearby)(sunrealtype by, SUNMatrix *E, SUNMatrix *F, void *user);

/* How the data depend on p, at its value; zero is: not at all. */
typedef struct steif_impulse_direction {
  SUNMatrix E, F;        /* dE/dp and dF/dp of the order of E and F, dense or CSC; NULL: 0 */
  const sunrealtype *x0; /* n: dx(0-)/dp; NULL: 0 */
  steif_forcing f;       /* df/dp with derivatives in t as those of f; NULL: 0 */
  void *user;            /* of f and nearby */
  steif_pencil_nearby
    nearby; /* NULL: E + d dE/dp and F + d dF/dp with small d, which leaves the structure in second
                   order where p moves it along a curve: that is undecided then, unless */
  int straight; /* 1: E and F are linear in p, so that these are the pencils nearby */
  int reserved_int;
  void *reserved[7]; /* 0 */
} steif_impulse_direction;

/* What was found. Arrays belong to it. */
typedef struct steif_impulse_slope {
  sunindextype n;
  int index, count; /* of the system: count = max(index - 1, 0) impulses */
  int
    exists; /* 1: yes; 0: no, and x_plus and c are NaN; -1: undecided, the numbers are those of a
                           curve that keeps the structure */
  sunrealtype *x_plus; /* n: dx(0+)/dp */
  sunrealtype *c;      /* count x n, by rows: dc_0/dp, dc_1/dp, ... */
  int certified;       /* both analyses; then x_plus is right to `estimate` */
  sunrealtype
    estimate; /* of the error of x_plus relative to the larger of its norm and what x(0+) has, in
                           steps of p that change x(0+) as much as it has */
  sunrealtype unit;                 /* such a step of p, a power of 2 */
  int index_near;                   /* of the pencil nearby that decides; -1: none does */
  sunindextype finite, finite_near; /* finite eigenvalues here and there; -1: undecided */
  char message[512];
  void *reserved[4]; /* 0 */
} steif_impulse_slope;

/* At the jump of the system at t from x0 (n values). analysis, structure: as in steif_impulse_find. Codes of
 * steif_impulse_find; STEIF_BAD_INPUT: sizes that differ, NaN. A derivative that does not exist is no failure. */
STEIF_EXPORT int steif_impulse_slope_find(steif_context *ctx, const steif_linear *system,
                                          const sunrealtype *x0, sunrealtype t,
                                          const steif_analysis *analysis,
                                          const steif_structure *structure,
                                          const steif_impulse_direction *direction,
                                          steif_impulse_slope *slope);
STEIF_EXPORT void steif_impulse_slope_clear(steif_context *ctx, steif_impulse_slope *slope);

/* The direction of parameter k of a problem of the descriptor form: dE/dp and dF/dp from its dF/dp at unit
 * vectors (steif_parameter_slope), dx(0-)/dp, df/dp by differences of the forcing in p, and the pencil at
 * p (1 + 2^-6). The problem stays as it was and outlives the direction. STEIF_UNSUPPORTED: another form. */
STEIF_EXPORT int steif_impulse_direction_of(steif_context *ctx, const steif_problem *problem,
                                            int k, steif_impulse_direction *direction);
STEIF_EXPORT void steif_impulse_direction_clear(steif_context *ctx,
                                                steif_impulse_direction *direction);

#ifdef __cplusplus
}
#endif
#endif
