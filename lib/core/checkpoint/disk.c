/* disk.c: files as blocks.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "checkpoint_file.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static int unreadable(steif_context *ctx, const char *path)
{
  return STEIF_FAIL(ctx, STEIF_IO, "checkpoint '%s' cannot be read: %s", path, strerror(errno));
}

/* How many bytes; folders and streams without an end have none. */
static int measure(steif_context *ctx, const char *path, FILE *stream, size_t *count)
{
  if (fgetc(stream) == EOF && ferror(stream)) return unreadable(ctx, path);
  const long end = fseek(stream, 0, SEEK_END) ? -1 : ftell(stream);
  if (end < 0 || fseek(stream, 0, SEEK_SET)) return unreadable(ctx, path);
  *count = (size_t)end;
  return STEIF_OK;
}

static int take(steif_context *ctx, const char *path, FILE *stream, unsigned char **bytes,
                size_t *count)
{
  STEIF_TRY(measure(ctx, path, stream, count));
  *bytes = stf_allocate(ctx, *count + 1, 1);
  if (!*bytes) return STEIF_NO_MEMORY;
  if (fread(*bytes, 1, *count, stream) == *count) return STEIF_OK;
  stf_release(ctx, *bytes);
  *bytes = NULL;
  return unreadable(ctx, path);
}

int stf_disk_read(steif_context *ctx, const char *path, unsigned char **bytes, size_t *count)
{
  FILE *stream = fopen(path, "rb");
  if (!stream) return unreadable(ctx, path);
  const int code = take(ctx, path, stream, bytes, count);
  fclose(stream);
  return code;
}

static bool put(FILE *stream, const void *bytes, size_t count)
{
  const bool whole =
    fwrite(bytes, 1, count, stream) == count && !fflush(stream) && !fsync(fileno(stream));
  return !fclose(stream) && whole;
}

/* By a file beside it, whose data are on the disk before it takes the name. */
int stf_disk_write(steif_context *ctx, const char *path, const void *bytes, size_t count)
{
  const size_t room = strlen(path) + sizeof ".part";
  char *beside = stf_allocate(ctx, room, 1);
  if (!beside) return STEIF_NO_MEMORY;
  snprintf(beside, room, "%s.part", path);
  FILE *stream = fopen(beside, "wb");
  const bool whole = stream && put(stream, bytes, count) && !rename(beside, path);
  const int error = errno;
  if (stream && !whole) remove(beside);
  stf_release(ctx, beside);
  STEIF_CHECK(
    whole, ctx, STEIF_IO,
    "checkpoint '%s' cannot be written: %s; the one before it, if any, is still there", path,
    strerror(error));
  return STEIF_OK;
}
