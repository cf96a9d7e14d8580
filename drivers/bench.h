/* bench.h: the benchmarks by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef BENCH_H
#define BENCH_H

#include "face.h"
#include <stdio.h>

/* The answer of the first Python that has SciPy to a script with one argument, for pclose; scipy_missing
 * says what to do where there is none. */
FILE *scipy_ask(const char *script, const char *argument);
void scipy_missing(struct call *call, const char *column);

/* Each returns an exit code. */
int bench_step(struct call *call);
int bench_impulse(struct call *call);
int bench_lorenz(struct call *call);
int bench_phi(struct call *call);
int bench_workprec(struct call *call);

#endif
