/* model_cost.c: models as text against the same problems in C.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels.h"
#include "timing.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <steif/collection.h>
#include <steif/model.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* hires and bruss2d of the collection. */
static const char hires[] =
  "state y1 = 1, y2 = 0, y3 = 0, y4 = 0, y5 = 0, y6 = 0, y7 = 0, y8 = 0.0057\n"
  "let bind = 280*y6*y8\n"
  "y1' = -1.71*y1 + 0.43*y2 + 8.32*y3 + 0.0007\n"
  "y2' = 1.71*y1 - 8.75*y2\n"
  "y3' = -10.03*y3 + 0.43*y4 + 0.035*y5\n"
  "y4' = 8.32*y2 + 1.71*y3 - 1.12*y4\n"
  "y5' = -1.745*y5 + 0.43*y6 + 0.43*y7\n"
  "y6' = -bind + 0.69*y4 + 1.71*y5 - 0.43*y6 + 0.69*y7\n"
  "y7' = bind - 1.81*y7\n"
  "y8' = -bind + 1.81*y7\n"
  "time 0 to 321.8122\n";
#define SQUARE(SOURCE)                                                                         \
  "param N = 64 whole\n"                                                                       \
  "let c = 0.1*N^2\n"                                                                          \
  "state u[j in 0:N-1, i in 0:N-1] = 22*(j/N)*(1 - j/N)*sqrt(1 - j/N)\n"                       \
  "state v[j in 0:N-1, i in 0:N-1] = 27*(i/N)*(1 - i/N)*sqrt(1 - i/N)\n"                       \
  "boundary u[-1, i in 0:N-1] = u[N-1, i], u[N, i in 0:N-1] = u[0, i]\n"                       \
  "boundary u[j in 0:N-1, -1] = u[j, N-1], u[j in 0:N-1, N] = u[j, 0]\n"                       \
  "boundary v[-1, i in 0:N-1] = v[N-1, i], v[N, i in 0:N-1] = v[0, i]\n"                       \
  "boundary v[j in 0:N-1, -1] = v[j, N-1], v[j in 0:N-1, N] = v[j, 0]\n"                       \
  "let disc[j, i] = if (10*i - 3*N)^2 + (10*j - 6*N)^2 <= N^2 then 5 else 0\n"                 \
  "for j in 0:N-1\n"                                                                           \
  "for i in 0:N-1\n"                                                                           \
  "u[j,i]' = 1 + u[j,i]^2*v[j,i] - 4.4*u[j,i]" SOURCE                                          \
  " + c*(u[j,i-1] + u[j,i+1] + u[j+1,i] + u[j-1,i] - 4*u[j,i])\n"                              \
  "v[j,i]' = 3.4*u[j,i] - u[j,i]^2*v[j,i]"                                                     \
  " + c*(v[j,i-1] + v[j,i+1] + v[j+1,i] + v[j-1,i] - 4*v[j,i])\n"                              \
  "end\n"                                                                                      \
  "end\n"                                                                                      \
  "time 0 to 11.5\n"

static const char square[] = SQUARE(" + step(t - 1.1)*disc[j,i]"), plain[] = SQUARE("");

/* The same without the disc as one would write it by hand: arrays with a rim, one loop. */
enum { SIDE = 64, CELLS = SIDE * SIDE };

static int by_hand(sunrealtype t, N_Vector y, N_Vector ydot, void *user)
{
  static double u[SIDE + 2][SIDE + 2], v[SIDE + 2][SIDE + 2];
  const double *from = N_VGetArrayPointer(y), c = 0.1 * SIDE * SIDE;
  double *restrict du = N_VGetArrayPointer(ydot), *restrict dv = du + CELLS;
  (void)t, (void)user;
  for (int j = 0; j < SIDE + 2; j++) {
    const double *row = from + (j + SIDE - 1) % SIDE * SIDE;
    memcpy(&u[j][1], row, SIDE * sizeof *row);
    memcpy(&v[j][1], row + CELLS, SIDE * sizeof *row);
    u[j][0] = row[SIDE - 1], u[j][SIDE + 1] = row[0];
    v[j][0] = row[CELLS + SIDE - 1], v[j][SIDE + 1] = row[CELLS];
  }
  for (int j = 1; j <= SIDE; j++)
    for (int i = 1; i <= SIDE; i++) {
      const double uuv = u[j][i] * u[j][i] * v[j][i];
      du[(j - 1) * SIDE + i - 1] =
        1 + uuv - 4.4 * u[j][i] +
        c * (u[j][i - 1] + u[j][i + 1] + u[j + 1][i] + u[j - 1][i] - 4 * u[j][i]);
      dv[(j - 1) * SIDE + i - 1] =
        3.4 * u[j][i] - uuv +
        c * (v[j][i - 1] + v[j][i + 1] + v[j + 1][i] + v[j - 1][i] - 4 * v[j][i]);
    }
  return 0;
}

