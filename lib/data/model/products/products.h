/* products.h: derivatives of the residual F(t, y, y'; p) of a model times vectors, without matrices.
 *
 *   tangent   F_y v + F_y' v' + F_p q       a node beside each node of the graph, forwards
 *   adjoint   F_y^T w, F_y'^T w, F_p^T w    one sweep backwards from all rows at once
 *
 * Both cost a few evaluations of F, whatever the number of parameters (A. Griewank and A. Walther,
 * Evaluating Derivatives, 2nd ed., SIAM 2008, sections 3.1 and 3.2). The tapes are made at their first
 * use.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PRODUCTS_H
#define STF_PRODUCTS_H

#include "model.h"

typedef struct stf_products {
  stf_quantity tangent, adjoint;
  bool tangent_made, adjoint_made;
  int64_t rows;      /* of weights: n, and one for each pass of an equation with slots */
  double *weight;    /* rows */
  double *none;      /* as many zeros as y, y' and p together */
  double *gradient;  /* n + n + parameters: by y, y', p */
  double *direction; /* parameters */
} stf_products;

int stf_products_open(stf_model *m);
void stf_products_free(stf_model *m);
/* The tape of tangents is there. */
int stf_products_ready(stf_model *m);
/* NULL directions are 0. STEIF_RETRY: not finite. */
int stf_tangent(stf_model *m, double t, const double *y, const double *yp, const double *v,
                const double *vp, const double *q, double *out);
/* Into m->products->gradient. */
int stf_adjoint(stf_model *m, double t, const double *y, const double *yp, const double *w);
/* tangents.c and adjoints.c: the tape of one block. */
int stf_tangent_tape(stf_model *m, stf_block *block, stf_quantity *q);
/* The derivatives of what the stores take, along a direction; the stores take these then. */
int stf_tangents_of(stf_model *m, stf_block *block, stf_vector *stores, stf_quantity *q);
int stf_adjoint_tape(stf_model *m, stf_block *block, int64_t *rows, stf_quantity *q);
/* The residual of an equation: y_row' - value, or what stands in the text. */
int32_t stf_residual_node(const stf_model *m, stf_block *block, const stf_equation *e);

/* operators.c: the members .Ev, .Av, .Etv and .Atv. */
void stf_operators(const stf_model *m, steif_problem *p);

/* moved_parameters.c: members of steif_parameters. */
int stf_model_follow(void *user);
int stf_model_break_slope(int i, int k, sunrealtype *slope, void *user);

#endif
