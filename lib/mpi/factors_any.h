/* factors_any.h: the calls of MUMPS for the arithmetic in MUMPS (dmumps_c, zmumps_c), STRUCTURE, NUMBER and RESULT.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "factors.h"
#include <float.h>
#include <string.h>

#define ICNTL(i) icntl[(i)-1]

static void answer(const STRUCTURE *m, factors_answer *out)
{
  *out = (factors_answer){.code = m->infog[0],
                          .detail = m->infog[1],
                          .null_pivots = m->infog[27],
                          .memory = m->info[21],
                          .rows = m->info[22],
                          .estimate = m->infog[15],
                          .here = m->info[0] == m->infog[0]};
}

static void *open_any(rows *r)
{
  STRUCTURE *m = steif_allocate(r->ctx, 1, sizeof *m);
  if (steif_agree(r->ctx, r->like, m ? STEIF_OK : STEIF_NO_MEMORY)) {
    steif_release(r->ctx, m);
    return NULL;
  }
  m->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(r->own.comm);
  m->par = 1, m->sym = 0, m->job = -1;
  MUMPS(m);
  for (int i = 1; i <= 3; i++) m->ICNTL(i) = -1; /* silent */
  m->ICNTL(4) = 0;
  return m;
}

/* Rows are spread (18), right-hand sides and solutions too (20, 21); pivots that are exactly null are told (24, CNTL(3)),
 * for which the root is not left to ScaLAPACK (13): small ones are right where c E and A differ much in size. */
static void analyse_any(void *state, const rows *r, factors_setting *set, factors_answer *out)
{
  STRUCTURE *m = state;
  const bool parallel = set->order < 0, known = set->placed && !parallel;
  m->n = (MUMPS_INT)r->own.n;
  m->nnz_loc = r->entries;
  m->irn_loc = set->row, m->jcn_loc = set->column;
  m->ICNTL(18) = 3, m->ICNTL(20) = 10, m->ICNTL(21) = 1, m->ICNTL(13) = 1, m->ICNTL(24) = 1;
  m->cntl[2] = -DBL_MIN;
  m->ICNTL(28) = parallel ? 2 : 1;
  m->ICNTL(7) = parallel ? 7 : known ? 1 : set->order;
  if (known) m->perm_in = set->place;
  m->ICNTL(29) = 1;
  m->ICNTL(23) = set->memory;
  m->job = 1;
  MUMPS(m);
  answer(m, out);
  if (out->code < 0 || parallel || known) return;
  if (set->place) memcpy(set->place, m->sym_perm, (size_t)r->own.n * sizeof *set->place);
  set->placed = true;
}

static void factor_any(void *state, sunrealtype *values, int workspace, factors_answer *out)
{
  STRUCTURE *m = state;
  m->a_loc = (NUMBER *)values;
  m->ICNTL(14) = workspace;
  m->job = 2;
  MUMPS(m);
  answer(m, out);
}

static void solve_any(void *state, bool transposed, int columns, sunrealtype *b, int *row_of_b,
                      int count, sunrealtype *x, int *row_of_x, int room, factors_answer *out)
{
  STRUCTURE *m = state;
  m->nrhs = columns;
  m->rhs_loc = (NUMBER *)b, m->irhs_loc = row_of_b;
  m->nloc_rhs = count, m->lrhs_loc = count > 0 ? count : 1;
  m->sol_loc = (NUMBER *)x, m->isol_loc = row_of_x, m->lsol_loc = room;
  m->ICNTL(9) = transposed ? 0 : 1;
  m->job = 3;
  MUMPS(m);
  answer(m, out);
}

static void close_any(void *state, rows *r)
{
  STRUCTURE *m = state;
  m->job = -2;
  MUMPS(m);
  steif_release(r->ctx, m);
}

const factors_calls RESULT = {
  .complex = sizeof(NUMBER) > sizeof(sunrealtype),
  .open = open_any,
  .analyse = analyse_any,
  .factor = factor_any,
  .solve = solve_any,
  .close = close_any,
};
