/* linear.c: solvers over ranks against a product; runs with them against closed solutions and one rank; bad input.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include "shortage.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <steif/data.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* A pencil with entries far from the diagonal, not symmetric; E diagonal, singular in one row. */
typedef struct pencil {
  sunindextype n, rows, first;
  int wrong, alone;
} pencil;
enum { RIGHT, SINGULAR, OUTSIDE, TWICE, FAILS, INFINITE };

static sunrealtype entry(sunindextype i, sunindextype j)
{
  return i == j ? -4 - sin((double)i) : cos((double)(3 * i + 5 * j));
}

static sunindextype neighbours(const pencil *k, sunindextype i, sunindextype *column)
{
  sunindextype used = 0;
  column[used++] = i;
  if (i > 0) column[used++] = i - 1;
  if (i < k->n - 1) column[used++] = i + 1;
  const sunindextype far = (i * 7 + 3) % k->n;
  if (far > i + 1 || far < i - 1) column[used++] = far;
  return used;
}

static int fill_A(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const pencil *k = user;
  sunindextype *at = SM_INDEXPTRS_S(M), *column = SM_INDEXVALS_S(M), used = 0;
  const int wrong = rank == k->alone ? k->wrong : k->wrong == SINGULAR ? SINGULAR : RIGHT;
  (void)t, (void)y, (void)yp;
  at[0] = 0;
  for (sunindextype r = 0; r < k->rows; r++) {
    const sunindextype i = k->first + r, count = neighbours(k, i, column + used);
    for (sunindextype m = 0; m < count; m++)
      SM_DATA_S(M)[used + m] = wrong == SINGULAR && i == 1 ? 0 : entry(i, column[used + m]);
    used += count;
    at[r + 1] = used;
  }
  if (wrong == OUTSIDE && used) column[0] = k->n;
  if (wrong == TWICE && used > 1) column[1] = column[0];
  if (wrong == INFINITE && used) SM_DATA_S(M)[0] = NAN;
  return wrong == FAILS ? -1 : 0;
}

static int fill_E(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const pencil *k = user;
  (void)t, (void)y, (void)yp;
  for (sunindextype r = 0; r < k->rows; r++) {
    SM_INDEXPTRS_S(M)[r] = r;
    SM_INDEXVALS_S(M)[r] = k->first + r;
    SM_DATA_S(M)[r] = k->first + r == 1 ? 0 : 1 + 1. / (double)(k->first + r + 1);
  }
  SM_INDEXPTRS_S(M)[k->rows] = k->rows;
  return 0;
}

static int g(sunrealtype t, int derivative, N_Vector out, void *user)
{
  (void)t, (void)derivative, (void)user;
  N_VConst(0, out);
  return 0;
}

static pencil pencil_of(sunindextype n)
{
  pencil k = {.n = n, .alone = ranks - 1};
  k.first = n * rank / ranks, k.rows = n * (rank + 1) / ranks - k.first;
  return k;
}

static steif_problem problem_of(pencil *k)
{
  return (steif_problem){.name = "pencil",
                         .n = k->n,
                         .t1 = 1,
                         .E = fill_E,
                         .A = fill_A,
                         .g = g,
                         .storage = STEIF_SPARSE,
                         .nnz = 4 * k->rows,
                         .user = k};
}

/* All of x is known everywhere: x_j = sin(j + 1), and b from the entries; transposed or not. */
static sunrealtype known(sunindextype j, int half) { return sin((double)j + 1 + 2 * half); }

static void right_side(const pencil *k, sunrealtype re, sunrealtype im, int transposed,
                       N_Vector *b)
{
  sunrealtype *out[] = {N_VGetArrayPointer(b[0]), N_VGetArrayPointer(b[1])};
  N_VConst(0, b[0]), N_VConst(0, b[1]);
  for (sunindextype i = 0; i < k->n; i++) {
    sunindextype column[4];
    const sunindextype count = neighbours(k, i, column);
    for (sunindextype m = 0; m < count; m++) {
      const sunindextype j = column[m], to = (transposed ? j : i) - k->first,
                         from = transposed ? i : j;
      if (to < 0 || to >= k->rows) continue;
      const sunrealtype e = i == j && i != 1 ? 1 + 1. / (double)(i + 1) : 0,
                        p = re * e - entry(i, j), q = im * e;
      out[0][to] += p * known(from, 0) - q * known(from, 1);
      out[1][to] += p * known(from, 1) + q * known(from, 0);
    }
  }
}

static sunrealtype distance(const pencil *k, N_Vector *x, int halves)
{
  sunrealtype most = 0;
  for (int w = 0; w < halves; w++)
    for (sunindextype i = 0; i < k->rows; i++)
      most = fmax(most, fabs(N_VGetArrayPointer(x[w])[i] - known(k->first + i, w)));
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return most;
}

