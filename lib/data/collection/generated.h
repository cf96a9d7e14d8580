/* generated.h: what the generators of descriptor systems E x' + F x = f(t) share: matrices put
 * together entry by entry, forcing by waves, and solves with S = G W G^T.
 *
 * A generator's build is
 *   stf_linear *l = stf_linear_open(ctx, self, n, room_E, room_F, waves);
 *   stf_linear_put(&l->E, i, j, value) ..., stf_linear_wave(l, i, ...) ..., l->start[i] = ...
 *   return stf_linear_finish(ctx, spec, self);
 * and self->user is the stf_linear. Its .destroy is stf_linear_release.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LINEAR_H
#define STF_LINEAR_H

#include "collection.h"
#include "known_structure.h"
#include "random.h"
#include <stdint.h>
#include <steif/parameters.h>

/* An n x n matrix: entries in any order until stf_linear_finish adds up what is double and sorts
 * by columns. count > room: more was put than there is room for. */
typedef struct stf_sparse {
  sunindextype n, count, room;
  sunindextype *row, *at; /* at: column of each entry until sorted, then n + 1 starts */
  sunrealtype *value;
  bool sorted; /* what is put from now on is added to an entry that is there */
} stf_sparse;

/* f_row += amplitude cos(frequency t + phase). */
typedef struct stf_wave {
  sunindextype row;
  sunrealtype amplitude, frequency, phase;
} stf_wave;

enum { STF_LINEAR_PARAMETERS = 8 };

typedef struct stf_linear stf_linear;
struct stf_linear {
  stf_pool *pool, *scratch; /* scratch lives until stf_linear_finish */
  sunindextype n;
  stf_sparse E, F;
  stf_wave *wave;
  sunindextype waves, room;
  sunrealtype *start; /* x(0-) */
  int *index;         /* of each component, 1 */
  bool consistent;    /* it is x(0+) instead ... */
  sunrealtype *after; /* ... made here, with the impulses */
  int dae_index;
  sunindextype finite; /* eigenvalues */
  void *data;          /* of the generator */
  /* Of those with parameters: puts matrices, waves and start of the values p together, at the beginning and when they
   * change; entries stay where they are. */
  void (*fill)(stf_linear *l);
  sunrealtype p[STF_LINEAR_PARAMETERS];
  sunrealtype *slope; /* what all of that is by each of them, and room for two more */
  steif_parameters parameters;
  /* x_plus and c (zeroed) from x(0-) = x0. */
  int (*jump)(steif_context *ctx, const stf_linear *l, const sunrealtype *x0,
              stf_exact_start *out);
};

/* NULL when memory is short. Parameters "case" (inc, cons) and "storage" (dense, sparse) belong to
 * stf_linear_finish: case=cons starts from the x(0+) that the inconsistent start jumps to. */
stf_linear *stf_linear_open(steif_context *ctx, steif_problem *self, sunindextype n,
                            sunindextype room_E, sunindextype room_F, sunindextype waves);
void stf_linear_put(stf_sparse *m, sunindextype i, sunindextype j, sunrealtype value);
void stf_linear_wave(stf_linear *l, sunindextype row, sunrealtype amplitude,
                     sunrealtype frequency, sunrealtype phase);
/* `count` parameters, whose values the generator has put into l->p, for the problem; fills l. */
void stf_linear_depend(stf_linear *l, steif_problem *self, int count, const char *const *name,
                       void (*fill)(stf_linear *l));
int stf_linear_finish(steif_context *ctx, const steif_spec *spec, steif_problem *self);
void stf_linear_release(steif_context *ctx, steif_problem *self);

/* Callbacks of every generator; user is the stf_linear. */
int stf_linear_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user);
int stf_linear_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user);
int stf_linear_g(sunrealtype t, int derivative, N_Vector out, void *user);

#define STF_LINEAR_CALLBACKS                                                                   \
  .E = stf_linear_E, .A = stf_linear_A, .g = stf_linear_g, .linear = 1,                        \
  .destroy = stf_linear_release

/* f^(order)(t), F x, and F x - f^(order)(0), each into out. */
void stf_linear_force(const stf_linear *l, sunrealtype t, int order, sunrealtype *out);
void stf_linear_times(const stf_linear *l, const sunrealtype *x, sunrealtype *out);
void stf_linear_defect(const stf_linear *l, const sunrealtype *x, int order, sunrealtype *out);

/* A chain of masses under constraints, with a hidden mode of rate lambda where that is not 0: the
 * build of two shelf entries, which have checked the names of the parameters. */
int stf_chain_build(steif_context *ctx, const steif_spec *spec, steif_problem *self,
                    sunrealtype lambda);

int stf_sparse_open(stf_pool *pool, sunindextype n, sunindextype room, stf_sparse *m);
/* `m` sorted into `out`, whose arrays come from the pool. */
int stf_sparse_sort(steif_context *ctx, stf_pool *pool, const stf_sparse *m, stf_sparse *out);

/* Solves with S = sum_j weight_j b_j b_j^T, b_j = rows base .. base + size - 1 of column
 * j = first .. first + count - 1 of M; stf_schur_of takes any sorted S. *s is NULL on failure. */
typedef struct stf_schur stf_schur;
int stf_schur_open(steif_context *ctx, const stf_sparse *M, sunindextype base,
                   sunindextype size, sunindextype first, sunindextype count,
                   const sunrealtype *weight, stf_schur **s);
int stf_schur_of(steif_context *ctx, const stf_sparse *S, stf_schur **s);
int stf_schur_solve(stf_schur *s, sunrealtype *b);
void stf_schur_close(stf_schur **s);

#endif
