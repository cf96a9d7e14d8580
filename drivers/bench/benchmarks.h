/* benchmarks.h: the benchmarks by name, and what their reports share.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef BENCHMARKS_H
#define BENCHMARKS_H

#include "members.h"
#include "program.h"
#include <stdio.h>

/* Each returns an exit code. */
int bench_step(struct call *call);
int bench_cost_accounting(struct call *call);
int bench_lyapunov(struct call *call);
int bench_model(struct call *call);
int bench_workprec(struct call *call);
int bench_success(struct call *call);
int bench_certificates(struct call *call);
int bench_verdicts(struct call *call);
int bench_impulse(struct call *call);
int bench_phi(struct call *call);
int bench_lorenz(struct call *call);
int bench_scale(struct call *call);
int bench_sensitivity(struct call *call);

/* Benchmarks look at interrupted() between rows and write rows as they come. At the end of the plan: the report,
 * freed, or why it stopped; after an interruption what there is. */
int bench_present(struct call *call, steif_report **r);
/* A sentence where the benchmark was interrupted; the exit code, else `code`. */
int bench_end(struct call *call, int code);

/* The answer of the first Python that has SciPy to a script with one argument, for pclose;
 * scipy_missing says what to do where there is none. */
FILE *scipy_ask(const char *script, const char *argument);
void scipy_missing(struct call *call, const char *column);

#endif