/* b, and of column c > 0 it times c + 1, with the other sign where c is odd. */
static sunrealtype times(int c) { return c % 2 ? -1 - c : 1 + c; }

/* Real and complex shifts, one analysis for each kind, algebraic row, transposed; n = 2 leaves ranks without rows.
 * `count` right-hand sides at once, x in their place. */
static void solves(sunindextype n, int count)
{
  enum { MOST = 19 };
  static const sunrealtype shift[][2] = {{3, 0}, {0.5, 0}, {2, 1.5}, {0, 40}};
  steif_context *ctx = steif_context_new(NULL);
  pencil k = pencil_of(n);
  const steif_problem p = problem_of(&k);
  N_Vector like = steif_mpi_vector(ctx, MPI_COMM_WORLD, k.rows), b[2 * MOST];
  for (int i = 0; i < 2 * count; i++) b[i] = N_VClone(like);
  ALL(steif_mpi_first(like) == k.first);
  steif_mpi *m = steif_mpi_open(ctx, &p, "mumps", like);
  for (int i = 0; ALL(m != NULL) && i < 8; i++) {
    const sunrealtype re = shift[i % 4][0], im = shift[i % 4][1];
    const int halves = im != 0 ? 2 : 1;
    right_side(&k, re, im, i / 4, b);
    for (int c = halves; c < halves * count; c++)
      N_VScale(times(c / halves), b[c % halves], b[c]);
    const int code = steif_mpi_solve(m, 0, like, like, re, im, i / 4, count, b, b);
    for (int c = 0; c < halves * count; c++) N_VScale(1 / times(c / halves), b[c], b[c]);
    for (int c = 0; c < count; c++)
      if (!ALL(!code && distance(&k, b + halves * c, halves) < 1e-11))
        printf("  shift %g %g, transposed %d: %s\n", re, im, i / 4, steif_message(ctx));
  }
  const steif_mpi_stats told = m ? steif_mpi_statistics(m) : (steif_mpi_stats){0};
  ALL(told.fills == 1 && told.backward_error < 1e-14);
  ALL(m && steif_mpi_solve(m, 0, like, like, 3, 0, 0, 0, b, b) == STEIF_BAD_INPUT);
  steif_mpi_free(&m);
  for (int i = 0; i < 2 * count; i++) N_VDestroy(b[i]);
  N_VDestroy(like);
  steif_context_free(&ctx);
}

/* Each failure with its code, the same sentence on all ranks, and no rank that waits. */
static void wrong(int which, int alone, const char *spec, int expected)
{
  steif_context *ctx = steif_context_new(NULL);
  pencil k = pencil_of(40);
  k.wrong = which, k.alone = alone;
  steif_problem p = problem_of(&k);
  N_Vector like = steif_mpi_vector(ctx, MPI_COMM_WORLD, k.rows);
  N_Vector b[] = {N_VClone(like), NULL}, x[] = {N_VClone(like), NULL};
  N_VConst(1, b[0]);
  steif_mpi *m = steif_mpi_open(ctx, &p, spec, like);
  const int code = m ? steif_mpi_solve(m, 0, like, like, 1, 0, 0, 1, b, x) : steif_status(ctx);
  if (!ALL(code == expected) && rank == 0)
    printf("  case %d, %s: %d, %s\n", which, spec, code, steif_message(ctx));
  ALL(same(ctx));
  steif_mpi_free(&m);
  N_VDestroy(b[0]), N_VDestroy(x[0]), N_VDestroy(like);
  steif_context_free(&ctx);
}

static void bad_input(void)
{
  for (int alone = 0; alone<ranks; alone += ranks> 1 ? ranks - 1 : 1) {
    wrong(OUTSIDE, alone, "mumps", STEIF_BAD_INPUT);
    wrong(TWICE, alone, "mumps", STEIF_BAD_INPUT);
    wrong(INFINITE, alone, "mumps", STEIF_NOT_FINITE);
    wrong(FAILS, alone, "mumps", STEIF_CALLBACK);
  }
  wrong(SINGULAR, 0, "mumps", STEIF_SINGULAR);
  wrong(RIGHT, 0, "mumps:order=nested", STEIF_BAD_INPUT);
  wrong(RIGHT, 0, "amg:cycles=3", STEIF_UNKNOWN_NAME);
  wrong(RIGHT, 0, "pardiso", STEIF_UNKNOWN_NAME);
  wrong(RIGHT, 0, rank == ranks - 1 && ranks > 1 ? "amg" : "mumps",
        ranks > 1 ? STEIF_BAD_INPUT : STEIF_OK);
}

