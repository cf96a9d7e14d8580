/* steif/consistent.h: start values of a DAE that fulfil all its equations, the hidden ones too.
 *
 * Stage by stage, for any n, where the structure determines the order of the equations (index.h): dense up to
 * STEIF_DIAGNOSE_LARGEST unknowns, above by sparse factors, where memory and time grow as those of a factor of
 * s E - A do. Else, for n <= STEIF_DIAGNOSE_LARGEST, from the whole derivative array.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_CONSISTENT_H
#define STEIF_CONSISTENT_H

#include <steif/index.h>
#include <steif/initial.h>

#ifdef __cplusplus
extern "C" {
#endif

/* As enum steif_attribute tells. */
typedef struct steif_request {
  const enum steif_attribute *attribute; /* n; NULL: all STEIF_GUESS */
  const sunrealtype *weight;             /* n weights w_j > 0; NULL: all 1 */
  int iterations;                        /* of each stage; 0: 60 */
} steif_request;

typedef struct steif_start {
  sunrealtype *y, *yp; /* n */
  sunrealtype *moved;  /* n: y - guess */
  int *enforced;       /* n: equation i and its first enforced[i] derivatives are fulfilled */
  int levels;          /* largest of them */
  int stages;          /* sizes of the problem solved: 1 for the whole array at once */
  int iterations;
  sunrealtype violation; /* by the guess, the largest of equations without derivatives ... */
  sunindextype worst;    /* ... this one; -1: none is violated */
  sunrealtype residual;  /* largest residual left, relative to the terms of its equation */
  char message[STEIF_SENTENCE];
  void *memory;
} steif_start;

/* STEIF_BAD_INPUT when fixed values contradict the equations, STEIF_NO_CONVERGENCE when no
 * consistent point is found, STEIF_SINGULAR when there is none or more than one near the
 * guess. */
STEIF_EXPORT int steif_consistent(steif_context *ctx, const steif_problem *problem,
                                  const steif_point *inquiry, const steif_request *request,
                                  steif_start *start);
STEIF_EXPORT void steif_start_clear(steif_start *start);

#ifdef __cplusplus
}
#endif
#endif
