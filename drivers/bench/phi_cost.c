/* phi.c: exponentials of dense matrices, and phi functions in place of implicit methods.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "phi_cost.h"
#include "timing.h"
#include "workprec.h"
#include <math.h>
#include <steif/collection.h>
#include <steif/phi.h>
#include <stdio.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* -- e^A of dense matrices --------------------------------------------------------------------- */

enum shape { FULL, TRIANGULAR, DIFFERENCES };
static const struct {
  const char *name;
  enum shape shape;
  sunrealtype norm; /* ||A||_1 */
} matrices[] = {{"random", FULL, 0.2},
                {"random", FULL, 5},
                {"random", FULL, 300},
                {"triangular", TRIANGULAR, 20},
                {"second differences", DIFFERENCES, 100}};
static const int sizes[] = {16, 64, 256};
enum { MATRICES = sizeof matrices / sizeof *matrices, SIZES = sizeof sizes / sizeof *sizes };

/* In (-1, 1): S. K. Park and K. W. Miller, Comm. ACM 31 (1988). */
static sunrealtype random_in(unsigned *seed)
{
  *seed = (unsigned)((unsigned long long)*seed * 48271u % 2147483647u);
  return 2 * (sunrealtype)*seed / 2147483647.0 - 1;
}

static sunrealtype entry(enum shape shape, int i, int j, unsigned *seed)
{
  if (shape == DIFFERENCES) return i == j ? -2 : i - j == 1 || j - i == 1;
  return shape == FULL || i <= j ? random_in(seed) : 0;
}

static void fill(enum shape shape, int n, sunrealtype norm, sunrealtype *A)
{
  unsigned seed = 4711;
  sunrealtype most = 0;
  for (int j = 0; j < n; j++) {
    sunrealtype sum = 0;
    for (int i = 0; i < n; i++) sum += fabs(A[i + n * j] = entry(shape, i, j, &seed));
    most = fmax(most, sum);
  }
  for (int i = 0; i < n * n; i++) A[i] *= norm / most;
}

typedef struct dense {
  steif_context *ctx;
  int n, code;
  const sunrealtype *A;
  sunrealtype *X;
} dense;

static void exponential(void *data)
{
  dense *d = data;
  d->code = steif_expm(d->ctx, d->n, d->A, d->X);
}

int steif_bench_exponential(steif_context *ctx, size_t i, steif_bench_expm *row, sunrealtype *A,
                            sunrealtype *X)
{
  if (i >= (size_t)MATRICES * SIZES) return STEIF_BAD_INPUT;
  const size_t kind = i % MATRICES;
  *row = (steif_bench_expm){.n = sizes[i / MATRICES], .norm = matrices[kind].norm};
  snprintf(row->matrix, sizeof row->matrix, "%s", matrices[kind].name);
  fill(matrices[kind].shape, row->n, row->norm, A);
  dense d = {.ctx = ctx, .n = row->n, .A = A, .X = X};
  row->cpu_s = stf_time(exponential, &d);
  return d.code;
}

/* -- actions and exponential Rosenbrock methods ------------------------------------------------ */

static const struct {
  const char *problem, *sparse; /* sparse: the same for one action of e^{tA}; NULL: nonlinear */
} subjects[] = {{"heat:n=1000", "heat:n=1000,storage=sparse"},
                {"heat2d:n=64", "heat2d:n=64"},
                {"bruss2d:n=32", NULL}};
static const int digits[] = {4, 7, 10};
enum { SUBJECTS = sizeof subjects / sizeof *subjects, DIGITS = sizeof digits / sizeof *digits };

/* e^{tA} y0 of a linear problem, from its callbacks to the solution. */
typedef struct single {
  steif_context *ctx;
  steif_problem problem;
  sunrealtype tolerance, mescd;
  int code;
} single;

