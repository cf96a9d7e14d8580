/* lapack.h: prototypes of the LAPACK routines used. Complex arrays are interleaved; Fortran passes
 * the length of a character argument last.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LAPACK_H
#define STF_LAPACK_H

#include <stddef.h>

void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
void zgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *ipiv, double *b, const int *ldb, int *info, size_t trans_length);
void zgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *ipiv, double *b, const int *ldb, int *info, size_t trans_length);

void dgbtrf_(const int *m, const int *n, const int *kl, const int *ku, double *ab,
             const int *ldab, int *ipiv, int *info);
void zgbtrf_(const int *m, const int *n, const int *kl, const int *ku, double *ab,
             const int *ldab, int *ipiv, int *info);
void dgbtrs_(const char *trans, const int *n, const int *kl, const int *ku, const int *nrhs,
             const double *ab, const int *ldab, const int *ipiv, double *b, const int *ldb,
             int *info, size_t trans_length);
void zgbtrs_(const char *trans, const int *n, const int *kl, const int *ku, const int *nrhs,
             const double *ab, const int *ldab, const int *ipiv, double *b, const int *ldb,
             int *info, size_t trans_length);

#endif
