/* solve_system.c: E x' = A x + f from files as a problem.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "descriptor.h"
#include "solve_system.h"
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

/* A as F = -A. */
static void negate(SUNMatrix M)
{
  const bool dense = SUNMatGetID(M) == SUNMATRIX_DENSE;
  const sunindextype count = dense ? SM_LDATA_D(M) : SM_INDEXPTRS_S(M)[SM_COLUMNS_S(M)];
  sunrealtype *x = dense ? SM_DATA_D(M) : SM_DATA_S(M);
  for (sunindextype k = 0; k < count; k++) x[k] = -x[k];
}

/* A dense matrix beside a sparse one becomes sparse. */
static bool unify(SUNMatrix *M, const SUNMatrix other)
{
  if (SUNMatGetID(*M) != SUNMATRIX_DENSE || SUNMatGetID(other) != SUNMATRIX_SPARSE) return true;
  SUNMatrix S = SUNSparseFromDenseMatrix(*M, 0, CSC_MAT);
  if (!S) return false;
  SUNMatDestroy(*M);
  *M = S;
  return true;
}

static int solve(struct call *call, const struct descriptor *l,
                 int (*work)(struct call *call, const steif_problem *p))
{
  const double t1 = real_of(call, "--t1");
  double breaks[REALS_MOST];
  steif_problem p;
  if (!given(call, "--t1"))
    return bad_usage(call, "--t1 T is needed: the end of the run of matrices");
  const size_t count = steif_function_breaks(l->function, 0, t1, REALS_MOST, breaks);
  if (count > REALS_MOST)
    return bad_usage(call, "f has %zu breaks up to t = %g; %d are the most", count, t1,
                     REALS_MOST);
  if (steif_linear_problem(call->ctx, &l->system, l->x0, 0, t1, &p)) return fail(call);
  p.name = call->word[0];
  p.names = l->names;
  p.breaks = breaks;
  p.break_count = (int)count;
  const int code = work(call, &p);
  steif_problem_clear(call->ctx, &p);
  return code;
}

static bool is_matrix_file(const char *word)
{
  const size_t length = strlen(word);
  return length > 4 && !strcmp(word + length - 4, ".mtx");
}

int solve_system(struct call *call, int (*work)(struct call *call, const steif_problem *p))
{
  struct descriptor l;
  const int words = call->words;
  const bool two = words > 2;
  if (is_matrix_file(call->word[words - 1]))
    return bad_usage(
      call, "%s is a file of a matrix where the method is due: steif solve E.mtx A.mtx auto",
      call->word[words - 1]);
  call->words = words - 1; /* all but the method: the matrices */
  int code = descriptor_open(call, &l, 0, true);
  if (!code) code = descriptor_started(call, &l);
  call->words = words;
  if (!code && (!unify(&l.system.E, l.system.F) || !unify(&l.system.F, l.system.E)))
    code = no_memory(call, "sparse matrices", "save both as coordinates");
  if (!code && two) negate(l.system.F);
  if (!code) code = solve(call, &l, work);
  descriptor_close(call, &l);
  return code;
}
