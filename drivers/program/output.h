/* output.h: reports, pictures and files as the user asked for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef OUTPUT_H
#define OUTPUT_H

#include "command_line.h"
#include <steif/report.h>
#include <sundials/sundials_matrix.h>

/* Before a long run: can the files asked for be written? EXIT_OK, or an exit code after a sentence;
 * so do the next ones. */
int check_outputs(const struct call *call);
/* The report on stdout in the form asked for. */
int show(const struct call *call, steif_report *report);
/* --npz and --mtx of a verb that makes matrices: done by show. */
/* Of --npz and --h5, in those that are given; an exit code. */
int save_arrays(const struct call *call, size_t count, const steif_array *array);
bool wants_arrays(const struct call *call);
/* Of --mtx PREFIX, where it is given: PREFIXname.mtx, sparse or dense. */
int save_matrix(const struct call *call, const char *name, SUNMatrix M);
int save_report_arrays(const struct call *call, const steif_report *report);
/* The rows of its first sheet that are new, each of which is complete, in --csv and, without --json, on stdout; show
 * then shows the rest. A failure is left to save_csv. */
void rows_come(const struct call *call, steif_report *report);
/* The same in --csv alone. */
void csv_comes(const struct call *call, steif_report *report);
/* As --csv. */
int save_csv(const struct call *call, steif_report *report);
/* Both. */
int present(const struct call *call, steif_report *report);
/* A report of one result, made and freed here: presented, shown alone, or saved alone as --csv. */
typedef void report_filler(steif_report *r, const struct call *call, const void *result);
int present_result(const struct call *call, report_filler *fill, const void *result);
int show_result(const struct call *call, report_filler *fill, const void *result);
int save_rows(const struct call *call, report_filler *fill, const void *result);
/* Nothing to do when the path is NULL. */
int save_plot(const struct call *call, const steif_plot *plot, const char *path);

#endif
