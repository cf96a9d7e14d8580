/* constraints.c: signs of components over ranks: the steps, codes and sentences of one process.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "ranks.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two components move, y_i' = -k (y_i - c_i(t)^2 - e_i), c_i = max(0, cos(3 t + i / 2)): they rest at e_i, where coarse
 * steps carry them below zero. They may be driven through zero instead: y_i' = -1. All others are 0 and stay so: norms are sums of two numbers, and the same for any number of ranks. */
enum { N = 24, STILL = 0, RESTS, LEAVES };

typedef struct basins {
  rod r;
  double rest[N];        /* e_i */
  int moves[N], sign[N]; /* of all components */
  double low, c;     /* the lowest value of own rows at ends of steps; of the preconditioner */
  sunrealtype y0[N]; /* of all components */
} basins;

enum { K = 300 };

static int f(sunrealtype t, N_Vector y, N_Vector out, void *user)
{
  basins *b = user;
  rod *r = &b->r;
  const sunrealtype *u = N_VGetArrayPointer(y);
  sunrealtype *du = N_VGetArrayPointer(out);
  for (sunindextype k = 0; k < r->rows; k++) {
    const sunindextype i = r->first + k;
    const double c = fmax(0, cos(3 * t + 0.5 * (double)i));
    du[k] = b->moves[i] == RESTS ? -K * (u[k] - c * c - b->rest[i]) : -(b->moves[i] == LEAVES);
  }
  r->calls++;
  if (r->rank != r->alone) return 0;
  if (r->wrong == RECOVERABLE) return r->calls % 37 == 20 && r->calls < 400;
  return r->wrong == FATAL && r->calls > 60 ? -1 : 0;
}

static int setup(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, sunrealtype c, void *user)
{
  (void)t, (void)y, (void)yp, (void)r;
  ((basins *)user)->c = c;
  return 0;
}

static int solve(sunrealtype t, N_Vector y, N_Vector yp, N_Vector r, N_Vector b, N_Vector z,
                 sunrealtype c, sunrealtype delta, void *user)
{
  const basins *s = user;
  (void)t, (void)y, (void)yp, (void)r, (void)c, (void)delta;
  N_VScale(1 / (s->c + K), b, z);
  return 0;
}

static int watch(steif_solver *s, sunrealtype t, N_Vector y, void *user)
{
  basins *b = user;
  const sunrealtype *u = N_VGetArrayPointer(y);
  (void)s, (void)t;
  for (sunindextype k = 0; k < b->r.rows; k++)
    if (b->sign[b->r.first + k] > 0) b->low = fmin(b->low, u[k]);
  return 0;
}

static void moved(basins *b, int i, double rest)
{
  const double c = fmax(0, cos(0.5 * i));
  b->moves[i] = RESTS, b->rest[i] = rest, b->y0[i] = c * c + rest;
}

static basins basin(const rod *r, int first, int second)
{
  basins b = {.r = *r};
  b.r.alone = b.r.wrong = b.r.calls = 0;
  for (int i = 0; i < N; i++) b.sign[i] = i % 3 != 1;
  b.sign[first] = b.sign[second] = 1;
  moved(&b, first, 0), moved(&b, second, 0);
  return b;
}

/* One process alone that has all rows. */
static basins whole(const basins *from)
{
  basins b = *from;
  b.r.rank = 0, b.r.size = 1, b.r.first = 0, b.r.rows = b.r.n;
  return b;
}

static steif_problem problem_of(basins *b)
{
  return (steif_problem){.name = "basins",
                         .n = N,
                         .t1 = 4,
                         .y0 = b->y0 + b->r.first,
                         .f = f,
                         .precsetup = setup,
                         .precsolve = solve,
                         .constraint = b->sign + b->r.first,
                         .storage = STEIF_KRYLOV,
                         .user = b};
}

typedef struct outcome {
  int code;
  long steps, rejected, sums;
  sunrealtype t, y[N]; /* own rows */
  char text[1100];
} outcome;

static steif_options usual(basins *b, const char *method)
{
  steif_options o = steif_defaults();
  o.rtol = o.atol = 1e-3, o.observe = watch, o.observer = b, o.max_steps = 1500;
  if (!strcmp(method, "rk4")) o.h = 1. / 256;
  return o;
}

