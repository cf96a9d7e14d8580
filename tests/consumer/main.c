/* main.c: one constructor, one failure with its sentence, one vector of SUNDIALS.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/steif.h>
#include <string.h>

int main(void)
{
  steif_context *ctx = steif_context_new(NULL);
  steif_spec spec;
  int bad = steif_spec_parse(ctx, "radau:s=5", &spec) || strcmp(spec.param[0].value, "5");
  bad |= steif_spec_parse(ctx, "radau:=5", &spec) != STEIF_BAD_INPUT;
  N_Vector v = N_VNew_Serial(7, steif_sundials(ctx));
  bad |= !v || N_VGetLength(v) != 7;
  N_VDestroy(v);
  printf("steif %s: %s\n", steif_version(), steif_message(ctx));
  steif_context_free(&ctx);
  return bad;
}
