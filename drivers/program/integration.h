/* integration.h: one integration and what came of it, for the verbs that integrate.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef INTEGRATION_H
#define INTEGRATION_H

#include "problem.h"

typedef struct outcome {
  int code;
  char message[1200]; /* "ok" or the sentence */
  char why[2400];     /* where a run stopped, on what components and for what cause; or "" */
  double t;
  bool known; /* there is a reference at t: scd and mescd are set */
  double scd, mescd;
  steif_stats stats;
} outcome;

/* Rows of an option table that options_of reads, besides --rtol, --atol and --h. */
/* clang-format off */
#define SET_OPTION                                                                             \
  {"--set", REPEATED, "NAME=VALUE,...",                                                        \
   "values of parameters: what a colon takes, and what sweep --p takes", NULL}
#define PARALLEL_OPTION(about)                                                                 \
  {"--parallel", FLAG, NULL, about, NULL}
#define RANKS_OPTIONS                                                                          \
  PARALLEL_OPTION("over ranks, with mpirun -np N: --rtol --atol --h --t1 --linear --json alone"), \
    {"--linear", WORD, "NAME", "with --parallel: amg, mumps or krylov", "amg"}
#define RUN_OPTIONS                                                                            \
  SET_OPTION,                                                                                  \
  {"--compile", FLAG, NULL,                                                                    \
   "a model by the C compiler STEIF_CC (else CC, cc), kept in the cache folder of the user", NULL},   \
  INTERPRETED_OPTIONS
#define INTERPRETED_OPTIONS                                                                    \
  {"--t1", POSITIVE, "T", "end of the integration (default: the problem's)", NULL},            \
  {"--h0", POSITIVE, "H", "first step of an adaptive step size (default: automatic)", NULL},   \
  {"--h-max", POSITIVE, "H", "largest step of an adaptive step size (default: none)", NULL},   \
  {"--start", WORD, "S",                                                                       \
   "starting procedure of multistep methods: exact, ramp, constant, cq", NULL},                \
  {"--initial", CHOICE, "repair|check|given",                                                  \
   "an inconsistent start of a DAE: moved to the nearest consistent one (linear: by its jump), an error, or kept",   \
   NULL},                                                                                      \
  {"--max-steps", COUNT, "N",                                                                  \
   "give up after N steps (default: 1000000; with --h: 1000000000)", NULL},                     \
  {"--max-seconds", POSITIVE, "S", "give up after S seconds of wall-clock time", NULL},        \
  {"--storage", CHOICE, "dense|band|sparse|krylov",                                            \
   "storage of the matrices; krylov: GMRES, no factors", NULL}
/* clang-format on */

/* The options of a solver from those of a call, where given. A signal ends the run after a step. */
steif_options options_of(const struct call *call);

/* Integrate to options->t1 (the problem's when 0), the start shown to options->observe first. The
 * solver is kept in *solver unless `solver` is NULL; one that is there goes on, else a new one is made, NULL
 * afterwards when that could not be.
 * The context's message is forgotten. */
outcome integrate(steif_context *ctx, const steif_problem *problem, const char *method,
                  const steif_options *options, steif_solver **solver);
/* The same; begun is told of the solver at the start, as the method has made it, and a run that fails is not
 * explained. */
outcome integrate_from(steif_context *ctx, const steif_problem *problem, const char *method,
                       const steif_options *options, steif_solver **solver,
                       void (*begun)(steif_solver *s, void *user), void *user);

/* atol/rtol of a run: how much of the size of a component counts as nothing. */
double tolerance_ratio(const steif_problem *problem, const steif_options *options);

/* Constant steps h from t0, the last one last_h long, to `end`; the end asked for. Reported as h, end, last_h
 * and, where h does not divide the interval, a sentence: grid. */
struct steps_made {
  double t0, h, end, last_h, asked;
  long steps; /* 0: those that end at `end` */
};
void report_steps(steif_report *r, const struct steps_made *m);

/* Under `prefix` ("rows." or ""): scd, mescd; status, message; the counts. */
void report_digits(steif_report *r, const char *prefix, const outcome *o);
void report_status(steif_report *r, const char *prefix, const outcome *o);
void report_stats(steif_report *r, const char *prefix, const outcome *o);
/* A row of the sheet "rows": method, rtol, atol, h, digits, status, counts. */
void report_run(steif_report *r, const char *method, const steif_problem *problem,
                const steif_options *options, const outcome *o);

#endif
