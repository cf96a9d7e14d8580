/* fuzz_names.c: any text as a file of names of three unknowns and equations. What is accepted has three
 * of each, none empty; what is not has a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_names -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char path[64];
  snprintf(path, sizeof path, "/tmp/fuzz-%ld.txt", (long)getpid());
  FILE *file = fopen(path, "w");
  if (!file || fwrite(data, 1, size, file) != size || fclose(file)) abort();
  steif_context *ctx = steif_context_new(NULL);
  steif_names *names = NULL;
  const int code = steif_names_read(ctx, path, 3, &names);
  if (code != steif_status(ctx) || (code && names)) abort();
  for (int i = 0; !code && i < 3; i++) {
    if (names->unknown && !*names->unknown[i]) abort();
    if (names->equation && !*names->equation[i]) abort();
  }
  steif_names_free(&names);
  steif_context_free(&ctx);
  unlink(path);
  return 0;
}
