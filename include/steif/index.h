/* steif/index.h: the index of a nonlinear DAE F(t, y, y') = 0 at a point, and what follows from it.
 *
 * Three tests of the index stand beside each other, since each of them alone is misled by some
 * problem:
 *   structure   offsets c, d of the equations and unknowns by maximum-weight matching, and the
 *               system Jacobian J_ij = dF_i/dy_j^(d_j - c_i) (J. D. Pryce, BIT 41, 2001)
 *   growth      powers of s in (s E - A)^{-1}, row by row and column by column
 *   array       the derivative array F, F', ..., F^(K) and when it determines y'
 *               (S. L. Campbell; P. Kunkel and V. Mehrmann 2006)
 * The verdict says how sure it is; where the tests cannot decide it says so.
 *
 * Derivatives of F along a curve are taken from values of F, E and A at Chebyshev nodes: nothing
 * beyond the callbacks of steif_problem is asked for. The structure and the growth are computed for
 * any n; the array is dense and serves n <= STEIF_DIAGNOSE_LARGEST.
 *
 * Small entries. Of differences those below 1e-9 of their row are taken as rounding, of callbacks below 1e-13 where E and
 * F_y are constant, 1e-25 where they vary: the conductance of a diode that is closed, 1e-15 of its row, is that of index 1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_INDEX_H
#define STEIF_INDEX_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STEIF_DIAGNOSE_LARGEST = 300, STEIF_SENTENCE = 1200 };

/* Where to look. {0}: the start of the problem. */
typedef struct steif_point {
  const sunrealtype *y, *yp; /* n values at t; y NULL: start of the problem at its t0;
                                         yp NULL: with y 0, else the problem's */
  sunrealtype t;             /* with y */
  const sunrealtype *size;   /* n sizes below which components count as zero, atol_j/rtol;
                                         NULL: rtol_scale of the problem (1 when not set) */
  const char *const *equation, *const *unknown; /* n each; NULL: the names of the problem, else
                                         e1, e2, ..., y1, y2, ... */
} steif_point;

enum steif_confidence { STEIF_UNDECIDED, STEIF_PROBABLE, STEIF_SURE };
enum steif_verdict {
  STEIF_REGULAR,    /* one index at all points */
  STEIF_VARIES,     /* it differs between nearby points: a singular point is near */
  STEIF_NOT_UNIQUE, /* solutions are not determined by their start, though s E - A is regular */
  STEIF_NO_SOLUTION, /* s E - A is singular for every s, or too many equations somewhere */
  STEIF_RANGE        /* undecided: see the sentence */
};

typedef struct steif_diagnosis {
  enum steif_verdict verdict;
  enum steif_confidence confidence;
  int index;            /* differentiation index; -1: none or undecided */
  sunindextype freedom; /* start values that can be prescribed; -1: unknown */
  int *number;          /* n: 1 + differentiations of perturbations that reach unknown j */
  int *derivatives;     /* n: how often equation i is differentiated on the way to y */
  int *determined;      /* n: differentiations until y_j' is determined; -1: not computed */
  int *prescribe;       /* n: 1 in a proposed set of `freedom` start values, -1 never, 0 other
                                   (all 0 when not computed) */
  int structural;       /* index by structure; -1: no matching */
  int *c, *d;           /* n: offsets of equations and unknowns; 0 without a matching */
  sunrealtype rcond;    /* of the system Jacobian, equilibrated; 0: singular */
  int growth;           /* index by growth; -1: none */
  int array;            /* index by the array; -1: not closed or not computed */
  sunrealtype gap;      /* smallest ratio of singular values the array relied on; 0: none */
  char message[STEIF_SENTENCE];
  void *memory; /* of the lists; freed by steif_diagnosis_clear */
} steif_diagnosis;

STEIF_EXPORT int steif_diagnose(steif_context *ctx, const steif_problem *problem,
                                const steif_point *inquiry, steif_diagnosis *diagnosis);
/* Accepts NULL and zeroed ones; before the context is freed. */
STEIF_EXPORT void steif_diagnosis_clear(steif_diagnosis *diagnosis);
/* "sure", "probable", "undecided" */
STEIF_EXPORT const char *steif_confidence_name(enum steif_confidence confidence);

#ifdef __cplusplus
}
#endif
#endif
