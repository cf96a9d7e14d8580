/* fill_order.h: orders of elimination with little fill, and what an LU costs in them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_ORDER_H
#define STF_ORDER_H

#include <SuiteSparse_config.h>
#include <sundials/sundials_types.h>

/* An order for the symmetric pattern (ptr, row) without its diagonal: nested dissection of
 * large ones where CHOLMOD has METIS, else approximate minimum degree. STEIF_OK or
 * STEIF_NO_MEMORY. */
int stf_fill_order(sunindextype n, SuiteSparse_long *ptr, SuiteSparse_long *row,
                   SuiteSparse_long *order);

/* The order of a diagonal block that KLU asks for, any pattern: nested dissection of the
 * symmetric closure. 1, or 0 where it is not to be had. */
struct klu_l_common_struct;
SuiteSparse_long stf_fill_order_block(SuiteSparse_long n, SuiteSparse_long *ptr,
                                      SuiteSparse_long *row, SuiteSparse_long *order,
                                      struct klu_l_common_struct *common);

/* Flops of an LU by minimum degree on any pattern, and entries of its factors: their quotient is how
 * many solves one factorisation costs, up to a factor. Negative: not known. */
double stf_fill_work(sunindextype n, const sunindextype *column, const sunindextype *row,
                     double *entries);

#endif
