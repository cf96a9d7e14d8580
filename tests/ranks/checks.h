/* checks.h: what holds on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CHECKS_H
#define CHECKS_H

#include <steif/mpi.h>

extern int failures, rank, ranks;

/* True on all ranks? Else rank 0 prints it, and the program fails. */
int everywhere(int condition, const char *text, const char *file, int line);
#define ALL(condition) everywhere(condition, #condition, __FILE__, __LINE__)

/* The same code and sentence on all ranks? */
int same(steif_context *ctx);

void test_differences(void);
void test_hard_systems(void);
void test_index_two(void);
void test_one_rank_short(void);
void test_passed_on(void);
void test_singular_pencils(void);

#endif
