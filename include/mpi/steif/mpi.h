/* steif/mpi.h: problems whose unknowns are spread over the ranks of MPI; the library steif-mpi.
 *
 * A rank owns consecutive rows of y, E and A, the first rank the first ones. The same calls solve the problem as in
 * one process: a vector of own rows, made by steif_mpi_vector, is options.like; callbacks read and write own rows,
 * exchange what they need of neighbours, and are called on all ranks at the same places. y0, yp0, atols, index,
 * constraint and names are of own rows; a rank without rows gives a pointer where the others do. All else that a run
 * looks at is the same on all ranks: numbers, times, the method, events, parameters, which callbacks there are;
 * STEIF_BAD_INPUT names the member in which ranks disagree. Event functions, invariants and integrands (quadrature.h)
 * have the same values on all of them, so the callback sums up. steif_solve_to, steif_solver_extend and
 * steif_quadrature_values are called by all ranks with the same t; steif_dense too, with the explicit methods whose
 * dense output evaluates f, and arkode. Not over ranks: sensitivities, reinitialise, steif_recompute, checkpoints. A
 * run needs a vector over ranks on all of them: a problem of steif_mpi_open brings it where options.like is NULL, and
 * rejects one of one process; without steif_mpi_open such a run does not know of the other ranks.
 *
 * Linear systems (c E - A) x = b: steif_mpi_open makes of a problem with A (and E) by rows one that GMRES solves
 * with a preconditioner made of these rows:
 *
 *   "mumps"    factors by MUMPS, real and complex: P = c E - A itself, for each shift; a few iterations, of which
 *              there is more than one only while factors of an earlier step size or Jacobian serve.
 *              mumps:order=metis|amf|amd|ptscotch: nested dissection by METIS on rank 0, found once for a pattern; up to
 *              200 unknowns amf, approximate minimum fill, whose trees are as deep as a chain of unknowns is long
 *              and may take more stack than there is; ptscotch: by all ranks, for many thousand unknowns each, with
 *              SCOTCH_PTHREAD_NUMBER=1 in the environment or MPI_THREAD_MULTIPLE;
 *              memory=MB a rank (as much as it takes), refine=N sweeps (2)
 *   "amg"      one cycle of BoomerAMG of hypre for the real c E - A, at |c| for both halves of a complex system:
 *              for elliptic parts; every row needs a diagonal entry.
 *              amg:strong=X threshold of strong connections (0.25), functions=N interleaved unknowns a point (1)
 *
 * P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, A fully asynchronous multifrontal solver using
 * distributed dynamic scheduling, SIAM J. Matrix Anal. Appl. 23, 2001; V. E. Henson, U. M. Yang, BoomerAMG, Appl.
 * Numer. Math. 41, 2002.
 *
 * Failures are the same on all ranks, code and sentence, unless said otherwise.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_MPI_H
#define STEIF_MPI_H

#include <mpi.h>
#include <nvector/nvector_parallel.h>
#include <steif/steif.h>
#include <steif/team.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_mpi steif_mpi;

/* What the linear solves of this rank have cost. */
typedef struct steif_mpi_stats {
  long fills;            /* of A by the callback */
  long analyses, setups; /* of MUMPS; factorisations or AMG hierarchies */
  long solves;           /* of MUMPS, refinement included, or AMG cycles */
  long exchanges;        /* of rows with neighbours */
  long long sent;        /* bytes of them, from this rank */
  double memory;         /* MB that the factors of MUMPS take on this rank at most */
  /* The largest |b - M x|_i / (|M| |x| + |b|)_i after refinement, of M^T as well (W. Oettli, W. Prager, Numer. Math. 6,
   * 1964); rows whose terms are rounding of others are measured beside the longest |x|. 1: nothing is known, as terms
   * are beyond the largest number. */
  double backward_error;
  long evaluations; /* of f or F for differences */
  int colours;      /* of the columns then */
} steif_mpi_stats;

/* A vector of `rows` rows of this rank, 0 or more, zeroed; NULL with the sentence set: rows < 0 on one rank, MPI
 * is not initialised (then on the rank that asks). N_VDestroy frees it. */
STEIF_EXPORT N_Vector steif_mpi_vector(steif_context *ctx, MPI_Comm comm, sunindextype rows);

/* The number, from 0, of the first own row. */
STEIF_EXPORT sunindextype steif_mpi_first(N_Vector v);