/* ---- one evaluation --------------------------------------------------------------------------- */

typedef struct evaluation {
  const steif_problem *problem;
  N_Vector y, out;
  SUNMatrix J;
} evaluation;

static void call_f(void *data)
{
  const evaluation *e = data;
  e->problem->f(0.1, e->y, e->out, e->problem->user);
}

static void call_jac(void *data)
{
  const evaluation *e = data;
  e->problem->jac(0.1, e->y, e->out, e->J, e->problem->user, NULL, NULL, NULL);
}

static void evaluation_free(evaluation *e)
{
  if (e->y) N_VDestroy(e->y);
  if (e->out) N_VDestroy(e->out);
  if (e->J) SUNMatDestroy(e->J);
}

static int evaluation_open(steif_context *ctx, const steif_problem *p, evaluation *e)
{
  SUNContext sun = steif_sundials(ctx);
  *e =
    (evaluation){.problem = p, .y = N_VNew_Serial(p->n, sun), .out = N_VNew_Serial(p->n, sun)};
  e->J = p->storage == STEIF_SPARSE ? SUNSparseMatrix(p->n, p->n, p->nnz, CSC_MAT, sun)
                                    : SUNDenseMatrix(p->n, p->n, sun);
  if (!e->y || !e->out || !e->J) return STEIF_NO_MEMORY;
  memcpy(N_VGetArrayPointer(e->y), p->y0, (size_t)p->n * sizeof(sunrealtype));
  return STEIF_OK;
}

/* Largest difference of f, against the largest component. */
static double deviation(const evaluation *a, const evaluation *b)
{
  double worst = 0, size = 0;
  for (sunindextype i = 0; i < a->problem->n; i++) {
    worst = fmax(worst, fabs(NV_Ith_S(a->out, i) - NV_Ith_S(b->out, i)));
    size = fmax(size, fabs(NV_Ith_S(b->out, i)));
  }
  return worst / size;
}

/* The text against C, in turns: the median of the ratios. */
static int turns(steif_context *ctx, evaluation *text, evaluation *c, void (*work)(void *data),
                 steif_bench_row *row)
{
  enum { TURNS = 7 };
  row->ratio = INFINITY;
  call_f(text);
  call_f(c);
  STEIF_CHECK(deviation(text, c) < 1e-12, ctx, STEIF_NOT_CERTIFIED,
              "the text and the C of %s differ by %.2e", row->problem, deviation(text, c));
  for (int i = 0; i < TURNS; i++) {
    const double mine = stf_time(work, text), theirs = stf_time(work, c);
    if (mine / theirs < row->ratio) {
      row->ratio = mine / theirs;
      row->step_s = mine;
      row->floor_s = theirs;
    }
  }
  return STEIF_OK;
}

/* ---- rows ------------------------------------------------------------------------------------- */

typedef struct row_plan {
  const char *kind, *problem, *method;
  const char *text;
  double limit;
} row_plan;

static int both(steif_context *ctx, const row_plan *plan, steif_problem *text, steif_problem *c)
{
  *c = (steif_problem){0};
  STEIF_TRY(steif_model_parse(ctx, plan->text, "text", NULL, text));
  STEIF_TRY(steif_problem_find(ctx, plan->problem, c));
  if (plan->text == plain) c->f = by_hand;
  return STEIF_OK;
}

static int evaluations(steif_context *ctx, const row_plan *plan, steif_problem *text,
                       steif_problem *c, steif_bench_row *row)
{
  evaluation e[2] = {{0}, {0}};
  const bool compiled = strncmp(plan->kind, "compiled", 8) == 0;
  int code = compiled ? steif_model_compile(ctx, text, NULL, NULL) : STEIF_OK;
  if (!code) code = evaluation_open(ctx, text, &e[0]);
  if (!code) code = evaluation_open(ctx, c, &e[1]);
  if (!code) code = turns(ctx, &e[0], &e[1], strstr(plan->kind, "J") ? call_jac : call_f, row);
  evaluation_free(&e[0]);
  evaluation_free(&e[1]);
  return code;
}

/* floor_s: a nanosecond for each operation of f. */
static int operations(steif_context *ctx, const steif_problem *text, steif_bench_row *row)
{
  evaluation e = {0};
  steif_model_facts facts;
  int code = steif_model_describe(ctx, text, &facts);
  if (!code) code = evaluation_open(ctx, text, &e);
  row->step_s = INFINITY;
  for (int i = 0; !code && i < 5; i++) row->step_s = fmin(row->step_s, stf_time(call_f, &e));
  row->floor_s = code ? 0 : 1e-9 * (double)facts.operations;
  row->ratio = row->step_s / row->floor_s;
  evaluation_free(&e);
  return code;
}

