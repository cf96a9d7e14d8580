/* test_grids.c: grids with fixed, reflecting and periodic borders, whose interior, faces and edges are loops
 * of their own, against the sums written here point by point; and compiled models against the interpreter.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include "base/failing.h"
#include "fixture.h"
#include <stdlib.h>
#include <sys/stat.h>

/* u' = sum of the neighbours - u^2 + i - 2 j + 3 k; borders: fixed in i, reflecting in j, periodic in k. */
static const char *const cube =
  "param n = 5 whole, c = 0.3\nstate u[i in 1:n, j in 1:n, k in 1:n] = 1 + i/7 - j/9 + k/11\n"
  "boundary u[0, j in 1:n, k in 1:n] = c, u[n+1, j in 1:n, k in 1:n] = c^2\n"
  "boundary u[i in 1:n, 0, k in 1:n] = u[i, 1, k], u[i in 1:n, n+1, k in 1:n] = u[i, n, k]\n"
  "boundary u[i in 1:n, j in 1:n, 0] = u[i, j, n], u[i in 1:n, j in 1:n, n+1] = u[i, j, 1]\n"
  "for i in 1:n\nfor j in 1:n\nfor k in 1:n\n"
  "u[i,j,k]' = u[i-1,j,k] + u[i+1,j,k] + 2*u[i,j-1,k] + 3*u[i,j+1,k] + 4*u[i,j,k-1] + "
  "5*u[i,j,k+1]"
  " - u[i,j,k]^2 + i - 2*j + 3*k\nend\nend\nend\ntime 0 to 1\n";

static double at(const double *u, int n, int i, int j, int k)
{
  if (i < 0) return 0.3;
  if (i >= n) return 0.3 * 0.3;
  j = j < 0 ? 0 : j >= n ? n - 1 : j;
  k = k < 0 ? n - 1 : k >= n ? 0 : k;
  return u[(i * n + j) * n + k];
}

static double sum_at(const double *u, int n, int i, int j, int k)
{
  const double own = at(u, n, i, j, k);
  return at(u, n, i - 1, j, k) + at(u, n, i + 1, j, k) + 2 * at(u, n, i, j - 1, k) +
         3 * at(u, n, i, j + 1, k) + 4 * at(u, n, i, j, k - 1) + 5 * at(u, n, i, j, k + 1) -
         own * own + (i + 1) - 2 * (j + 1) + 3 * (k + 1);
}

static void three_dimensions(void)
{
  static const int sizes[] = {1, 2, 3, 4, 5, 9, 12};
  char rest[20];
  for (size_t m = 0; m < sizeof sizes / sizeof *sizes; m++) {
    fixture s;
    const int n = sizes[m];
    snprintf(rest, sizeof rest, ":n=%d", n);
    CU_ASSERT_FATAL(fixture_text(&s, cube, rest) == STEIF_OK);
    N_Vector y = N_VNew_Serial(s.p.n, steif_sundials(s.ctx)), f = N_VClone(y);
    for (int i = 0; i < s.p.n; i++) NV_Ith_S(y, i) = sin(3.0 * i);
    CHECK(!s.p.f(0, y, f, s.p.user));
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++)
          CLOSE_FLOOR(NV_Ith_S(f, (i * n + j) * n + k), sum_at(NV_DATA_S(y), n, i, j, k), 1e-14,
                      20);
    N_VDestroy(y), N_VDestroy(f);
    fixture_close(&s);
  }
}

/* A stencil of width two, and borders given for a part of the side at a time. */
static void wide_stencils(void)
{
  fixture s;
  const int n = 30;
  CU_ASSERT_FATAL(
    fixture_text(
      &s,
      "param n = 30 whole\nstate u[i in 1:n, j in 1:n] = i + j/100\n"
      "boundary u[0, j in 1:12] = 7, u[0, j in 13:n] = -u[2, j], u[-1, j in 1:n] = j\n"
      "for i in 1:n-2\nfor j in 1:n\nu[i,j]' = u[i-2,j] - u[i-1,j] + u[i+2,j]*j\nend\nend\n"
      "for i in n-1:n\nfor j in 1:n\nu[i,j]' = i*u[i,j]\nend\nend\ntime 0 to 1\n",
      "") == STEIF_OK);
  N_Vector y = N_VNew_Serial(s.p.n, steif_sundials(s.ctx)), f = N_VClone(y);
  for (int i = 0; i < s.p.n; i++) NV_Ith_S(y, i) = cos(2.0 * i);
  const double *u = NV_DATA_S(y);
  CHECK(!s.p.f(0, y, f, s.p.user));
  for (int i = 1; i <= n; i++)
    for (int j = 1; j <= n; j++) {
      const double one = i > 1 ? u[(i - 2) * n + j - 1] : j <= 12 ? 7 : -u[n + j - 1];
      const double two = i > 2     ? u[(i - 3) * n + j - 1]
                         : i == 1  ? j
                         : j <= 12 ? 7
                                   : -u[n + j - 1];
      const double wanted =
        i > n - 2 ? i * u[(i - 1) * n + j - 1] : two - one + u[(i + 1) * n + j - 1] * j;
      CLOSE_FLOOR(NV_Ith_S(f, (i - 1) * n + j - 1), wanted, 1e-14, 10);
    }
  N_VDestroy(y), N_VDestroy(f);
  fixture_close(&s);
}

