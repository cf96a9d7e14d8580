/* jacobi_svd.h: A = U diag(sigma) V^T.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_JACOBI_SVD_H
#define STF_JACOBI_SVD_H

#include <steif/base.h>

/* A is m x P by columns and becomes U diag(sigma); sigma descending; row k of V (P x P by rows) is the right
 * singular vector of sigma[k]. */
void stf_jacobi_svd(size_t m, size_t P, sunrealtype *A, sunrealtype *sigma, sunrealtype *V);

#endif
