/* methods.c: the list of methods, ours and the baselines, with what is claimed of each.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "exponential.h"
#include "march.h"
#include "splitting.h"
#include <stdio.h>
#include <string.h>

static int describe_engine(steif_context *ctx, const steif_engine *engine,
                           const steif_spec *spec, steif_method_info *info)
{
  (void)ctx, (void)spec;
  info->family = engine->family ? engine->family : "baseline", info->about = engine->about;
  info->forms = engine->forms, info->adaptive = 1;
  return STEIF_OK;
}

int steif_method_find(steif_context *ctx, const char *text, steif_method_info *info)
{
  steif_spec spec;
  STEIF_TRY(steif_spec_parse(ctx, text, &spec));
  memset(info, 0, sizeof *info);
  snprintf(info->name, sizeof info->name, "%s", text);
  if (!strcmp(text, "auto")) {
    info->family = "auto", info->about = "chooses by size, storage, index, tolerance and the stiffness it meets";
    info->forms = STEIF_ODE | STEIF_MASS | STEIF_IMPLICIT | STEIF_DESCRIPTOR,
    info->adaptive = 1;
    return STEIF_OK;
  }
  const steif_engine *engine = stf_engine_find(spec.name);
  if (engine) return describe_engine(ctx, engine, &spec, info);
  const steif_method *method;
  steif_table *table;
  STEIF_TRY(stf_method_find(ctx, &spec, &method, &table));
  info->forms = method->forms;
  const int code = method->describe(ctx, &spec, table, info);
  for (size_t i = 0; table && i < stf_table_count; i++) /* outlives the table */
    if (!strcmp(stf_table_shelf[i].name, table->name))
      info->about = stf_table_shelf[i].item->about;
  steif_table_free(ctx, &table);
  return code;
}

/* Specs of one shelf entry: families with several stage numbers, tables with one line. */
/* clang-format off */
static const char *const fixed[] = {
  "be",          "bdf:p=2",       "bdf:p=3",       "bdf:p=4",       "bdf:p=5",   "bdf:p=6",
  "gauss:s=1",   "gauss:s=2",     "gauss:s=3",     "gauss:s=4",     "gauss:s=5", "radau:s=1",
  "radau:s=2",   "radau:s=3",     "radau:s=4",     "radau:s=5",     "radau:s=7", "radau1a:s=2",
  "radau1a:s=3", "lobatto3c:s=2", "lobatto3c:s=3", "lobatto3c:s=4", "rodas4",    "rodas4p",
  "rodas4p2",    "rodas5p",       "symeuler:first=q", "verlet:first=drift",
  "glm:ab,p=2",  "glm:ab,p=3",    "glm:ab,p=4",    "glm:am,p=2",    "glm:am,p=3", "glm:am,p=4",
  "glm:bdf,p=3", "glm:irks,p=1", "glm:irks,p=2", "glm:irks,p=3", "glm:irks,p=4",
  "glm:dimsim1,p=3", "glm:dimsim1,p=4", "glm:dimsim2,p=3", "glm:dimsim2,p=4",
  "glm:nordsieck,of=bdf,p=2", "glm:nordsieck,of=bdf,p=4",
  "glm:nordsieck,of=am,p=3",  "glm:nordsieck,of=am,p=5",
};
/* clang-format on */

static bool spec_at(size_t i, char *text, size_t size)
{
  const size_t count = sizeof fixed / sizeof *fixed;
  if (i < count) return snprintf(text, size, "%s", fixed[i]) > 0;
  i -= count;
  if (i < stf_splitting_count) return snprintf(text, size, "%s", stf_splittings[i].name) > 0;
  i -= stf_splitting_count;
  if (i < stf_exponential_rk_count)
    return snprintf(text, size, "%s", stf_exponential_rk[i].name) > 0;
  i -= stf_exponential_rk_count;
  if (i < stf_exponential_rb_count)
    return snprintf(text, size, "%s", stf_exponential_rb[i].name) > 0;
  i -= stf_exponential_rb_count;
  for (size_t k = 0; k < stf_table_count; k++) {
    const steif_table *item = stf_table_shelf[k].item;
    if (item->build || item->fill || i--) continue;
    return snprintf(text, size, "%s%s",
                    item->kind == STEIF_DIRK  ? "dirk:"
                    : item->kind == STEIF_GLM ? "glm:"
                                              : "",
                    stf_table_shelf[k].name) > 0;
  }
  if (i-- == 0) return snprintf(text, size, "auto") > 0;
  return i < stf_engine_count && snprintf(text, size, "%s", stf_engine_shelf[i].name) > 0;
}

int steif_method_at(steif_context *ctx, size_t i, steif_method_info *info)
{
  char text[STEIF_SPEC_WORD];
  return spec_at(i, text, sizeof text) ? steif_method_find(ctx, text, info) : STEIF_BAD_INPUT;
}
