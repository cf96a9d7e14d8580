/* sweep_resume.c: rows of an earlier sweep, kept as they are; the other members are run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct old_rows {
  char *text;
  char **line; /* in the order of the members */
  long long *number, count, next;
};

static char *read_all(FILE *file)
{
  size_t used = 0, room = 1 << 16;
  char *text = malloc(room);
  while (text) {
    used += fread(text + used, 1, room - used - 1, file);
    if (used < room - 1) break;
    char *more = realloc(text, room *= 2);
    if (!more) free(text);
    text = more;
  }
  if (text) text[used] = 0;
  return text;
}

static int stranger(const struct sweep *s, const char *path, long line, const char *what)
{
  say(s->call,
      "\"%s\", line %ld: %s; --resume goes with the words and options of the sweep "
      "that wrote the file [STEIF_BAD_INPUT]",
      path, line, what);
  return EXIT_FILE;
}

/* A line is that of the member whose number it has. */
static int keep_line(struct sweep *s, const char *path, long at, char *line)
{
  struct old_rows *o = s->old;
  char *end;
  const long long i = strtoll(line, &end, 10);
  if (end == line || *end != ',' || i < 0 || i >= s->axes.members)
    return stranger(s, path, at, "no member of this sweep");
  const size_t length = sweep_begin(s, i, s->line, s->room);
  if (length >= s->room || strncmp(line, s->line, length))
    return stranger(s, path, at, "the member has other parameters here");
  if (o->count && o->number[o->count - 1] >= i)
    return stranger(s, path, at, "members are not in ascending order");
  o->number[o->count] = i;
  o->line[o->count++] = line;
  return EXIT_OK;
}

/* A last line without an end was being written when the sweep died: its member is run again. */
static int keep_lines(struct sweep *s, const char *path)
{
  struct old_rows *o = s->old;
  int code = EXIT_OK;
  long at = 0;
  for (char *line = o->text, *end; !code && (end = strchr(line, '\n')); line = end + 1) {
    *end = 0;
    if (++at > 1) {
      code = keep_line(s, path, at, line);
    } else {
      sweep_header(s, s->line, s->room);
      if (strcmp(line, s->line)) code = stranger(s, path, at, "other columns than this sweep");
    }
  }
  return code;
}

static long long lines_of(const char *text)
{
  long long count = 0;
  for (; (text = strchr(text, '\n')); text++) count++;
  return count;
}

int old_open(struct sweep *s, const char *path)
{
  FILE *file = fopen(path, "r");
  if (!file) {
    say(s->call, "cannot read \"%s\": %s [STEIF_IO]", path, strerror(errno));
    return EXIT_FILE;
  }
  struct old_rows *o = s->old = calloc(1, sizeof *o);
  if (o) o->text = read_all(file);
  fclose(file);
  if (o && o->text) {
    const size_t count = (size_t)lines_of(o->text) + 1;
    o->line = malloc(count * sizeof *o->line);
    o->number = malloc(count * sizeof *o->number);
  }
  if (!o || !o->text || !o->line || !o->number)
    return no_memory(s->call, "the rows to be kept", "give the process more");
  return keep_lines(s, path);
}

long long old_missing(const struct sweep *s)
{
  return s->axes.members - (s->old ? s->old->count : 0);
}

/* Member i has i - (rows kept before it) missing ones before it: the smallest i with i - kept(i) = k that is not
 * kept, by bisection over the rows. */
long long old_number(const struct sweep *s, long long k)
{
  const struct old_rows *o = s->old;
  long long low = 0,
            high = o ? o->count : 0; /* rows with number - place <= k stand before it */
  while (low < high) {
    const long long middle = low + (high - low) / 2;
    if (o->number[middle] - middle <= k)
      low = middle + 1;
    else
      high = middle;
  }
  return k + low;
}

int old_before(struct sweep *s, long long i)
{
  struct old_rows *o = s->old;
  for (; o && o->next < o->count && o->number[o->next] < i; o->next++)
    if (sweep_row_kept(s, o->line[o->next])) return 1;
  return 0;
}

void old_close(struct sweep *s)
{
  if (!s->old) return;
  free(s->old->text);
  free(s->old->line);
  free(s->old->number);
  free(s->old);
  s->old = NULL;
}
