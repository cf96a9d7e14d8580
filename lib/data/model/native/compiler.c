/* compiler.c: the compiler of the system, without a shell, and a folder of what it has made.
 *
 * The folder belongs to the user and nobody else may enter it, or it is not used. A library lies there
 * beside its text, under a name made of a hash of the text; it is opened only where the text is the same
 * byte by byte. Both are written under names of their own and renamed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "compiler.h"
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { PATH_ROOM = 1024, LINE = 200 };

typedef struct place {
  steif_context *ctx;
  char folder[PATH_ROOM - 64];
  char text[PATH_ROOM], library[PATH_ROOM];                         /* as they are known */
  char new_text[PATH_ROOM], new_library[PATH_ROOM], log[PATH_ROOM]; /* while they are made */
} place;

/* ---- the folder ------------------------------------------------------------------------------- */

/* Missing folders on the way, for the user alone. */
static void make_folders(const char *path)
{
  char part[PATH_ROOM];
  for (size_t i = 1; path[i - 1] && i < sizeof part; i++) {
    if (path[i] != '/' && path[i]) continue;
    memcpy(part, path, i);
    part[i] = 0;
    if (mkdir(part, 0700) && errno != EEXIST) return;
  }
}

/* Is a part of the path a link that another user could have made? Links of the user or of the system are followed. */
static bool through_links(const char *path)
{
  char part[PATH_ROOM];
  struct stat found;
  for (size_t i = 1; path[i - 1] && i < sizeof part; i++) {
    if (path[i] != '/' && path[i]) continue;
    memcpy(part, path, i);
    part[i] = 0;
    if (!lstat(part, &found) && S_ISLNK(found.st_mode) && found.st_uid != geteuid() &&
        found.st_uid != 0)
      return true;
  }
  return false;
}

static int check_folder(steif_context *ctx, const char *folder)
{
  struct stat found;
  STEIF_CHECK(
    folder[0] == '/' && strlen(folder) < PATH_ROOM - 64, ctx, STEIF_BAD_INPUT,
    "the folder of compiled models must be an absolute path of less than %d characters",
    PATH_ROOM - 64);
  STEIF_CHECK(
    !through_links(folder), ctx, STEIF_IO,
    "the folder %.200s for compiled models is reached by a link of another user and is not "
    "used",
    folder);
  make_folders(folder);
  STEIF_CHECK(!lstat(folder, &found) && S_ISDIR(found.st_mode), ctx, STEIF_IO,
              "the folder %.200s for compiled models cannot be made or is none", folder);
  STEIF_CHECK(
    found.st_uid == geteuid(), ctx, STEIF_IO,
    "the folder %.200s belongs to another user and is not used for compiled models: give "
    "XDG_CACHE_HOME, or one of your own",
    folder);
  STEIF_CHECK(!(found.st_mode & 077), ctx, STEIF_IO,
              "the folder %.200s is open to other users and is not used for compiled models: "
              "chmod 700",
              folder);
  return STEIF_OK;
}

/* FNV-1a, 64 bits: a name only, the texts are compared. */
static uint64_t hash_of(const char *text)
{
  uint64_t hash = 14695981039346656037u;
  for (; *text; text++) hash = (hash ^ (unsigned char)*text) * 1099511628211u;
  return hash;
}

static void name_files(place *at, const char *text)
{
  const unsigned long long hash = hash_of(text);
  const long process = (long)getpid();
  snprintf(at->text, PATH_ROOM, "%s/%016llx.c", at->folder, hash);
  snprintf(at->library, PATH_ROOM, "%s/%016llx.so", at->folder, hash);
  snprintf(at->new_text, PATH_ROOM, "%s/%016llx.%ld.c", at->folder, hash, process);
  snprintf(at->new_library, PATH_ROOM, "%s/%016llx.%ld.so", at->folder, hash, process);
  snprintf(at->log, PATH_ROOM, "%s/%016llx.%ld.log", at->folder, hash, process);
}

/* ---- files ------------------------------------------------------------------------------------ */

static bool own_file(const char *path)
{
  struct stat found;
  return !lstat(path, &found) && S_ISREG(found.st_mode) && found.st_uid == geteuid() &&
         !(found.st_mode & 022);
}

static bool same_text(const char *path, const char *text)
{
  char part[4096];
  const size_t length = strlen(text);
  size_t at = 0, got;
  bool same = true;
  FILE *file = own_file(path) ? fopen(path, "rb") : NULL;
  if (!file) return false;
  while (same && (got = fread(part, 1, sizeof part, file)) > 0) {
    same = got <= length - at && !memcmp(part, text + at, got);
    at += same ? got : 0;
  }
  fclose(file);
  return same && at == length;
}

