/* extension.c: memory, sentences and agreement for libraries beside this one.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "agree.h"
#include "image.h"
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

int steif_same(steif_context *ctx, N_Vector like, const char *what, const void *bytes,
               size_t count)
{
  const unsigned long long number = bytes ? stf_checksum(bytes, count) : 0;
  STEIF_CHECK(stf_agree_same(like, &number, sizeof number), ctx, STEIF_BAD_INPUT,
              "ranks disagree in %s: give all the same", what);
  return STEIF_OK;
}

typedef struct stf_stand_in {
  struct stf_stand_in *next;
  const void *user;
  void *own;
} stf_stand_in;

int steif_stand_in(steif_context *ctx, const void *user, void *own)
{
  if (!ctx) return STEIF_BAD_INPUT;
  stf_stand_in **head = stf_context_stand_ins(ctx), *one = stf_allocate(ctx, 1, sizeof *one);
  if (!one) return STEIF_NO_MEMORY;
  *one = (stf_stand_in){*head, user, own};
  *head = one;
  return STEIF_OK;
}

void steif_stand_down(steif_context *ctx, const void *user)
{
  if (!ctx) return;
  for (stf_stand_in **at = stf_context_stand_ins(ctx), *one; (one = *at);)
    if (one->user == user) {
      *at = one->next;
      stf_release(ctx, one);
    } else
      at = &one->next;
}

void *stf_own_user(steif_context *ctx, void *user)
{
  for (const stf_stand_in *one = *stf_context_stand_ins(ctx); one; one = one->next)
    if (one->user == user) return one->own;
  return user;
}
