/* small_state.h: the state of the family `small`, the polynomial it predicts with and its iteration.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SMALL_STATE_H
#define STF_SMALL_STATE_H

#include "lanes.h"
#include "method.h"

enum { STF_SMALL_LARGEST = STF_LANES_LARGEST, STF_SMALL_STAGES = STF_EIGEN_STAGES };

typedef struct stf_small {
  const steif_table *table;
  int s, n, itmax, iterations, fails; /* fails: attempts refused since the last accepted step */
  stf_lanes L;
  N_Vector *Y, *F; /* views of the stages in L */
  N_Vector moved;
  double *a; /* n x wide: u(t_n + x h_old) - y_n = sum_k a_k x^(k+1) */
  double K[STF_SMALL_STAGES][STF_WIDE]; /* a_k = sum_j K[j][k] Z_j */
  double d[STF_SMALL_STAGES], end[STF_SMALL_STAGES];
  double *f0, *before, *M;
  double *last_Z; /* n x wide, with M: stages before a correction */
  const sunrealtype *B; /* A^{-1}, s x s by rows */
  stf_trust trust;
  double h_factored, theta, eta, kappa, first; /* first: ||first correction|| / ||omega|| */
  bool accurate;                               /* the end is a stage */
  bool rough;                                  /* rounding ended Newton's iteration */
  bool history, have_f0, renew, new_J, predicted;
  bool sharpened; /* J is from inside this attempt */
} stf_small;

/* K, d and end for stage j. */
void stf_small_basis(stf_small *e, int j);
/* Z_j = u(q c_j) from the last polynomial, q = h / h_old, cut where its terms begin to grow, and what
 * the iteration begins with. */
void stf_small_predict(const stf_step *s, stf_small *e, double h);

/* A Jacobian and factors for a step h, where those at hand do not serve. */
int stf_small_prepare(stf_step *s, double h);
/* The stages, from the prediction. */
int stf_small_iterate(stf_step *s, double h);

#endif
