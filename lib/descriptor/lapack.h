/* lapack.h: prototypes of the LAPACK and BLAS routines of the dense analysis. Fortran passes
 * the lengths of character arguments last; its logical is an int.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_DESCRIPTOR_LAPACK_H
#define STF_DESCRIPTOR_LAPACK_H

#include <stddef.h>

void dgemm_(const char *transa, const char *transb, const int *m, const int *n, const int *k,
            const double *alpha, const double *a, const int *lda, const double *b,
            const int *ldb, const double *beta, double *c, const int *ldc, size_t transa_length,
            size_t transb_length);

void dgesdd_(const char *jobz, const int *m, const int *n, double *a, const int *lda, double *s,
             double *u, const int *ldu, double *vt, const int *ldvt, double *work,
             const int *lwork, int *iwork, int *info, size_t jobz_length);
void dgeqrf_(const int *m, const int *n, double *a, const int *lda, double *tau, double *work,
             const int *lwork, int *info);
void dormqr_(const char *side, const char *trans, const int *m, const int *n, const int *k,
             const double *a, const int *lda, const double *tau, double *c, const int *ldc,
             double *work, const int *lwork, int *info, size_t side_length,
             size_t trans_length);

void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
void zgetrf_(const int *m, const int *n, void *a, const int *lda, int *ipiv, int *info);
void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *ipiv, double *b, const int *ldb, int *info, size_t trans_length);
void dgecon_(const char *norm, const int *n, const double *a, const int *lda,
             const double *anorm, double *rcond, double *work, int *iwork, int *info,
             size_t norm_length);

void dgges_(const char *jobvsl, const char *jobvsr, const char *sort,
            int (*select)(const double *, const double *, const double *), const int *n,
            double *a, const int *lda, double *b, const int *ldb, int *sdim, double *alphar,
            double *alphai, double *beta, double *vsl, const int *ldvsl, double *vsr,
            const int *ldvsr, double *work, const int *lwork, int *bwork, int *info,
            size_t jobvsl_length, size_t jobvsr_length, size_t sort_length);
void dtgsen_(const int *ijob, const int *wantq, const int *wantz, const int *select,
             const int *n, double *a, const int *lda, double *b, const int *ldb, double *alphar,
             double *alphai, double *beta, double *q, const int *ldq, double *z, const int *ldz,
             int *m, double *pl, double *pr, double *dif, double *work, const int *lwork,
             int *iwork, const int *liwork, int *info);
void dtgsyl_(const char *trans, const int *ijob, const int *m, const int *n, const double *a,
             const int *lda, const double *b, const int *ldb, double *c, const int *ldc,
             const double *d, const int *ldd, const double *e, const int *lde, double *f,
             const int *ldf, double *scale, double *dif, double *work, const int *lwork,
             int *iwork, int *info, size_t trans_length);

#endif