/* ---- compiled --------------------------------------------------------------------------------- */

static char cache[300];

static void run_to_end(fixture *s, double *y)
{
  steif_solver *solver = steif_solver_new(s->ctx, &s->p, "radau:s=3", NULL);
  CU_ASSERT_FATAL(solver != NULL);
  CHECK(steif_solve_to(solver, s->p.t1) >= 0);
  memcpy(y, N_VGetArrayPointer(steif_solution(solver)), (size_t)s->p.n * sizeof *y);
  steif_solver_free(&solver);
}

/* Twice: made, and found in the folder. Events and discrete values among them. */
static void the_same_numbers(void)
{
  static const char *const names[] = {"rober.steif",    "converter.steif",
                                      "hunters.steif",  "reactor.steif",
                                      "transamp.steif", "brusselator.steif:n=100"};
  char folder[200];
  CU_ASSERT_FATAL(folder_make(folder, sizeof folder) != NULL);
  snprintf(cache, sizeof cache, "%s/a b/models", folder);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    for (int turn = 0; turn < 2; turn++) {
      fixture s;
      CU_ASSERT_FATAL(fixture_example(&s, names[i]) == STEIF_OK);
      double *y[2] = {calloc((size_t)s.p.n, sizeof(double)),
                      calloc((size_t)s.p.n, sizeof(double))};
      run_to_end(&s, y[0]);
      const int code = steif_model_compile(s.ctx, &s.p, turn ? "/none" : C_COMPILER, cache);
      if (!turn && code) printf("\n  %s", steif_message(s.ctx));
      CHECK(code == (turn ? STEIF_UNSUPPORTED : STEIF_OK));
      if (turn) CHECK(!steif_model_compile(s.ctx, &s.p, C_COMPILER, cache));
      run_to_end(&s, y[1]);
      CHECK(!memcmp(y[0], y[1], (size_t)s.p.n * sizeof(double)));
      free(y[0]), free(y[1]);
      fixture_close(&s);
    }
  struct stat found;
  CHECK(!stat(cache, &found) && (found.st_mode & 0777) == 0700);
  char command[700];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  CHECK(system(command) == 0);
}

static int compile_text(const char *folder, const char *compiler, const char *words)
{
  fixture s;
  CU_ASSERT_FATAL(fixture_text(&s, "state x = 1\nx' = -2*x\ntime 0 to 1\n", "") == STEIF_OK);
  const int code = steif_model_compile(s.ctx, &s.p, compiler, folder);
  CHECK(!words || strstr(steif_message(s.ctx), words) != NULL);
  double y;
  run_to_end(&s, &y);
  CLOSE(y, exp(-2), 1e-4);
  fixture_close(&s);
  return code;
}

/* Another user's folder, a file changed by somebody, a compiler that fails: never used, and said. */
static void what_is_not_used(void)
{
  char folder[200], command[700];
  CU_ASSERT_FATAL(folder_make(folder, sizeof folder) != NULL);
  snprintf(cache, sizeof cache, "%s/models", folder);
  CHECK(compile_text("models", C_COMPILER, "absolute path") == STEIF_BAD_INPUT);
  CHECK(compile_text(NULL, C_COMPILER, NULL) == STEIF_OK);
  CHECK(compile_text(cache, "/bin/false", "did not compile") == STEIF_UNSUPPORTED);
  CHECK(compile_text(cache, "no-such-compiler -x", "no C compiler") == STEIF_UNSUPPORTED);
  CHECK(compile_text(cache, C_COMPILER, NULL) == STEIF_OK);
  /* a text that is not ours beside the library: it is made again */
  snprintf(
    command, sizeof command,
    "cd '%s' && for f in *.c; do echo >> $f; done && for f in *.so; do echo no > $f; done",
    cache);
  CHECK(system(command) == 0);
  CHECK(compile_text(cache, C_COMPILER, NULL) == STEIF_OK);
  snprintf(command, sizeof command, "cd '%s' && for f in *.so; do echo no > $f; done", cache);
  CHECK(system(command) == 0);
  CHECK(compile_text(cache, C_COMPILER, "cannot be opened") == STEIF_IO);
  CHECK(!chmod(cache, 0777));
  CHECK(compile_text(cache, C_COMPILER, "open to other users") == STEIF_IO);
  snprintf(command, sizeof command, "chmod 700 '%s' && rm -r '%s'", cache, folder);
  CHECK(system(command) == 0);
}

