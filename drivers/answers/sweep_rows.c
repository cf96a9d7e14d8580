/* sweep_rows.c: rows of a sweep on stdout and in its file, one after the other.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "sweep.h"
#include <errno.h>
#include <stdlib.h>

static void table_row(const struct sweep *s, long long i, const struct member_record *r,
                      size_t row)
{
  const char *message = sweep_message(r, row);
  double value[AXES];
  axes_at(&s->axes, i, value);
  printf("%8lld", i);
  for (int k = 0; k < s->axes.count; k++) printf(" %13.6g", value[k]);
  printf(" %-15s %13.6g", steif_code_name(sweep_code(r, row)), *sweep_numbers(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++) printf(" %13.6g", sweep_cell(s, r, row, j));
  printf("%s%s\n", *message ? "  " : "", message);
}

static void table_head(const struct sweep *s)
{
  char name[COLUMN];
  printf("%8s", "member");
  for (int k = 0; k < s->axes.count; k++) printf(" %13s", sweep_parameter(s, k, name));
  printf(" %-15s %13s", "status", "t");
  for (size_t j = 0; j < sweep_columns(s); j++) printf(" %13s", sweep_column(s, j, name));
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
  for (int k = 0; k < s->axes.count; k++)
    steif_report_real(o, sweep_parameter(s, k, name), value[k]);
  steif_report_text(o, "status", steif_code_name(sweep_code(r, row)));
  steif_report_real(o, "t", *sweep_numbers(s, r, row));
  for (size_t j = 0; j < sweep_columns(s); j++)
    if (s->collect == COLLECT_STATS)
      steif_report_whole(o, sweep_column(s, j, name), (long)sweep_cell(s, r, row, j));
    else
      steif_report_real(o, sweep_column(s, j, name), sweep_cell(s, r, row, j));
  if (*sweep_message(r, row)) steif_report_text(o, "message", sweep_message(r, row));
  if (s->rows) putchar(',');
  const int code = steif_report_write(o, STEIF_JSON, stdout);
  steif_report_free(&o);
  return code;
}

static int draw_row(struct sweep *s, long long i, const struct member_record *r, size_t row)
{
  double value[SWEEP_PANELS];
  const size_t shown = sweep_columns(s) < SWEEP_PANELS ? sweep_columns(s) : SWEEP_PANELS;
  for (size_t j = 0; s->picture && j < shown; j++) value[j] = sweep_cell(s, r, row, j);
  return s->picture ? sweep_picture_row(s, i, *sweep_numbers(s, r, row), value) : 0;
}

/* What could not be written, and why, for the sentence at the end. */
static int unwritten(struct sweep *s, const char *name)
{
  if (!s->unwritten) s->unwritten = name, s->reason = errno;
  return 1;
}

static int count(struct sweep *s, const char *line)
{
  for (const char *at = line; *at; at++)
    s->fingerprint = (s->fingerprint ^ (unsigned char)*at) * UINT64_C(0x100000001b3);
  s->rows++;
  return s->csv && fprintf(s->csv, "%s\n", line) < 0 ? unwritten(s, s->file) : 0;
}

/* Who is killed keeps them. */
static int flush(struct sweep *s)
{
  if (s->csv && fflush(s->csv)) return unwritten(s, s->file);
  return fflush(stdout) || ferror(stdout) ? unwritten(s, "standard output") : 0;
}

int sweep_rows(struct sweep *s, long long i, const struct member_record *r)
{
  if (r->code < 0 && !s->first_code) {
    s->first_code = r->code;
    snprintf(s->first_message, sizeof s->first_message, "%s", r->message);
  }
  for (size_t row = 0; row < r->rows; row++) {
    if (s->call->json && json_row(s, i, r, row)) return 1;
    if (!s->call->json && !s->call->csv) table_row(s, i, r, row);
    if (draw_row(s, i, r, row)) return 1;
    if (sweep_line(s, i, r, row) >= s->room || count(s, s->line)) return 1;
  }
  if (flush(s)) return 1;
  s->done++, s->ok += r->code >= 0;
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
  return fprintf(s->csv, "%s\n", s->line) < 0 ? unwritten(s, s->file) : flush(s);
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
  if (!s->failure) return;
  steif_report_text(r, "status", steif_code_name(s->failure));
  steif_report_text(r, "message", s->why);
}

/* The rest of the JSON object goes on where the rows end. */
int sweep_json_foot(const struct sweep *s)
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
  int code = s->call->json ? sweep_json_foot(s) : EXIT_OK;
  if (!s->call->json) {
    if (!s->call->csv) putchar('\n');
    code = show_result(s->call, facts, s);
  }
  fflush(stdout);
  if (!code) code = sweep_picture_save(s);
  if (stopped)
    say(s->call, "interrupted; %lld of %lld members are finished%s [STEIF_STOPPED]", s->done,
        s->axes.members, s->call->csv ? ", and --resume goes on with the others" : "");
  return code;
}