/* With and without the ranks; without constraints where `kept` is 0. */
static outcome run(basins *b, const char *method, int spread, int kept)
{
  outcome out = {.code = STEIF_OK};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem p = problem_of(b);
  steif_options o = usual(b, method);
  o.like = spread ? rod_vector(&b->r, ctx) : NULL;
  b->low = 1, b->r.calls = 0;
  if (!kept) p.constraint = NULL;
  const long from = allreduces;
  steif_solver *s = steif_solver_new(ctx, &p, method, &o);
  out.code = s ? steif_solve_to(s, p.t1) : steif_status(ctx);
  snprintf(out.text, sizeof out.text, "%s", steif_message(ctx));
  if (s) {
    out.steps = steif_statistics(s)->steps, out.rejected = steif_statistics(s)->rejected;
    out.t = steif_time(s);
    if (b->r.rows)
      memcpy(out.y, N_VGetArrayPointer(steif_solution(s)),
             (size_t)b->r.rows * sizeof(sunrealtype));
  }
  out.sums = allreduces - from;
  if (spread) EVERYWHERE(&b->r, same_answer(&b->r, ctx, out.code));
  steif_solver_free(&s);
  if (o.like) N_VDestroy(o.like);
  steif_context_free(&ctx);
  return out;
}

/* The sentence without what ranks have more. */
static void as_alone(char *text)
{
  char *at = strstr(text, " (on rank "), *end = at ? strchr(at, ')') : NULL;
  if (end) memmove(at, end + 1, strlen(end + 1) + 1);
}

/* The run of one process. */
static outcome as_one(basins *b, const char *method)
{
  basins all = whole(b);
  const outcome one = run(&all, method, 0, 1);
  outcome out = run(b, method, 1, 1), told = out;
  double off = 0;
  as_alone(told.text);
  for (sunindextype k = 0; k < b->r.rows; k++)
    off = fmax(off, fabs(out.y[k] - one.y[b->r.first + k]));
  const int same = out.code == one.code && out.steps == one.steps &&
                   out.rejected == one.rejected && off == 0 && out.t == one.t &&
                   !strcmp(told.text, one.text);
  if (!EVERYWHERE(&b->r, same) && !same)
    printf("  %s on rank %d: %ld + %ld steps, %s\n  one process: %ld + %ld steps, %s\n", method,
           b->r.rank, out.steps, out.rejected, out.text, one.steps, one.rejected, one.text);
  return out;
}

static const char *const methods[] = {"radau:s=3", "bdf",   "dirk:hw43", "dopri87", "auto",
                                      "rk4",       "cvode", "ida",       "arkode"};
enum { METHODS = sizeof methods / sizeof *methods };

static void steps_end_where_they_may(const rod *r)
{
  int below = 0;
  for (int m = 0; m < METHODS; m++)
    for (int k = 0; k < 2; k++) {
      basins b = basin(r, k ? 5 : 0, k ? 18 : N - 1);
      const outcome kept = as_one(&b, methods[m]);
      const int at_most = strcmp(methods[m], "ida") ? 0 : 1; /* IDA: up to atol */
      EVERYWHERE(r, kept.code == STEIF_OK && b.low >= -1e-3 * at_most);
      run(&b, methods[m], 1, 0);
      double low = b.low;
      MPI_Allreduce(MPI_IN_PLACE, &low, 1, MPI_DOUBLE, MPI_MIN, r->comm);
      below += low < 0;
    }
  EVERYWHERE(r, below >= 10); /* the constraints had something to do */
}

/* A strict constraint: steps are made anew; so are those that fail on one rank alone. */
static void steps_are_made_anew(const rod *r)
{
  long rejected = 0;
  for (int m = 0; m < METHODS; m++) {
    if (!strcmp(methods[m], "rk4")) continue;
    basins b = basin(r, 2, N - 1);
    moved(&b, 2, 1e-5), moved(&b, N - 1, 1e-5);
    b.sign[2] = b.sign[N - 1] = 2;
    const outcome kept = as_one(&b, methods[m]);
    rejected += kept.rejected - run(&b, methods[m], 1, 0).rejected;
    run(&b, methods[m], 1, 1);
    EVERYWHERE(r, m > 3 || kept.code == STEIF_OK);
    EVERYWHERE(r, kept.code != STEIF_OK || b.low >= (m > 3 ? -1e-3 : 0));
    for (int wrong = RECOVERABLE; wrong <= FATAL; wrong++)
      for (int alone = 0; alone<r->size; alone += r->size> 1 ? r->size - 1 : 1) {
        basins c = b;
        c.r.wrong = wrong, c.r.alone = alone;
        const outcome failed = run(&c, methods[m], 1, 1);
        EVERYWHERE(r, wrong == RECOVERABLE || failed.code == STEIF_CALLBACK);
      }
  }
  EVERYWHERE(r, rejected > 0);
}

/* Of the rank that owns component `at`, as in sentences. */
static int owner_of(const rod *r, int at)
{
  int rank = 0, end = r->owned[0];
  while (at >= end) end += r->owned[++rank];
  return rank;
}

