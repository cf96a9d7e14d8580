/* flow.c: rows of a report as they come, so that a run that is killed has shown and written what it made.
 *
 * The file has the columns of the rows so far. A row with another one is rare: then the file is written anew, whole at
 * every moment. On a terminal the names of the columns come again.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <sys/stat.h>

void stf_flow_close(stf_flow *flow)
{
  if (flow->file) (void)fclose(flow->file);
  json_decref(flow->widths);
  json_decref(flow->names);
  *flow = (stf_flow){0};
}

/* ---- the file ---- */

static bool in_place(const char *path)
{
  struct stat info;
  return stat(path, &info) || S_ISREG(info.st_mode);
}

static int anew(steif_report *r, const char *path)
{
  stf_flow *flow = &r->flow;
  if (flow->file) (void)fclose(flow->file);
  flow->file = NULL;
  STEIF_TRY(steif_report_save(r, STEIF_CSV, path));
  flow->file = fopen(path, "a");
  return flow->file ? STEIF_OK : STEIF_IO;
}

static int to_file(steif_report *r, json_t *sheet, const char *path)
{
  stf_flow *flow = &r->flow;
  const size_t count = json_array_size(sheet);
  if (!flow->names && !(flow->names = json_object())) return STEIF_NO_MEMORY;
  json_t *before = json_copy(flow->names);
  int code = before ? STEIF_OK : STEIF_NO_MEMORY;
  for (size_t i = flow->written; i < count && code == STEIF_OK; i++)
    code = stf_csv_collect(flow->names, json_array_get(sheet, i));
  const bool same = flow->file && json_equal(before, flow->names);
  json_decref(before);
  STEIF_TRY(code);
  if (!same) STEIF_TRY(anew(r, path));
  for (size_t i = flow->written; same && i < count; i++)
    stf_csv_line(flow->file, flow->names, json_array_get(sheet, i));
  flow->written = count;
  return fflush(flow->file) || ferror(flow->file) ? STEIF_IO : STEIF_OK;
}

/* ---- the terminal ---- */

static int to_terminal(steif_report *r, json_t *sheet, FILE *stream)
{
  stf_flow *flow = &r->flow;
  const size_t count = json_array_size(sheet);
  if (!flow->widths && !(flow->widths = json_object())) return STEIF_NO_MEMORY;
  const size_t known = json_object_size(flow->widths);
  STEIF_TRY(stf_table_measure(sheet, flow->shown, true, flow->widths));
  if (!flow->shown) stf_table_fields(r, stream);
  if (json_object_size(flow->widths) > known) stf_table_line(stream, flow->widths, NULL);
  for (; flow->shown < count; flow->shown++)
    stf_table_line(stream, flow->widths, json_array_get(sheet, flow->shown));
  return fflush(stream) ? STEIF_IO : STEIF_OK;
}

void steif_report_reserve(steif_report *r, const char *column, size_t width)
{
  if (!r || !column || r->flow.shown) return;
  stf_flow *flow = &r->flow;
  if (!flow->widths && !(flow->widths = json_object())) {
    r->code = STEIF_NO_MEMORY;
    return;
  }
  json_t *known = json_pack("{s:I}", "width", (json_int_t)width);
  if (!known || json_object_set_new(flow->widths, column, known)) r->code = STEIF_NO_MEMORY;
}

int stf_flow_rest(steif_report *r, json_t *sheet, FILE *stream)
{
  const int code =
    r->flow.shown < json_array_size(sheet) ? to_terminal(r, sheet, stream) : STEIF_OK;
  stf_table_notes(stream, sheet);
  return code == STEIF_NO_MEMORY ? code : STEIF_OK;
}

int steif_report_flow(steif_report *r, const char *path, FILE *stream)
{
  if (!r) return STEIF_NO_MEMORY;
  STEIF_TRY(r->code);
  json_t *sheet = stf_report_first_sheet(r->root);
  const size_t count = json_array_size(sheet);
  int code = STEIF_OK;
  if (stream && r->flow.shown < count) code = to_terminal(r, sheet, stream);
  if (!r->flow.file && path && !in_place(path)) r->flow.whole = true;
  if (path && !r->flow.whole && r->flow.written < count) {
    const int written = to_file(r, sheet, path);
    r->flow.whole = written != STEIF_OK;
    code = code ? code : written;
  }
  return code == STEIF_NO_MEMORY
           ? STEIF_FAIL(r->ctx, code, "no memory for the columns of the rows; ask for fewer")
         : code == STEIF_IO ? STEIF_FAIL(r->ctx, code, "the rows could not be written")
                            : code;
}
