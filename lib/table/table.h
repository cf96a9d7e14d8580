/* table.h: the table room inside: shelf, nodes, differentiation, splits.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_TABLE_H
#define STF_TABLE_H

#include "base.h"
#include <steif/table.h>

typedef struct stf_table_entry {
  const char *name;
  const steif_table *item;
} stf_table_entry;
extern const stf_table_entry stf_table_shelf[];
extern const size_t stf_table_count;

/* From a parsed spec. */
steif_table *stf_table_build(steif_context *ctx, const steif_spec *spec);

/* Nodes of collocation on [0, 1], ascending, to the last bit of double (computed in long double):
 * Gauss (roots of P_s), Radau right (c_s = 1), Radau left (c_1 = 0), Lobatto (both). */
enum stf_node_kind { STF_GAUSS, STF_RADAU_RIGHT, STF_RADAU_LEFT, STF_LOBATTO };
int stf_nodes(steif_context *ctx, enum stf_node_kind kind, int s, long double *c);

/* Values and derivatives at x of the Lagrange basis on count distinct points. */
void stf_lagrange(int count, const long double *points, long double x, long double *value,
                  long double *slope);

/* The split of B = A^{-1} (s x s) into independent shifts. Lanes are ordered: the real eigenvalue
 * first (if s is odd), then one lane per conjugate pair. With the s x s real matrices T, Tinv
 *     omega = Tinv Z,   Z = T omega,
 * omega holds one row per real lane and two rows (real, imaginary) per pair, in lane order.
 *  - eigen split (coupling NULL): B maps to the lanes' eigenvalues, a pair acting as the complex
 *    number lambda on omega_re + i omega_im;
 *  - Schur split (s > STF_EIGEN_STAGES): the same with strictly upper coupling S between lanes:
 *    (T^{-1} B T) = blockdiag(lambda) + S, S s x s by rows. */
enum { STF_EIGEN_STAGES = 11 };
typedef struct stf_split {
  int s, lanes;
  sunrealtype re[STEIF_STAGES], im[STEIF_STAGES]; /* eigenvalue of each lane, im = 0: real */
  int row[STEIF_STAGES];                          /* first row of omega of each lane */
  const sunrealtype *B, *T, *Tinv, *coupling;     /* s x s by rows */
} stf_split;

/* Split of the table's A^{-1}; everything is claimed from the pool. */
int stf_split_build(stf_pool *pool, steif_context *ctx, const steif_table *table,
                    stf_split *split);

#endif
