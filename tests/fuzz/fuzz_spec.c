/* fuzz_spec.c: any text as a spec. What is accepted must read again to the same thing after being
 * written out, and every look-up must answer.
 *   cmake -DSTEIF_FUZZ=ON -DCMAKE_C_COMPILER=clang ..., then ./fuzz_spec -max_total_time=60
 * SPDX-License-Identifier: BSD-3-Clause */
#include "base.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void write_out(const steif_spec *spec, char *text, size_t room)
{
  size_t used = (size_t)snprintf(text, room, "%s", spec->name);
  for (int i = 0; i < spec->count; i++) {
    const char *key = spec->param[i].key;
    used += (size_t)snprintf(text + used, room - used, "%c%s%s%s", i ? ',' : ':', key,
                             *key ? "=" : "", spec->param[i].value);
  }
}

static void look_up(steif_context *ctx, const steif_spec *spec)
{
  static const char *const names[] = {"radau", "gauss", "bdf"}, *const keys[] = {"s", "", NULL};
  int whole;
  sunrealtype real;
  for (int i = 0; i < spec->count; i++) {
    if (!stf_spec_int(ctx, spec, spec->param[i].key, -9, 99, 3, &whole) &&
        (whole < -9 || whole > 99))
      abort();
    if (!stf_spec_real(ctx, spec, spec->param[i].key, -9, 99, 3, &real) &&
        !(real >= -9 && real <= 99))
      abort();
  }
  stf_spec_only(ctx, spec, keys);
  const char *near = stf_nearest(spec->name, names, 3, sizeof *names);
  if (near && !stf_near(spec->name, near)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[1024], again[2 * (STEIF_SPEC_PARAMS + 1) * STEIF_SPEC_VALUE];
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  steif_context *ctx = steif_context_new(NULL);
  steif_spec first = {0}, second = {0}; /* compared as a whole */
  if (!ctx) return 0;
  if (!steif_spec_parse(ctx, text, &first)) {
    write_out(&first, again, sizeof again);
    if (strcmp(text, again) || steif_spec_parse(ctx, again, &second)) abort();
    if (memcmp(&first, &second, sizeof first)) abort();
    look_up(ctx, &first);
  } else if (!strcmp(steif_message(ctx), "ok")) {
    abort();
  }
  steif_context_free(&ctx);
  return 0;
}
