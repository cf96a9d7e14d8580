/* bench.h: the benchmarks by name.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef BENCH_H
#define BENCH_H

#include "face.h"

/* Each returns an exit code. */
int bench_step(struct call *call);
int bench_impulse(struct call *call);
int bench_phi(struct call *call);
int bench_workprec(struct call *call);

#endif
