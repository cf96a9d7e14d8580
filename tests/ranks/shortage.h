/* shortage.h: the k-th allocation fails on one rank.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SHORTAGE_H
#define SHORTAGE_H

#include <steif/mpi.h>

/* 1: it failed and all is right, 0: there were fewer, -1: wrong. `here`: on this rank; differences: A by those of f, for
 * problems of 16 unknowns. */
int shortage_at(const char *name, const char *spec, int differences, int k, int here,
                int *code);

#endif
