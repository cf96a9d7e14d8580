/* parts.c: vectors of two parts on each rank (MPIManyVector), which have no array: the steps of vectors in one
 * piece.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"

#ifdef HAVE_MPIMANYVECTOR
#include "base/failing.h"
#include <math.h>
#include <nvector/nvector_mpimanyvector.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

typedef struct pieces {
  rod r;
  N_Vector whole, out; /* in one piece */
} pieces;

/* The parts one after another into the whole vector, or back. */
static void join(N_Vector v, N_Vector whole, int back)
{
  sunrealtype *at = N_VGetArrayPointer(whole);
  for (int i = 0; i < 2; i++) {
    N_Vector part = N_VGetSubvector_MPIManyVector(v, i);
    const size_t count = (size_t)N_VGetLength(part);
    sunrealtype *a = N_VGetArrayPointer(part);
    memcpy(back ? a : at, back ? at : a, count * sizeof *a);
    at += count;
  }
}

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  pieces *p = user;
  join(y, p->whole, 0);
  const int code = rod_f(t, p->whole, p->out, &p->r);
  join(out, p->out, 1);
  return code;
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  return rod_setup(t, y, yp, r, c, &((pieces *)user)->r);
}

static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  return rod_solve(t, y, yp, r, b, z, c, delta, &((pieces *)user)->r);
}

static int start(sunrealtype t, N_Vector y, N_Vector yp, void *user)
{
  pieces *p = user;
  (void)t, (void)yp;
  rod_problem(&p->r, N_VGetArrayPointer(p->whole));
  join(y, p->whole, 1);
  return 0;
}

static void run(MPI_Comm comm, const char *method)
{
  pieces p;
  sunrealtype y0[64], off = 0;
  rod_open(&p.r, comm, 40, 0);
  steif_context *ctx = steif_context_new(NULL);
  SUNContext sun = steif_sundials(ctx);
  p.whole = rod_vector(&p.r, ctx), p.out = N_VClone(p.whole);
  const sunindextype first = p.r.rows / 2;
  N_Vector part[] = {N_VNew_Serial(first, sun), N_VNew_Serial(p.r.rows - first, sun)};
  steif_problem a = rod_problem(&p.r, y0), b = a;
  b.y0 = NULL, b.start = start, b.f = f, b.precsetup = setup, b.precsolve = solve, b.user = &p;
  steif_options o = steif_defaults(), q = o;
  o.rtol = q.rtol = 1e-4, o.like = p.whole;
  q.like = N_VMake_MPIManyVector(comm, 2, part, sun);
  steif_solver *s = steif_solver_new(ctx, &a, method, &o),
               *t = steif_solver_new(ctx, &b, method, &q);
  const int code = s && t ? steif_solve_to(s, a.t1) | steif_solve_to(t, b.t1) : -1;
  if (EVERYWHERE(&p.r, code == STEIF_OK)) {
    join(steif_solution(t), p.out, 0);
    for (sunindextype i = 0; i < p.r.rows; i++)
      off = fmax(off,
                 fabs(N_VGetArrayPointer(p.out)[i] - N_VGetArrayPointer(steif_solution(s))[i]));
    EVERYWHERE(&p.r, off < 0.1 * o.rtol);
    EVERYWHERE(&p.r, steif_statistics(s)->steps == steif_statistics(t)->steps);
  } else
    printf("%s, rank %d: %s\n", method, p.r.rank, steif_message(ctx));
  steif_solver_free(&s), steif_solver_free(&t);
  static const int signs[64] = {1};
  b.constraint = signs; /* of rows that are in no array */
  EVERYWHERE(&p.r, !steif_solver_new(ctx, &b, method, &q));
  EVERYWHERE(&p.r, same_answer(&p.r, ctx, STEIF_UNSUPPORTED));
  EVERYWHERE(&p.r, !!strstr(steif_message(ctx), "constraints of problem 'rod' need the rows"));
  N_VDestroy(q.like), N_VDestroy(part[0]), N_VDestroy(part[1]);
  N_VDestroy(p.whole), N_VDestroy(p.out);
  steif_context_free(&ctx);
  rod_close(&p.r);
}

/* The last rank does not get the k-th piece of memory, while others clone vectors, which takes all ranks. */
static int refused(MPI_Comm comm, const char *method, long k)
{
  pieces p;
  sunrealtype y0[64];
  rod_open(&p.r, comm, 40, 0);
  failing fails = {.refuse_at = p.r.rank == p.r.size - 1 ? k : 0};
  const steif_setup given = failing_setup(&fails);
  steif_context *ctx = steif_context_new(&given), *own = steif_context_new(NULL);
  int there = ctx != NULL, code = STEIF_NO_MEMORY;
  MPI_Allreduce(MPI_IN_PLACE, &there, 1, MPI_INT, MPI_MIN, comm);
  SUNContext sun = steif_sundials(own);
  p.whole = rod_vector(&p.r, own), p.out = N_VClone(p.whole);
  N_Vector part[] = {N_VNew_Serial(p.r.rows / 2, sun),
                     N_VNew_Serial(p.r.rows - p.r.rows / 2, sun)};
  N_Vector like = N_VMake_MPIManyVector(comm, 2, part, sun);
  if (there) {
    steif_problem b = rod_problem(&p.r, y0);
    b.y0 = NULL, b.start = start, b.f = f, b.precsetup = setup, b.precsolve = solve,
    b.user = &p;
    steif_options o = steif_defaults();
    o.rtol = 1e-3, o.like = like;
    steif_solver *s = steif_solver_new(ctx, &b, method, &o);
    code = s ? STEIF_OK : steif_status(ctx);
    EVERYWHERE(&p.r, same_answer(&p.r, ctx, code));
    EVERYWHERE(&p.r, code == STEIF_OK || code == STEIF_NO_MEMORY);
    steif_solver_free(&s);
  }
  steif_context_free(&ctx);
  EVERYWHERE(&p.r, fails.alive == 0);
  N_VDestroy(like), N_VDestroy(part[0]), N_VDestroy(part[1]);
  N_VDestroy(p.whole), N_VDestroy(p.out);
  steif_context_free(&own);
  rod_close(&p.r);
  return code != STEIF_OK;
}

static void memory(MPI_Comm comm, const char *method)
{
  rod r;
  long k = 1;
  rod_open(&r, comm, 40, 0);
  while (k < 1000 && refused(comm, method, k)) k++;
  EVERYWHERE(&r, k > 10 && k < 1000);
  rod_close(&r);
}

void test_parts(MPI_Comm comm)
{
  static const char *const methods[] = {"bdf", "radau:s=3", "dirk:hw43", "rodas4", "cvode"};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) run(comm, methods[k]);
  memory(comm, "bdf"), memory(comm, "cvode"), memory(comm, "ida"), memory(comm, "arkode");
}
#else
void test_parts(MPI_Comm comm) { (void)comm; }
#endif