static int apply(single *q, SUNMatrix A, N_Vector y, N_Vector w)
{
  const steif_problem *p = &q->problem;
  const steif_action_options o = {.tolerance = q->tolerance};
  sunrealtype scd;
  memcpy(N_VGetArrayPointer(y), p->y0, (size_t)p->n * sizeof *p->y0);
  if (p->jac(p->t0, y, w, A, p->user, w, w, w)) return STEIF_CALLBACK;
  steif_action *a = steif_action_new(q->ctx, A, NULL, y, &o);
  if (!a) return steif_status(q->ctx);
  const int code = steif_action_apply(a, p->t1 - p->t0, 0, &y, w, NULL);
  steif_action_free(&a);
  return code ? code : steif_problem_digits(q->ctx, p, p->t1, w, 1, &scd, &q->mescd);
}

static void one_action(void *data)
{
  single *q = data;
  SUNContext sun = steif_sundials(q->ctx);
  SUNMatrix A = SUNSparseMatrix(q->problem.n, q->problem.n, q->problem.nnz, CSC_MAT, sun);
  N_Vector y = N_VNew_Serial(q->problem.n, sun), w = N_VNew_Serial(q->problem.n, sun);
  q->code = A && y && w ? apply(q, A, y, w) : STEIF_NO_MEMORY;
  if (A) SUNMatDestroy(A);
  if (y) N_VDestroy(y);
  if (w) N_VDestroy(w);
}

static int action(steif_context *ctx, const char *spec, steif_bench_phi *row)
{
  single q = {.ctx = ctx};
  STEIF_TRY(steif_problem_find(ctx, spec, &q.problem));
  for (int k = row->digits - 1; k < row->digits + 3 && !(q.mescd >= row->digits); k++) {
    q.tolerance = pow(10, -k);
    one_action(&q);
  }
  if (q.code == STEIF_OK && q.mescd >= row->digits) row->cpu_s = stf_time(one_action, &q);
  snprintf(row->method, sizeof row->method, "action");
  steif_problem_clear(ctx, &q.problem);
  return q.code;
}

/* Seconds of the loosest tolerance with which a method reaches the digits; NaN: none. */
static int cheapest(steif_context *ctx, const steif_bench_phi *row, const char *method,
                    sunrealtype longest, sunrealtype *seconds)
{
  steif_bench_solve run;
  *seconds = NAN;
  for (int k = row->digits - 2; k < row->digits + 4 && isnan(*seconds); k++) {
    if (k < 2) continue;
    STEIF_TRY(steif_bench_measure(ctx, row->problem, method, pow(10, -k), longest, &run));
    if (run.late) break;
    if (run.code == STEIF_OK && run.mescd >= row->digits) *seconds = run.cpu_s;
  }
  steif_forget(ctx);
  return STEIF_OK;
}

/* The cheaper exponential Rosenbrock method. */
static int rosenbrock(steif_context *ctx, steif_bench_phi *row, sunrealtype longest)
{
  static const char *const methods[] = {"exprb32", "exprb43"};
  for (int m = 0; m < 2; m++) {
    sunrealtype seconds;
    STEIF_TRY(cheapest(ctx, row, methods[m], longest, &seconds));
    if (isnan(seconds) || seconds >= row->cpu_s) continue;
    row->cpu_s = seconds;
    snprintf(row->method, sizeof row->method, "%s", methods[m]);
  }
  return STEIF_OK;
}

int steif_bench_functions(steif_context *ctx, size_t i, sunrealtype longest,
                          steif_bench_phi *row)
{
  if (i >= (size_t)SUBJECTS * DIGITS) return STEIF_BAD_INPUT;
  const size_t which = i / DIGITS;
  steif_problem p;
  *row = (steif_bench_phi){.digits = digits[i % DIGITS], .cpu_s = INFINITY};
  snprintf(row->problem, sizeof row->problem, "%s", subjects[which].problem);
  STEIF_TRY(steif_problem_find(ctx, row->problem, &p));
  row->n = p.n;
  steif_problem_clear(ctx, &p);
  STEIF_TRY(subjects[which].sparse ? action(ctx, subjects[which].sparse, row)
                                   : rosenbrock(ctx, row, longest));
  if (isinf(row->cpu_s)) row->cpu_s = NAN;
  STEIF_TRY(cheapest(ctx, row, "radau:s=3", longest, &row->radau_s));
  return cheapest(ctx, row, "cvode", longest, &row->cvode_s);
}
