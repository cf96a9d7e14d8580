/* fuzz_mat.c: any bytes as a MATLAB file: its E as a matrix, all of it as a system with inputs, outputs
 * and names. What is not accepted has a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_mat -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void destroy(SUNMatrix M)
{
  if (M) SUNMatDestroy(M);
}

static void matrix(steif_context *ctx, const char *path)
{
  int found;
  steif_forget(ctx);
  SUNMatrix E = steif_matrix_read_mat(ctx, path, "E", &found);
  if (E && (!found || stf_input_check(ctx, E, "E"))) abort();
  if (!E && found && !steif_status(ctx)) abort();
  destroy(E);
}

static void whole_system(steif_context *ctx, const char *path)
{
  SUNMatrix E, F, B = NULL, C = NULL, D = NULL;
  steif_names *names = NULL;
  steif_forget(ctx);
  const int code = steif_system_read(ctx, path, NULL, 0, &E, &F);
  if (code != steif_status(ctx) || !code != (E && F)) abort();
  if (code) return;
  steif_input_output_read(ctx, path, &B, &C, &D);
  if (!steif_names_read(ctx, path, stf_input_rows(E), &names)) steif_names_free(&names);
  destroy(E), destroy(F), destroy(B), destroy(C), destroy(D);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const char head[128] = "MATLAB 5.0 MAT-file";
  const unsigned char version[4] = {0, 1, 'I', 'M'};
  char path[64];
  snprintf(path, sizeof path, "/tmp/fuzz-%ld.mat", (long)getpid());
  FILE *file = fopen(path, "w");
  if (!file || fwrite(head, 1, 124, file) != 124 || fwrite(version, 1, 4, file) != 4 ||
      fwrite(data, 1, size, file) != size || fclose(file))
    abort();
  steif_context *ctx = steif_context_new(NULL);
  matrix(ctx, path);
  whole_system(ctx, path);
  steif_context_free(&ctx);
  unlink(path);
  return 0;
}
