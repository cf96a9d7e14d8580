/* test_singular.c: linear DAEs whose pencil is singular at every shift, though no pivot vanishes, and their regular
 * twins.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "suite.h"
#include <nvector/nvector_serial.h>
#include <stdbool.h>
#include <steif/data.h>
#include <steif/linear.h>
#include <steif/solver.h>
#include <stdlib.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const char everywhere[] = "singular at every s";

/* The code of a run to t1, whose last values are copied to y; its sentence stays in ctx. */
static int run(steif_context *ctx, const steif_problem *p, const char *method, double h,
               int storage, sunrealtype *y)
{
  steif_options o = steif_defaults();
  o.h = h;
  if (storage) o.force_storage = 1, o.storage = (enum steif_storage)storage;
  steif_solver *s = steif_solver_new(ctx, p, method, &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (!code && y) memcpy(y, N_VGetArrayPointer(steif_solution(s)), (size_t)p->n * sizeof *y);
  steif_solver_free(&s);
  return code;
}

static bool told(steif_context *ctx, int code)
{
  const bool good = code == STEIF_SINGULAR && strstr(steif_message(ctx), everywhere);
  if (!good) printf("\n  code %d: %s", code, steif_message(ctx));
  return good;
}

static bool well(steif_context *ctx, int code)
{
  if (code) printf("\n  code %d: %s", code, steif_message(ctx));
  return !code;
}

/* -- random sparse pencils ------------------------------------------------------------------- */

enum { N = 30, SEEDS = 60 };

static double drawn(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (*state >> 8) / 8388608.0 - 1;
}

/* E of rank N - 6 or less, F with about five entries a row, of 26 bits at most; row 1 of both is `times` row 0, which is
 * exact; times 0: its own. */
static void draw(unsigned seed, double times, SUNMatrix E, SUNMatrix F)
{
  SUNMatZero(E), SUNMatZero(F);
  for (sunindextype i = 0; i < N; i++) {
    SM_ELEMENT_D(F, i, i) = 1.5 + drawn(&seed);
    if (i < N - 6) SM_ELEMENT_D(E, i, i) = 1.5 + drawn(&seed);
    for (int k = 0; k < 4; k++) {
      const sunindextype j = (sunindextype)((drawn(&seed) + 1) / 2 * N);
      SM_ELEMENT_D(F, i, j) += drawn(&seed);
      if (i < N - 6 && k == 0) SM_ELEMENT_D(E, i, j) += 0.3125 * drawn(&seed);
    }
  }
  for (sunindextype j = 0; times != 0 && j < N; j++) {
    SM_ELEMENT_D(E, 1, j) = times * SM_ELEMENT_D(E, 0, j);
    SM_ELEMENT_D(F, 1, j) = times * SM_ELEMENT_D(F, 0, j);
  }
}

static void pencils_of_repeated_rows_are_told(void)
{
  static const char *const methods[] = {"radau", "bdf", "radau:s=2"};
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype x0[N] = {0};
  int count = 0;
  for (unsigned seed = 0; seed < SEEDS; seed++) {
    SUNMatrix D[] = {SUNDenseMatrix(N, N, steif_sundials(ctx)),
                     SUNDenseMatrix(N, N, steif_sundials(ctx))};
    steif_problem p;
    for (int twin = 0; twin < 2; twin++) {
      draw(seed, twin ? 0 : seed % 3 ? 2 : 314573.0 / 1048576, D[0], D[1]);
      SUNMatrix S[] = {SUNSparseFromDenseMatrix(D[0], 0, CSC_MAT),
                       SUNSparseFromDenseMatrix(D[1], 0, CSC_MAT)};
      SUNMatrix *use = seed % 2 ? D : S;
      const steif_linear l = {.E = use[0], .F = use[1]};
      CHECK(!steif_linear_problem(ctx, &l, x0, 0, 1e-3, &p));
      for (int k = 0; k < 3; k++) {
        const int code = run(ctx, &p, methods[k], k == 2 ? 1e-4 : 0, 0, NULL);
        /* some are singular by their patterns, which is told otherwise */
        CHECK(twin ? well(ctx, code) : code == STEIF_SINGULAR);
        count += !twin && strstr(steif_message(ctx), everywhere);
      }
      SUNMatDestroy(S[0]), SUNMatDestroy(S[1]);
    }
    SUNMatDestroy(D[0]), SUNMatDestroy(D[1]);
  }
  CHECK(count >= 3 * (SEEDS - 3));
  steif_context_free(&ctx);
}

/* -- Stokes in a box ------------------------------------------------------------------------- */

/* M x M cells, velocities on their faces, none at the walls, pressures in them: u' = nu Lap u - grad p + grad phi,
 * div u = 0. The fluid rests, and p is phi but for what nothing fixes; fixed: p = 0 in the first cell. */
enum { M = 7, FACES = M * (M - 1), BOX = 2 * FACES + M * M, ENTRIES = 8 * BOX };

typedef struct box {
  int count, row[ENTRIES], column[ENTRIES];
  double value[ENTRIES];
} box;

static void put(box *b, int row, int column, double value)
{
  b->row[b->count] = row, b->column[b->count] = column, b->value[b->count++] = value;
}

static int cell(int i, int j) { return 2 * FACES + j * M + i; }
/* Face i of row j across direction d, which has cell i before it and i + 1 after it. */
static int face(int d, int i, int j) { return d * FACES + j * (M - 1) + i; }
static int beside(int d, int i, int j) { return d ? cell(j, i) : cell(i, j); }
static double potential(int k)
{
  const int i = k % M, j = k / M;
  return sin(0.9 * i + 0.2) + 0.4 * i * j - 0.3 * j * j;
}

/* F of E x' + F x = f, E = 1 for velocities. */
static void fill(box *b, bool fixed)
{
  const double h = 1.0 / M, nu = 0.013;
  b->count = 0;
  for (int d = 0; d < 2; d++)
    for (int j = 0; j < M; j++)
      for (int i = 0; i < M - 1; i++) {
        const int at = face(d, i, j), cells[] = {beside(d, i, j), beside(d, i + 1, j)};
        put(b, at, at, nu / (h * h) * (4 + (j == 0) + (j == M - 1)));
        if (i > 0) put(b, at, face(d, i - 1, j), -nu / (h * h));
        if (i < M - 2) put(b, at, face(d, i + 1, j), -nu / (h * h));
        if (j > 0) put(b, at, face(d, i, j - 1), -nu / (h * h));
        if (j < M - 1) put(b, at, face(d, i, j + 1), -nu / (h * h));
        for (int k = 0; k < 2; k++) {
          put(b, at, cells[k], k ? 1 / h : -1 / h);
          if (!fixed || cells[k] != cell(0, 0)) put(b, cells[k], at, k ? -1 / h : 1 / h);
        }
      }
  if (fixed) put(b, cell(0, 0), cell(0, 0), 1);
}

static SUNMatrix sparse_of(steif_context *ctx, const box *b)
{
  SUNMatrix D = SUNDenseMatrix(BOX, BOX, steif_sundials(ctx));
  for (int k = 0; k < b->count; k++) SM_ELEMENT_D(D, b->row[k], b->column[k]) = b->value[k];
  SUNMatrix S = SUNSparseFromDenseMatrix(D, 0, CSC_MAT);
  SUNMatDestroy(D);
  return S;
}

static int gradient(sunrealtype t, N_Vector f, void *user)
{
  (void)t, (void)user;
  N_VConst(0, f);
  for (int d = 0; d < 2; d++)
    for (int j = 0; j < M; j++)
      for (int i = 0; i < M - 1; i++)
        NV_Ith_S(f, face(d, i, j)) = M * (potential(beside(d, i + 1, j) - 2 * FACES) -
                                          potential(beside(d, i, j) - 2 * FACES));
  return 0;
}

static int derivatives(sunrealtype t, int derivative, N_Vector f, void *user)
{
  if (derivative == 0) return gradient(t, f, user);
  N_VConst(0, f);
  return 0;
}

/* Velocities are 0 and pressures phi - phi(0). */
static void rests(const sunrealtype *y)
{
  for (int k = 0; k < 2 * FACES; k++) CLOSE_FLOOR(y[k], 0, 1e-6, 1);
  for (int k = 0; k < M * M; k++)
    CLOSE_FLOOR(y[2 * FACES + k], potential(k) - potential(0), 1e-5, 1);
}

static void a_box_needs_a_pressure(void)
{
  static const char *const methods[] = {"radau", "bdf", "radau:s=2", "radau"};
  static const int storage[] = {0, 0, 0, STEIF_DENSE};
  steif_context *ctx = steif_context_new(NULL);
  box *b = malloc(sizeof *b);
  sunrealtype x0[BOX] = {0}, y[BOX];
  for (int fixed = 0; fixed < 2; fixed++) {
    steif_problem p;
    b->count = 0;
    for (int k = 0; k < 2 * FACES; k++) put(b, k, k, 1);
    SUNMatrix E = sparse_of(ctx, b);
    fill(b, fixed);
    SUNMatrix F = sparse_of(ctx, b);
    const steif_linear l = {.E = E, .F = F, .f = derivatives};
    CHECK(!steif_linear_problem(ctx, &l, x0, 0, 1, &p));
    for (int k = 0; k < 4; k++) {
      const int code = run(ctx, &p, methods[k], k == 2 ? 0.01 : 0, storage[k], y);
      CHECK(fixed ? well(ctx, code) : told(ctx, code));
      if (fixed && k != 2) rests(y);
      /* nothing but pressures, all 49 */
      if (!fixed) CHECK(strstr(steif_message(ctx), "of y85, y86, ") != NULL);
      if (!fixed) CHECK(strstr(steif_message(ctx), " and 41 more;") != NULL);
    }
    SUNMatDestroy(E), SUNMatDestroy(F);
  }
  free(b);
  steif_context_free(&ctx);
}

/* -- models ---------------------------------------------------------------------------------- */

static int of_model(steif_context *ctx, const char *text, const char *method, double h)
{
  steif_problem p;
  CU_ASSERT_FATAL(!steif_model_parse(ctx, text, "circuit", NULL, &p));
  const int code = run(ctx, &p, method, h, 0, NULL);
  if (!code || h > 0) return steif_problem_clear(ctx, &p), code;
  CHECK(p.linear);
  char kept[STEIF_SENTENCE];
  snprintf(kept, sizeof kept, "%s", steif_message(ctx));
  steif_problem_clear(ctx, &p);
  CHECK(!strcmp(kept, steif_message(ctx)));
  return code;
}

#define CIRCUIT(last)                                                                          \
  "model \"circuit\"\nparam C = 1.1e-6, R = 330, S = 470, T = 730\n"                           \
  "state a ~ 0, b ~ 0, c ~ 0\n"                                                                \
  "C*a' - C*b' = -(a - c)/R + 1e-3*sin(t)\n"                                                   \
  "C*b' - C*a' = -(b - c)/S - 1e-3*sin(t)\n" last "\ntime 0 to 1\n"

static void a_circuit_needs_a_ground(void)
{
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 3; k++) {
    const char *method = k ? "bdf" : "radau";
    const double h = k == 2 ? 0.01 : 0;
    const int code = of_model(ctx, CIRCUIT("0 = -(c - a)/R - (c - b)/S"), method, h);
    CHECK(told(ctx, code));
    CHECK(strstr(steif_message(ctx), "nothing fixes a combination of a, b, c;") != NULL);
    CHECK(well(ctx, of_model(ctx, CIRCUIT("0 = c"), method, h)));
    /* a leak of 1e12 ohm */
    const char *leaks = CIRCUIT("0 = -(c - a)/R - (c - b)/S - 1e-12*c");
    CHECK(of_model(ctx, leaks, method, h) != STEIF_SINGULAR);
  }
  steif_context_free(&ctx);
}

