/* coloured.c: sparse Jacobians by steif's own differences, columns that share no row moved together, where a
 * problem tells its pattern only: SUNDIALS has none for sparse matrices.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "baseline.h"
#include "problem.h"
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

int stf_coloured_open(stf_baseline *base)
{
  stf_run *run = base->run;
  const steif_problem *p = run->problem;
  const bool entries =
    run->form == STEIF_IMPLICIT ? p->idajac || (p->E && p->A) : p->jac || p->A;
  if (base->storage != STEIF_SPARSE || entries || !p->pattern || run->form == STEIF_DESCRIPTOR)
    return STEIF_OK;
  stf_system *s = stf_pool_array(run->pool, 1, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  s->ctx = run->ctx;
  s->problem = p;
  s->form = run->form;
  s->storage = STEIF_SPARSE;
  s->scale = run->options->atol / run->options->rtol;
  const sunrealtype *atols = run->options->atols;
  sunrealtype *floors = atols ? stf_pool_array(run->pool, (size_t)p->n, sizeof *floors) : NULL;
  if (atols && !floors) return STEIF_NO_MEMORY;
  for (sunindextype j = 0; floors && j < p->n; j++) floors[j] = atols[j] / run->options->rtol;
  s->floors = floors;
  stf_space_open(&s->space, run->y);
  for (int i = 0; i < 6; i++)
    if (!(s->work[i] = stf_pool_vector(run->pool, run->y))) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_groups_open(run->pool, s));
  base->coloured = s;
  return STEIF_OK;
}

/* Patterns grow as those of steif's own methods do: the 1st, 2nd, 4th ... matrix is probed. KLU then analyses
 * anew. */
static int fill(stf_baseline *base, char which, sunrealtype t, N_Vector y, N_Vector yp,
                SUNMatrix M)
{
  stf_system *s = base->coloured;
  STEIF_TRY(stf_differ(s, which, t, y, yp, M));
  if (which == 'A') s->nje++;
  for (bool grown = (s->nje & (s->nje - 1)) == 0; grown;) {
    const int code = stf_probe(s, which, t, y, yp, M, &grown);
    if (code || !grown) return code > 0 ? STEIF_OK : code;
    if (base->solver)
      SUNLinSol_KLUReInit(base->solver, base->J, SM_NNZ_S(base->J), SUNKLU_REINIT_PARTIAL);
    STEIF_TRY(stf_differ(s, which, t, y, yp, M));
  }
  return STEIF_OK;
}

int stf_coloured_fill(stf_baseline *base, char which, sunrealtype t, N_Vector y, N_Vector yp,
                      SUNMatrix M)
{
  const int code = fill(base, which, t, y, yp, M);
  return stf_baseline_watch_matrix(base, "f or F, moved for differences,", code < 0 ? -1 : code,
                                   t, M);
}

long stf_coloured_count(stf_baseline *base) { return base->coloured ? base->coloured->nfe : 0; }

void stf_coloured_forget(stf_baseline *base)
{
  if (base->coloured) base->coloured->nfe = 0;
}
