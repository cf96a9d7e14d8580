/* planted.h: random pencils s E + F whose structure is known by other means.
 *
 *   dense     U diag(s I + J, s N + I) V, U and V of condition 1 to 1e3, eigenvalues up to 1e3
 *   whole     the same from small whole numbers, U and V products of elementary ones: sparse, exact, and
 *             with less finite eigenvalues than the pattern allows
 *   pattern   random places and small whole numbers
 *   circuit   nodes joined by random resistors, capacitors, inductors and sources
 *
 * The last two are judged by exact ranks modulo 2^61 - 1, which no analysis draws.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef PLANTED_H
#define PLANTED_H

#include "random.h"
#include <steif/impulse.h>

enum { PLANTED_MOST = 60 };
enum planted_kind {
  PLANTED_DENSE,
  PLANTED_WHOLE,
  PLANTED_PATTERN,
  PLANTED_CIRCUIT,
  PLANTED_KINDS
};

typedef struct planted {
  stf_random random;
  int n, finite, index;
  bool singular; /* det(s E + F) = 0 for all s */
  sunrealtype E[PLANTED_MOST * PLANTED_MOST],
    F[PLANTED_MOST * PLANTED_MOST]; /* n x n by columns */
  bool start;                       /* x(0+) from x(0-) for f = 0 is known: */
  sunrealtype before[PLANTED_MOST], after[PLANTED_MOST];
} planted;

const char *planted_name(enum planted_kind kind);
/* Pencil number `seed` of a kind; a code, with the message set. */
int planted_new(steif_context *ctx, enum planted_kind kind, long seed, planted *p);
/* U diag(...) V and its start. */
void planted_dense(planted *p);

enum planted_verdict { PLANTED_RIGHT, PLANTED_WRONG, PLANTED_OPEN };
typedef struct planted_outcome {
  enum planted_verdict structure, start;
  bool cancels;      /* the pattern allows more finite eigenvalues than there are */
  sunrealtype off;   /* error of x(0+) over its estimate, where it is known */
  char message[512]; /* of the structure */
} planted_outcome;
/* By staircase and Schur form, and by circles what these leave open, where the kind is dense; else by circles. */
int planted_judge(steif_context *ctx, enum planted_kind kind, const planted *p,
                  planted_outcome *out);

#endif