/* The problem with one of the solvers above, for vectors like `like`, which is kept until steif_mpi_free; NULL with
 * the sentence set. problem->A, and E where there is one, fill SUNSparseMatrix(rows, n, nnz, CSR_MAT): index
 * pointers of own rows, column numbers from 0 to n - 1 in any order, none twice in a row; problem->nnz and nnz_E is
 * the room on this rank. A = df/dy, or -dF/dy at the (t, y, y') given; E is constant. Without A, problem->pattern
 * is that of own rows: row i has the columns pattern->row[pattern->column[i]] .., ascending, global numbers; A comes
 * from differences of f (of F: E too), an evaluation for each colour and one, columns that share no row being one
 * colour, the same colours for any number of ranks. Increments are 1.5e-8 max(|y_j|, rtol_scale). The callback is
 * called equally often on all ranks. For constant coefficients (.linear, or the descriptor form) products come from the
 * rows too, and entries that the pattern lacks are an error; else products come from .Av or differences of f, and what
 * the pattern lacks costs iterations.
 * STEIF_BAD_INPUT: rows that do not add up to n, ranks with different problems or specs, columns out of range;
 * STEIF_UNKNOWN_NAME: no such solver; STEIF_UNSUPPORTED: more rows than the integers of MUMPS or hypre hold. */
STEIF_EXPORT steif_mpi *steif_mpi_open(steif_context *ctx, const steif_problem *problem,
                                       const char *spec, N_Vector like);
/* What steif_solver_new is given instead of `problem`. Storage Krylov; callbacks are those of the problem, called with its
 * user, as options.ewt is; .L, parameters and its preconditioner are left out. */
STEIF_EXPORT const steif_problem *steif_mpi_problem(const steif_mpi *m);
STEIF_EXPORT steif_mpi_stats steif_mpi_statistics(const steif_mpi *m);
/* After the solvers that use it; NULL is accepted. On all ranks, before MPI_Finalize. */
STEIF_EXPORT void steif_mpi_free(steif_mpi **m);

/* x = (c E - A)^{-1} b, or the transposed (not conjugated) one, by MUMPS, for `count` >= 1 right-hand sides, own rows of
 * x and b, and the (t, y, yp) given. c_im = 0: b and x are `count` vectors; else their real and imaginary parts by turns,
 * 2 count of them. Several at once cost less than one after the other: 16 go through the factors together. x may be b.
 * `spec` must have been "mumps". Rows and columns are scaled by powers of two before c E - A is factored, and solutions
 * refined. STEIF_SINGULAR: it is, exactly or to rounding: by three scalings its reciprocal condition is below 4e-16, or a
 * sweep of refinement changes more than a twentieth of a solution, which some solves tell once for each factorisation.
 * STEIF_BAD_INPUT: count, or c is not finite; STEIF_NOT_FINITE: b is not, or x is beyond the largest number. */
STEIF_EXPORT int steif_mpi_solve(steif_mpi *m, sunrealtype t, N_Vector y, N_Vector yp,
                                 sunrealtype c_re, sunrealtype c_im, int transposed, int count,
                                 N_Vector *b, N_Vector *x);

/* Problems of the collection over ranks: "heat2d:n=32", "heat3d:n=20", "bruss2d:n=32", "bruss3d:n=12"; whole grid
 * lines or planes to a rank, unknowns of a point together. Any other is a linear system E x' + F x = f with constant
 * E and F ("ladder:n=1000,case=cons"; E.steif models too), for "mumps": every rank builds all of it, keeps its own
 * rows, numbered by levels of the graph of F so that ranks have few neighbours, and evaluates all of f.
 * As in one process, an inconsistent start is moved to x(0+), and the index of the unknowns found, by rank 0 for all; so
 * are x(t+) after breaks of f and, of index 2, what is shown (problem.project), for which rank 0 keeps factors of the
 * pencil. STEIF_NOT_CERTIFIED of a run: these are not certain at t.
 * *like is a vector of own rows. NULL with the sentence set; STEIF_UNSUPPORTED: another form, index 3, or breaks of f
 * where the index is 2 and the structure not certified (impulse.h). The problem must outlive what uses it. */
STEIF_EXPORT steif_problem *steif_mpi_problem_new(steif_context *ctx, const char *spec,
                                                  MPI_Comm comm, N_Vector *like);
/* What was done about the start of such a problem, "" when nothing was. */
STEIF_EXPORT const char *steif_mpi_start(const steif_problem *problem);
/* The number, from 0, of own row k of such a problem (0 <= k < own rows) among the unknowns of the same problem in one
 * process. */
STEIF_EXPORT sunindextype steif_mpi_number(const steif_problem *problem, sunindextype k);
/* Frees the vector too. */
STEIF_EXPORT void steif_mpi_problem_free(steif_context *ctx, steif_problem **problem,
                                         N_Vector *like);

/* A team of the ranks of a communicator, which share the analyses of large descriptor systems (steif/team.h): rank 0
 * leads (steif_team_lead) and makes the calls, the others serve (steif_team_serve) until it dismisses them. NULL with
 * the sentence set: MPI is not initialised, or the communicator has one rank. */
STEIF_EXPORT steif_team *steif_mpi_team_new(steif_context *ctx, MPI_Comm comm);
/* On all ranks, before MPI_Finalize and the end of the context; NULL is accepted. */
STEIF_EXPORT void steif_mpi_team_free(steif_team **team);

#ifdef __cplusplus
}
#endif
#endif
