/* lapack.h: prototypes of all BLAS and LAPACK routines in use. Matrices are stored by columns; complex
 * numbers are pairs (re, im). Fortran takes the length of each character argument as an argument
 * after the last, and its logical is an int.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LAPACK_H
#define STF_LAPACK_H

#include <stddef.h>

/* --- products --- */
void dgemm_(const char *transa, const char *transb, const int *m, const int *n, const int *k,
            const double *alpha, const double *a, const int *lda, const double *b,
            const int *ldb, const double *beta, double *c, const int *ldc, size_t, size_t);
void zgemm_(const char *transa, const char *transb, const int *m, const int *n, const int *k,
            const void *alpha, const void *a, const int *lda, const void *b, const int *ldb,
            const void *beta, void *c, const int *ldc, size_t, size_t);
void dgemv_(const char *trans, const int *m, const int *n, const double *alpha, const double *a,
            const int *lda, const double *x, const int *incx, const double *beta, double *y,
            const int *incy, size_t);
void dsyrk_(const char *uplo, const char *trans, const int *n, const int *k,
            const double *alpha, const double *a, const int *lda, const double *beta, double *c,
            const int *ldc, size_t, size_t);

/* --- linear systems: general, band, triangular, Cholesky, Sylvester --- */
void dgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
void zgetrf_(const int *m, const int *n, double *a, const int *lda, int *ipiv, int *info);
void dgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *ipiv, double *b, const int *ldb, int *info, size_t);
void zgetrs_(const char *trans, const int *n, const int *nrhs, const double *a, const int *lda,
             const int *ipiv, double *b, const int *ldb, int *info, size_t);
void dgesv_(const int *n, const int *nrhs, double *a, const int *lda, int *ipiv, double *b,
            const int *ldb, int *info);
void zgesv_(const int *n, const int *nrhs, void *a, const int *lda, int *ipiv, void *b,
            const int *ldb, int *info);
void dgbtrf_(const int *m, const int *n, const int *kl, const int *ku, double *ab,
             const int *ldab, int *ipiv, int *info);
void zgbtrf_(const int *m, const int *n, const int *kl, const int *ku, double *ab,
             const int *ldab, int *ipiv, int *info);
void dgbtrs_(const char *trans, const int *n, const int *kl, const int *ku, const int *nrhs,
             const double *ab, const int *ldab, const int *ipiv, double *b, const int *ldb,
             int *info, size_t);
void zgbtrs_(const char *trans, const int *n, const int *kl, const int *ku, const int *nrhs,
             const double *ab, const int *ldab, const int *ipiv, double *b, const int *ldb,
             int *info, size_t);
void dtrsm_(const char *side, const char *uplo, const char *trans, const char *diag,
            const int *m, const int *n, const double *alpha, const double *a, const int *lda,
            double *b, const int *ldb, size_t, size_t, size_t, size_t);
void dpotrf_(const char *uplo, const int *n, double *a, const int *lda, int *info, size_t);
void dtgsyl_(const char *trans, const int *ijob, const int *m, const int *n, const double *a,
             const int *lda, const double *b, const int *ldb, double *c, const int *ldc,
             const double *d, const int *ldd, const double *e, const int *lde, double *f,
             const int *ldf, double *scale, double *dif, double *work, const int *lwork,
             int *iwork, int *info, size_t);
void dgecon_(const char *norm, const int *n, const double *a, const int *lda,
             const double *anorm, double *rcond, double *work, int *iwork, int *info, size_t);
void dlacn2_(const int *n, double *v, double *x, int *isgn, double *est, int *kase, int *isave);

/* --- orthogonal factors, least squares, singular values --- */
void dgeqrf_(const int *m, const int *n, double *a, const int *lda, double *tau, double *work,
             const int *lwork, int *info);
void dgelqf_(const int *m, const int *n, double *a, const int *lda, double *tau, double *work,
             const int *lwork, int *info);
