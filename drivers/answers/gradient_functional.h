/* gradient_functional.h: what --functional and --end ask a gradient of, with exact slopes.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GRADIENT_FUNCTIONAL_H
#define GRADIENT_FUNCTIONAL_H

#include "gradient_terms.h"

/* A sum of unknowns and squares, of problems of any size, or an expression: of a model one of its integrands, else a
 * model of its own. */
struct asked {
  bool is_sum;
  struct sum sum;
  int number; /* of the integrands, from 0 */
  steif_problem model;
};
enum { FUNCTIONALS = 32 };
struct gradient_functional {
  steif_context *ctx;
  const steif_problem *now; /* whose parameters count */
  steif_problem extended;   /* a model with its integrands ... */
  char *expression[2 * FUNCTIONALS];
  int expressions; /* ... so many; 0: `now` is the problem given */
  double all[2 * FUNCTIONALS];
  struct asked *asked
    [2]; /* integrands, and what is asked at the end, `of.count` of each; NULL: nothing is */
  char *label[FUNCTIONALS]; /* what was asked, as text */
  steif_functional of;
  N_Vector first, none, out;
};
/* f->now is the problem to be asked from then on. */
int gradient_functional_open(struct call *call, const steif_problem *p,
                             struct gradient_functional *f);
/* Where there are integrands the problem with them takes the place of *p; it is cleared on failure. */
int gradient_functional_extend(struct call *call, const struct gradient_functional *f,
                               steif_problem *p);
void gradient_functional_close(struct call *call, struct gradient_functional *f);

#endif
