/* shortage.h: the k-th allocation fails on one rank.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SHORTAGE_H
#define SHORTAGE_H

#include <steif/mpi.h>

/* 1: it failed and all is right, 0: there were fewer, -1: wrong. `here`: on this rank. */
int shortage_at(const char *name, const char *spec, int k, int here, int *code,
                int (*same)(steif_context *));

#endif