void dormqr_(const char *side, const char *trans, const int *m, const int *n, const int *k,
             const double *a, const int *lda, const double *tau, double *c, const int *ldc,
             double *work, const int *lwork, int *info, size_t, size_t);
void dorgqr_(const int *m, const int *n, const int *k, double *a, const int *lda,
             const double *tau, double *work, const int *lwork, int *info);
void dgelss_(const int *m, const int *n, const int *nrhs, double *a, const int *lda, double *b,
             const int *ldb, double *s, const double *rcond, int *rank, double *work,
             const int *lwork, int *info);
void dgesdd_(const char *jobz, const int *m, const int *n, double *a, const int *lda, double *s,
             double *u, const int *ldu, double *vt, const int *ldvt, double *work,
             const int *lwork, int *iwork, int *info, size_t);
void dgesvd_(const char *jobu, const char *jobvt, const int *m, const int *n, double *a,
             const int *lda, double *s, double *u, const int *ldu, double *vt, const int *ldvt,
             double *work, const int *lwork, int *info, size_t, size_t);
void zgesvd_(const char *jobu, const char *jobvt, const int *m, const int *n, void *a,
             const int *lda, double *s, void *u, const int *ldu, void *vt, const int *ldvt,
             void *work, const int *lwork, double *rwork, int *info, size_t, size_t);

/* --- eigenvalues, Schur forms and their order --- */
void dgebal_(const char *job, const int *n, double *a, const int *lda, int *ilo, int *ihi,
             double *scale, int *info, size_t);
void dgeev_(const char *jobvl, const char *jobvr, const int *n, double *a, const int *lda,
            double *wr, double *wi, double *vl, const int *ldvl, double *vr, const int *ldvr,
            double *work, const int *lwork, int *info, size_t, size_t);
void dggev_(const char *jobvl, const char *jobvr, const int *n, double *a, const int *lda,
            double *b, const int *ldb, double *alphar, double *alphai, double *beta, double *vl,
            const int *ldvl, double *vr, const int *ldvr, double *work, const int *lwork,
            int *info, size_t, size_t);
void zgeev_(const char *jobvl, const char *jobvr, const int *n, void *a, const int *lda,
            void *w, void *vl, const int *ldvl, void *vr, const int *ldvr, void *work,
            const int *lwork, double *rwork, int *info, size_t, size_t);
void zgees_(const char *jobvs, const char *sort, int (*select)(const void *), const int *n,
            void *a, const int *lda, int *sdim, void *w, void *vs, const int *ldvs, void *work,
            const int *lwork, double *rwork, int *bwork, int *info, size_t, size_t);
void ztrexc_(const char *compq, const int *n, void *t, const int *ldt, void *q, const int *ldq,
             const int *ifst, const int *ilst, int *info, size_t);
void dgges_(const char *jobvsl, const char *jobvsr, const char *sort,
            int (*select)(const double *, const double *, const double *), const int *n,
            double *a, const int *lda, double *b, const int *ldb, int *sdim, double *alphar,
            double *alphai, double *beta, double *vsl, const int *ldvsl, double *vsr,
            const int *ldvsr, double *work, const int *lwork, int *bwork, int *info, size_t,
            size_t, size_t);
void dtgsen_(const int *ijob, const int *wantq, const int *wantz, const int *select,
             const int *n, double *a, const int *lda, double *b, const int *ldb, double *alphar,
             double *alphai, double *beta, double *q, const int *ldq, double *z, const int *ldz,
             int *m, double *pl, double *pr, double *dif, double *work, const int *lwork,
             int *iwork, const int *liwork, int *info);

/* C = A B + beta C for n x n matrices A and n x columns matrices B and C. */
static inline void stf_multiply(int n, int columns, const double *A, const double *B,
                                double beta, double *C)
{
  const double one = 1;
  dgemm_("N", "N", &n, &columns, &n, &one, A, &n, B, &n, &beta, C, &n, 1, 1);
}

#endif
