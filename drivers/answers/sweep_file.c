/* sweep_file.c: the file of a sweep. Rows that are kept are never at stake: a new file is written beside them and takes
 * their place, by renaming, when it has them all.
 *   FILE.part       what a run with --resume writes; its lock keeps every other sweep away from FILE
 *   FILE.part.kept  rows of FILE.part that an earlier run has left, and those of FILE, before FILE.part is begun again
 * SPDX-License-Identifier: BSD-3-Clause */
#define _DEFAULT_SOURCE   /* flock */
#define _DARWIN_C_SOURCE  /* flock */
#define _XOPEN_SOURCE 700 /* realpath */
#include "sweep.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
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

static void name_written(struct names *n, const struct call *call)
{
  name_files(n, word_of(call, given(call, "--csv") ? "--csv" : "--resume"));
}

int sweep_file_old(const struct sweep *s, char path[OLD_FILES][PATH_ROOM])
{
  struct names n;
  name_written(&n, s->call);
  snprintf(path[0], PATH_ROOM, "%s", word_of(s->call, "--resume"));
  snprintf(path[1], PATH_ROOM, "%s", n.kept);
  snprintf(path[2], PATH_ROOM, "%s", n.part);
  return n.beside ? OLD_FILES : 1;
}

static int unwritable(const struct sweep *s, const char *path, int reason)
{
  say(s->call, "cannot write \"%s\": %s [STEIF_IO]", path, strerror(reason));
  return EXIT_FAILED;
}

static bool is_at(int file, const char *path)
{
  struct stat open, there;
  return !fstat(file, &open) && !stat(path, &there) && open.st_dev == there.st_dev &&
         open.st_ino == there.st_ino;
}

/* The lock is that of the open file, which the kernel takes back when the process dies, and which other openings of the
 * same file leave alone. One of a file that its former owner has renamed or removed keeps nobody away. Where the file
 * cannot be opened, that is told when it is to be written; where the file system has no locks, there is none. */
int sweep_file_lock(struct sweep *s)
{
  struct names n;
  name_written(&n, s->call);
  for (int file; n.beside && s->lock < 0; s->lock = file) {
    file = open(n.part, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return EXIT_OK;
    const bool busy = flock(file, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK;
    if (!busy && is_at(file, n.part)) continue;
    close(file);
    if (busy) {
      refuse(s->call, STEIF_IO, "STEIF_IO",
             "another sweep writes \"%s\" now; wait for its end, or take another file by --csv",
             n.target);
      return EXIT_FAILED;
    }
    file = -1;
  }
  return EXIT_OK;
}

/* Of a sweep that has written nothing no file is left. */
void sweep_file_unlock(struct sweep *s)
{
  struct names n;
  struct stat info;
  if (s->lock < 0) return;
  name_written(&n, s->call);
  if (!fstat(s->lock, &info) && !info.st_size && is_at(s->lock, n.part)) remove(n.part);
  close(s->lock);
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
