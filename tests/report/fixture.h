/* fixture.h: a report of each kind of member, and what a stream or a file holds.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "report.h"
#include "suite.h"
#include <string.h>

enum { TEXT = 1 << 18 };

/* What the file holds, "" when there is none. */
static inline const char *contents(const char *path, char *text)
{
  FILE *file = fopen(path, "r");
  const size_t used = file ? fread(text, 1, TEXT - 1, file) : 0;
  text[used] = 0;
  if (file) fclose(file);
  return text;
}

static inline const char *written(steif_report *r, enum steif_format format, char *text)
{
  FILE *file = tmpfile();
  CU_ASSERT_PTR_NOT_NULL_FATAL(file);
  CU_ASSERT_EQUAL(steif_report_write(r, format, file), STEIF_OK);
  rewind(file);
  text[fread(text, 1, TEXT - 1, file)] = 0;
  fclose(file);
  return text;
}

static inline steif_report *mixed(steif_context *ctx)
{
  static const sunrealtype list[] = {2.385, NAN, -INFINITY};
  static const sunrealtype matrix[] = {1.5, 2.25, -3.125, 4.0625, 5.5, 6.75};
  static const char *const claims[] = {"A-stable", "L-stable"};
  steif_report *r = steif_report_new(ctx);
  CU_ASSERT_PTR_NOT_NULL_FATAL(r);
  steif_report_text(r, "problem", "rober");
  steif_report_text(r, "scd", NULL);
  steif_report_real(r, "t", 0.1);
  steif_report_real(r, "bound", INFINITY);
  steif_report_truth(r, "a_stable", 7);
  steif_report_list(r, "y", 3, list);
  steif_report_matrix(r, "boundary", 3, 2, matrix);
  steif_report_texts(r, "claims", 2, claims);
  steif_report_whole(r, "stats.steps", 417);
  steif_report_real(r, "stats.cpu_s", 0.03125);
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", 0.5);
  steif_report_text(r, "rows.verdict", "say \"yes\", or no");
  steif_report_row(r, "rows");
  steif_report_real(r, "rows.h", 0.25);
  steif_report_real(r, "rows.order", NAN);
  steif_report_list(r, "rows.x", 3, list);
  return r;
}

#endif
