/* file.c: files that are complete or not there: written beside the target, then renamed.
 * SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700 /* realpath */
#include "report.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int reject(steif_context *ctx, const char *path)
{
  return STEIF_FAIL(ctx, STEIF_IO,
                    "cannot write \"%s\": %s; name a file in a folder that exists "
                    "and may be written",
                    path, strerror(errno));
}

/* A new file beside the target, with the permissions an ordinary new file would have. */
static int create(stf_output *o)
{
  int fd = -1;
  for (int i = 0; i < 100 && fd < 0; i++) {
    snprintf(o->part, sizeof o->part, "%s.%ld-%d.part", o->path, (long)getpid(), i);
    fd = open(o->part, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd < 0 && errno != EEXIST) break;
  }
  return fd;
}

int stf_output_open(steif_context *ctx, const char *path, stf_output *o)
{
  *o = (stf_output){0};
  STEIF_CHECK(path && *path && strlen(path) < STF_PATH && PATH_MAX <= STF_PATH, ctx,
              STEIF_BAD_INPUT, "the path of the output file is %s; give a file name",
              path && *path ? "too long" : "empty");
  struct stat info;
  const bool there = !stat(path, &info);
  if (there && S_ISDIR(info.st_mode)) {
    errno = EISDIR;
    return reject(ctx, path);
  }
  /* Through a link the file it leads to is replaced, not the link. */
  if (!there || !realpath(path, o->path)) strcpy(o->path, path);
  /* Devices and pipes are written in place: renaming onto them would destroy them. */
  const bool special = there && !S_ISREG(info.st_mode);
  if (there && !special && access(path, W_OK)) return reject(ctx, path);
  const int fd = special ? open(o->path, O_WRONLY) : create(o);
  if (special) o->part[0] = 0;
  if (fd < 0) return reject(ctx, path);
  if (there && !special) (void)fchmod(fd, info.st_mode & 07777);
  o->stream = fdopen(fd, "w");
  if (o->stream) return STEIF_OK;
  close(fd);
  if (o->part[0]) unlink(o->part);
  return reject(ctx, path);
}

int stf_output_close(steif_context *ctx, stf_output *o, int code)
{
  const bool written = !fflush(o->stream) && !ferror(o->stream);
  const bool closed = !fclose(o->stream);
  if (code == STEIF_OK && !(written && closed)) code = reject(ctx, o->path);
  if (code == STEIF_OK && o->part[0] && rename(o->part, o->path)) code = reject(ctx, o->path);
  if (code != STEIF_OK && o->part[0]) unlink(o->part);
  return code;
}