/* As root alone: a folder that is given to another user, and a link of another user to one of ours. */
static void what_others_could_change(void)
{
  enum { OTHER = 65534 };
  char folder[200], link[300], command[700];
  if (geteuid() != 0) return;
  CU_ASSERT_FATAL(folder_make(folder, sizeof folder) != NULL);
  snprintf(cache, sizeof cache, "%s/models", folder);
  snprintf(link, sizeof link, "%s/link", folder);
  CHECK(compile_text(cache, C_COMPILER, NULL) == STEIF_OK);
  CHECK(!symlink(cache, link) && !lchown(link, OTHER, OTHER));
  strcat(link, "/deeper");
  CHECK(compile_text(link, C_COMPILER, "by a link of another user") == STEIF_IO);
  CHECK(!chown(cache, OTHER, OTHER));
  CHECK(compile_text(cache, C_COMPILER, "belongs to another user") == STEIF_IO);
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  CHECK(system(command) == 0);
}

/* ---- memory ----------------------------------------------------------------------------------- */

/* All that can be asked of a model. `in` the same vectors for all calls. */
static int life(steif_context *ctx, steif_problem *p, N_Vector *in)
{
  double c[12] = {1, 0.5, 0.1}, F[8], by_p[2];
  STEIF_TRY(
    steif_model_parse(ctx,
                      "param a = 1, b = 2\nstate x = a, y = b\nx' = -a*x*y\ny' = b*x - exp(y)\n"
                      "output z = x + y\ninvariant w = x - y\ntime 0 to 1\n",
                      "m.steif", NULL, p));
  STEIF_TRY(steif_model_tangent(ctx, p, 0, in[0], in[1], in[2], NULL, NULL, in[3]));
  STEIF_TRY(steif_model_adjoint(ctx, p, 0, in[0], in[1], in[2], in[3], NULL, by_p));
  STEIF_TRY(steif_model_taylor(ctx, p, 0, 2, c, F));
  STEIF_TRY(steif_parameter_slope(ctx, p, 1, 0, in[0], in[1], in[3]));
  STEIF_TRY(steif_parameter_start(ctx, p, 1, in[3]));
  STEIF_TRY(steif_parameter_pull(ctx, p, 0, in[0], in[1], in[2], by_p));
  if (!steif_model_c(ctx, p)) return steif_status(ctx);
  STEIF_TRY(steif_model_set(ctx, p, "a", 3));
  return steif_model_compile(ctx, p, "/none", NULL) == STEIF_UNSUPPORTED ? STEIF_OK
                                                                         : STEIF_NO_MEMORY;
}

static void memory_may_be_short_anywhere(void)
{
  steif_context *own = steif_context_new(NULL);
  N_Vector in[4] = {N_VNew_Serial(2, steif_sundials(own))};
  for (int i = 1; i < 4; i++) in[i] = N_VClone(in[0]);
  for (int i = 0; i < 4; i++) N_VConst(0.3 + i, in[i]);
  for (long k = 1;; k++) {
    failing memory = {.refuse_at = k};
    steif_setup setup = failing_setup(&memory);
    setup.threads = 1;
    steif_context *ctx = steif_context_new(&setup);
    steif_problem p = {0};
    const int code = ctx ? life(ctx, &p, in) : STEIF_NO_MEMORY;
    if (ctx) steif_problem_clear(ctx, &p);
    steif_context_free(&ctx);
    CHECK(memory.alive == 0);
    if (memory.served < k) {
      CHECK(code == STEIF_OK && k > 100);
      break;
    }
    if (code != STEIF_NO_MEMORY) printf("\n  k = %ld: %d", k, code);
    CHECK(code == STEIF_NO_MEMORY);
  }
  for (int i = 0; i < 4; i++) N_VDestroy(in[i]);
  steif_context_free(&own);
}

CU_TestInfo tests_of_grids[] = {{"three dimensions", three_dimensions},
                                {"wide stencils and borders in parts", wide_stencils},
                                {"compiled models give the same numbers", the_same_numbers},
                                {"what is not used", what_is_not_used},
                                {"what others could change", what_others_could_change},
                                {"memory may be short", memory_may_be_short_anywhere},
                                CU_TEST_INFO_NULL};
