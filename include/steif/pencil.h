/* steif/pencil.h: the matrix pencil s E - A and its verbs, shift and solve.
 *
 * Everything implicit is a shift of a pencil: BDF asks for one real s, DIRK for one, collocation
 * with s stages for floor(s/2) complex ones and at most one real, descriptor analysis for points on
 * a circle. One object keeps E and A, shares one symbolic analysis between all shifts and both
 * arithmetics, and factors the shifts of one call side by side on the cores there are.
 *
 *   steif_pencil *p = steif_pencil_new(ctx, E, A);      E NULL: identity
 *   steif_pencil_factor(p, 2, (steif_shift[]){{2, 0}, {1, 3}});
 *   steif_pencil_solve(p, 1, 1, &re, &im);              ((1 + 3i) E - A) x = b, in place
 *
 * Dense matrices use an in-line LU up to n = 16 and LAPACK above, band matrices LAPACK, sparse ones
 * KLU (64-bit indices, AMD ordering), and for real shifts of 200 unknowns and more a multifrontal LU
 * in dense blocks, with KLU instead where pivots are bad. Operators are solved by GMRES, complex
 * shifts on pairs (re, im) with the inner product of complex vectors, both parts preconditioned with a
 * real shift.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_PENCIL_H
#define STEIF_PENCIL_H

#include <steif/base.h>
#include <sundials/sundials_matrix.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_pencil steif_pencil;

/* Shifts that can be factored at the same time. */
enum { STEIF_PENCIL_SLOTS = 64 };

typedef struct steif_shift {
  sunrealtype re, im; /* im = 0: real arithmetic */
} steif_shift;

/* A pencil known by its products. `precondition` solves approximately (re E - A) z = r, with the
 * real shift it is given, and may be NULL. With `prepare` that shift is the last one prepared: when
 * products have changed (steif_pencil_update) and for shifts that are not within a factor of 2 of it.
 * All return 0, > 0 or < 0 as in problem.h. */
typedef struct steif_operator {
  int (*E)(N_Vector x, N_Vector out, void *user); /* NULL: identity */
  int (*A)(N_Vector x, N_Vector out, void *user);
  int (*prepare)(sunrealtype re, void *user); /* NULL: nothing to prepare */
  int (*precondition)(sunrealtype re, N_Vector r, N_Vector z, sunrealtype tolerance,
                      void *user);
  void *user;
  int dimension;         /* of the Krylov space; 0: 30 */
  int restarts;          /* 0: 10 */
  sunrealtype tolerance; /* relative residual of a solve; 0: 1e-10 */
} steif_operator;

/* What an operator needs for solves with the transpose, with the `user` of the operator. `precondition` solves
 * (re E^T - A^T) z = r approximately, re and what `prepare` has prepared as for the operator's own. */
typedef struct steif_transposed {
  int (*E)(N_Vector x, N_Vector out, void *user); /* E^T x; read unless E is the identity */
  int (*A)(N_Vector x, N_Vector out, void *user); /* A^T x */
  int (*precondition)(sunrealtype re, N_Vector r, N_Vector z, sunrealtype tolerance,
                      void *user); /* NULL: none */
  void *reserved[4];               /* 0 */
} steif_transposed;

/* Counters since the pencil was made. */
typedef struct steif_pencil_stats {
  long analyses, factors, refactors, fallbacks; /* fallbacks are among the factors; operators: a
                             factor is a preconditioner prepared */
  long solves;                                  /* right-hand sides */
  long iterations;                              /* Krylov */
  long fill;                                    /* entries of L + U of the last sparse factor */
} steif_pencil_stats;

/* E and A are borrowed: same size and storage, dense (column-major), band or sparse (CSC); E NULL
 * is the identity. Their patterns may differ; the pencil works on the union. Call
 * steif_pencil_update after changing values. */
STEIF_EXPORT steif_pencil *steif_pencil_new(steif_context *ctx, SUNMatrix E, SUNMatrix A);
/* The same with incomplete factors, ILU(0), sparse and for real shifts only: solves are approximate, for
 * preconditioners. STEIF_SINGULAR: a pivot is missing, as in DAEs whose algebraic equations do not hold
 * their own unknowns. */
STEIF_EXPORT steif_pencil *steif_pencil_new_incomplete(steif_context *ctx, SUNMatrix E,
                                                       SUNMatrix A);
STEIF_EXPORT steif_pencil *steif_pencil_new_operator(steif_context *ctx,
                                                     const steif_operator *op, N_Vector like);
STEIF_EXPORT void steif_pencil_free(steif_pencil **p);

/* The values of E or A changed: factors become stale, factor before the next solve. A changed sparse pattern is found and
 * analysed anew. STEIF_NOT_FINITE names the first entry that is NaN or infinite. */
STEIF_EXPORT int steif_pencil_update(steif_pencil *p);

/* Factor s_k E - A for k = 0 .. count-1; a slot whose shift and matrices have not changed is kept.
 * Sparse factors are refactored with the pivots in use while their growth stays moderate, and
 * factored anew otherwise. STEIF_SINGULAR names shift and column. */
STEIF_EXPORT int steif_pencil_factor(steif_pencil *p, int count, const steif_shift *s);

/* Solve with slot k, in place, for nrhs right-hand sides: re[i] + i im[i]; im may be NULL for a
 * real shift. Vectors need a host array except for operators. */
STEIF_EXPORT int steif_pencil_solve(steif_pencil *p, int k, int nrhs, N_Vector *re,
                                    N_Vector *im);

/* The same with the transpose, from the same factors: (s_k E - A)^T x = b for a real shift. For a complex one the
 * conjugate transpose, (conj(s_k) E^T - A^T) x = b: a solve is a real linear map of the pairs (re, im), and this is
 * the transpose of that map, so that u . solve(v) = solve_transposed(u) . v over both parts.
 * STEIF_UNSUPPORTED: operators whose transposed products are not known. */
STEIF_EXPORT int steif_pencil_solve_transposed(steif_pencil *p, int k, int nrhs, N_Vector *re,
                                               N_Vector *im);

/* The transposed products of an operator, copied, before its solves with the transpose, which are by GMRES with the
 * tolerance of the operator. STEIF_BAD_INPUT: A or, where the operator has E, E is NULL; STEIF_UNSUPPORTED: a pencil
 * of matrices, which transposes itself. */
STEIF_EXPORT int steif_pencil_give_transposed(steif_pencil *p, const steif_transposed *t);

/* out = E x or A x. */
STEIF_EXPORT int steif_pencil_product(steif_pencil *p, char which, N_Vector x, N_Vector out);

STEIF_EXPORT const steif_pencil_stats *steif_pencil_statistics(const steif_pencil *p);

#ifdef __cplusplus
}
#endif
#endif
