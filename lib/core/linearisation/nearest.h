/* nearest.h: the nearest point on r(z) = 0.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_NEAREST_H
#define STF_NEAREST_H

#include "linearisation.h"

struct stf_nearest_point;

/* How a step is solved. nearest.c has the dense way, nearest_sparse.c the other. */
typedef struct stf_nearest_solver {
  int (*open)(stf_pool *pool, struct stf_nearest_point *move);
  int (*factor)(struct stf_nearest_point *move); /* J W^{-1} with rows scaled; rank */
  int (*direction)(struct stf_nearest_point *move, sunrealtype *dz);
  sunrealtype (*merit)(const struct stf_nearest_point *move, const sunrealtype *r);
} stf_nearest_solver;
extern const stf_nearest_solver stf_nearest_dense, stf_nearest_sparse;

/* Least movement: minimise sum (weight_j (z_j - target_j))^2 subject to r(z) = 0 by Gauss-
 * Newton with damping; target NaN: stay near the current value. Rows need not be
 * independent. */
typedef struct stf_nearest_point {
  steif_context *ctx;
  const stf_nearest_solver *solver;        /* NULL: dense */
  size_t rows, columns, entries;           /* entries: of J at most, sparse */
  sunrealtype *z, *target, *weight, *unit; /* unit: sizes of z for the test of convergence */
  int (*residual)(void *data, const sunrealtype *z, sunrealtype *r);
  int (*jacobian)(void *data, struct stf_nearest_point *move); /* at z, into J or `sparse` */
  void (*prepare)(void *data,
                  struct stf_nearest_point *move); /* fill z, target, weight, unit */
  int (*accept)(void *data,
                struct stf_nearest_point *move); /* take the solution, or say why not */
  void *data;
  int most; /* iterations */
  int iterations;
  bool converged;
  bool unpulled; /* steps for r alone, whatever the targets are */
  size_t rank;
  sunrealtype rcond;                      /* smallest kept singular value over the largest */
  sunrealtype *r, *J, *U, *VT, *s, *left; /* at the end: r and J at z, U of the scaled J */
  sunrealtype *work;
  SUNMatrix sparse; /* J by columns, values after factor as left as they were; dense: NULL */
  struct stf_augmented *augmented;
} stf_nearest_point;
/* From memory to acceptance; a callback that asks for another point becomes a sentence. */
int stf_nearest_point_find(stf_point *point, stf_nearest_point *move);

/* Sparse, after rank < rows: a vector of the null space of square J, columns entries; else 0. */
int stf_nearest_null_vector(stf_nearest_point *move, sunrealtype *v);

#endif
