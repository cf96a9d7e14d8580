/* ranks_run.c: one integration over ranks, and what its linear systems have cost: sums and seconds within
 * preconditioners are told from the others.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "over_ranks.h"
#include <math.h>
#include <steif/extension.h>
#include <string.h>
#include <time.h>

/* What goes on in this process now. */
static struct {
  const steif_problem *inner; /* whose preconditioners are timed */
  bool within;
  long sums;
  double setup, cycle;
} now;

/* The profiling interface of MPI: all sums of vectors, steps and preconditioners come here. */
int MPI_Allreduce(const void *from, void *to, int count, MPI_Datatype type, MPI_Op op,
                  MPI_Comm comm)
{
  now.sums += !now.within;
  return PMPI_Allreduce(from, to, count, type, op, comm);
}

static double processor(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double enter(void)
{
  now.within = true;
  return processor();
}

static void leave(double *spent, double since)
{
  *spent += processor() - since;
  now.within = false;
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  const double since = enter();
  const int code = now.inner->precsetup(t, y, yp, r, c, user);
  leave(&now.setup, since);
  return code;
}

static int cycle(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  const double since = enter();
  const int code = now.inner->precsolve(t, y, yp, r, b, z, c, delta, user);
  leave(&now.cycle, since);
  return code;
}

static int cycle_pair(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector *b,
                      N_Vector *z, sunrealtype re, sunrealtype im, sunrealtype delta,
                      void *user)
{
  const double since = enter();
  const int code = now.inner->precsolve_pair(t, y, yp, r, b, z, re, im, delta, user);
  leave(&now.cycle, since);
  return code;
}

static double most(double own)
{
  PMPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return own;
}

/* Sums come first: all ranks take part. */
static void compare(const steif_problem *p, N_Vector y, N_Vector truth, ranks_run *out)
{
  N_Vector off = truth || p->exact ? N_VClone(y) : NULL;
  if (!off) return;
  const bool known = truth || !p->exact(p->t1, off, NULL, p->user);
  if (known) {
    N_VLinearSum(1, y, -1, truth ? truth : off, off);
    out->error = N_VMaxNorm(off);
  }
  N_VDestroy(off);
}

/* GMRES alone, of y' = f: no matrix is made. */
static int without_matrices(steif_context *ctx, const steif_problem *p, steif_problem *to)
{
  if (!p->f || p->E || p->Ev)
    return steif_fail(ctx, STEIF_UNSUPPORTED,
                      "--linear krylov serves y' = f, and '%s' is another form: take mumps",
                      p->name);
  *to = *p;
  to->storage = STEIF_KRYLOV;
  to->jac = NULL, to->A = to->L = NULL, to->pattern = NULL;
  to->nnz = 0;
  return STEIF_OK;
}

/* With a solver over ranks in *m, whose preconditioner is timed. */
static int with_matrices(steif_context *ctx, const steif_problem *p, const char *linear,
                         N_Vector like, steif_mpi **m, steif_problem *to)
{
  if (!(*m = steif_mpi_open(ctx, p, linear, like))) return steif_status(ctx);
  now.inner = steif_mpi_problem(*m);
  *to = *now.inner;
  to->precsetup = setup, to->precsolve = cycle;
  if (to->precsolve_pair) to->precsolve_pair = cycle_pair;
  return STEIF_OK;
}

void run_over_ranks(steif_context *ctx, const steif_problem *p, N_Vector like,
                    const char *linear, const char *method, const steif_options *options,
                    N_Vector truth, N_Vector end, ranks_run *out)
{
  *out = (ranks_run){.error = NAN};
  steif_mpi *m = NULL;
  steif_problem own;
  const int opened = strcmp(linear, "krylov") ? with_matrices(ctx, p, linear, like, &m, &own)
                                              : without_matrices(ctx, p, &own);
  now.sums = 0, now.setup = now.cycle = 0;
  const double since = processor();
  steif_solver *s = opened ? NULL : steif_solver_new(ctx, &own, method, options);
  out->code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (s) {
    out->sums = now.sums;
    out->seconds = most(processor() - since);
    out->setup_seconds = most(now.setup), out->cycle_seconds = most(now.cycle);
    out->stats = *steif_statistics(s);
    if (m) out->linear = steif_mpi_statistics(m);
    out->linear.memory = most(out->linear.memory);
    PMPI_Allreduce(MPI_IN_PLACE, &out->linear.sent, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
    if (!out->code) compare(p, steif_solution(s), truth, out);
    if (!out->code && end) N_VScale(1, steif_solution(s), end);
  }
  steif_solver_free(&s), steif_mpi_free(&m);
}
