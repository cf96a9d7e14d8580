/* interleaved_image.c: what the factors of all shifts are, and the pattern that their order was found for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "image.h"
#include "interleaved.h"
#include "lu.h"

void stf_interleaved_image(stf_interleaved *face, stf_image *m)
{
  stf_shifts *L = (stf_shifts *)face;
  const size_t n = (size_t)face->n, row = (size_t)(2 * L->lanes), s = (size_t)face->s;
  stf_keep(m, L->lu, n * n * row * sizeof *L->lu);
  stf_keep(m, L->omega, n * row * sizeof *L->omega);
  stf_keep(m, face->Z, n * (size_t)face->wide * sizeof *face->Z);
  stf_keep(m, face->F, 2 * n * s * sizeof *face->F);
  stf_keep(m, L->order, n * sizeof *L->order);
  stf_keep(m, L->row, n * n * sizeof *L->row);
  STF_KEEP(m, face->residuals);
  STF_KEEP(m, L->sparse);
  STF_KEEP(m, L->full);
  STF_KEEP(m, L->pattern);
  STF_KEEP(m, L->column);
  STF_KEEP(m, L->lower);
  STF_KEEP(m, L->upper);
}
