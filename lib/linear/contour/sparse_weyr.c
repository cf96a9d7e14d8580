/* sparse_weyr.c: rank of E and Weyr characteristic at infinity of a sparse pencil, from kernels of
 *   T_1 = E,  T_2 = [E 0; F E],  T_3 = [E 0 0; F E 0; 0 F E], ...,
 * dim ker T_j = w_1 + ... + w_j for a regular pencil: the kernel holds the beginnings of its chains at
 * infinity. The ranks are those of the numbers as given. F. R. Gantmacher, Theory of Matrices II
 * (1959), ch. XII.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "linear_system.h"
#include "prime_field.h"
#include "weyr.h"
#include <string.h>

enum { CHAIN_MOST = 64 };

typedef struct pencil {
  steif_context *ctx;
  stf_field field;
  sunindextype n, rank_E;
} pencil;

static int kernel(void *data, int level, sunindextype *dimension)
{
  const pencil *p = data;
  sunindextype rank = p->rank_E;
  if (level > 1) STEIF_TRY(stf_field_rank(p->ctx, &p->field, level, 0, &rank));
  *dimension = rank < 0 ? -1 : level * p->n - rank;
  return STEIF_OK;
}

int steif_structure_ranks(steif_context *ctx, SUNMatrix E, SUNMatrix F, steif_structure *s)
{
  sunindextype weyr[CHAIN_MOST];
  int count;
  bool complete;
  STEIF_CHECK(s && s->method, ctx, STEIF_BAD_INPUT,
              "the structure of the pencil is needed: call steif_structure_find before");
  STEIF_TRY(stf_structure_check(ctx, E, F));
  if (s->rank_E >= 0) return STEIF_OK;
  pencil p = {.ctx = ctx, .n = s->n};
  STEIF_TRY(stf_field_open(ctx, E, F, false, &p.field));
  STEIF_TRY(stf_field_rank(ctx, &p.field, 1, 0, &s->rank_E));
  if (s->rank_E < 0 || !s->regular || s->index < 1 || s->index > CHAIN_MOST) return STEIF_OK;
  p.rank_E = s->rank_E;
  STEIF_TRY(stf_weyr_find(kernel, &p, s->infinite, s->index, weyr, &count, &complete));
  if (!complete || count != s->index) return STEIF_OK;
  STEIF_TRY(stf_structure_list(ctx, count, &s->weyr));
  s->weyr_count = count;
  memcpy(s->weyr, weyr, (size_t)count * sizeof *weyr);
  return STEIF_OK;
}
