/* sweep_file.c: the file of a sweep. Rows that are kept are never at stake: a new file is written beside them and takes
 * their place, by renaming, when it has them all.
 *   FILE.part       what a run with --resume writes
 *   FILE.part.kept  rows of FILE.part that an earlier run has left, and those of FILE, before FILE.part is begun again
 * SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700 /* realpath */
#include "sweep.h"
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct names {
  char target[PATH_ROOM], part[PATH_ROOM], kept[PATH_ROOM], fresh[PATH_ROOM];
  bool beside; /* no pipe or device, which nothing can take the place of */
  mode_t mode; /* 0: there is no file yet */
};

/* The file itself where the path is a link. */
static void name_files(struct names *n, const char *path)
{
  struct stat info;
  char *file = realpath(path, NULL);
  const int most = PATH_ROOM - 16;
  snprintf(n->target, PATH_ROOM, "%.*s", most, file ? file : path);
  snprintf(n->part, PATH_ROOM, "%.*s.part", most, n->target);
  snprintf(n->kept, PATH_ROOM, "%.*s.part.kept", most, n->target);
  snprintf(n->fresh, PATH_ROOM, "%.*s.part.new", most, n->target);
  const bool there = !stat(n->target, &info);
  n->beside = !there || S_ISREG(info.st_mode);
  n->mode = there ? info.st_mode & 07777 : 0;
  free(file);
}

int sweep_file_old(const struct sweep *s, char path[OLD_FILES][PATH_ROOM])
{
  struct names n;
  const char *old = word_of(s->call, "--resume");
  name_files(&n, given(s->call, "--csv") ? word_of(s->call, "--csv") : old);
  snprintf(path[0], PATH_ROOM, "%s", old);
  snprintf(path[1], PATH_ROOM, "%s", n.kept);
  snprintf(path[2], PATH_ROOM, "%s", n.part);
  return n.beside ? OLD_FILES : 1;
}

static int unwritable(const struct sweep *s, const char *path, int reason)
{
  say(s->call, "cannot write \"%s\": %s [STEIF_IO]", path, strerror(reason));
  return EXIT_FAILED;
}

/* What FILE.part has is safe elsewhere before it is emptied. */
static int gather(struct sweep *s, const struct names *n)
{
  FILE *file = fopen(n->fresh, "w");
  if (!file) return unwritable(s, n->fresh, errno);
  int reason = old_write(s, file);
  if (!reason && fsync(fileno(file))) reason = errno;
  if (fclose(file) && !reason) reason = errno;
  if (!reason && rename(n->fresh, n->kept)) reason = errno;
  if (!reason) return EXIT_OK;
  remove(n->fresh);
  return unwritable(s, n->fresh, reason);
}

/* After the last row: EXIT_OK, or `code`, or that of a file that is not whole. */
static int finish(struct sweep *s, const struct names *n, int code)
{
  int reason = fsync(fileno(s->csv)) && errno != EINVAL && errno != EROFS ? errno : 0;
  if (fclose(s->csv) && !reason) reason = errno;
  if (reason && s->complete) code = unwritable(s, s->file, reason);
  if (!s->old || !n->beside) return code;
  const bool good = s->complete && !reason;
  if (good && n->mode) chmod(n->part, n->mode);
  if (good && !rename(n->part, n->target)) {
    remove(n->kept);
    return code;
  }
  if (good) code = unwritable(s, n->target, errno);
  if (s->fresh)
    say(s->call, "\"%s\" keeps what was run, for the next --resume; \"%s\" is as it was",
        n->part, n->target);
  else
    remove(n->part);
  return code;
}

int sweep_file_write(struct sweep *s, const char *path, int (*run)(struct sweep *s))
{
  struct names n;
  name_files(&n, path);
  const bool beside = s->old && n.beside;
  const int code = beside && old_scattered(s) ? gather(s, &n) : EXIT_OK;
  if (code) return code;
  s->file = beside ? n.part : path;
  s->csv = fopen(s->file, "w");
  if (!s->csv) return unwritable(s, s->file, errno);
  return finish(s, &n, run(s));
}