static int product(sunrealtype t, N_Vector y, N_Vector yp, N_Vector x, N_Vector out, void *user)
{
  (void)t, (void)y, (void)yp, (void)x, (void)out, (void)user;
  return -1;
}

/* Rows that do not add up to n, another n on one rank, less than no rows. */
static void sizes(void)
{
  steif_context *ctx = steif_context_new(NULL);
  pencil k = pencil_of(40);
  steif_problem p = problem_of(&k);
  ALL(!steif_mpi_vector(ctx, MPI_COMM_WORLD, rank == ranks - 1 ? -1 : 4) && same(ctx));
  N_Vector like = steif_mpi_vector(ctx, MPI_COMM_WORLD, k.rows);
  p.n = 41;
  ALL(!steif_mpi_open(ctx, &p, "mumps", like) && steif_status(ctx) == STEIF_BAD_INPUT);
  ALL(same(ctx));
  p.n = rank == 0 && ranks > 1 ? 41 : 40;
  steif_mpi *m = steif_mpi_open(ctx, &p, "mumps", like);
  ALL(ranks == 1 || (!m && steif_status(ctx) == STEIF_BAD_INPUT && same(ctx)));
  steif_mpi_free(&m);
  p.n = 40, p.Av = rank == 0 && ranks > 1 ? product : NULL;
  m = steif_mpi_open(ctx, &p, "mumps", like);
  ALL(ranks == 1 || (!m && strstr(steif_message(ctx), "ranks disagree in problem.Av")));
  steif_mpi_free(&m);
  N_VDestroy(like);
  steif_context_free(&ctx);
}

/* Problems that cannot be cut into rows, with the same sentence everywhere. */
static void not_over_ranks(void)
{
  static const struct {
    const char *name;
    int code;
  } not [] = {{"hires", STEIF_UNSUPPORTED},
              {"hirex", STEIF_UNKNOWN_NAME},
              {"blocks", STEIF_UNSUPPORTED},
              {"heat2d:n=0", STEIF_BAD_INPUT},
              {"no/such.steif", STEIF_IO}};
  for (size_t i = 0; i < sizeof not / sizeof *not ; i++) {
    N_Vector like;
    steif_context *ctx = steif_context_new(NULL);
    steif_problem *p = steif_mpi_problem_new(ctx, not [i].name, MPI_COMM_WORLD, &like);
    if (!ALL(!p && !like && steif_status(ctx) == not [i].code) && rank == 0)
      printf("  %s: %s\n", not [i].name, steif_message(ctx));
    ALL(same(ctx));
    steif_mpi_problem_free(ctx, &p, &like);
    steif_context_free(&ctx);
  }
}

/* More memory than is allowed, on all ranks alike. */
static void little_memory(void)
{
  N_Vector like;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, "heat2d:n=150", MPI_COMM_WORLD, &like);
  N_Vector b = N_VClone(like);
  N_VConst(1, b);
  steif_mpi *m = steif_mpi_open(ctx, p, "mumps:memory=1", like);
  ALL(m && steif_mpi_solve(m, 0, like, like, 1, 0, 0, 1, &b, &b) == STEIF_NO_MEMORY);
  ALL(same(ctx) && strstr(steif_message(ctx), "within memory=1 MB on rank "));
  steif_mpi_free(&m);
  N_VDestroy(b);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

/* -- runs ------------------------------------------------------------------------------------- */

/* Steps, the distance from the closed solution and the norm of the end. */
typedef struct end {
  long steps;
  sunrealtype error, norm;
} end;

static end run(MPI_Comm comm, const char *name, const char *spec, const char *method)
{
  N_Vector like;
  end e = {-1, INFINITY, 0};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, name, comm, &like);
  steif_options o = steif_defaults();
  o.rtol = 1e-5, o.like = like;
  if (p) p->t1 = p->linear ? 0.01 : 0.1;
  steif_mpi *m = p ? steif_mpi_open(ctx, p, spec, like) : NULL;
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  if (s && steif_solve_to(s, p->t1) == STEIF_OK) {
    N_Vector y = steif_solution(s), truth = N_VClone(y);
    e.steps = steif_statistics(s)->steps, e.norm = sqrt(N_VDotProd(y, y));
    if (p->exact && !p->exact(p->t1, truth, NULL, p->user)) {
      N_VLinearSum(1, y, -1, truth, truth);
      e.error = N_VMaxNorm(truth);
    }
    N_VDestroy(truth);
  } else
    printf("rank %d, %s %s %s: %s\n", rank, name, spec, method, steif_message(ctx));
  steif_solver_free(&s);
  steif_mpi_free(&m);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
  return e;
}

/* As many steps but for what sums in another order change: every BLAS and every number of ranks has its own. */
static int nearly(long a, long b) { return a > 0 && b > 0 && 8 * labs(a - b) <= a + b; }

