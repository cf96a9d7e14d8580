/* fuzz_checkpoint.c: any bytes as a checkpoint, and a checkpoint of which some bytes were turned: what is read is
 * what was written; all else has a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_checkpoint -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int f(sunrealtype t, N_Vector y, N_Vector r, void *user)
{
  (void)t, (void)user;
  NV_Ith_S(r, 0) = -NV_Ith_S(y, 0) * NV_Ith_S(y, 0);
  return 0;
}

/* The bytes of a run after five steps. */
static unsigned char *whole(steif_context *ctx, size_t *count)
{
  static const sunrealtype y0[] = {1};
  static const steif_problem p = {.name = "fuzz", .n = 1, .t1 = 3, .y0 = y0, .f = f};
  unsigned char *bytes = NULL;
  steif_solver *s = steif_solver_new(ctx, &p, "bdf", NULL);
  for (int k = 0; s && k < 5; k++) steif_solve_step(s);
  if (!s || stf_checkpoint_bytes(s, "note", 4, &bytes, count)) abort();
  steif_solver_free(&s);
  return bytes;
}

/* Pairs of a place and what is turned there; does anything differ? */
static int turn(unsigned char *bytes, size_t count, const uint8_t *data, size_t size)
{
  unsigned char *before = malloc(count);
  if (!before) return -1;
  memcpy(before, bytes, count);
  for (size_t i = 0; i + 3 <= size; i += 3)
    bytes[((size_t)data[i] << 8 | data[i + 1]) % count] ^= data[i + 2];
  const int differs = memcmp(before, bytes, count) != 0;
  free(before);
  return differs;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  stf_opened file;
  steif_context *ctx = steif_context_new(NULL);
  if (!ctx || !size) return steif_context_free(&ctx), 0;
  size_t count = size - 1;
  unsigned char *bytes = data[0] & 1 ? whole(ctx, &count) : stf_allocate(ctx, size, 1);
  if (!bytes) return steif_context_free(&ctx), 0;
  int differs = 1;
  if (data[0] & 1)
    differs = turn(bytes, count, data + 1, size - 1);
  else
    memcpy(bytes, data + 1, count);
  steif_forget(ctx);
  const int code = stf_checkpoint_open(ctx, "fuzz", bytes, count, &file);
  if (differs >= 0 && (differs != 0) != (code != 0) && data[0] & 1) abort();
  if (code && !strcmp(steif_message(ctx), "ok")) abort();
  if (!code) stf_checkpoint_close(ctx, &file);
  steif_context_free(&ctx);
  return 0;
}