/* Seconds a step of a whole run. */
static int seconds(steif_context *ctx, const steif_problem *p, const steif_bench_row *row,
                   double *least)
{
  steif_options o = steif_defaults();
  o.rtol = row->rtol;
  o.atol = row->atol;
  const sunrealtype from = stf_now();
  steif_solver *s = steif_solver_new(ctx, p, row->method, &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (!code) *least = fmin(*least, (stf_now() - from) / (double)steif_statistics(s)->steps);
  steif_solver_free(&s);
  return code;
}

static int whole_runs(steif_context *ctx, const steif_problem *text, const steif_problem *c,
                      steif_bench_row *row)
{
  const sunrealtype from = stf_now();
  int code = STEIF_OK;
  row->rtol = 1e-6;
  row->atol = row->rtol * (c->rtol_scale > 0 ? c->rtol_scale : 1);
  row->step_s = row->floor_s = INFINITY;
  for (int i = 0; !code && i < 200 && (i < 3 || stf_now() - from < 4); i++) {
    code = seconds(ctx, text, row, &row->step_s);
    if (!code) code = seconds(ctx, c, row, &row->floor_s);
  }
  row->ratio = row->step_s / row->floor_s;
  return code;
}

/* 1e5 equations written out, a reaction with diffusion; floor_s: two seconds. */
static int reading(steif_context *ctx, steif_bench_row *row)
{
  enum { HALF = 50000, LINE = 200 };
  char *text = malloc((size_t)HALF * 3 * LINE), *end = text;
  if (!text) return STEIF_NO_MEMORY;
  end += sprintf(end,
                 "param A = 1, B = 3, c = 0.02\nstate u0 = 1, v0 = 3, u%d = 1, v%d = 3\n"
                 "u0' = 0\nv0' = 0\nu%d' = 0\nv%d' = 0\n",
                 HALF, HALF, HALF, HALF);
  for (int i = 1; i < HALF; i++) {
    end += sprintf(end, "state u%d = 1.%d, v%d = 3\n", i, i % 7, i);
    end += sprintf(end, "u%d' = A + u%d^2*v%d - (B + 1)*u%d + c*(u%d - 2*u%d + u%d)\n", i, i, i,
                   i, i - 1, i, i + 1);
    end += sprintf(end, "v%d' = B*u%d - u%d^2*v%d + c*(v%d - 2*v%d + v%d)\n", i, i, i, i, i - 1,
                   i, i + 1);
  }
  strcpy(end, "time 0 to 1\n");
  int code = STEIF_OK;
  row->step_s = INFINITY;
  for (int i = 0; !code && i < 3; i++) {
    steif_problem p = {0};
    const sunrealtype from = stf_now();
    code = steif_model_parse(ctx, text, "text", NULL, &p);
    row->step_s = fmin(row->step_s, stf_now() - from);
    row->n = p.n;
    steif_problem_clear(ctx, &p);
  }
  free(text);
  row->floor_s = 2;
  row->ratio = row->step_s / row->floor_s;
  return code;
}

static const row_plan plans[] = {{"operations", "hires", "f", hires, 1.5},
                                 {"loops f", "bruss2d:n=64", "f", plain, 5},
                                 {"loops J", "bruss2d:n=64", "jac", square, 5},
                                 {"run", "hires", "radau:s=3", hires, 1.3},
                                 {"run", "bruss2d:n=64", "radau:s=3", square, 1.05},
                                 {"reading", "written out", "open", NULL, 1},
                                 {"compiled f", "bruss2d:n=64", "f", plain, 1.2},
                                 {"compiled J", "bruss2d:n=64", "jac", square, 1.2}};

int steif_bench_model(steif_context *ctx, size_t i, steif_bench_row *row)
{
  if (i >= sizeof plans / sizeof *plans) return STEIF_BAD_INPUT;
  const row_plan *plan = &plans[i];
  steif_problem text = {0}, c = {0};
  *row = (steif_bench_row){.limit = plan->limit};
  snprintf(row->kind, sizeof row->kind, "%s", plan->kind);
  snprintf(row->problem, sizeof row->problem, "%s", plan->problem);
  snprintf(row->method, sizeof row->method, "%s", plan->method);
  if (!plan->text) return reading(ctx, row);
  int code = both(ctx, plan, &text, &c);
  row->n = text.n;
  if (!code && plan->kind[0] == 'o')
    code = operations(ctx, &text, row);
  else if (!code && plan->kind[0] == 'r')
    code = whole_runs(ctx, &text, &c, row);
  else if (!code)
    code = evaluations(ctx, plan, &text, &c, row);
  steif_problem_clear(ctx, &text);
  steif_problem_clear(ctx, &c);
  return code;
}
