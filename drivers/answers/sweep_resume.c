/* sweep_resume.c: rows of an earlier sweep, kept as they are; the other members are run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct old_rows {
  char *text;
  char **line;       /* in the order of the members */
  long long *number; /* of the members that are whole */
  size_t *first;     /* their lines, and where the last of them end */
  long long count, next;
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
static int keep_line(struct sweep *s, const char *path, long at, char *line, size_t k)
{
  struct old_rows *o = s->old;
  char *end;
  const long long i = strtoll(line, &end, 10);
  if (end == line || *end != ',' || i < 0 || i >= s->axes.members)
    return stranger(s, path, at, "no member of this sweep");
  const size_t length = sweep_begin(s, i, s->line, s->room);
  if (length >= s->room || strncmp(line, s->line, length))
    return stranger(s, path, at, "the member has other parameters here");
  o->line[k] = line;
  if (o->count && o->number[o->count - 1] == i) return EXIT_OK;
  if (o->count && o->number[o->count - 1] > i)
    return stranger(s, path, at, "members are not in ascending order");
  o->number[o->count] = i;
  o->first[o->count++] = k;
  return EXIT_OK;
}

/* Members whose lines are all there, or end early by a failure or an event; the others are run again. */
static void leave_out_halves(struct sweep *s, size_t lines)
{
  struct old_rows *o = s->old;
  size_t whole = 0, used = 0;
  for (long long k = 0; k < o->count; k++) {
    const size_t first = o->first[k], end = k + 1 < o->count ? o->first[k + 1] : lines;
    const bool early = strncmp(sweep_status(s, o->line[end - 1]), "ok,", 3) != 0;
    if (early ? end - first > s->points + 1 : end - first != s->points) continue;
    memmove(o->line + used, o->line + first, (end - first) * sizeof *o->line);
    o->number[whole] = o->number[k];
    o->first[whole++] = used;
    used += end - first;
  }
  o->count = (long long)whole;
  o->first[whole] = used;
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
      code = keep_line(s, path, at, line, (size_t)at - 2);
    } else {
      sweep_header(s, s->line, s->room);
      if (strcmp(line, s->line)) code = stranger(s, path, at, "other columns than this sweep");
    }
  }
  if (!code && at > 1) leave_out_halves(s, (size_t)at - 1);
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
    o->first = malloc((count + 1) * sizeof *o->first);
  }
  if (!o || !o->text || !o->line || !o->number || !o->first)
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
  for (; o && o->next < o->count && o->number[o->next] < i; o->next++) {
    const size_t first = o->first[o->next];
    if (sweep_rows_kept(s, o->line + first, o->first[o->next + 1] - first)) return 1;
  }
  return 0;
}

void old_close(struct sweep *s)
{
  if (!s->old) return;
  free(s->old->text);
  free(s->old->line);
  free(s->old->number);
  free(s->old->first);
  free(s->old);
  s->old = NULL;
}