static bool write_text(const char *path, const char *text)
{
  const int to = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  FILE *file = to < 0 ? NULL : fdopen(to, "wb");
  if (!file) return false;
  const bool written = fputs(text, file) >= 0;
  return !fclose(file) && written;
}

static void first_line(const char *path, char *line)
{
  FILE *file = fopen(path, "rb");
  const size_t got = file ? fread(line, 1, LINE - 1, file) : 0;
  if (file) fclose(file);
  line[got] = 0;
  for (size_t i = 0; i < got; i++)
    if (line[i] < ' ' || line[i] == 127) {
      line[i] = 0;
      break;
    }
}

/* ---- the compiler ----------------------------------------------------------------------------- */

static int start(const place *at, const char *compiler, pid_t *child)
{
  /* the arguments of exec are no constants */
  char program[PATH_ROOM], text[PATH_ROOM], library[PATH_ROOM];
  char flags[][24] = {"-std=c11",
                      "-O3",
                      "-ffp-contract=off",
                      "-fno-math-errno",
                      "-fno-trapping-math",
                      "-w",
                      "-fPIC",
                      "-shared",
                      "-o",
                      "-lm"};
  snprintf(program, sizeof program, "%s", compiler);
  snprintf(text, sizeof text, "%s", at->new_text);
  snprintf(library, sizeof library, "%s", at->new_library);
  char *const arguments[] = {program,  flags[0], flags[1], flags[2], flags[3],
                             flags[4], flags[5], flags[6], flags[7], flags[8],
                             library,  text,     flags[9], NULL};
  posix_spawn_file_actions_t streams;
  int failed = posix_spawn_file_actions_init(&streams);
  if (failed) return failed;
  failed = posix_spawn_file_actions_addopen(&streams, 0, "/dev/null", O_RDONLY, 0);
  if (!failed) failed = posix_spawn_file_actions_addopen(&streams, 1, "/dev/null", O_WRONLY, 0);
  if (!failed)
    failed = posix_spawn_file_actions_addopen(&streams, 2, at->log,
                                              O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (!failed) failed = posix_spawnp(child, program, &streams, NULL, arguments, environ);
  posix_spawn_file_actions_destroy(&streams);
  return failed;
}

static int waited(pid_t child)
{
  int status = 0;
  pid_t got;
  do got = waitpid(child, &status, 0);
  while (got < 0 && errno == EINTR);
  return got == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int compile(const place *at, const char *compiler)
{
  char line[LINE] = "";
  pid_t child = 0;
  const int failed = start(at, compiler, &child), left = failed ? -1 : waited(child);
  STEIF_CHECK(failed != ENOENT && failed != EACCES && left != 127, at->ctx, STEIF_UNSUPPORTED,
              "no C compiler '%.100s': install one, or name it, without arguments (STEIF_CC)",
              compiler);
  first_line(at->log, line);
  STEIF_CHECK(left == 0, at->ctx, STEIF_UNSUPPORTED,
              "the compiler '%.100s' did not compile the model (exit code %d): %s", compiler,
              left, failed ? strerror(failed) : line);
  return STEIF_OK;
}

static int make(const place *at, const char *compiler, const char *text)
{
  unlink(at->new_text);
  STEIF_CHECK(write_text(at->new_text, text), at->ctx, STEIF_IO, "cannot write %.200s: %s",
              at->new_text, strerror(errno));
  int code = compile(at, compiler);
  if (!code && (chmod(at->new_library, 0700) || rename(at->new_library, at->library) ||
                rename(at->new_text, at->text)))
    code =
      STEIF_FAIL(at->ctx, STEIF_IO, "cannot write %.200s: %s", at->library, strerror(errno));
  unlink(at->log);
  unlink(at->new_text);
  unlink(at->new_library);
  return code;
}

static void *opened(const place *at)
{
  void *library = dlopen(at->library, RTLD_NOW | RTLD_LOCAL);
  if (!library)
    STEIF_FAIL(at->ctx, STEIF_IO, "the compiled model %.200s cannot be opened: remove it",
               at->library);
  return library;
}

void *stf_library_of(steif_context *ctx, const char *compiler, const char *folder,
                     const char *text)
{
  place at = {.ctx = ctx};
  if (folder && check_folder(ctx, folder)) return NULL;
  snprintf(at.folder, sizeof at.folder, "%s", folder ? folder : "/tmp/steif-XXXXXX");
  if (!folder && !mkdtemp(at.folder)) {
    STEIF_FAIL(ctx, STEIF_IO, "no temporary folder for the compiler: %s", strerror(errno));
    return NULL;
  }
  name_files(&at, text);
  const bool known = folder && own_file(at.library) && same_text(at.text, text);
  void *library = known || !make(&at, compiler, text) ? opened(&at) : NULL;
  if (!folder) {
    unlink(at.text);
    unlink(at.library);
    rmdir(at.folder);
  }
  return library;
}
