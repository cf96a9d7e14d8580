/* extension.c: memory, sentences and agreement for libraries beside this one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agree.h"
#include <stdarg.h>
#include <stdio.h>
#include <steif/extension.h>

void *steif_allocate(steif_context *ctx, size_t count, size_t size)
{
  return ctx ? stf_allocate(ctx, count, size) : NULL;
}

void steif_release(steif_context *ctx, void *block)
{
  if (block) stf_release(ctx, block);
}

int steif_fail(steif_context *ctx, int code, const char *format, ...)
{
  char text[STF_MESSAGE];
  va_list list;
  va_start(list, format);
  vsnprintf(text, sizeof text, format, list);
  va_end(list);
  return STEIF_FAIL(ctx, code, "%s", text);
}

int steif_agree(steif_context *ctx, N_Vector like, int code)
{
  return stf_agree(ctx, like, code);
}
