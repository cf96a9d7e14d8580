/* rows.c: comma-separated values row by row, as they come.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"
#include <errno.h>
#include <string.h>

struct steif_rows {
  steif_context *ctx;
  FILE *stream;
  char path[STF_PATH];
  size_t columns;
};

static int lost(const steif_rows *r)
{
  return STEIF_FAIL(r->ctx, STEIF_IO,
                    "cannot write \"%s\": %s; name a file in a folder that exists and may be "
                    "written",
                    r->path, strerror(errno));
}

static int write_out(const steif_rows *r)
{
  putc('\n', r->stream);
  return fflush(r->stream) || ferror(r->stream) ? lost(r) : STEIF_OK;
}

static int open(steif_rows *r, const char *path, const char *const *name)
{
  STEIF_CHECK(path && *path && strlen(path) < STF_PATH, r->ctx, STEIF_BAD_INPUT,
              "the path of the output file is %s; give a file name",
              path && *path ? "too long" : "empty");
  strcpy(r->path, path);
  r->stream = fopen(path, "w");
  if (!r->stream) return lost(r);
  for (size_t i = 0; i < r->columns; i++) {
    if (i) putc(',', r->stream);
    stf_report_quoted(r->stream, name[i]);
  }
  return write_out(r);
}

steif_rows *steif_rows_new(steif_context *ctx, const char *path, size_t columns,
                           const char *const *name)
{
  if (!ctx) return NULL;
  steif_rows *r = stf_allocate(ctx, 1, sizeof *r);
  if (!r) return NULL;
  r->ctx = ctx, r->columns = columns;
  if (open(r, path, name)) (void)steif_rows_close(&r);
  return r;
}

int steif_rows_add(steif_rows *r, const sunrealtype *value)
{
  char number[40];
  if (!r) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < r->columns; i++) {
    stf_report_number(number, sizeof number, 'g', 17, value[i]);
    if (i) putc(',', r->stream);
    fputs(number, r->stream);
  }
  return write_out(r);
}

int steif_rows_close(steif_rows **r)
{
  if (!r || !*r) return STEIF_OK;
  steif_context *ctx = (*r)->ctx;
  const int code = (*r)->stream && fclose((*r)->stream) ? lost(*r) : STEIF_OK;
  stf_release(ctx, *r);
  *r = NULL;
  return code;
}