static void compare(const char *name, const char *spec, const char *method, int closed)
{
  const end many = run(MPI_COMM_WORLD, name, spec, method);
  end one = {0};
  if (rank == 0) one = run(MPI_COMM_SELF, name, spec, method);
  MPI_Bcast(&one, (int)sizeof one, MPI_BYTE, 0, MPI_COMM_WORLD);
  const int fine = ALL(nearly(many.steps, one.steps)) &
                   ALL(fabs(many.norm - one.norm) <= 1e-5 * (1 + one.norm)) &
                   ALL(!closed || many.error <= 1e-5);
  if (!fine && rank == 0)
    printf("  %s %s %s: %ld and %ld steps, error %.2e, norms %.10g and %.10g\n", name, spec,
           method, many.steps, one.steps, many.error, many.norm, one.norm);
}

/* The norm of the end, which the numbering does not change, by the library without ranks. */
static void same_as_in_one_process(const char *name, const char *method)
{
  const end many = run(MPI_COMM_WORLD, name, "mumps", method);
  steif_problem p;
  steif_options o = steif_defaults();
  steif_context *ctx = steif_context_new(NULL);
  sunrealtype norm = NAN;
  o.rtol = 1e-5;
  if (ALL(steif_problem_find(ctx, name, &p) == STEIF_OK)) {
    p.t1 = 0.01;
    steif_solver *s = steif_solver_new(ctx, &p, method, &o);
    if (s && steif_solve_to(s, p.t1) == STEIF_OK)
      norm = sqrt(N_VDotProd(steif_solution(s), steif_solution(s)));
    steif_solver_free(&s);
    steif_problem_clear(ctx, &p);
  }
  if (!ALL(fabs(many.norm - norm) <= 1e-4 * norm) && rank == 0)
    printf("  %s %s: norms %.10g and %.10g\n", name, method, many.norm, norm);
  steif_context_free(&ctx);
}

static void runs(void)
{
  static const char *const methods[] = {"bdf", "radau:s=3", "dirk:hw43"};
  for (int k = 0; k < 3; k++) compare("heat3d:n=6", "amg", methods[k], 1);
  compare("heat2d:n=8", "mumps", "radau:s=3", 1);
  compare("heat2d:n=2", "mumps", "radau:s=3", 1); /* ranks without rows */
  compare("heat2d:n=2", "amg", "bdf", 1);
  compare("bruss2d:n=6", "mumps", "radau:s=3", 0);
  compare("bruss3d:n=4", "amg:functions=2", "bdf", 0);
  compare("heat2d:n=12", "amg", "cvode", 0);
  compare("heat2d:n=6", "mumps", "ida", 0);
  compare("heat2d:n=6", "amg", "arkode", 0);
  compare("ladder:n=40,case=cons", "mumps", "bdf", 0);
  compare("jordan:k=2,case=N-cons", "mumps", "radau:s=3", 0); /* dense; ranks without rows */
  same_as_in_one_process("ladder:n=40,case=cons", "radau:s=3");
  same_as_in_one_process("ladder:n=40", "radau:s=3"); /* an inconsistent start */
  test_index_two();
}

static void shortage(const char *name, const char *spec, int differences)
{
  int code = 0, found = 1, k = 0;
  for (; found == 1 && k < 400; k++) {
    found = shortage_at(name, spec, differences, k, rank == ranks - 1, &code);
    MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (!ALL(found >= 0) && rank == 0)
      printf("  %s by %s, allocation %d: code %d\n", name, spec, k, code);
  }
  ALL(found == 0 && k > 20); /* to the end */
}

int main(int argc, char **argv)
{
  steif_context *ctx = steif_context_new(NULL);
  const int early =
    !steif_mpi_vector(ctx, MPI_COMM_WORLD, 1) && strstr(steif_message(ctx), "MPI_Init") != NULL;
  steif_context_free(&ctx);
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank), MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  ALL(early);
  const char *part = argc > 1 ? argv[1] : "solves bad runs differences";
  if (strstr(part, "solves")) solves(60, 1), solves(60, 19), solves(2, 3), little_memory();
  if (strstr(part, "differences")) test_differences();
  if (strstr(part, "hard")) test_hard_systems(), test_singular_pencils();
  if (strstr(part, "memory")) test_one_rank_short();
  if (strstr(part, "bad")) bad_input(), sizes(), not_over_ranks(), test_passed_on();
  if (strstr(part, "short"))
    shortage("heat2d:n=4", "mumps", 0), shortage("heat2d:n=4", "amg", 0),
      shortage("jordan:k=2", "mumps", 0), shortage("heat2d:n=4", "mumps", 1);
  if (strstr(part, "runs")) runs();
  MPI_Finalize();
  return failures != 0;
}
