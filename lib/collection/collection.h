/* collection.h: the shelf of problems.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_COLLECTION_H
#define STF_COLLECTION_H

#include "base.h"
#include <steif/collection.h>

typedef struct stf_problem_entry {
  const char *name;
  const steif_problem *item;
} stf_problem_entry;
extern const stf_problem_entry stf_problem_shelf[];
extern const size_t stf_problem_count;

#endif
