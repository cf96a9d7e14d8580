/* linearisation.h: a DAE F(t, y, y') = 0 at a point: F, E = F_y' and B = F_y, names and sentences.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LINEARISATION_H
#define STF_LINEARISATION_H

#include "base.h"
#include "problem.h"
#include <steif/consistent.h>

/* F_0 .. F_order, rows of n, of F along y(t + s) = y_0 + y_1 s + ... + y_{order+1} s^{order+1}; > 0: there is no series. */
typedef int (*stf_taylor_of)(steif_context *ctx, const steif_problem *problem, sunrealtype t,
                             int order, const sunrealtype *y, sunrealtype *F);

/* A problem to look at. Reals are host arrays of n values throughout. */
typedef struct stf_point {
  steif_context *ctx;
  stf_pool *pool;
  steif_problem problem; /* a copy whose t0 is the point */
  const char *const *equation, *const *unknown;
  stf_system system;
  size_t n;
  bool analytic; /* E and A come from callbacks */
  bool quick; /* views of any n as the time loop sees E and A, not by differences of order 4 */
  bool every; /* views hold all entries that are not 0 */
  bool brief; /* the index is wanted, no report: tests that agree are enough */
  stf_taylor_of taylor; /* NULL: derivatives along curves are differences */
  int views; /* quick ones taken; after the first, system->E and A are those of another point */
  N_Vector y, yp, r;
  sunrealtype t, *y0, *yp0; /* the point */
  sunrealtype from, to;     /* no break of the problem lies between: F is asked for here only */
  sunrealtype *floor, *size; /* size = |y0| + floor, or so */
  sunrealtype *scratch;      /* 6 n */
} stf_point;

/* E and A come from callbacks. */
static inline bool stf_analytic(const steif_problem *p, int form)
{
  return form == STEIF_IMPLICIT ? p->idajac || (p->E && p->A)
                                : form == STEIF_DESCRIPTOR || p->A || p->jac;
}

int stf_point_open(steif_context *ctx, const steif_problem *problem, const steif_point *inquiry,
                   stf_point *point);
void stf_point_close(stf_point *point);
/* "e3" and "y2", or the user's; `room` has STEIF_SPEC_WORD characters. */
const char *stf_point_equation(const stf_point *point, size_t i, char *room);
const char *stf_point_unknown(const stf_point *point, size_t j, char *room);
/* Append to a sentence of STEIF_SENTENCE characters. */
void stf_point_say(char *sentence, const char *format, ...) STEIF_PRINTF(2, 3);
/* Is there one with flag[i] >= least? */
bool stf_point_any(const stf_point *point, const int *flag, int least);
/* " a, b, c (and 7 more)" of those with flag[i] >= least; with counts: "a (2), b (1)". */
void stf_point_list(const stf_point *point, char *sentence, bool equations, const int *flag,
                    int least, bool counts);

/* r = F(t, y, y'), > 0 where it cannot be evaluated or is not finite. */
int stf_point_residual(stf_point *point, sunrealtype t, const sunrealtype *y,
                       const sunrealtype *yp, sunrealtype *r);
/* E = F_y' and B = F_y, dense by columns; by differences of order 4 without callbacks. */
int stf_point_matrices(stf_point *point, sunrealtype t, const sunrealtype *y,
                       const sunrealtype *yp, sunrealtype *E, sunrealtype *B);
/* The same by differences whatever callbacks there are, column j only. */
int stf_point_column(stf_point *point, char which, sunrealtype t, const sunrealtype *y,
                     const sunrealtype *yp, size_t j, sunrealtype *column);

/* Reproducible numbers in (-1, 1). */
sunrealtype stf_point_random(unsigned *state);

#endif
