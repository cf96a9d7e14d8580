/* run.h: one integration and what came of it, for the verbs that integrate.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef RUN_H
#define RUN_H

#include "face.h"

typedef struct outcome {
  int code;
  char message[1200]; /* "ok" or the sentence */
  char why[2400];     /* where a run stopped, on what components and for what cause; or "" */
  double t;
  bool known; /* there is a reference at t: scd and mescd are set */
  double scd, mescd;
  steif_stats stats;
} outcome;

/* Integrate to options->t1 (the problem's when 0), the start shown to options->observe first. The solver is kept in *solver unless that is
 * NULL; it may be NULL afterwards when it could not be made. The context's message is forgotten. */
outcome integrate(steif_context *ctx, const steif_problem *problem, const char *method,
                  const steif_options *options, steif_solver **solver);

/* Under `prefix` ("rows." or ""): scd, mescd; status, message; with stats_prefix: the counts. */
void report_digits(steif_report *r, const char *prefix, const outcome *o);
void report_status(steif_report *r, const char *prefix, const outcome *o);
void report_stats(steif_report *r, const char *prefix, const outcome *o);
/* A row of the sheet "rows": method, rtol, atol, h, digits, status, counts. */
void report_run(steif_report *r, const char *method, const steif_problem *problem,
                const steif_options *options, const outcome *o);

/* "null" unless the number is meant. */
void report_maybe(steif_report *r, const char *prefix, const char *key, bool there,
                  double value);

/* The accepted steps of a run, or its solution at the times asked for, and its events. */
typedef struct trajectory {
  const struct call *call;
  const steif_problem *problem;
  size_t n, count, room;
  double t0, t1, *t, *y; /* y by rows, n values each */
  size_t asked, next;    /* times asked for, those kept already; 0: every step is kept */
  double *at;
  N_Vector between; /* the solution at one of them */
  size_t events, event_room;
  double *event_t, *event_which, *event_direction; /* one row per function that fired */
  size_t *event_number; /* 0-based: functions that fire together have one number */
  size_t happened;
  bool short_of_memory, live;
  double shown; /* when the progress line was written */
  steif_report *report; /* takes jumps as they come; NULL: they are not kept */
} trajectory;
/* EXIT_OK, or an exit code after a sentence about --at. Observers are set in *options. */
int trajectory_open(struct call *call, const steif_problem *problem, steif_options *options,
                    trajectory *tr);
/* One more row; nonzero when memory is short. */
int trajectory_keep(trajectory *tr, double t, N_Vector y);
void trajectory_free(trajectory *tr);
int trajectory_save(const struct call *call, const trajectory *tr);
int trajectory_plot(const struct call *call, const trajectory *tr, const char *title);
/* Sheets "output" (times asked for) and "events" (--events); jumps are there already. */
void trajectory_fill(steif_report *r, const trajectory *tr);

/* Was a run stopped by SIGINT? */
bool interrupted(void);

/* --rtol, --atol, --h, --t1, --start, --storage where given. */
steif_options options_of(const struct call *call);
/* The option lines that options_of reads, for the tables of the verbs. */
#define RUN_OPTIONS                                                                            \
  {"--t1", POSITIVE, "T", "end of the integration (default: the problem's)"},                  \
    {"--h0", POSITIVE, "H", "first chosen step (default: automatic)"},                         \
    {"--h-max", POSITIVE, "H", "largest chosen step (default: none)"},                         \
    {"--start", WORD, "S",                                                                     \
     "starting procedure of multistep methods: exact, ramp, constant, cq"},                    \
    {"--max-steps", COUNT, "N", "give up after N steps (default 1000000; --h: 1000000000)"},   \
    {"--max-seconds", POSITIVE, "S", "give up after S seconds by the clock"},                  \
  {                                                                                            \
    "--storage", CHOICE, "dense|band|sparse|krylov",                                           \
      "of the matrices; krylov: GMRES, no factors"                                             \
  }

#endif
