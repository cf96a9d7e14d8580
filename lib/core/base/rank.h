/* rank.h: the number of this rank in the communicator of a vector, for sentences.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_RANK_H
#define STF_RANK_H

#include <sundials/sundials_nvector.h>

/* Of a vector that is spread over ranks; -1: not known. Without a sum. */
int stf_own_rank(N_Vector like);

#endif
