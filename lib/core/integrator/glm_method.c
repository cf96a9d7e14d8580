/* glm_method.c: the general linear method that a spec stands for.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"

static int find(steif_context *ctx, const char *text, steif_glm *g)
{
  steif_spec spec;
  steif_method_info info = {0};
  const steif_method *method;
  steif_table *table;
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  STEIF_TRY(stf_method_find(ctx, &spec, &method, &table));
  int code = method->describe(ctx, &spec, table, &info);
  if (code == STEIF_OK && method->general)
    code = method->general(ctx, &spec, g);
  else if (code == STEIF_OK && table)
    code = steif_table_glm(ctx, table, g);
  else if (code == STEIF_OK)
    code =
      STEIF_FAIL(ctx, STEIF_UNSUPPORTED,
                 "one step of %s is no recurrence that is followed here: take a Runge-Kutta "
                 "method (gauss:s=2, dirk:alexander2, rk4), bdf:p=1..6 or glm:TABLE",
                 text);
  steif_table_free(ctx, &table);
  return code;
}

steif_glm *steif_glm_new(steif_context *ctx, const char *method)
{
  if (!ctx) return NULL;
  steif_glm *g = stf_allocate(ctx, 1, sizeof *g);
  if (g && find(ctx, method, g)) steif_glm_free(ctx, &g);
  return g;
}

void steif_glm_free(steif_context *ctx, steif_glm **g)
{
  if (!ctx || !g || !*g) return;
  stf_release(ctx, *g);
  *g = NULL;
}
