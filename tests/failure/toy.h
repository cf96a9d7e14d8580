/* toy.h: a variable-step backward Euler or trapezoidal rule that fails easily, and keeps what
 * steif_explain wants to know.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef TOY_H
#define TOY_H

#include <steif/consistent.h>
#include <steif/failure.h>

enum { TOY_RING = 400, TOY_LARGEST = 27 };

typedef struct toy {
  double rtol, atol, t1, h0;
  int trapezoid, weighted; /* weighted: norms scale by h^(index - 1) of the problem */
  long most;               /* steps */
  int failed;              /* 1: the step became too small, or too many; 0: reached t1 */
  steif_history scene;
  double t[TOY_RING], y[TOY_RING * TOY_LARGEST], yp[TOY_RING * TOY_LARGEST];
  double error[TOY_LARGEST];
} toy;

/* From y, yp at the start of the problem (NULL: its own). 0, or < 0 when it could not
 * begin. */
int toy_run(steif_context *ctx, const steif_problem *p, const double *y, const double *yp,
            toy *r);
/* The cause of its end; the inquiry is completed with the last point. */
int toy_explain(steif_context *ctx, const steif_problem *p, const toy *r, steif_point names,
                steif_cause *cause);

#endif
