/* json.c: a report as one JSON object on one line, reals with 17 significant digits.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "report.h"

int stf_report_json(steif_report *r, FILE *stream)
{
  const int failed = json_dumpf(r->root, stream, JSON_COMPACT | JSON_REAL_PRECISION(17));
  STEIF_CHECK(!failed, r->ctx, ferror(stream) ? STEIF_IO : STEIF_NO_MEMORY,
              "the JSON object could not be written: %s",
              ferror(stream) ? "the stream failed; is the disk full or the reader gone?"
                             : "memory is short; ask for fewer rows");
  putc('\n', stream);
  return STEIF_OK;
}
