/* steif/initial.h: what a run does about the start values of a DAE, and what it did.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_INITIAL_H
#define STEIF_INITIAL_H

#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Consistent start values: y keeps the fixed components, moves the guessed ones as little
 * as possible in sum (w_j (y_j - guess_j))^2 and computes the free ones; y' and nothing
 * else follows from y. Movement is minimal stage by stage: positions first, velocities for
 * these positions, multipliers from both. A multiplier is computed whatever its guess is
 * worth. */
enum steif_attribute { STEIF_GUESS, STEIF_FIXED, STEIF_FREE };

/* What a run does about its start (options.initial of solver.h). Of DAEs with adaptive steps and methods of
 * steif; prescribed steps and baselines take the start as it is. Linear systems of index 2 and more, and of index 1
 * whose constraints stand in sums of equations, are moved by their jump from x(0-) (impulse.h), where it is certified.
 *   STEIF_REPAIR    index 1, any n: algebraic components move to fulfil the equations, by a damped Newton
 *                   iteration on the sparse matrix of y_a and y_d'; differential ones stay. Index 2 and 3:
 *                   stage by stage as above (consistent.h), positions by at most 1 % of the
 *                   largest. The index of components is found where .index is NULL, at any n.
 *   STEIF_CHECK     the same is computed, and a start that would move is STEIF_BAD_INPUT
 *   STEIF_AS_GIVEN  the start is not looked at; the index of components is found all the same
 * As given is also a start with Krylov storage, options.like or problem.start, where STEIF_CHECK is STEIF_UNSUPPORTED, and
 * with prescribed steps or by a baseline; over ranks STEIF_CHECK is STEIF_UNSUPPORTED with all of these.
 * Components that would move by less than their tolerance stay as they are, and multipliers of index 3 where nothing
 * else would move: the first step computes them. A start that is consistent costs two evaluations of f and
 * one factorisation more than one that is not looked at; where .index is NULL, some Jacobians beside. */
enum steif_initial { STEIF_REPAIR, STEIF_CHECK, STEIF_AS_GIVEN };

/* What was done, shown by steif_initial_used (solver.h). */
typedef struct steif_repair {
  int moved;            /* components that moved by more than their tolerance */
  int index;            /* of the DAE, where it was found; 0: it was not looked for */
  sunrealtype largest;  /* movement, in tolerances */
  const sunrealtype *y; /* n: the start used; NULL: the one given */
  const int *number;    /* n: index of each component, where it was found; else NULL */
  char message[1200];   /* what moved, to fulfil which equation; "" when nothing was done */
  /* Behind events and breaks other equations may hold: the same is done there. */
  int jumps; /* how often unknowns with a derivative jumped there, by more than 10 tolerances */
  char jumped[1200]; /* at the first of them: what moved, and the impulses */
} steif_repair;

#ifdef __cplusplus
}
#endif
#endif
