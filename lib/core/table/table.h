/* table.h: the table room inside: shelf, nodes, differentiation, transformation into shifts.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TABLE_H
#define STF_TABLE_H

#include "base.h"
#include <complex.h>
#include <steif/table.h>

typedef struct stf_table_entry {
  const char *name;
  const steif_table *item;
} stf_table_entry;
extern const stf_table_entry stf_table_shelf[];
extern const size_t stf_table_count;

/* From a parsed spec. */
steif_table *stf_table_build(steif_context *ctx, const steif_spec *spec);
/* Refuse NULL, families that are not built, general linear methods, and numbers of stages out
 * of range. */
int stf_table_check(steif_context *ctx, const steif_table *table);

/* The table of a text file, and its text. */
int stf_table_read(steif_context *ctx, const char *path, steif_glm *glm);
int stf_table_parse(steif_context *ctx, const char *path, const char *text, steif_glm *glm);

/* Nodes of collocation on [0, 1], ascending, to the last bit of double (computed in long
 * double): Gauss (roots of P_s), Radau right (c_s = 1), left (c_1 = 0), Lobatto (both). */
enum stf_node_kind { STF_GAUSS, STF_RADAU_RIGHT, STF_RADAU_LEFT, STF_LOBATTO };
int stf_nodes(steif_context *ctx, enum stf_node_kind kind, int s, long double *c);

/* Nodes and weights of Gauss's rule with m points on [0, 1], exact to degree 2m - 1. */
void stf_gauss(int m, long double *c, long double *w);

/* Values and derivatives at x of the Lagrange basis on count distinct points. */
void stf_lagrange(int count, const long double *points, long double x, long double *value,
                  long double *slope);

/* What a family's build is made of. The number of stages from the spec; then the collocation
 * method on these nodes in long double, changed by `alter` (NULL: none), rounded into *self. */
typedef void stf_alter(int s, const long double *b, long double *A);
int stf_family_stages(steif_context *ctx, const steif_spec *spec, int lowest, int fallback,
                      int *s);
int stf_family_fill(steif_context *ctx, enum stf_node_kind kind, stf_alter *alter,
                    steif_table *self, sunrealtype *A, sunrealtype *b, sunrealtype *c);
/* The same, computed even when it is kept as data. */
int stf_family_compute(steif_context *ctx, enum stf_node_kind kind, stf_alter *alter,
                       steif_table *self, sunrealtype *A, sunrealtype *b, sunrealtype *c);

/* X := A^{-1} X for A (n x n) and X (n x m), both by rows and overwritten; false when a pivot
 * is not larger than `tiny`. */
typedef long double complex stf_complex;
bool stf_solve(int n, int m, stf_complex *A, stf_complex *X, long double tiny);

/* Eigenvalues of the real n x n matrix M with im >= 0, ascending in im, in double accuracy. */
int stf_eigen_values(steif_context *ctx, int n, const long double *M, stf_complex *lambda,
                     int *count);
/* Newton's iteration in long double for the eigenvalue of M near *lambda, and its vector v of
 * length 1; where it diverges, as near multiple eigenvalues, *lambda stays and v is the vector
 * of inverse iteration. False when M v - *lambda v exceeds the rounding of double. */
bool stf_eigen_refine(int n, const long double *M, stf_complex *lambda, stf_complex *v);

/* B = A^{-1} (s x s) transformed into independent shifts. They are ordered: the real
 * eigenvalue first (if s is odd), then one shift per conjugate pair (im > 0, ascending). With
 * the s x s real matrices T, Tinv
 *     omega = Tinv Z,   Z = T omega,
 * omega holds one row per real shift and two rows (real, imaginary) per pair, in this order.
 *  - eigenvectors (coupling NULL): B becomes the eigenvalues, a pair acting as the
 *    complex number lambda on omega_re + i omega_im. A shift's columns of T are v (real) or 2 Re
 *    v, -2 Im v (pair) for the eigenvector v with last component 1, so that Z = v_0 omega_0
 *    + sum 2 Re(v_k omega_k) and omega = V^{-1} Z;
 *  - Schur form (s > STF_EIGEN_STAGES, or eigenvectors nearly dependent): the same with
 *    strictly upper coupling S between shifts: (T^{-1} B T) = blockdiag(lambda) + S, S s x s by
 *    rows, with blocks [re -im; im re]. The columns of T are orthogonal, those of a pair scaled
 *    by r, 1/r. Above 26 stages double no longer determines the eigenvalues, and a pair near
 *    the axis may come as two real shifts, not in order. */
enum { STF_EIGEN_STAGES = 11 };
typedef struct stf_transform {
  int s, shifts;
  sunrealtype re[STEIF_STAGES], im[STEIF_STAGES]; /* eigenvalue of each shift, im = 0: real */
  int row[STEIF_STAGES];                          /* first row of omega of each shift */
  const sunrealtype *B, *T, *Tinv, *coupling;     /* s x s by rows */
} stf_transform;

/* Of the table's A^{-1}; everything is allocated from the pool. */
int stf_transform_build(stf_pool *pool, steif_context *ctx, const steif_table *table,
                        stf_transform *transform);
/* The same, computed even when it is kept as data. */
int stf_transform_compute(stf_pool *pool, steif_context *ctx, const steif_table *table,
                          stf_transform *transform);

/* B = A^{-1} (s x s) and w = b^T B to 64 bits, as a part of 24 bits and the rest: a product with
 * either is rounded anew in every step, where a rounded coefficient errs the same way in all of
 * them (E. Hairer, R. I. McLachlan and A. Razakarivony, BIT 48, 2008). */
typedef struct stf_parts {
  sunrealtype *B[2], *w[2];
} stf_parts;
int stf_transform_parts(stf_pool *pool, steif_context *ctx, const steif_table *table,
                        stf_parts *parts);

#endif
