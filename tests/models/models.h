/* models.h: small DAEs F(t, y, y') = 0 written once in complex arithmetic; E and F_y
 * follow exactly by complex steps (J. N. Lyness and C. B. Moler, SIAM J. Numer. Anal. 4,
 * 1967).
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MODELS_H
#define MODELS_H

#include <complex.h>
#include <steif/collection.h>
#include <steif/consistent.h>
#include <steif/failure.h>

typedef double complex cplx;
enum { MODEL_LARGEST = 10 };

typedef struct model {
  const char *name;
  sunindextype n;
  void (*F)(double t, const cplx *y, const cplx *yp, cplx *r);
  double t0, y0[MODEL_LARGEST], yp0[MODEL_LARGEST];
  const char *equation[MODEL_LARGEST], *unknown[MODEL_LARGEST]; /* NULL: e1 .., y1 .. */
  double size[MODEL_LARGEST];                                   /* 0: not given */
} model;

extern const model models[], troubles[]; /* ended by a NULL name */
const model *model_find(const char *name);
/* With exact E and A, or without any Jacobian. */
steif_problem model_problem(const model *m, int jacobian);
/* Names of the model for an inquiry; y, yp, t left to the caller. */
steif_point model_inquiry(const model *m);

#endif
