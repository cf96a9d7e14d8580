/* fuzz_function.c: any text as expressions, and as a file of samples. What is accepted must answer
 * in every order with finite values, NaN where only others have the derivative, or a recoverable
 * failure with a sentence, and its breakpoints must ascend.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_function -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "forcing.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Finite; a derivative that some components have is NaN in the others. */
static void values(int order, sunindextype n, const double *g)
{
  sunindextype known = 0;
  for (sunindextype j = 0; j < n; j++) {
    if (!isfinite(g[j]) && !(order && isnan(g[j]))) abort();
    known += isfinite(g[j]) != 0;
  }
  if (!known) abort();
}

static void check(steif_context *ctx, steif_function *f, sunindextype n)
{
  static const double times[] = {-1.5, 0, 0.5, 1e10};
  static const int orders[] = {0, 1, 5, 64, 65};
  double last[64];
  N_Vector g = N_VNew_Serial(n, steif_sundials(ctx));
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 5; k++) {
      steif_forget(ctx);
      const int code = steif_function_value(times[i], orders[k], g, f);
      if (code < 0 || (code > 0 && !steif_status(ctx))) abort();
      if (code == 0 && orders[k] == 65) abort();
      if (code == 0) values(orders[k], n, N_VGetArrayPointer(g));
    }
  const size_t count = steif_function_breaks(f, -1e300, 1e300, 64, last);
  for (size_t k = 1; k < count && k < 64; k++)
    if (!(last[k - 1] < last[k])) abort();
  N_VDestroy(g);
}

static void samples(steif_context *ctx, const char *text)
{
  char path[64];
  double accuracy;
  snprintf(path, sizeof path, "/tmp/fuzz-%ld.csv", (long)getpid());
  FILE *file = fopen(path, "w");
  if (!file || fputs(text, file) < 0 || fclose(file)) abort();
  for (sunindextype n = 1; n <= 2; n++) {
    steif_forget(ctx);
    steif_function *f = steif_function_samples(ctx, path, n, NULL, n == 1 ? 0 : 2, &accuracy);
    if (f)
      check(ctx, f, n);
    else if (!steif_status(ctx))
      abort();
    steif_function_free(&f);
  }
  unlink(path);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[1024];
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  sunindextype n = 1;
  for (const char *c = text; *c; c++) n += *c == ';';
  steif_context *ctx = steif_context_new(NULL);
  steif_function *f = steif_function_parse(ctx, text, n, NULL);
  if (f)
    check(ctx, f, n);
  else if (!strcmp(steif_message(ctx), "ok"))
    abort();
  steif_function_free(&f);
  if (n == 1) samples(ctx, text);
  steif_context_free(&ctx);
  return 0;
}
