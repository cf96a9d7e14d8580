/* weyr.c: rank of E and Weyr characteristic at infinity of a sparse pencil, from kernels of
 *   T_1 = E,  T_2 = [E 0; F E],  T_3 = [E 0 0; F E 0; 0 F E], ...,
 * dim ker T_j = w_1 + ... + w_j for a regular pencil: the kernel holds the beginnings of its chains at
 * infinity. The ranks are those of the numbers as given. F. R. Gantmacher, Theory of Matrices II
 * (1959), ch. XII.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "field.h"
#include <string.h>

enum { CHAIN_MOST = 64 };

/* w_2, w_3, ... behind w_1; *kernel: their sum, or -1 when the factors grew too large. */
static int characteristic(steif_context *ctx, SUNMatrix E, SUNMatrix F, int count,
                          sunindextype n, sunindextype *weyr, sunindextype *kernel)
{
  *kernel = weyr[0];
  for (int blocks = 2; blocks <= count; blocks++) {
    sunindextype rank;
    STEIF_TRY(stf_field_rank(ctx, E, F, blocks, &rank));
    weyr[blocks - 1] = blocks * n - rank - *kernel;
    *kernel = rank < 0 ? -1 : blocks * n - rank;
    if (rank < 0) break;
  }
  return STEIF_OK;
}

int steif_structure_ranks(steif_context *ctx, SUNMatrix E, SUNMatrix F, steif_structure *s)
{
  sunindextype weyr[CHAIN_MOST], kernel;
  STEIF_CHECK(s && s->method, ctx, STEIF_BAD_INPUT,
              "the structure of the pencil is needed: call steif_structure_find before");
  STEIF_TRY(stf_structure_check(ctx, E, F));
  if (s->rank_E >= 0) return STEIF_OK;
  STEIF_TRY(stf_field_rank(ctx, E, F, 1, &s->rank_E));
  const int count = s->index;
  if (s->rank_E < 0 || !s->regular || count < 1 || count > CHAIN_MOST) return STEIF_OK;
  weyr[0] = s->n - s->rank_E;
  STEIF_TRY(characteristic(ctx, E, F, count, s->n, weyr, &kernel));
  if (kernel != s->infinite || weyr[count - 1] < 1) return STEIF_OK;
  STEIF_TRY(stf_structure_list(ctx, count, &s->weyr));
  s->weyr_count = count;
  memcpy(s->weyr, weyr, (size_t)count * sizeof *weyr);
  return STEIF_OK;
}
