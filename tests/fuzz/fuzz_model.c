/* fuzz_model.c: any text as a model. What is accepted must have f, a Jacobian and events that can be asked
 * at the start, and take a few steps or say why not; what is not must have a sentence.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then
 *   ./fuzz_model -max_total_time=60 ../tests/fuzz/corpus/fuzz_model ../examples/models
 * SPDX-License-Identifier: BSD-3-Clause */
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <steif/data.h>
#include <steif/steif.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Numbers of many digits, powers and products may make loops and arrays that are right but long. */
static int is_long(const char *text)
{
  int digits = 0;
  const int ranges = strchr(text, ':') != NULL;
  for (const char *c = text; *c; c++) {
    digits = *c >= '0' && *c <= '9' ? digits + 1 : 0;
    const int exponent = (*c == 'e' || *c == 'E') && c > text && c[-1] >= '0' && c[-1] <= '9';
    if (ranges && (digits > 3 || exponent)) return 1;
  }
  return 0;
}

static void run(steif_context *ctx, const steif_problem *p)
{
  steif_options o = steif_defaults();
  steif_model_facts facts;
  o.max_steps = 5;
  o.rtol = 1e-3;
  if (steif_model_describe(ctx, p, &facts) || facts.n != p->n) abort();
  if (p->n > 200) return;
  steif_solver *s = steif_solver_new(ctx, p, "radau:s=3", &o);
  const int code = s ? steif_solve_to(s, p->t1) : steif_status(ctx);
  if (code < 0 && !strcmp(steif_message(ctx), "ok")) abort();
  steif_solver_free(&s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[2048];
  steif_problem p;
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  if (is_long(text)) return 0;
  steif_context *ctx = steif_context_new(NULL);
  if (!steif_model_parse(ctx, text, "m.steif", NULL, &p))
    run(ctx, &p);
  else if (!strcmp(steif_message(ctx), "ok"))
    abort();
  steif_problem_clear(ctx, &p);
  steif_context_free(&ctx);
  return 0;
}
