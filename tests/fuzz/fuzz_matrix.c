/* fuzz_matrix.c: any bytes as a Matrix Market file. What is accepted must read again to the same
 * matrix after being written out; what is not has a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_matrix -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void same(SUNMatrix A, SUNMatrix B)
{
  if (stf_input_rows(A) != stf_input_rows(B) || stf_input_columns(A) != stf_input_columns(B))
    abort();
  for (sunindextype j = 0; j < stf_input_columns(A); j++) {
    if (stf_input_column(A, j) != stf_input_column(B, j)) abort();
    for (sunindextype k = 0; k < stf_input_column(A, j); k++) {
      sunindextype row[2];
      sunrealtype x[2];
      stf_input_entry(A, j, k, row, x);
      stf_input_entry(B, j, k, row + 1, x + 1);
      if (row[0] != row[1] || x[0] != x[1]) abort();
    }
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char path[64], copy[64];
  snprintf(path, sizeof path, "/tmp/fuzz-%ld.mtx", (long)getpid());
  snprintf(copy, sizeof copy, "/tmp/fuzz-%ld-copy.mtx", (long)getpid());
  FILE *file = fopen(path, "w");
  if (!file || fwrite(data, 1, size, file) != size || fclose(file)) abort();
  steif_context *ctx = steif_context_new(NULL);
  SUNMatrix A = steif_matrix_read(ctx, path);
  if (A) {
    if (steif_matrix_write(ctx, A, copy)) abort();
    SUNMatrix B = steif_matrix_read(ctx, copy);
    if (!B) abort();
    same(A, B);
    SUNMatDestroy(A), SUNMatDestroy(B);
  } else if (!strcmp(steif_message(ctx), "ok")) {
    abort();
  }
  steif_context_free(&ctx);
  unlink(path), unlink(copy);
  return 0;
}
