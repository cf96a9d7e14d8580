/* steif_mpi.c: the program steif-mpi, which `steif solve ... --parallel` becomes: one integration over ranks. Rank 0
 * prints; exit codes are those of steif, the same on all ranks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <steif/mpi.h>
#include <string.h>

enum { FINE, FAILED, USAGE, SINGULAR = 4 };

typedef struct request {
  const char *problem, *method, *linear;
  double rtol, atol, h, t1;
  bool json;
  int rank, ranks;
} request;

static int refuse(const request *r, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  if (r->rank == 0) {
    fputs("steif solve --parallel: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
  }
  va_end(list);
  return USAGE;
}

static int read_option(request *r, int argc, char **argv, int *i)
{
  const struct {
    const char *name;
    double *value;
  } numbers[] = {{"--rtol", &r->rtol}, {"--atol", &r->atol}, {"--h", &r->h}, {"--t1", &r->t1}};
  const char *word = argv[*i];
  if (!strcmp(word, "--parallel")) return FINE;
  if (!strcmp(word, "--json")) return r->json = true, FINE;
  for (int k = 0; k < 4; k++)
    if (!strcmp(word, numbers[k].name)) {
      char *end = NULL;
      const char *text = ++*i < argc ? argv[*i] : "";
      *numbers[k].value = strtod(text, &end);
      if (end > text && *end == 0 && *numbers[k].value > 0 && isfinite(*numbers[k].value))
        return FINE;
      return refuse(r, "%s needs a positive number, not \"%s\" [STEIF_BAD_INPUT]", word, text);
    }
  if (!strcmp(word, "--linear") && *i + 1 < argc) return r->linear = argv[++*i], FINE;
  return refuse(r,
                "no option %s here; there are --rtol, --atol, --h, --t1, --linear amg|mumps, "
                "--json [STEIF_UNKNOWN_NAME]",
                word);
}

static int read_words(request *r, int argc, char **argv)
{
  if (argc < 2 || strcmp(argv[1], "solve"))
    return refuse(r, "only the verb solve runs over ranks [STEIF_UNSUPPORTED]");
  for (int i = 2; i < argc; i++) {
    if (argv[i][0] == '-') {
      const int code = read_option(r, argc, argv, &i);
      if (code) return code;
    } else if (!r->problem)
      r->problem = argv[i];
    else if (!r->method)
      r->method = argv[i];
    else
      return refuse(r, "\"%s\" is one word too many [STEIF_BAD_INPUT]", argv[i]);
  }
  return r->method ? FINE
                   : refuse(r, "steif solve PROBLEM METHOD --parallel [STEIF_BAD_INPUT]");
}

static int exit_of(int code)
{
  switch (code) {
  case STEIF_OK: return FINE;
  case STEIF_BAD_INPUT:
  case STEIF_UNKNOWN_NAME:
  case STEIF_UNSUPPORTED: return USAGE;
  case STEIF_SINGULAR: return SINGULAR;
  default: return FAILED;
  }
}

/* The greatest difference from the closed solution, NaN where there is none. */
static double error_of(const steif_problem *p, N_Vector y)
{
  double error = NAN;
  N_Vector truth = p->exact ? N_VClone(y) : NULL;
  if (!truth) return error;
  if (!p->exact(p->t1, truth, NULL, p->user)) {
    N_VLinearSum(1, y, -1, truth, truth);
    error = N_VMaxNorm(truth);
  }
  N_VDestroy(truth);
  return error;
}

/* Sums over ranks come first: all of them take part. */
static void present(const request *r, const steif_problem *p, steif_solver *s,
                    steif_mpi_stats own)
{
  const double error = error_of(p, steif_solution(s));
  const steif_stats *stats = steif_statistics(s);
  long long sent = own.sent;
  MPI_Allreduce(MPI_IN_PLACE, &sent, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(MPI_IN_PLACE, &own.memory, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  if (r->rank) return;
  char known[64] = "null";
  if (isfinite(error)) snprintf(known, sizeof known, "%.3e", error);
  printf(
    r->json
      ? "{\"problem\": \"%s\", \"method\": \"%s\", \"linear\": \"%s\", \"ranks\": %d, "
        "\"unknowns\": %lld, \"steps\": %ld, \"setups\": %ld, \"solves\": %ld, "
        "\"halo_bytes\": %lld, \"factor_megabytes\": %g, \"error\": %s}\n"
      : "%s with %s, linear systems by %s\nranks      %d\nunknowns   %lld\nsteps      %ld\n"
        "setups     %ld\nsolves     %ld\nhalo bytes %lld\nfactors MB %g a rank at most\n"
        "error      %s\n",
    r->problem, r->method, r->linear, r->ranks, (long long)p->n, stats->steps, own.setups,
    own.solves, sent, own.memory, known);
}

static int integrate(const request *r, steif_context *ctx, steif_problem *p, N_Vector like)
{
  steif_options o = steif_defaults();
  if (r->rtol > 0) o.rtol = r->rtol;
  if (r->atol > 0) o.atol = r->atol;
  if (r->h > 0) o.h = r->h;
  if (r->t1 > 0) p->t1 = r->t1;
  o.like = like;
  steif_mpi *m = steif_mpi_open(ctx, p, r->linear, like);
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), r->method, &o) : NULL;
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code == STEIF_OK) present(r, p, s, steif_mpi_statistics(m));
  steif_solver_free(&s), steif_mpi_free(&m);
  return code;
}

static int solve(const request *r)
{
  N_Vector like = NULL;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, r->problem, MPI_COMM_WORLD, &like);
  const int code = p ? integrate(r, ctx, p, like) : steif_status(ctx);
  if (code && r->rank == 0) fprintf(stderr, "steif solve --parallel: %s\n", steif_message(ctx));
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
  return exit_of(code);
}

int main(int argc, char **argv)
{
  request r = {.linear = "amg"};
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &r.rank), MPI_Comm_size(MPI_COMM_WORLD, &r.ranks);
  int code = read_words(&r, argc, argv);
  if (!code) code = solve(&r);
  MPI_Finalize();
  return code;
}
