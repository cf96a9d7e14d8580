/* sweep_rows.c: rows of a sweep on stdout and as comma-separated values, one after the other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char *const stats[] = {"steps", "rejected", "nfe", "nje", "nlu", "nsolve"};
enum { STATS = sizeof stats / sizeof *stats };

size_t sweep_columns(const struct sweep *s)
{
  return s->collect == COLLECT_Y ? s->n : s->collect == COLLECT_DIGITS ? 2 : STATS;
}

static const char *column(const struct sweep *s, size_t j, char room[COLUMN])
{
  static const char *const digits[] = {"scd", "mescd"};
  const steif_names *names = s->problem->names;
  if (s->collect == COLLECT_DIGITS) return digits[j];
  if (s->collect == COLLECT_STATS) return stats[j];
  if (names && names->unknown) return names->unknown[j];
  snprintf(room, COLUMN, "y%zu", j + 1);
  return room;
}

static bool whole(const struct sweep *s) { return s->collect == COLLECT_STATS; }

/* Row number `row` of a member: its code; t, y or whatever is collected. */
static int code_of(const struct member_record *r, size_t row)
{
  return row + 1 < r->rows ? STEIF_OK : r->code;
}

static const double *numbers_of(const struct sweep *s, const struct member_record *r,
                                size_t row)
{
  return r->row + row * (s->n + 1);
}

static const char *message_of(const struct member_record *r, size_t row)
{
  return row + 1 < r->rows ? "" : r->message;
}

static double cell(const struct sweep *s, const struct member_record *r, size_t row, size_t j)
{
  const long count[STATS] = {r->stats.steps, r->stats.rejected, r->stats.nfe,
                             r->stats.nje,   r->stats.nlu,      r->stats.nsolve};
  if (s->collect == COLLECT_STATS) return (double)count[j];
  if (s->collect == COLLECT_DIGITS) return j ? r->mescd : r->scd;
  return numbers_of(s, r, row)[1 + j];
}

/* ---- as comma-separated values --------------------------------------------------------------- */

struct text {
  char *at;
  size_t room, used;
};

static void add(struct text *t, const char *format, ...) STEIF_PRINTF(2, 3);
static void add(struct text *t, const char *format, ...)
{
  va_list arguments;
  const size_t left = t->used < t->room ? t->room - t->used : 0;
  va_start(arguments, format);
  t->used += (size_t)vsnprintf(left ? t->at + t->used : NULL, left, format, arguments);
  va_end(arguments);
}

static void add_number(struct text *t, double x)
{
  if (isfinite(x))
    add(t, ",%.17g", x);
  else
    add(t, ",%s", isnan(x) ? "nan" : x > 0 ? "inf" : "-inf");
}

static void add_quoted(struct text *t, const char *words)
{
  if (!strpbrk(words, ",\"")) {
    add(t, ",%s", words);
    return;
  }
  add(t, ",\"");
  for (; *words; words++) add(t, *words == '"' ? "\"\"" : "%c", *words);
  add(t, "\"");
}

size_t sweep_header(const struct sweep *s, char *text, size_t room)
{
  struct text t = {text, room, 0};
  char name[COLUMN];
  add(&t, "member");
  for (int k = 0; k < s->axes.count; k++) add_quoted(&t, s->axes.name[k]);
  add(&t, ",status,t");
  for (size_t j = 0; j < sweep_columns(s); j++) add_quoted(&t, column(s, j, name));
  add(&t, ",message");
  return t.used;
}

size_t sweep_begin(const struct sweep *s, long long i, char *text, size_t room)
{
  struct text t = {text, room, 0};
  double value[AXES];
  axes_at(&s->axes, i, value);
  add(&t, "%lld", i);
  for (int k = 0; k < s->axes.count; k++) add_number(&t, value[k]);
  add(&t, ",");
  return t.used;
}

