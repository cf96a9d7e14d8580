/* context.c: allocator, SUNDIALS context and the last message.
 * SPDX-License-Identifier: BSD-3-Clause */
#define _DEFAULT_SOURCE /* madvise */
#include "base.h"
#include "compat.h"
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MESSAGE = STF_MESSAGE };

struct steif_context {
  steif_setup setup;
  SUNContext sundials;
  int code;
  bool silent;
  const struct steif_team *team;
  long long teams; /* that have led or gone */
  long failures;   /* told by stf_fail */
  struct stf_deferred *opening;
  struct stf_stand_in *stand_ins;
  char message[MESSAGE];
};

#ifdef MADV_HUGEPAGE
/* The whole pages of a large block may become huge ones: a few faults instead of thousands. */
static void widen(void *block, size_t bytes)
{
  enum { HUGE = 1 << 21 };
  const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), from = (uintptr_t)block;
  const uintptr_t first = (from + page - 1) / page * page, end = (from + bytes) / page * page;
  if (bytes >= HUGE) madvise((void *)first, end - first, MADV_HUGEPAGE);
}
#else
static void widen(void *block, size_t bytes) { (void)block, (void)bytes; }
#endif

/* Zeroed: large blocks come so from the system, untouched. */
static void *allocate(size_t bytes, void *user)
{
  void *block = calloc(1, bytes);
  (void)user;
  if (block) widen(block, bytes);
  return block;
}

static void release(void *block, void *user)
{
  (void)user;
  free(block);
}

static int cores(void)
{
  const long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count < 1 ? 1 : count > 64 ? 64 : (int)count;
}

steif_context *steif_context_new(const steif_setup *setup)
{
  steif_setup s = setup ? *setup : (steif_setup){0};
  if (!s.allocate != !s.release) return NULL;
  if (!s.allocate) s.allocate = allocate, s.release = release;
  if (s.threads < 1) s.threads = cores();
  steif_context *ctx = s.allocate(sizeof *ctx, s.user);
  if (!ctx) return NULL;
  memset(ctx, 0, sizeof *ctx);
  ctx->setup = s;
  steif_forget(ctx);
  if (SUNContext_Create(STF_NO_COMM, &ctx->sundials)) steif_context_free(&ctx);
  if (ctx) STF_SILENT_ERRORS(ctx->sundials);
  return ctx;
}

void steif_context_free(steif_context **ctx)
{
  if (!ctx || !*ctx) return;
  if ((*ctx)->sundials) SUNContext_Free(&(*ctx)->sundials);
  const steif_setup s = (*ctx)->setup;
  s.release(*ctx, s.user);
  *ctx = NULL;
}

const char *steif_message(const steif_context *ctx)
{
  return ctx ? ctx->message
             : "no context: memory is short, or only one of allocate and release "
               "was given";
}

int steif_status(const steif_context *ctx) { return ctx ? ctx->code : STEIF_NO_MEMORY; }

void steif_forget(steif_context *ctx)
{
  if (!ctx) return;
  ctx->code = STEIF_OK;
  strcpy(ctx->message, "ok");
}

SUNContext steif_sundials(steif_context *ctx) { return ctx ? ctx->sundials : NULL; }

const struct steif_team *stf_team(const steif_context *ctx, long long *number)
{
  *number = ctx->teams;
  return ctx->team;
}

void stf_context_lead(steif_context *ctx, const struct steif_team *team)
{
  ctx->team = team;
  ctx->teams++;
}

struct stf_deferred *stf_context_open(steif_context *ctx, struct stf_deferred *opening)
{
  struct stf_deferred *before = ctx->opening;
  ctx->opening = opening;
  return before;
}

struct stf_deferred *stf_context_opening(const steif_context *ctx) { return ctx->opening; }

struct stf_stand_in **stf_context_stand_ins(steif_context *ctx) { return &ctx->stand_ins; }

int stf_threads(const steif_context *ctx) { return ctx->setup.threads; }

steif_setup stf_setup_alone(const steif_context *ctx)
{
  steif_setup s = ctx->setup;
  s.threads = 1;
  return s;
}

long stf_failures(const steif_context *ctx) { return ctx->failures; }

bool stf_silence(steif_context *ctx, bool silent)
{
  const bool before = ctx->silent;
  ctx->silent = silent;
  return before;
}

/* The length of a text without the codes at its end, of sentences that it passes on. */
static int without_codes(const char *text, int length)
{
  static const char mark[] = " [STEIF_";
  for (int k = length; k > 0 && text[k - 1] == ']';) {
    while (k > 0 && text[k] != ' ') k--;
    if (strncmp(text + k, mark, sizeof mark - 1)) break;
    length = k;
  }
  return length;
}

static void keep(steif_context *ctx, int code, const char *format, va_list arguments)
{
  ctx->code = code;
  char text[MESSAGE] = ""; /* the former message may be among the arguments */
  int used = vsnprintf(text, MESSAGE, format, arguments);
  if (used >= 0 && used < MESSAGE) used = without_codes(text, used);
  memcpy(ctx->message, text, MESSAGE);
  if (used >= 0 && used < MESSAGE)
    snprintf(ctx->message + used, (size_t)(MESSAGE - used), " [%s]", steif_code_symbol(code));
}

int stf_fail(steif_context *ctx, int code, const char *format, ...)
{
  if (!ctx) return code;
  ctx->failures++;
  va_list arguments;
  va_start(arguments, format);
  keep(ctx, code, format, arguments);
  va_end(arguments);
  return code;
}

int stf_recover(steif_context *ctx, int cause, const char *format, ...)
{
  if (!ctx) return STEIF_RETRY;
  ctx->code = cause;
  if (ctx->silent) return STEIF_RETRY;
  va_list arguments;
  va_start(arguments, format);
  keep(ctx, cause, format, arguments);
  va_end(arguments);
  return STEIF_RETRY;
}

void stf_message_copy(const steif_context *ctx, char *text)
{
  strncpy(text, ctx->message, MESSAGE);
}

void stf_message_take(steif_context *ctx, int code, const char *text)
{
  ctx->code = code, ctx->failures++;
  strcpy(ctx->message, text);
}

bool stf_foreign_memory(const steif_context *ctx) { return ctx->setup.allocate != allocate; }

void *stf_allocate(steif_context *ctx, size_t count, size_t size)
{
  if (count == 0) count = 1;
  if (size == 0) size = 1;
  void *block =
    count <= PTRDIFF_MAX / size ? ctx->setup.allocate(count * size, ctx->setup.user) : NULL;
  if (!block)
    STEIF_FAIL(ctx, STEIF_NO_MEMORY,
               "no memory for %zu items of %zu bytes; make the problem "
               "smaller",
               count, size);
  else if (stf_foreign_memory(ctx))
    memset(block, 0, count * size);
  return block;
}

void stf_release(steif_context *ctx, void *block)
{
  ctx->setup.release(block, ctx->setup.user);
}
