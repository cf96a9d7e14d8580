/* fuzz_problem.c: any text as a problem of the collection with its parameters, and as a method. What is
 * found has a form and values that can be evaluated; what is not has a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_problem -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Numbers of three digits, and products with factors of two (8x84 blocks), ask for more memory and
 * time than a fuzzer has. */
static int large(const char *text)
{
  int run = 0;
  for (; *text; text++) {
    if (run == 2 && *text == 'x') return 1;
    run = isdigit((unsigned char)*text) || strchr("eE+", *text) ? run + 1 : 0;
    if (run == 3 || (run == 1 && text[1] == 'x' && isdigit((unsigned char)text[2]) &&
                     isdigit((unsigned char)text[3])))
      return 1;
  }
  return 0;
}

static void problem(steif_context *ctx, const char *text)
{
  steif_problem p;
  steif_forget(ctx);
  const int code = steif_problem_find(ctx, text, &p);
  if (code != steif_status(ctx)) abort();
  if (code) return;
  if (p.n < 1 || !steif_problem_form(ctx, &p) || !p.name) abort();
  steif_problem_clear(ctx, &p);
}

static void method(steif_context *ctx, const char *text)
{
  steif_method_info m;
  steif_forget(ctx);
  if (strstr(text, "file=")) return;
  const int code = steif_method_find(ctx, text, &m);
  if (code != steif_status(ctx)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[256];
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  if (large(text)) return 0;
  steif_context *ctx = steif_context_new(NULL);
  problem(ctx, text);
  method(ctx, text);
  steif_context_free(&ctx);
  return 0;
}