static size_t csv_line(const struct sweep *s, long long i, const struct member_record *r,
                       size_t row)
{
  struct text t = {s->line, s->room, sweep_begin(s, i, s->line, s->room)};
  add(&t, "%s", steif_code_name(code_of(r, row)));
  add_number(&t, *numbers_of(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++) add_number(&t, cell(s, r, row, j));
  add_quoted(&t, message_of(r, row));
  return t.used;
}

/* ---- rows ------------------------------------------------------------------------------------- */

static void table_row(const struct sweep *s, long long i, const struct member_record *r,
                      size_t row)
{
  const char *message = message_of(r, row);
  double value[AXES];
  axes_at(&s->axes, i, value);
  printf("%8lld", i);
  for (int k = 0; k < s->axes.count; k++) printf(" %13.6g", value[k]);
  printf(" %-15s %13.6g", steif_code_name(code_of(r, row)), *numbers_of(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++) printf(" %13.6g", cell(s, r, row, j));
  printf("%s%s\n", *message ? "  " : "", message);
}

static void table_head(const struct sweep *s)
{
  char name[COLUMN];
  printf("%8s", "member");
  for (int k = 0; k < s->axes.count; k++) printf(" %13s", s->axes.name[k]);
  printf(" %-15s %13s", "status", "t");
  for (size_t j = 0; j < sweep_columns(s); j++) printf(" %13s", column(s, j, name));
  putchar('\n');
}

static int json_row(const struct sweep *s, long long i, const struct member_record *r,
                    size_t row)
{
  char name[COLUMN];
  double value[AXES];
  steif_report *o = steif_report_new(s->call->ctx);
  if (!o) return 1;
  axes_at(&s->axes, i, value);
  steif_report_whole(o, "member", (long)i);
  for (int k = 0; k < s->axes.count; k++) steif_report_real(o, s->axes.name[k], value[k]);
  steif_report_text(o, "status", steif_code_name(code_of(r, row)));
  steif_report_real(o, "t", *numbers_of(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++)
    if (whole(s))
      steif_report_whole(o, column(s, j, name), (long)cell(s, r, row, j));
    else
      steif_report_real(o, column(s, j, name), cell(s, r, row, j));
  if (*message_of(r, row)) steif_report_text(o, "message", message_of(r, row));
  if (s->rows) putchar(',');
  const int code = steif_report_write(o, STEIF_JSON, stdout);
  steif_report_free(&o);
  return code;
}

static int draw_row(struct sweep *s, long long i, const struct member_record *r, size_t row)
{
  double value[SWEEP_PANELS];
  const size_t shown = sweep_columns(s) < SWEEP_PANELS ? sweep_columns(s) : SWEEP_PANELS;
  for (size_t j = 0; s->picture && j < shown; j++) value[j] = cell(s, r, row, j);
  return s->picture ? sweep_picture_row(s, i, *numbers_of(s, r, row), value) : 0;
}

static int count(struct sweep *s, const char *line)
{
  for (const char *at = line; *at; at++)
    s->fingerprint = (s->fingerprint ^ (unsigned char)*at) * UINT64_C(0x100000001b3);
  s->rows++;
  if (s->csv && fprintf(s->csv, "%s\n", line) < 0) return 1;
  return ferror(stdout);
}

static void count_member(struct sweep *s, bool ok)
{
  s->ok += ok;
  if (++s->done % 256 == 0) progress(s->call, "%lld of %lld members", s->done, s->axes.members);
}

int sweep_rows(struct sweep *s, long long i, const struct member_record *r)
{
  if (r->code < 0 && !s->first_code) {
    s->first_code = r->code, s->first_member = i;
    snprintf(s->first_message, sizeof s->first_message, "%s", r->message);
  }
  for (size_t row = 0; row < r->rows; row++) {
    if (s->call->json && json_row(s, i, r, row)) return 1;
    if (!s->call->json && !s->call->csv) table_row(s, i, r, row);
    if (draw_row(s, i, r, row)) return 1;
    if (csv_line(s, i, r, row) >= s->room || count(s, s->line)) return 1;
  }
  if ((s->csv && fflush(s->csv)) || fflush(stdout)) return 1; /* who is killed keeps them */
  count_member(s, r->code >= 0);
  return 0;
}

const char *sweep_status(const struct sweep *s, const char *line)
{
  const char *at = line;
  for (int k = 0; k <= s->axes.count && at; k++) at = strchr(at + (k > 0), ',');
  return at ? at + 1 : "";
}

int sweep_rows_kept(struct sweep *s, char *const line[], size_t lines)
{
  for (size_t k = 0; k < lines; k++)
    if (count(s, line[k])) return 1;
  const char *last = sweep_status(s, line[lines - 1]);
  count_member(s, !strncmp(last, "ok,", 3) || !strncmp(last, "event,", 6));
  return 0;
}

/* ---- head and foot ----------------------------------------------------------------------------- */

int sweep_head(struct sweep *s)
{
  s->fingerprint = UINT64_C(0xcbf29ce484222325);
  if (s->call->json)
    printf("{\"rows\":[");
  else if (!s->call->csv)
    table_head(s);
  if (!s->csv) return 0;
  sweep_header(s, s->line, s->room);
  return fprintf(s->csv, "%s\n", s->line) < 0;
}

static void facts(steif_report *r, const struct call *call, const void *of)
{
  const struct sweep *s = of;
  char print[32];
  snprintf(print, sizeof print, "%016llx", (unsigned long long)s->fingerprint);
  steif_report_text(r, "problem", call->word[0]);
  steif_report_text(r, "method", call->word[1]);
  steif_report_whole(r, "members", (long)s->axes.members);
  steif_report_whole(r, "rows_written", (long)s->rows);
  steif_report_whole(r, "ok", (long)s->ok);
  steif_report_whole(r, "failed", (long)(s->done - s->ok));
  steif_report_text(r, "fingerprint", print);
}

/* The rest of the JSON object goes on where the rows end. */
static int json_foot(const struct sweep *s)
{
  char *text = NULL;
  size_t length = 0;
  FILE *memory = open_memstream(&text, &length);
  steif_report *r = steif_report_new(s->call->ctx);
  if (r) facts(r, s->call, s);
  const bool good = r && memory && !steif_report_write(r, STEIF_JSON, memory);
  if (memory) fclose(memory);
  if (good) printf("],%s", text + 1);
  steif_report_free(&r);
  free(text);
  return good ? EXIT_OK : no_memory(s->call, "the summary", "give the process more");
}

int sweep_foot(struct sweep *s, bool stopped)
{
  progress(s->call, NULL);
  int code = s->call->json ? json_foot(s) : EXIT_OK;
  if (!s->call->json) {
    if (!s->call->csv) putchar('\n');
    code = show_result(s->call, facts, s);
  }
  fflush(stdout);
  if (!code) code = sweep_picture_save(s, column);
  if (stopped)
    say(s->call, "interrupted; %lld of %lld members are finished%s [STEIF_STOPPED]", s->done,
        s->axes.members, s->call->csv ? ", and --resume goes on with the others" : "");
  return code;
}
