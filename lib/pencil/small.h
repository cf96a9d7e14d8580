/* small.h: LU of small dense matrices without a library call.
 *
 * Columns one after another (entry i + n j), complex ones as two arrays. The factors replace the
 * matrix, with the reciprocals of the pivots on the diagonal; perm[i] is the row that became row i.
 * A factorisation returns 0, or k when the pivot of column k (from 1) vanished.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SMALL_H
#define STF_SMALL_H

enum { STF_SMALL = 16, STF_SMALL_PAD = 3 }; /* PAD: numbers behind real factors that are read */

int stf_small_factor(int n, double *a, int *perm);
void stf_small_solve(int n, const double *lu, const int *perm, double *b);
int stf_small_zfactor(int n, double *re, double *im, int *perm);
void stf_small_zsolve(int n, const double *re, const double *im, const int *perm, double *br,
                      double *bi);

/* medium.c: the same of real ones for 8 < n <= 16. */
int stf_medium_factor(int n, double *a, int *perm);
void stf_medium_solve(int n, const double *lu, const int *perm, double *b);

#endif
