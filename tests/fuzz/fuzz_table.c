/* fuzz_table.c: any text as a tableau. What is read and completed has an order, and M(z) can be
 * asked for.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_table -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "table.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static char text[1 << 14];
  static steif_glm g;
  const sunrealtype z[2] = {-0.7, 1.3};
  sunrealtype M[2 * STEIF_PAST * STEIF_PAST];
  if (size >= sizeof text || memchr(data, 0, size)) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  steif_context *ctx = steif_context_new(NULL);
  if (!ctx) return 0;
  if (stf_table_parse(ctx, "fuzz", text, &g) || steif_glm_complete(ctx, &g)) {
    if (!strcmp(steif_message(ctx), "ok")) abort();
  } else if (g.order < 1 || g.second >= 1 || steif_glm_propagator(ctx, &g, z, M)) {
    abort();
  }
  steif_context_free(&ctx);
  return 0;
}
