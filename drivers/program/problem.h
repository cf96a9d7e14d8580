/* problem.h: a problem of the collection by a word of a call, and a point of its solution.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PROGRAM_PROBLEM_H
#define PROGRAM_PROBLEM_H

#include "program.h"

/* The problem of a word with the parameters of --set, compiled where --compile asks for it: what then
 * stands in the way is said, and the interpreter runs it. EXIT_OK or an exit code after a sentence. */
int find_problem(struct call *call, const char *word, steif_problem *p);
/* NAME=NUMBER of --set, at most `room` of them: how many. *words: how many have other values. */
int numbers_set(const struct call *call, int room, char name[][STEIF_SPEC_KEY], double *value,
                int *words);
/* Where the call gives this parameter of `word` a value, for a sentence: "by --set", "after the colon"; NULL: nowhere. */
const char *value_given(const struct call *call, const char *word, const char *name);

/* What `work` returns for the problem of the first word, or an exit code after a sentence. */
int with_problem(struct call *call, int (*work)(struct call *call, const steif_problem *p));

/* A point of a solution: the exact one where it is known, else that of a run. */
struct point {
  steif_point at;
  N_Vector y, yp;
  steif_solver *solver; /* of the run; NULL: none */
};

/* The solution of p at t: EXIT_OK or an exit code after a sentence; close it in any case. */
int point_open(struct call *call, const steif_problem *p, double t, struct point *point);
void point_close(struct point *point);

#endif
