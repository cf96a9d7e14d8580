/* over_ranks.h: the program steif-mpi, which steif with --parallel becomes.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef OVER_RANKS_H
#define OVER_RANKS_H

#include <stdbool.h>
#include <steif/mpi.h>

/* Exit codes are those of steif. */
enum { FINE, FAILED, USAGE, FILES, UNSOLVABLE };
enum { METHODS = 16, TOLERANCES = 16 };

typedef struct request {
  const char *verb, *problem, *method[METHODS], *linear;
  int methods, tolerances;
  double rtol[TOLERANCES], atol, h, t1;
  bool json;
  int rank, ranks;
} request;

/* A sentence of rank 0; USAGE. */
int object(const request *r, const char *format, ...);
/* From the words of the program. */
int request_read(request *r, int argc, char **argv);
int exit_of_code(int code);

/* One run and what it has cost: `sums` over the ranks outside of preconditioners; seconds of the processor, the most
 * of all ranks: all, in setups, in cycles or solves. */
typedef struct ranks_run {
  int code;
  steif_stats stats;
  steif_mpi_stats linear;
  long sums;
  double seconds, setup_seconds, cycle_seconds;
  double error; /* the largest difference from the truth, NaN where it is not known */
} ranks_run;
/* Truth: at the end, NULL: the closed solution, if there is one. The solution comes into `end`, if that is not NULL. */
void run_over_ranks(steif_context *ctx, const steif_problem *p, N_Vector like,
                    const char *linear, const char *method, const steif_options *options,
                    N_Vector truth, N_Vector end, ranks_run *out);

/* y in the order of one process, as a line of a table or a member of a JSON object; called by all ranks. */
void show_solution(const request *r, const steif_problem *p, N_Vector y);
int solve_over_ranks(const request *r);
int compare_over_ranks(const request *r);
int sweep_over_ranks(int argc, char **argv);
/* The verbs whose analyses ranks share. */
bool team_verb(const char *name);
int team_over_ranks(const request *r, int argc, char **argv);

#endif
