/* passes.c: the passes of nested loops, counted through.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tape.h"

int64_t stf_passes(const stf_box *box)
{
  int64_t count = 1;
  for (int d = 0; d < box->dims; d++) count *= box->count[d];
  return count;
}

int32_t stf_at_pass(const stf_box *box, int64_t k, int32_t a, const int32_t *stride)
{
  int64_t value = a;
  for (int d = box->dims; d--;) {
    value += (int64_t)stride[d] * (box->low[d] + k % box->count[d]);
    k /= box->count[d];
  }
  return (int32_t)value;
}
