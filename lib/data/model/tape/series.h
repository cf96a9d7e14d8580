/* series.h: derivatives in t of nodes without unknowns.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_MODEL_SERIES_H
#define STF_MODEL_SERIES_H

#include "tape.h"

/* The derivative of the given order of `root` at feed->t; STEIF_RETRY: it is
 * not known there. */
int stf_taylor(const stf_graph *g, int32_t root, const stf_feed *feed, const int32_t *counter,
               int order, stf_sweep *sweep, double *value);

#endif