/* Solutions that leave on the first, a middle or the last rank, while another component rests, presses against its
 * constraint, which ends the run, or leaves at the same time: the sentence is that of the lowest. */
static void what_leaves_is_told(const rod *r)
{
  static const int at[] = {0, 12, N - 1};
  for (int m = 0; m < METHODS; m++)
    for (int k = 0; k < 9; k++) {
      const int leaves = at[k % 3], other = leaves == 12 ? 20 : 12, with = k / 3, ours = m < 6;
      const int first = with == 2 && other < leaves ? other : leaves;
      char words[80];
      if (!ours && k > 2) continue;
      basins b = basin(r, leaves, other);
      b.moves[leaves] = LEAVES, b.y0[leaves] = 0.5;
      if (with == 1) moved(&b, other, -2e-4), b.y0[other] = 0;
      if (with == 2) b.moves[other] = LEAVES, b.y0[other] = 0.5;
      const outcome out = ours ? as_one(&b, methods[m]) : run(&b, methods[m], 1, 1);
      EVERYWHERE(r, out.code < 0);
      snprintf(words, sizeof words, "component %d (on rank %d) of problem 'basins' becomes -",
               first + 1, owner_of(r, first));
      if (ours) EVERYWHERE(r, out.code == STEIF_INFEASIBLE);
      if (ours && with != 1) EVERYWHERE(r, !!strstr(out.text, words));
    }
}

static void bad_rows_are_told(const rod *r)
{
  char words[120];
  const int last = owner_of(r, N - 1), first = N - r->owned[last];
  for (int m = 0; m < METHODS; m++) {
    basins b = basin(r, 0, N - 1);
    b.y0[N - 1] = -1e-9, b.sign[N - 1] = 1;
    outcome out = as_one(&b, methods[m]);
    snprintf(words, sizeof words,
             "component %d (on rank %d) of problem 'basins' is -1e-09 at the start, t = 0, and "
             "is declared to be >= 0",
             N, last);
    EVERYWHERE(r, out.code == STEIF_INFEASIBLE && strstr(out.text, words));
    b.sign[N - 1] = -3;
    out = run(&b, methods[m], 1, 1);
    snprintf(words, sizeof words, "constraint[%d] = -3 of problem 'basins' must be 0 (none)",
             N - 1 - first);
    EVERYWHERE(r, out.code == STEIF_BAD_INPUT && strstr(out.text, words));
    snprintf(words, sizeof words, "(on rank %d, whose row 0 is row %d of all)", last, first);
    EVERYWHERE(r, last == 0 || strstr(out.text, words));
    out = run(&b, methods[m], 1, r->rank != r->size - 1);
    if (r->size == 1) continue;
    EVERYWHERE(r, out.code == STEIF_BAD_INPUT && strstr(out.text, "problem.constraint"));
    EVERYWHERE(r, !!strstr(out.text, "on all ranks or on none"));
  }
}

/* Constraints cost a sum for each step that the error lets pass, and some at the start; none where all are 0. */
static void sums_are_few(const rod *r)
{
  enum { AT_START = 2 };
  for (int m = 0; m < 6; m++) {
    basins b = basin(r, 0, N - 1);
    moved(&b, 0, 1), moved(&b, N - 1, 1); /* far away */
    const outcome none = run(&b, methods[m], 1, 0), kept = run(&b, methods[m], 1, 1);
    memset(b.sign, 0, sizeof b.sign);
    const outcome zeros = run(&b, methods[m], 1, 1);
    const long more = kept.sums - none.sums;
    EVERYWHERE(r, none.code == STEIF_OK && zeros.code == STEIF_OK && kept.code == STEIF_OK);
    EVERYWHERE(r, zeros.sums <= none.sums + AT_START && zeros.steps == none.steps);
    if (!EVERYWHERE(r, kept.steps == none.steps && more <= kept.steps + AT_START) && !r->rank)
      printf("  %s: %ld sums more in %ld steps\n", methods[m], more, kept.steps);
  }
}

void test_constraints(MPI_Comm comm)
{
  for (int uneven = 0; uneven < 2; uneven++) { /* with 3 ranks one has no rows then */
    rod r;
    rod_open(&r, comm, N, uneven);
    steps_end_where_they_may(&r);
    steps_are_made_anew(&r);
    what_leaves_is_told(&r);
    bad_rows_are_told(&r);
    sums_are_few(&r);
    rod_close(&r);
  }
  MPI_Comm reversed;
  int rank;
  rod r;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_split(comm, 0, -rank, &reversed);
  rod_open(&r, reversed, N, 0);
  bad_rows_are_told(&r);
  rod_close(&r);
  MPI_Comm_free(&reversed);
}
