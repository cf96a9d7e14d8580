/* model_c.c: a model as a C program, on request.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "native.h"
#include <steif/model.h>
#include <string.h>

const char *steif_model_c(steif_context *ctx, const steif_problem *p)
{
  stf_model *m = p && p->destroy == stf_model_close ? p->user : NULL;
  if (!m) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT, "a problem made from a text is needed");
    return NULL;
  }
  stf_writer w = {.ctx = ctx};
  stf_write_problem(&w, m, p);
  const char *text = stf_written(&w);
  char *kept = text ? stf_pool_array(m->pool, w.text.count, 1) : NULL;
  if (kept) memcpy(kept, text, w.text.count);
  stf_vector_free(ctx, &w.text);
  return kept;
}
