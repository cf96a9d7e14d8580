/* amg.c: one cycle of BoomerAMG for the real matrix c E - A; coarsening HMIS, extended interpolation (H. De Sterck,
 * U. M. Yang, J. J. Heys, SIAM J. Matrix Anal. Appl. 27, 2006), l1 Gauss-Seidel in symmetric order as smoother.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "own_rows.h"
#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>
#include <stdlib.h>
#include <string.h>

typedef struct amg {
  rows *r;
  double strong;
  int functions;
  HYPRE_Int *count; /* own rows: entries */
  HYPRE_BigInt *row, *column;
  long revision; /* of the pattern they are for */
  double *value;
  HYPRE_IJMatrix M;
  HYPRE_IJVector b, x;
  HYPRE_Solver solver;
} amg;

static int number(rows *r, const steif_spec *spec, int k, double low, double high,
                  double *value)
{
  char *end;
  *value = strtod(spec->param[k].value, &end);
  if (*end == 0 && *value >= low && *value <= high) return STEIF_OK;
  return steif_fail(r->ctx, STEIF_BAD_INPUT, "amg: %s = %s is not a number from %g to %g",
                    spec->param[k].key, spec->param[k].value, low, high);
}

static int read(amg *g, const steif_spec *spec)
{
  g->strong = 0.25, g->functions = 1;
  for (int k = 0; k < spec->count; k++) {
    const char *key = spec->param[k].key;
    double value;
    if (!strcmp(key, "strong")) {
      MPI_TRY(number(g->r, spec, k, 0, 1, &value));
      g->strong = value;
    } else if (!strcmp(key, "functions")) {
      MPI_TRY(number(g->r, spec, k, 1, 64, &value));
      g->functions = (int)value;
    } else
      return steif_fail(g->r->ctx, STEIF_UNKNOWN_NAME,
                        "amg has no parameter '%s': there are strong and functions", key);
  }
  return STEIF_OK;
}

/* hypre keeps the error of a cycle that has not converged; it is none. */
static int told(amg *g, const char *what)
{
  const HYPRE_Int error = HYPRE_GetError() & ~HYPRE_ERROR_CONV;
  HYPRE_ClearAllErrors();
  if (!error) return STEIF_OK;
  return steif_fail(g->r->ctx, error & HYPRE_ERROR_MEMORY ? STEIF_NO_MEMORY : STEIF_BASELINE,
                    "hypre could not %s on rank %d (its error %d)", what, g->r->own.rank,
                    (int)error);
}

static void drop(amg *g)
{
  if (g->solver) HYPRE_BoomerAMGDestroy(g->solver);
  if (g->M) HYPRE_IJMatrixDestroy(g->M);
  g->solver = NULL, g->M = NULL;
}

static void forget(amg *g)
{
  drop(g);
  if (g->b) HYPRE_IJVectorDestroy(g->b);
  if (g->x) HYPRE_IJVectorDestroy(g->x);
  g->b = g->x = NULL;
  steif_context *ctx = g->r->ctx;
  void *const all[] = {g->count, g->row, g->column, g->value};
  for (int i = 0; i < 4; i++) steif_release(ctx, all[i]);
  g->count = NULL, g->row = g->column = NULL, g->value = NULL;
}

static void finish(void *state)
{
  amg *g = state;
  forget(g);
  steif_release(g->r->ctx, g);
}

static int start(rows *r, const steif_spec *spec, void **state)
{
  amg *g = *state = steif_allocate(r->ctx, 1, sizeof *g);
  if (!g) return STEIF_NO_MEMORY;
  g->r = r;
  HYPRE_Init(); /* once for a process; further calls do nothing */
  HYPRE_ClearAllErrors();
  return read(g, spec);
}

/* Pattern in hypre's integers; every row needs a diagonal entry. */
static int pattern(amg *g)
{
  const rows *r = g->r;
  forget(g);
  const size_t here = (size_t)r->own.rows + 1, entries = (size_t)r->entries + 1;
  g->count = steif_allocate(r->ctx, here, sizeof *g->count);
  g->row = steif_allocate(r->ctx, here, sizeof *g->row);
  g->column = steif_allocate(r->ctx, entries, sizeof *g->column);
  g->value = steif_allocate(r->ctx, entries, sizeof *g->value);
  if (!g->count || !g->row || !g->column || !g->value) return STEIF_NO_MEMORY;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    g->row[i] = (HYPRE_BigInt)(r->own.first + i);
    g->count[i] = (HYPRE_Int)(r->row_at[i + 1] - r->row_at[i]);
  }
  for (sunindextype k = 0; k < r->entries; k++) g->column[k] = (HYPRE_BigInt)r->column[k];
  g->revision = r->revision;
  return STEIF_OK;
}

