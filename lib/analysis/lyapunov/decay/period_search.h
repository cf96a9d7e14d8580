/* period_search.h: the period of A(t), found or tested. SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_PERIOD_SEARCH_H
#define STF_PERIOD_SEARCH_H

#include "variation.h"

/* Of A(t) in E x' = A(t) x on [t0, t1]: the shortest that is seen, from h/64 to a third of the run; 0: none,
 * or A is constant or not known everywhere. stop may be NULL. off: the largest difference of entries
 * that passed for rounding. */
int stf_period_search(stf_pool *pool, stf_variation *v, sunrealtype h, sunrealtype t1,
                      const volatile int *stop, sunrealtype *period, sunrealtype *off);
/* STEIF_BAD_INPUT where A(t + period) is not A(t). */
int stf_period_tested(stf_variation *v, sunrealtype t1, sunrealtype period);

#endif
