/* order_rows.c: errors of a method with steps h, h/2, ..., and orders where rounding does not make them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "answers.h"
#include "members.h"
#include <math.h>

/* Above rounding, as far as that is known. */
static bool usable(const steif_order_row *row) { return !(row->error < 10 * row->rounding); }

void order_rows(steif_report *r, size_t count, const steif_order_row *row)
{
  for (size_t i = 0; i < count && row[i].error >= 0; i++) {
    const bool seen = i > 0 && usable(&row[i]) && usable(&row[i - 1]);
    steif_report_row(r, "rows");
    steif_report_real(r, "rows.h", row[i].h);
    steif_report_real(r, "rows.error", row[i].error);
    report_maybe(r, "rows.", "rounding", row[i].rounding >= 0, row[i].rounding);
    steif_report_real(r, "rows.order", seen ? row[i].order : NAN);
  }
}
