/* passed_on.c: what a problem and its caller give goes on through steif_mpi_problem, and what its callbacks say comes
 * back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checks.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/quadrature.h>
#include <string.h>
#include <sunmatrix/sunmatrix_sparse.h>

static const steif_problem *given;
static steif_matrix_fill fill;
static int others; /* calls with another user than the problem's */

static int clock_of(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  (void)t, (void)y;
  others += user != given->user;
  value[0] = 1;
  return 0;
}

static int weights(N_Vector y, N_Vector w, void *user)
{
  others += user != given->user;
  N_VAbs(y, w);
  N_VScale(1e-4, w, w);
  N_VAddConst(w, 1e-4, w);
  N_VInv(w, w);
  return 0;
}

static int no_number(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const int code = fill(t, y, yp, M, user);
  if (rank == ranks - 1 && SM_INDEXPTRS_S(M)[1] > 0) SM_DATA_S(M)[0] = NAN;
  return code;
}

/* The time passed, by the problem's user. */
static void integrals_and_weights(const char *name, const char *spec, const char *method)
{
  N_Vector like;
  steif_quadrature q = {.count = 1, .value = clock_of};
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, name, MPI_COMM_WORLD, &like);
  steif_options o = steif_defaults();
  sunrealtype passed = NAN;
  o.rtol = 1e-4, o.like = like, o.ewt = weights;
  p->quadrature = &q, p->t1 = 0.01, given = p, others = 0;
  steif_mpi *m = steif_mpi_open(ctx, p, spec, like);
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (!ALL(code == STEIF_OK) && rank == 0) printf("  %s: %s\n", method, steif_message(ctx));
  ALL(s && steif_quadrature_values(s, p->t1, &passed) == STEIF_OK);
  ALL(fabs(passed - p->t1) < 1e-12 && others == 0);
  steif_solver_free(&s);
  steif_mpi_free(&m);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

/* The first sentence, with its code, of a matrix that is asked for first by products of E, or a preconditioner. */
static void first_sentence(const char *name, const char *method)
{
  N_Vector like;
  char words[60];
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, name, MPI_COMM_WORLD, &like);
  steif_options o = steif_defaults();
  o.rtol = 1e-4, o.like = like, fill = p->A, p->A = no_number;
  steif_mpi *m = steif_mpi_open(ctx, p, "mumps", like);
  steif_solver *s = m ? steif_solver_new(ctx, steif_mpi_problem(m), method, &o) : NULL;
  const int code = s ? steif_solve_to(s, 0.01) : steif_status(ctx);
  snprintf(words, sizeof words, "is nan (rank %d) [STEIF_NOT_FINITE]", ranks - 1);
  if (!ALL(code == STEIF_NOT_FINITE && strstr(steif_message(ctx), words)) && rank == 0)
    printf("  %s\n", steif_message(ctx));
  ALL(same(ctx));
  steif_solver_free(&s);
  steif_mpi_free(&m);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

/* What is asked for differs. */
static void questions(void)
{
  N_Vector like;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, "heat2d:n=4", MPI_COMM_WORLD, &like);
  N_Vector b[] = {N_VClone(like), N_VClone(like)};
  steif_mpi *m = steif_mpi_open(ctx, p, "mumps", like);
  const int code = steif_mpi_solve(m, 0, like, like, 1, rank == 0 && ranks > 1, 0, 1, b, b);
  ALL(code == (ranks > 1 ? STEIF_BAD_INPUT : STEIF_OK) && same(ctx));
  steif_mpi_free(&m);
  N_VDestroy(b[0]), N_VDestroy(b[1]);
  steif_mpi_problem_free(ctx, &p, &like);
  p = steif_mpi_problem_new(ctx, rank ? "ladder:n=40,case=cons" : "heat2d:n=4", MPI_COMM_WORLD,
                            &like);
  ALL(ranks == 1 || (!p && !like && steif_status(ctx) == STEIF_BAD_INPUT && same(ctx)));
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

/* The vectors are those of the problem where options have none; those of one process are rejected. On the last rank alone
 * too: with options.like on the others. */
static void vectors(int opened, int wrong)
{
  N_Vector like;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, "heat2d:n=6", MPI_COMM_WORLD, &like);
  N_Vector serial = N_VNew_Serial(p->n, steif_sundials(ctx));
  steif_options o = steif_defaults();
  o.rtol = 1e-6, o.like = rank < ranks - 1 ? like : wrong ? serial : NULL;
  if (!opened) o.storage = STEIF_KRYLOV, o.force_storage = 1;
  steif_mpi *m = opened ? steif_mpi_open(ctx, p, "mumps", like) : NULL;
  steif_solver *s =
    steif_solver_new(ctx, m ? steif_mpi_problem(m) : p, opened ? "bdf" : "dopri87", &o);
  if (wrong) {
    ALL(!s && steif_status(ctx) == STEIF_BAD_INPUT && same(ctx));
    ALL(strstr(steif_message(ctx), "options.like is of one process") != NULL);
  } else {
    N_Vector exact = N_VClone(like);
    if (!ALL(s && steif_solve_to(s, 0.01) == STEIF_OK) && rank == 0)
      printf("  %s\n", steif_message(ctx));
    ALL(!p->exact(0.01, exact, NULL, p->user));
    N_VLinearSum(1, exact, -1, steif_solution(s), exact);
    ALL(N_VMaxNorm(exact) < 1e-4);
    N_VDestroy(exact);
  }
  steif_solver_free(&s);
  steif_mpi_free(&m);
  N_VDestroy(serial);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

static int far_pointer(sunrealtype t, N_Vector y, N_Vector yp, SUNMatrix M, void *user)
{
  const int code = fill(t, y, yp, M, user);
  if (rank == ranks - 1 && SM_ROWS_S(M) > 2) SM_INDEXPTRS_S(M)[2] = (sunindextype)1 << 40;
  return code;
}

/* Pointers in the middle are looked at before what they point to. */
static void pointers(void)
{
  N_Vector like;
  steif_context *ctx = steif_context_new(NULL);
  steif_problem *p = steif_mpi_problem_new(ctx, "heat2d:n=6", MPI_COMM_WORLD, &like);
  N_Vector b = N_VClone(like);
  fill = p->A, p->A = far_pointer;
  steif_mpi *m = steif_mpi_open(ctx, p, "mumps", like);
  ALL(steif_mpi_solve(m, 0, like, like, 1, 0, 0, 1, &b, &b) == STEIF_BAD_INPUT && same(ctx));
  ALL(strstr(steif_message(ctx), "the index pointers of A decrease at row ") != NULL);
  steif_mpi_free(&m);
  N_VDestroy(b);
  steif_mpi_problem_free(ctx, &p, &like);
  steif_context_free(&ctx);
}

void test_passed_on(void)
{
  questions(), pointers();
  for (int opened = 0; opened < 2; opened++)
    for (int wrong = 0; wrong < 2; wrong++) vectors(opened, wrong);
  integrals_and_weights("heat2d:n=6", "amg", "bdf");
  integrals_and_weights("heat2d:n=6", "mumps", "radau:s=2");
  integrals_and_weights("heat2d:n=6", "amg", "cvode");
  first_sentence("ladder:n=40,case=cons", "bdf");
  first_sentence("heat2d:n=6", "cvode"), first_sentence("heat2d:n=6", "ida");
}
