/* gradient_functional.h: what --functional and --end ask a gradient of, with exact slopes.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef GRADIENT_FUNCTIONAL_H
#define GRADIENT_FUNCTIONAL_H

#include "gradient_terms.h"

/* A sum of unknowns and squares, of problems of any size, or an expression as a model. */
struct asked {
  bool is_sum;
  struct sum sum;
  steif_problem model;
};
enum { FUNCTIONALS = 32 };
struct gradient_functional {
  steif_context *ctx;
  const steif_problem *now; /* whose parameters count */
  struct asked *asked
    [2]; /* integrands, and what is asked at the end, `of.count` of each; NULL: nothing is */
  char *label[FUNCTIONALS]; /* what was asked, as text */
  steif_functional of;
  N_Vector first, none, out;
};
int gradient_functional_open(struct call *call, const steif_problem *p,
                             struct gradient_functional *f);
void gradient_functional_close(struct call *call, struct gradient_functional *f);

#endif
