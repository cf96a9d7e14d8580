/* multishift.c: memory of all lanes, and the order of work on it.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "multishift.h"

/* Bytes of a line of cache, which is an entry of a batch. */
enum { ALIGNED = 2 * STF_LANES * sizeof(double) };

int stf_multishift_open(const stf_sequence *sequence, stf_multishift *b)
{
  enum { ENTRY = 2 * STF_LANES };
  const stf_steps *q = (const stf_steps *)sequence;
  const size_t n = (size_t)q->n, l = (size_t)q->lower[n], u = (size_t)q->upper[n];
  *b = (stf_multishift){.sequence = sequence};
  double *at = b->memory = stf_allocate(q->ctx, l + u + 3 * n + 1, ENTRY * sizeof *at);
  if (!at) return STEIF_NO_MEMORY;
  at += (ALIGNED - (uintptr_t)at % ALIGNED) % ALIGNED / sizeof *at;
  b->x = at, b->r = b->x + ENTRY * n, b->pivot = b->r + ENTRY * n;
  b->l = b->pivot + ENTRY * n, b->u = b->l + ENTRY * l;
  return STEIF_OK;
}

void stf_multishift_close(stf_multishift *b)
{
  if (b->memory) stf_release(stf_steps_of(b)->ctx, b->memory);
  b->memory = NULL;
}

void stf_multishift_factor(stf_multishift *b, double growth, const stf_polynomial *g)
{
  const stf_multishift_kernels *with = stf_multishift_here();
  if (g) with->load(b, g, b->x);
  with->factor(b, growth > 0, g != NULL);
  for (int q = 0; q < STF_LANES; q++) {
    b->good[q] &= !(b->growth[q] < growth);
    b->solves[q] = g != NULL;
  }
}

void stf_multishift_solve(stf_multishift *b, const stf_polynomial *g)
{
  const stf_multishift_kernels *with = stf_multishift_here();
  with->load(b, g, b->x);
  with->solve(b, b->x);
}

/* Lanes decide each for itself, so that they do not depend on their neighbours. */
static bool unsteady(stf_multishift *b, bool anyway, double steady, bool *again)
{
  bool any = false;
  for (int q = 0; q < STF_LANES; q++) {
    again[q] = anyway || b->error[q] > steady;
    b->solves[q] += again[q];
    any |= again[q];
  }
  return any;
}

void stf_multishift_refine(stf_multishift *b, const stf_polynomial *g, int sweeps,
                           double steady)
{
  const stf_multishift_kernels *with = stf_multishift_here();
  bool again[STF_LANES];
  if (!sweeps) with->residual(b, g);
  for (int sweep = 0; sweep < sweeps; sweep++) {
    with->load(b, g, b->r);
    stf_multishift_residual(b);
    if (!unsteady(b, sweep == 0, steady, again)) break;
    with->solve(b, b->r);
    with->correct(b, again);
  }
}
