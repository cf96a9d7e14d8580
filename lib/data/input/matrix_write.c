/* matrix_write.c: matrices into Matrix Market files with 17 digits, enough to read the same numbers back;
 * written beside the target and renamed, so that a file is complete or not there.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sys/stat.h>
#include <unistd.h>

static int reject(steif_context *ctx, const char *path)
{
  return STEIF_FAIL(
    ctx, errno == ENOMEM ? STEIF_NO_MEMORY : STEIF_IO,
    "cannot write '%s': %s; name a file in a folder that exists and may be written", path,
    strerror(errno));
}

/* A new file beside the target, with the permissions that an ordinary new file has. */
static int create(const char *path, char *part, size_t room)
{
  int fd = -1;
  for (int i = 0; i < 100 && fd < 0; i++) {
    snprintf(part, room, "%s.%ld-%d.part", path, (long)getpid(), i);
    fd = open(part, O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (fd < 0 && errno != EEXIST) break;
  }
  return fd;
}

static long long count(SUNMatrix M)
{
  long long sum = 0;
  for (sunindextype j = 0; j < stf_input_columns(M); j++)
    sum += (long long)stf_input_column(M, j);
  return sum;
}

static bool put(SUNMatrix M, FILE *file)
{
  const bool array = SUNMatGetID(M) == SUNMATRIX_DENSE;
  fprintf(file, "%%%%MatrixMarket matrix %s real general\n%lld %lld",
          array ? "array" : "coordinate", (long long)stf_input_rows(M),
          (long long)stf_input_columns(M));
  if (!array) fprintf(file, " %lld", count(M));
  fputc('\n', file);
  for (sunindextype j = 0; j < stf_input_columns(M); j++)
    for (sunindextype k = 0; k < stf_input_column(M, j); k++) {
      sunindextype i;
      sunrealtype x;
      stf_input_entry(M, j, k, &i, &x);
      if (!array) fprintf(file, "%lld %lld ", (long long)i + 1, (long long)j + 1);
      fprintf(file, "%.17g\n", x);
    }
  return !ferror(file);
}

static int write_part(steif_context *ctx, SUNMatrix M, const char *path, const char *part,
                      int fd)
{
  FILE *file = fdopen(fd, "w");
  if (!file) {
    const int code = reject(ctx, path);
    close(fd);
    return code;
  }
  const bool written = put(M, file) && !fflush(file);
  const bool closed = !fclose(file);
  if (!written || !closed || rename(part, path)) return reject(ctx, path);
  return STEIF_OK;
}

int steif_matrix_write(steif_context *ctx, SUNMatrix M, const char *path)
{
  STEIF_CHECK(path && *path, ctx, STEIF_BAD_INPUT,
              "the path of a file to write is empty; name a file");
  STEIF_TRY(stf_input_check(ctx, M, "the matrix to write"));
  struct stat info;
  STEIF_CHECK(stat(path, &info) || S_ISREG(info.st_mode), ctx, STEIF_IO,
              "cannot write '%s': it is no regular file; name another", path);
  const size_t room = strlen(path) + 48;
  char *part = stf_allocate(ctx, room, 1);
  if (!part) return STEIF_NO_MEMORY;
  stf_plain plain;
  int code = stf_plain_begin(ctx, &plain);
  if (code == STEIF_OK) {
    const int fd = create(path, part, room);
    code = fd < 0 ? reject(ctx, path) : write_part(ctx, M, path, part, fd);
    if (fd >= 0 && code != STEIF_OK) unlink(part);
    stf_plain_end(&plain);
  }
  stf_release(ctx, part);
  return code;
}
