/* test_function.h: test functions of weak convergence, from an expression in t or a family.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef TEST_FUNCTION_H
#define TEST_FUNCTION_H

#include "program.h"

struct test_function {
  char text[512]; /* the expression */
  steif_function *f;
  double from, to;     /* 0 outside */
  steif_weight weight; /* to be asked for */
};

/* "power:n=8", "bump", "bump:c=C,w=W", "expcos:a=1,b=5", "hermite:n=N,scale=S" or an expression on [0, t1];
 * t1 0: 1, or where a family has become 0. EXIT_OK, or an exit code after a sentence. It stays where it
 * is until it is closed. */
int test_function_open(struct call *call, const char *words, double t1,
                       struct test_function *g);
void test_function_close(struct test_function *g);

#endif
