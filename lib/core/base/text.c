/* text.c: files as text: opened with a reason when they cannot be, whole or line by line.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "text.h"
#include <ctype.h>
#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

int stf_plain_begin(steif_context *ctx, stf_plain *plain)
{
  plain->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  STEIF_CHECK(plain->own != (locale_t)0, ctx, STEIF_NO_MEMORY,
              "no memory for the locale in which numbers are read; make the problem smaller");
  plain->before = uselocale(plain->own);
  return STEIF_OK;
}

void stf_plain_end(stf_plain *plain)
{
  uselocale(plain->before);
  freelocale(plain->own);
}

const char *stf_input_shown(const char *text, char shown[STF_SHOWN])
{
  size_t i = 0;
  for (; text[i] && text[i] != '\n' && text[i] != '\r' && i < STF_SHOWN - 4; i++)
    shown[i] = isprint((unsigned char)text[i]) ? text[i] : '?';
  strcpy(shown + i, text[i] && text[i] != '\n' && text[i] != '\r' ? "..." : "");
  return shown;
}

static int refuse(steif_context *ctx, const char *path)
{
  const int code = errno == ENOMEM ? STEIF_NO_MEMORY : STEIF_IO;
  return STEIF_FAIL(ctx, code, "cannot read '%s': %s; check the path and the permissions", path,
                    strerror(errno));
}

/* A copy of standard input, in which one may go back; NULL with the message set. */
static FILE *standard_input(steif_context *ctx)
{
  const long most = 1L << 30;
  char chunk[STF_CHUNK];
  FILE *copy = tmpfile();
  long size = 0;
  errno = 0;
  for (size_t used = 1; copy && used && size <= most; size += (long)used) {
    used = fread(chunk, 1, sizeof chunk, stdin);
    if (ferror(stdin) || fwrite(chunk, 1, used, copy) != used) break;
  }
  if (copy && size <= most && !ferror(stdin) && !ferror(copy) && !fseek(copy, 0, SEEK_SET))
    return copy;
  STEIF_FAIL(ctx, STEIF_IO, "cannot read standard input: %s; name a file",
             size > most ? "it holds more than 1 GB" : strerror(errno));
  if (copy) fclose(copy);
  return NULL;
}

FILE *stf_input_open(steif_context *ctx, const char *path)
{
  if (!path || !*path) {
    STEIF_FAIL(ctx, STEIF_BAD_INPUT, "the path of a file to read is empty; name a file");
    return NULL;
  }
  if (!strcmp(path, "-")) return standard_input(ctx);
  struct stat info;
  const int missing = stat(path, &info);
  if (!missing && !S_ISREG(info.st_mode)) {
    STEIF_FAIL(ctx, STEIF_IO, "cannot read '%s': it is %s; name a regular file", path,
               S_ISDIR(info.st_mode) ? "a directory" : "a device or a pipe");
    return NULL;
  }
  FILE *file = missing ? NULL : fopen(path, "r");
  if (!file) refuse(ctx, path);
  return file;
}

/* The byte order mark that spreadsheets put before UTF-8, where text begins with it: its length. */
static size_t mark_of(const char *text, size_t size)
{
  static const char mark[] = {'\xEF', '\xBB', '\xBF'};
  return size >= sizeof mark && !memcmp(text, mark, sizeof mark) ? sizeof mark : 0;
}

/* The file into text[0 .. size-1] and a zero byte behind it. */
static int fill(steif_context *ctx, const char *path, FILE *file, char *text, size_t size)
{
  errno = 0;
  const size_t used = fread(text, 1, size, file);
  if (ferror(file)) return refuse(ctx, path);
  text[used] = 0;
  const size_t length = strlen(text), mark = mark_of(text, used);
  if (length == used) memmove(text, text + mark, used - mark + 1);
  if (length == used) return STEIF_OK;
  long line = 1;
  for (size_t i = 0; i < length; i++) line += text[i] == '\n';
  return STEIF_FAIL(ctx, STEIF_BAD_INPUT,
                    "%s, line %ld: a zero byte, so this is no text file; give plain text", path,
                    line);
}

bool stf_has_data(const char *line)
{
  while (isspace((unsigned char)*line) && *line != '\n') line++;
  return *line && *line != '\n' && *line != '#';
}

const char *stf_next_line(const char *line)
{
  const char *end = strchr(line, '\n');
  return end ? end + 1 : line + strlen(line);
}

char *stf_input_text(steif_context *ctx, const char *path)
{
  FILE *file = stf_input_open(ctx, path);
  if (!file) return NULL;
  char *text = NULL;
  long size = -1;
  if (!fseek(file, 0, SEEK_END)) size = ftell(file);
  if (size < 0 || fseek(file, 0, SEEK_SET))
    refuse(ctx, path);
  else
    text = stf_allocate(ctx, (size_t)size + 1, 1);
  if (text && fill(ctx, path, file, text, (size_t)size)) {
    stf_release(ctx, text);
    text = NULL;
  }
  fclose(file);
  return text;
}

/* More bytes into the empty chunk; used = at at the end of the file. */
static int refill(stf_lines *l)
{
  errno = 0;
  l->used = fread(l->chunk, 1, sizeof l->chunk, l->file);
  l->at = l->number == 0 ? mark_of(l->chunk, l->used) : 0;
  return l->used == 0 && ferror(l->file) ? refuse(l->ctx, l->path) : STEIF_OK;
}

int stf_line_next(stf_lines *l, int *more)
{
  size_t length = 0;
  *more = 0;
  for (bool ended = false; !ended;) {
    if (l->at == l->used) STEIF_TRY(refill(l));
    if (l->at == l->used) break;
    if (!*more) *more = 1, l->number++;
    const char *from = l->chunk + l->at, *end = memchr(from, '\n', l->used - l->at);
    const size_t taken = end ? (size_t)(end - from) : l->used - l->at;
    STEIF_CHECK(taken <= STF_LINE - length, l->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: longer than %d characters; break it up", l->path, l->number,
                STF_LINE);
    STEIF_CHECK(!memchr(from, 0, taken), l->ctx, STEIF_BAD_INPUT,
                "%s, line %ld: a zero byte, so this is no text file; give plain text", l->path,
                l->number);
    memcpy(l->text + length, from, taken);
    length += taken;
    l->at += taken + (end != NULL);
    ended = end != NULL;
  }
  l->text[length] = 0;
  return STEIF_OK;
}
