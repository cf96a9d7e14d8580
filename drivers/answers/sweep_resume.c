/* sweep_resume.c: rows of earlier runs of a sweep, kept as they are; the other members are run.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep_old.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- files ------------------------------------------------------------------------------------ */

/* NULL: no memory, or errno. */
static char *read_all(FILE *file, size_t *used)
{
  size_t room = 1 << 16;
  char *text = malloc(room);
  *used = 0;
  while (text) {
    *used += fread(text + *used, 1, room - *used - 1, file);
    if (*used < room - 1) break;
    char *more = realloc(text, room *= 2);
    if (!more) free(text);
    text = more;
  }
  if (text) text[*used] = 0;
  return text;
}

static int unreadable(const struct sweep *s, const char *path, int reason)
{
  say(s->call, "cannot read \"%s\": %s [STEIF_IO]", path, strerror(reason));
  return EXIT_FILE;
}

/* A line that cannot be kept, and what to do about it. */
static int unfit(const struct sweep *s, const char *path, long line, const char *what,
                 const char *remedy)
{
  say(s->call, "\"%s\", line %ld: %s; %s [STEIF_BAD_INPUT]", path, line, what, remedy);
  return EXIT_FILE;
}

static const char other_sweep[] =
  "--resume goes with the words and options of the sweep that wrote the file";
static const char run_again[] = "remove the line, and --resume runs its member again";

/* What killed runs have left may not be there. */
static int read_file(struct sweep *s, int k)
{
  const char *path = s->old->path[k];
  size_t used;
  FILE *file = fopen(path, "r");
  if (!file && k && errno == ENOENT) return EXIT_OK;
  if (!file) return unreadable(s, path, errno);
  errno = 0;
  char *text = s->old->text[k] = read_all(file, &used);
  const int reason = ferror(file) ? errno : 0;
  fclose(file);
  if (!text) return no_memory(s->call, "the rows to be kept", "give the process more");
  if (reason) return unreadable(s, path, reason);
  if (strlen(text) == used) return EXIT_OK;
  long line = 1;
  for (const char *at = text; (at = strchr(at, '\n')); at++) line++;
  return unfit(s, path, line, "a character of value 0 stands there", run_again);
}

/* ---- members ---------------------------------------------------------------------------------- */

/* Rows of times that this sweep shows, as far as these can be told. */
static bool in_time(const struct sweep *s, const struct member_record *r)
{
  const size_t row = r->rows - 1;
  const double t = *sweep_numbers(s, r, row);
  if (!s->on_the_way || r->code) return true;
  if (given(s->call, "--at")) return row < s->points && t == s->at[row];
  return row < s->points && (row == 0 || t > *sweep_numbers(s, r, row - 1));
}

/* A line is that of the member whose number it has. */
static int keep_line(struct sweep *s, const char *path, long at, char *line, long long first)
{
  struct old_rows *o = s->old;
  struct kept *last = o->count > first ? &o->member[o->count - 1] : NULL;
  char *end;
  const long long i = strtoll(line, &end, 10);
  if (end == line || *end != ',' || i < 0 || i >= s->axes.members)
    return unfit(s, path, at, "no member of this sweep", other_sweep);
  const size_t length = sweep_begin(s, i, s->line, s->room);
  if (length >= s->room || strncmp(line, s->line, length))
    return unfit(s, path, at, "the member has other parameters here", other_sweep);
  if (last && last->number > i)
    return unfit(s, path, at, "members are not in ascending order", other_sweep);
  if (!last || last->number < i) {
    last = &o->member[o->count++];
    *last = (struct kept){.number = i, .first = o->lines, .path = path};
    memset(o->record, 0, sizeof *o->record);
  }
  if (!sweep_read(s, i, line, o->record))
    return unfit(s, path, at, "this is no row as sweeps write it", run_again);
  if (!in_time(s, o->record))
    return unfit(s, path, at, "a row of this time is not among those of the sweep", run_again);
  last->code = o->record->code;
  last->lines++;
  o->line[o->lines++] = line;
  return EXIT_OK;
}

/* Members whose lines are all there, or end early by a failure or an event; the others are run again. Where a run goes
 * on after the last row, whether its end is missing can be told of a member that others follow. */
static void leave_out_halves(struct sweep *s, long long first)
{
  struct old_rows *o = s->old;
  const bool goes_on =
    given(s->call, "--at") && !(s->options.t1 > 0 && s->at[s->points - 1] >= s->options.t1);
  long long whole = first;
  for (long long k = first; k < o->count; k++) {
    const struct kept *m = &o->member[k];
    const bool doubtful = goes_on && k + 1 == o->count;
    if (m->code || (m->lines == s->points && !doubtful)) o->member[whole++] = *m;
  }
  o->count = whole;
}

