/* irk_interleaved.h: the state of collocation with interleaved shifts, the polynomial it predicts with and its iteration.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_IRK_INTERLEAVED_H
#define STF_IRK_INTERLEAVED_H

#include "lu.h"
#include "stage_polynomial.h"
#include "step_error.h"

typedef struct stf_irk_interleaved {
  const steif_table *table;
  int s, n, itmax, iterations, fails; /* fails: attempts refused since the last accepted step */
  stf_interleaved *L;
  N_Vector *Y, *F; /* views of the stages in L */
  N_Vector moved, rest, between;
  double *a; /* n x wide: u(t_n + x h_old) - y_n = sum_k a_k x^(k+1) */
  double K[STF_EIGEN_STAGES][STF_INTERLEAVED_STAGES]; /* a_k = sum_j K[j][k] Z_j */
  double d[STF_EIGEN_STAGES], end[STF_EIGEN_STAGES];
  double *f0, *before, *M;
  double *last_Z;       /* n x wide, with M: stages before a correction */
  const sunrealtype *B; /* A^{-1}, s x s by rows */
  stf_estimate higher_order;
  stf_carried carried;
  N_Vector own;                   /* the error; NULL: none is carried on */
  double own_norm, *ratio, least; /* ratio of the error to the estimate; least: that of norms */
  stf_stage_polynomial
    u; /* with derivatives by parameters; so are stages and what is set aside: */
  N_Vector *stage;
  double *aside;
  double h_factored, theta, eta, kappa, eta_of,
    first_correction; /* first_correction: ||first correction|| / ||omega||; eta_of: that eta was seen at */
  bool accurate;         /* the end is a stage */
  bool rounding_limited; /* rounding ended Newton's iteration */
  bool history, f0_known, renew_J, J_new, J_ahead;
  bool J_from_stage; /* J is from inside this attempt */
} stf_irk_interleaved;

/* K, d and end for stage j. */
void stf_irk_interleaved_basis(stf_irk_interleaved *e, int j);
/* Z_j = u(q c_j) from the last polynomial, q = h / h_old, cut where its terms begin to grow, and what
 * the iteration begins with. */
void stf_irk_interleaved_predict(const stf_step *s, stf_irk_interleaved *e, double h);

/* A Jacobian and factors for a step h, where those at hand do not serve. */
int stf_irk_interleaved_prepare(stf_step *s, double h);
/* The stages, from the prediction. */
int stf_irk_interleaved_iterate(stf_step *s, double h);

/* What the estimate may be, from the stages. */
void stf_irk_interleaved_tolerance(stf_step *s);
/* The error, and a look between the stages. */
int stf_irk_interleaved_estimate(stf_step *s, double h);
/* out = M v. */
int stf_irk_interleaved_product(stf_step *s, N_Vector v, N_Vector out);

/* Factors of the matrices at hand. */
int stf_irk_interleaved_factor(stf_step *s, double h);
/* The filter of the estimate. */
int stf_irk_interleaved_damp(stf_step *s, sunrealtype h, N_Vector v);
extern const stf_carrier stf_irk_interleaved_carrier;

#endif
