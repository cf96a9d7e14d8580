/* steif/diagnose.h: what is wrong with, or special about, a nonlinear DAE F(t, y, y') = 0.
 *
 *   steif_diagnose        index, numbers of unknowns, offending equations, degrees of freedom
 *   steif_consistent      start values that fulfil all equations, the hidden ones too
 *   steif_check_jacobian  are E and A the derivatives of F
 *   steif_explain         why did a run fail: the first of an ordered list of causes
 *
 * Three tests of the index stand beside each other, since each of them alone lies on some
 * problem:
 *   structure   offsets c, d of the equations and unknowns by maximum-weight matching, and the
 *               system Jacobian J_ij = dF_i/dy_j^(d_j - c_i) (J. D. Pryce, BIT 41, 2001)
 *   growth      powers of s in (s E - A)^{-1}, row by row and column by column
 *   array       the derivative array F, F', ..., F^(K) and when it determines y'
 *               (S. L. Campbell; P. Kunkel and V. Mehrmann 2006)
 * The verdict says how sure it is; where the tests cannot decide it says so.
 *
 * Derivatives of F along a curve are taken from values of F, E and A at Chebyshev nodes:
 * nothing beyond the callbacks of steif_problem is asked for. The structure and the growth
 * are computed for any n; the array, starts and most causes of failures are dense and serve n <= 300.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_DIAGNOSE_H
#define STEIF_DIAGNOSE_H

#include <steif/problem.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STEIF_DIAGNOSE_LARGEST = 300, STEIF_SENTENCE = 1200 };

/* Where to look. {0}: the start of the problem. */
typedef struct steif_inquiry {
  const sunrealtype *y, *yp;          /* n values at t; y NULL: start of the problem at its t0;
                                         yp NULL: with y 0, else the problem's */
  sunrealtype t;                      /* with y */
  const sunrealtype *size; /* n sizes below which components count as zero, atol_j/rtol;
                                         NULL: rtol_scale of the problem (1 when not set) */
  const char *const *equation, *const *unknown; /* n each; NULL: the names of the problem, else
                                         e1, e2, ..., y1, y2, ... */
} steif_inquiry;

enum steif_confidence { STEIF_UNDECIDED, STEIF_PROBABLE, STEIF_SURE };
enum steif_verdict {
  STEIF_REGULAR,      /* one index at all points */
  STEIF_VARIES,       /* it differs between nearby points: a singular point is near */
  STEIF_NOT_UNIQUE, /* solutions are not determined by their start, though s E - A is regular */
  STEIF_NO_SOLUTION, /* s E - A is singular for every s, or too many equations somewhere */
  STEIF_RANGE         /* undecided: see the sentence */
};

typedef struct steif_diagnosis {
  enum steif_verdict verdict;
  enum steif_confidence confidence;
  int index;                    /* differentiation index; -1: none or undecided */
  sunindextype freedom;         /* start values that can be prescribed; -1: unknown */
  int *number; /* n: 1 + differentiations of perturbations that reach unknown j */
  int *derivatives;             /* n: how often equation i is differentiated on the way to y */
  int *determined; /* n: differentiations until y_j' is determined; -1: not computed */
  int *prescribe; /* n: 1 in a proposed set of `freedom` start values, -1 never, 0 other
                                   (all 0 when not computed) */
  int structural;               /* index by structure; -1: no matching */
  int *c, *d;                   /* n: offsets of equations and unknowns; 0 without a matching */
  sunrealtype rcond;            /* of the system Jacobian, equilibrated; 0: singular */
  int growth;                   /* index by growth; -1: none */
  int array;                    /* index by the array; -1: not closed or not computed */
  sunrealtype gap; /* smallest ratio of singular values the array relied on; 0: none */
  char message[STEIF_SENTENCE];
  void *memory;                 /* of the lists; freed by steif_diagnosis_clear */
} steif_diagnosis;

STEIF_EXPORT int steif_diagnose(steif_context *ctx, const steif_problem *problem,
                                const steif_inquiry *inquiry, steif_diagnosis *diagnosis);
/* Accepts NULL and zeroed ones; before the context is freed. */
STEIF_EXPORT void steif_diagnosis_clear(steif_diagnosis *diagnosis);
/* "sure", "probable", "undecided" */
STEIF_EXPORT const char *steif_confidence_name(enum steif_confidence confidence);

/* Consistent start values: y keeps the fixed components, moves the guessed ones as little
 * as possible in sum (w_j (y_j - guess_j))^2 and computes the free ones; y' and nothing
 * else follows from y. Movement is minimal stage by stage: positions first, velocities for
 * these positions, multipliers from both. A multiplier is computed whatever its guess is
 * worth. */
