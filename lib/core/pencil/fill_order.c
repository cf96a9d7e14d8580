/* fill_order.c: fill-reducing orders.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "fill_order.h"
#include "base.h"
#include <amd.h>
#include <cholmod.h>
#include <pthread.h>

/* From here on nested dissection saves more in the factors than it costs. */
enum { LARGE = 1500 };

#ifdef STEIF_HAVE_METIS
/* METIS draws from rand() of the C library, which it seeds at each call: the order of a pattern is one and the same
 * only while nobody else draws. */
static pthread_mutex_t alone = PTHREAD_MUTEX_INITIALIZER;

static bool metis(cholmod_sparse *A, SuiteSparse_long *order, cholmod_common *c)
{
  pthread_mutex_lock(&alone);
  const bool good = cholmod_l_metis(A, NULL, 0, 1, order, c);
  pthread_mutex_unlock(&alone);
  return good && c->status == CHOLMOD_OK;
}

static cholmod_sparse pattern(SuiteSparse_long n, SuiteSparse_long *ptr, SuiteSparse_long *row,
                              int symmetric)
{
  return (cholmod_sparse){.nrow = (size_t)n,
                          .ncol = (size_t)n,
                          .nzmax = (size_t)ptr[n],
                          .p = ptr,
                          .i = row,
                          .stype = symmetric,
                          .itype = CHOLMOD_LONG,
                          .xtype = CHOLMOD_PATTERN,
                          .dtype = CHOLMOD_DOUBLE,
                          .packed = 1};
}

static bool dissect(sunindextype n, SuiteSparse_long *ptr, SuiteSparse_long *row,
                    SuiteSparse_long *order)
{
  cholmod_common c;
  if (!cholmod_l_start(&c)) return false;
  c.print = 0;
  cholmod_sparse A = pattern(n, ptr, row, 1);
  const bool good = metis(&A, order, &c);
  cholmod_l_finish(&c);
  return good;
}

SuiteSparse_long stf_fill_order_block(SuiteSparse_long n, SuiteSparse_long *ptr,
                                      SuiteSparse_long *row, SuiteSparse_long *order,
                                      struct klu_l_common_struct *common)
{
  cholmod_common c;
  double one[2] = {1, 0};
  (void)common;
  if (!cholmod_l_start(&c)) return 0;
  c.print = 0;
  cholmod_sparse A = pattern(n, ptr, row, 0);
  cholmod_sparse *T = cholmod_l_transpose(&A, 0, &c);
  cholmod_sparse *both = T ? cholmod_l_add(&A, T, one, one, 0, 0, &c) : NULL;
  cholmod_sparse *upper = both ? cholmod_l_copy(both, 1, 0, &c) : NULL;
  const bool good = upper && metis(upper, order, &c);
  cholmod_l_free_sparse(&T, &c), cholmod_l_free_sparse(&both, &c);
  cholmod_l_free_sparse(&upper, &c);
  cholmod_l_finish(&c);
  return good;
}
#else
static bool dissect(sunindextype n, SuiteSparse_long *ptr, SuiteSparse_long *row,
                    SuiteSparse_long *order)
{
  (void)n, (void)ptr, (void)row, (void)order;
  return false;
}

SuiteSparse_long stf_fill_order_block(SuiteSparse_long n, SuiteSparse_long *ptr,
                                      SuiteSparse_long *row, SuiteSparse_long *order,
                                      struct klu_l_common_struct *common)
{
  (void)n, (void)ptr, (void)row, (void)order, (void)common;
  return 0;
}
#endif

int stf_fill_order(sunindextype n, SuiteSparse_long *ptr, SuiteSparse_long *row,
                   SuiteSparse_long *order)
{
  if (n >= LARGE && dissect(n, ptr, row, order)) return STEIF_OK;
  return amd_l_order(n, ptr, row, order, NULL, NULL) >= AMD_OK ? STEIF_OK : STEIF_NO_MEMORY;
}

#ifdef SUNDIALS_INT32_T
#define AMD_ORDER amd_order
#else
#define AMD_ORDER amd_l_order
#endif

double stf_fill_work(sunindextype n, const sunindextype *column, const sunindextype *row,
                     double *entries)
{
  double info[AMD_INFO];
  sunindextype *order = SuiteSparse_malloc((size_t)n, sizeof *order);
  const bool good = order && AMD_ORDER(n, column, row, order, NULL, info) >= AMD_OK;
  SuiteSparse_free(order);
  *entries = good ? 2 * info[AMD_LNZ] + (double)n : -1;
  return good ? info[AMD_NDIV] + 2 * info[AMD_NMULTSUBS_LU] : -1;
}
