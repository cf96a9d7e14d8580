/* sizes.c: structs of callers that were compiled with another header: what is missing is 0.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrator.h"
#include <string.h>

/* Is anything set in the members that we do not have? */
static bool beyond(const void *given, size_t bytes, size_t own)
{
  const unsigned char *b = given;
  for (size_t i = own; i < bytes; i++)
    if (b[i]) return true;
  return false;
}

int stf_whole(steif_context *ctx, const char *name, const void *given, size_t bytes, size_t own,
              void *room)
{
  if (!bytes) bytes = own;
  STEIF_CHECK(
    !beyond(given, bytes, own), ctx, STEIF_UNSUPPORTED,
    "the program was compiled for a later steif than %s: its %s has %zu bytes, that of the "
    "library %zu, and members beyond are set; install the later library",
    steif_version(), name, bytes, own);
  const size_t common = bytes < own ? bytes : own;
  memcpy(room, given, common);
  memset((char *)room + common, 0, own - common);
  return STEIF_OK;
}

int stf_reserved_check(steif_context *ctx, const char *name, size_t count,
                       void *const *reserved)
{
  for (size_t i = 0; i < count; i++)
    STEIF_CHECK(
      !reserved[i], ctx, STEIF_BAD_INPUT,
      "reserved[%zu] of %s is not 0: the struct was not initialised (steif_defaults(), "
      "or = {.name = ...}), or a member of a later steif is set",
      i, name);
  return STEIF_OK;
}

int stf_whole_problem(steif_context *ctx, const steif_problem *given, size_t bytes,
                      steif_problem *room, const steif_problem **whole)
{
  *whole = given;
  if (!given || !bytes || bytes == sizeof *given) return STEIF_OK;
  *whole = room;
  return stf_whole(ctx, "steif_problem", given, bytes, sizeof *given, room);
}
