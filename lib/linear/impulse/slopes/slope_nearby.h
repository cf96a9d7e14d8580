/* slope_nearby.h: whether the structure at p is that of almost all p.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SLOPE_NEARBY_H
#define STF_SLOPE_NEARBY_H

#include "doubled.h"

/* An approach to p from both sides. */
typedef struct stf_approach {
  steif_context *ctx;
  const steif_linear *system;
  const steif_impulse_direction *direction;
  const steif_analysis *analysis;
  int index; /* at p, as the next */
  sunindextype finite;
  sunrealtype unit; /* of steps along a straight line */
} stf_approach;

typedef enum stf_neighbours { STF_OPEN, STF_STAYS, STF_GROWS } stf_neighbours;

/* Of the pencil nearby that decided; -1: none. */
typedef struct stf_neighbour {
  stf_neighbours verdict;
  int index;
  sunindextype finite;
} stf_neighbour;

int stf_approach_look(const stf_approach *a, stf_neighbour *found);

#endif