/* A last line without an end was being written when the sweep died: its member is run again. */
static int keep_lines(struct sweep *s, int k)
{
  struct old_rows *o = s->old;
  const long long first = o->count;
  const char *path = o->path[k];
  char *line = o->text[k], *end;
  int code = EXIT_OK;
  long at = 0;
  for (; !code && line && (end = strchr(line, '\n')); line = end + 1) {
    *end = 0;
    if (++at > 1) {
      code = keep_line(s, path, at, line, first);
    } else {
      sweep_header(s, s->line, s->room);
      if (strcmp(line, s->line))
        code = unfit(s, path, at, "other columns than this sweep", other_sweep);
    }
  }
  if (!code && !at && line) {
    sweep_header(s, s->line, s->room);
    if (strncmp(line, s->line, strlen(line)))
      code = unfit(s, path, 1, "other columns than this sweep", other_sweep);
  }
  if (!code) leave_out_halves(s, first);
  return code;
}

/* ---- all of them ------------------------------------------------------------------------------ */

static int by_number(const void *a, const void *b)
{
  const struct kept *x = a, *y = b;
  if (x->number != y->number) return x->number < y->number ? -1 : 1;
  return x->first < y->first ? -1 : x->first > y->first;
}

static bool alike(const struct old_rows *o, const struct kept *a, const struct kept *b)
{
  bool same = a->lines == b->lines;
  for (size_t k = 0; same && k < a->lines; k++)
    same = !strcmp(o->line[a->first + k], o->line[b->first + k]);
  return same;
}

/* Members that several files have are the same in all. */
static int merge(struct sweep *s)
{
  struct old_rows *o = s->old;
  long long used = 0;
  qsort(o->member, (size_t)o->count, sizeof *o->member, by_number);
  for (long long k = 0; k < o->count; k++) {
    const struct kept *m = &o->member[k], *before = used ? &o->member[used - 1] : m;
    if (!used || before->number != m->number) {
      o->scattered |= m->path != o->path[0];
      o->member[used++] = *m;
    } else if (!alike(o, before, m)) {
      say(
        s->call,
        "member %lld is another one in \"%s\" than in \"%s\", which an unfinished --resume has "
        "left; remove the file that is not of this sweep [STEIF_BAD_INPUT]",
        m->number, before->path, m->path);
      return EXIT_FILE;
    }
  }
  o->count = used;
  return EXIT_OK;
}

static bool reserve(struct sweep *s)
{
  struct old_rows *o = s->old;
  size_t lines = 1;
  for (int k = 0; k < OLD_FILES; k++)
    for (const char *at = o->text[k]; at && (at = strchr(at, '\n')); at++) lines++;
  o->line = malloc(lines * sizeof *o->line);
  o->member = malloc(lines * sizeof *o->member);
  o->record = malloc(sweep_record_size(s));
  return o->line && o->member && o->record;
}

int old_open(struct sweep *s)
{
  struct old_rows *o = s->old = calloc(1, sizeof *o);
  if (!o) return no_memory(s->call, "the rows to be kept", "give the process more");
  const int files = sweep_file_old(s, o->path);
  int code = EXIT_OK;
  for (int k = 0; k < files && !code; k++) code = read_file(s, k);
  if (!code && !reserve(s))
    return no_memory(s->call, "the rows to be kept",
                     "give the process more, or ask for fewer --points");
  for (int k = 0; k < files && !code; k++) code = keep_lines(s, k);
  return code ? code : merge(s);
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
    if (o->member[middle].number - middle <= k)
      low = middle + 1;
    else
      high = middle;
  }
  return k + low;
}

int old_before(struct sweep *s, long long i)
{
  struct old_rows *o = s->old;
  for (; o && o->next < o->count && o->member[o->next].number < i; o->next++) {
    const struct kept *m = &o->member[o->next];
    memset(o->record, 0, sizeof *o->record);
    for (size_t k = 0; k < m->lines; k++)
      if (!sweep_read(s, m->number, o->line[m->first + k], o->record)) return 1;
    if (sweep_rows(s, m->number, o->record)) return 1;
  }
  return 0;
}

bool old_scattered(const struct sweep *s) { return s->old->scattered; }

int old_write(struct sweep *s, FILE *file)
{
  const struct old_rows *o = s->old;
  sweep_header(s, s->line, s->room);
  bool good = fprintf(file, "%s\n", s->line) >= 0;
  for (long long k = 0; k < o->count; k++)
    for (size_t j = 0; j < o->member[k].lines && good; j++)
      good = fprintf(file, "%s\n", o->line[o->member[k].first + j]) >= 0;
  return good && !fflush(file) ? 0 : errno;
}

void old_close(struct sweep *s)
{
  struct old_rows *o = s->old;
  if (!o) return;
  for (int k = 0; k < OLD_FILES; k++) free(o->text[k]);
  free(o->line);
  free(o->member);
  free(o->record);
  free(o);
  s->old = NULL;
}