/* Index 3 in units far apart, and a rate that hides what is kept: all regular. */
static void regular_pencils_pass(void)
{
  static const char *const models[] = {
    "model \"far apart\"\nstate x ~ 0, v ~ 1e9, f ~ 0\nx' = 1e-9*v\n1e-12*v' = 1e7*f\n"
    "0 = 1e6*x - 1e6*sin(t)\ntime 0 to 1\n",
    "model \"chain\"\nstate a ~ 0, b ~ 0, c ~ 0, d ~ 0\na' = b\nb' = c\nc' = d\n"
    "0 = a - 1e-3*t\ntime 0 to 1e-6\n",
    "model \"fast\"\nstate a = 1, b = 0, z ~ 0\na' = -1e17*(a - b) + z\n"
    "b' = 1e17*(a - b)\n0 = a + b - 1\ntime 0 to 1\n"};
  steif_context *ctx = steif_context_new(NULL);
  for (int k = 0; k < 3; k++)
    for (int method = 0; method < 2; method++) {
      const int code = of_model(ctx, models[k], method ? "bdf" : "radau", 0);
      CHECK(code != STEIF_SINGULAR);
    }
  steif_context_free(&ctx);
}

CU_TestInfo tests_of_singular[] = {
  {"pencils of repeated rows are told", pencils_of_repeated_rows_are_told},
  {"a box needs a pressure", a_box_needs_a_pressure},
  {"a circuit needs a ground", a_circuit_needs_a_ground},
  {"regular pencils pass", regular_pencils_pass},
  CU_TEST_INFO_NULL};