static int vectors(amg *g)
{
  const owners *o = &g->r->own;
  const HYPRE_BigInt low = (HYPRE_BigInt)o->first, high = low + (HYPRE_BigInt)o->rows - 1;
  HYPRE_IJVector *const each[] = {&g->b, &g->x};
  for (int i = 0; i < 2; i++) {
    HYPRE_IJVectorCreate(o->comm, low, high, each[i]);
    HYPRE_IJVectorSetObjectType(*each[i], HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(*each[i]);
    HYPRE_IJVectorAssemble(*each[i]);
  }
  return told(g, "make vectors");
}

static int values(amg *g, double c)
{
  const rows *r = g->r;
  for (sunindextype i = 0; i < r->own.rows; i++) {
    double diagonal = 0;
    for (sunindextype k = r->row_at[i]; k < r->row_at[i + 1]; k++) {
      g->value[k] = c * r->e[k] - r->a[k];
      if (r->column[k] == r->own.first + i) diagonal = g->value[k];
    }
    if (diagonal == 0)
      return steif_fail(
        r->ctx, STEIF_UNSUPPORTED,
        "row %lld of c E - A has no diagonal at c = %g, and AMG smooths with it: "
        "take mumps, or give .precsolve",
        (long long)(r->own.first + i), c);
  }
  return STEIF_OK;
}

static void assemble(amg *g)
{
  const owners *o = &g->r->own;
  const HYPRE_BigInt low = (HYPRE_BigInt)o->first, high = low + (HYPRE_BigInt)o->rows - 1;
  HYPRE_IJMatrixCreate(o->comm, low, high, low, high, &g->M);
  HYPRE_IJMatrixSetObjectType(g->M, HYPRE_PARCSR);
  HYPRE_IJMatrixSetRowSizes(g->M, g->count);
  HYPRE_IJMatrixInitialize(g->M);
  if (o->rows)
    HYPRE_IJMatrixSetValues(g->M, (HYPRE_Int)o->rows, g->count, g->row, g->column, g->value);
  HYPRE_IJMatrixAssemble(g->M);
}

static void *object(HYPRE_IJMatrix M)
{
  void *inside = NULL;
  HYPRE_IJMatrixGetObject(M, &inside);
  return inside;
}

static void *object_of(HYPRE_IJVector v)
{
  void *inside = NULL;
  HYPRE_IJVectorGetObject(v, &inside);
  return inside;
}

/* One l1 Gauss-Seidel sweep forwards on the way down, one backwards on the way up: a third less work a cycle than both
 * at both places, for up to a sixth more cycles. */
enum { HMIS = 10, EXTENDED = 6, L1_FORWARDS = 13, L1_BACKWARDS = 14 };
enum { DOWN = 1, UP = 2 };

static void hierarchy(amg *g)
{
  HYPRE_BoomerAMGCreate(&g->solver);
  HYPRE_BoomerAMGSetPrintLevel(g->solver, 0);
  HYPRE_BoomerAMGSetCoarsenType(g->solver, HMIS);
  HYPRE_BoomerAMGSetInterpType(g->solver, EXTENDED);
  HYPRE_BoomerAMGSetPMaxElmts(g->solver, 4);
  HYPRE_BoomerAMGSetCycleRelaxType(g->solver, L1_FORWARDS, DOWN);
  HYPRE_BoomerAMGSetCycleRelaxType(g->solver, L1_BACKWARDS, UP);
  HYPRE_BoomerAMGSetRelaxOrder(g->solver, 0);
  HYPRE_BoomerAMGSetStrongThreshold(g->solver, g->strong);
  HYPRE_BoomerAMGSetNumFunctions(g->solver, g->functions);
  HYPRE_BoomerAMGSetTol(g->solver, 0);
  HYPRE_BoomerAMGSetMaxIter(g->solver, 1);
  HYPRE_BoomerAMGSetup(g->solver, object(g->M), object_of(g->b), object_of(g->x));
}

static int setup(void *state, sunrealtype re, sunrealtype im)
{
  amg *g = state;
  rows *r = g->r;
  (void)im;
  if (!g->count || g->revision != r->revision) {
    int code = steif_agree(r->ctx, r->like, pattern(g));
    if (!code) code = steif_agree(r->ctx, r->like, vectors(g));
    if (code) forget(g); /* on all ranks, or some would make them anew alone */
    MPI_TRY(code);
  }
  MPI_TRY(steif_agree(r->ctx, r->like, values(g, re)));
  drop(g);
  assemble(g);
  MPI_TRY(steif_agree(r->ctx, r->like, told(g, "assemble the matrix")));
  hierarchy(g);
  r->stats.setups++;
  return steif_agree(r->ctx, r->like, told(g, "make a hierarchy"));
}

/* A cycle for one right-hand side: a preconditioner has no more. */
static int solve(void *state, sunrealtype re, sunrealtype im, bool transposed, int count,
                 const sunrealtype *const *b, sunrealtype *const *x)
{
  amg *g = state;
  const HYPRE_Int here = (HYPRE_Int)g->r->own.rows;
  (void)re, (void)im, (void)transposed, (void)count;
  if (!g->solver)
    return steif_fail(g->r->ctx, STEIF_BAD_INPUT, "AMG is asked to solve before its setup");
  if (here) HYPRE_IJVectorSetValues(g->b, here, g->row, b[0]);
  HYPRE_ParVectorSetConstantValues(object_of(g->x), 0);
  HYPRE_BoomerAMGSolve(g->solver, object(g->M), object_of(g->b), object_of(g->x));
  if (here) HYPRE_IJVectorGetValues(g->x, here, g->row, x[0]);
  g->r->stats.solves++;
  return told(g, "run a cycle");
}

static int changed(void *state)
{
  (void)state;
  return STEIF_OK;
}

const back_end back_end_amg = {
  .name = "amg",
  .open = start,
  .changed = changed,
  .setup = setup,
  .solve = solve,
  .close = finish,
};