enum steif_attribute { STEIF_GUESS, STEIF_FIXED, STEIF_FREE };

typedef struct steif_request {
  const enum steif_attribute *attribute; /* n; NULL: all STEIF_GUESS */
  const sunrealtype *weight;             /* n weights w_j > 0; NULL: all 1 */
  int iterations;                        /* of each stage; 0: 60 */
} steif_request;

typedef struct steif_start {
  sunrealtype *y, *yp;       /* n */
  sunrealtype *moved;        /* n: y - guess */
  int *enforced; /* n: equation i and its first enforced[i] derivatives are fulfilled */
  int levels;                /* largest of them */
  int stages;                /* sizes of the problem solved: 1 for the whole array at once */
  int iterations;
  sunrealtype violation; /* by the guess, the largest of equations without derivatives ... */
  sunindextype worst;        /* ... this one; -1: none is violated */
  sunrealtype residual;      /* largest residual left, relative to the terms of its equation */
  char message[STEIF_SENTENCE];
  void *memory;
} steif_start;

/* STEIF_BAD_INPUT when fixed values contradict the equations, STEIF_NO_CONVERGENCE when no
 * consistent point is found, STEIF_SINGULAR when there is none or more than one near the
 * guess. */
STEIF_EXPORT int steif_consistent(steif_context *ctx, const steif_problem *problem,
                                  const steif_inquiry *inquiry, const steif_request *request,
                                  steif_start *start);
STEIF_EXPORT void steif_start_clear(steif_start *start);

/* Causes of a failure in the order in which they are looked for; noise that spoils a Jacobian made by
 * differences, a limit of ACCURACY, comes before BLOW_UP. */
enum steif_cause_kind {
  STEIF_CAUSE_UNKNOWN,
  STEIF_CAUSE_NOT_FINITE,
  STEIF_CAUSE_BLOW_UP,
  STEIF_CAUSE_IMPASSE,
  STEIF_CAUSE_JUMP,
  STEIF_CAUSE_JACOBIAN,
  STEIF_CAUSE_SINGULAR,
  STEIF_CAUSE_ACCURACY,
  STEIF_CAUSE_STIFF,
  STEIF_CAUSE_START,
  STEIF_CAUSE_RINGING,
  STEIF_CAUSE_INDEX
};

/* What the stepper knows. The point of the inquiry is the last accepted one. */
typedef struct steif_scene {
  sunrealtype h;                /* the step that failed */
  size_t count;                 /* accepted points kept, oldest first, the last one included; */
  const sunrealtype *t;         /* count times; the last dozen steps unthinned */
  const sunrealtype *y, *yp;    /* count x n by rows */
  long steps;                   /* accepted in all; 0 or 1: the start is under suspicion */
  sunrealtype t0;
  sunrealtype rtol, atol;
  const sunrealtype *atols;     /* n instead of atol; NULL: none */
  const sunrealtype *error;     /* n: last error estimate; NULL: not known */
  int explicit_method;          /* its steps may be held by stability */
  int weighted;                 /* norms scale component j by h^(number_j - 1) */
  const char *method;           /* for the sentence; NULL: "the method" */
} steif_scene;

typedef struct steif_cause {
  enum steif_cause_kind kind;
  sunrealtype t;                   /* of the event; NaN when there is none */
  sunindextype equation, unknown;  /* 0-based, -1: none named */
  /* blow-up: exponent, growth; impasse: growth, misfit; jump: size, median increment;
   * Jacobian: given, measured; singular: reciprocal condition; accuracy: noise, in weights
   * (in increments where it spoils a Jacobian by differences); stiff: h |lambda|, |lambda|;
   * start: move, in weights; ringing: share of sign changes, amplitude in weights; index:
   * index, number of the unknown */
  sunrealtype value[2];
  char message[STEIF_SENTENCE];
} steif_cause;

/* 0 also when the cause is unknown: the sentence then holds the numbers. */
STEIF_EXPORT int steif_explain(steif_context *ctx, const steif_problem *problem,
                               const steif_inquiry *inquiry, const steif_scene *scene,
                               steif_cause *cause);
/* The same for the Jacobian alone, before the first step: STEIF_CAUSE_JACOBIAN or
 * STEIF_CAUSE_UNKNOWN (nothing wrong found). */
STEIF_EXPORT int steif_check_jacobian(steif_context *ctx, const steif_problem *problem,
                                      const steif_inquiry *inquiry, steif_cause *cause);

#ifdef __cplusplus
}
#endif
#endif
