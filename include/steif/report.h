/* steif/report.h: results as one value that prints as a table, CSV or JSON, and pictures.
 *
 * A report is an ordered set of named fields: numbers, texts, lists of numbers, and sheets (rows of
 * named columns). Reals are written with 17 significant digits in JSON and CSV; NaN and infinities
 * as the strings "nan", "inf", "-inf" in JSON.
 *
 *   steif_report *r = steif_report_new(ctx);
 *   steif_report_text(r, "problem", "rober");
 *   steif_report_row(r, "rows");                      a new row of the sheet "rows"
 *   steif_report_real(r, "rows.h", 0.5);              a cell of the last row
 *   steif_report_write(r, STEIF_TABLE, stdout);
 *   steif_report_free(&r);
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STEIF_REPORT_H
#define STEIF_REPORT_H

#include <stdio.h>
#include <steif/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct steif_report steif_report;
enum steif_format { STEIF_TABLE, STEIF_CSV, STEIF_JSON };

STEIF_EXPORT steif_report *steif_report_new(steif_context *ctx);
STEIF_EXPORT void steif_report_free(steif_report **r);

/* Names: "key" for a field, "sheet.key" for a cell of the sheet's last row, "object.key" for a
 * member of an object (any name that was not opened as a sheet). A failure (memory) is kept in the
 * report and returned by steif_report_write. */
STEIF_EXPORT void steif_report_row(steif_report *r, const char *sheet);
STEIF_EXPORT void steif_report_real(steif_report *r, const char *name, sunrealtype value);
STEIF_EXPORT void steif_report_whole(steif_report *r, const char *name, long value);
STEIF_EXPORT void steif_report_truth(steif_report *r, const char *name, int value);
STEIF_EXPORT void steif_report_text(steif_report *r, const char *name,
                                    const char *value); /* NULL: null */
STEIF_EXPORT void steif_report_texts(steif_report *r, const char *name, size_t count,
                                     const char *const *value);
STEIF_EXPORT void steif_report_list(steif_report *r, const char *name, size_t count,
                                    const sunrealtype *value);
/* rows x columns by rows, as [[..],..]. */
STEIF_EXPORT void steif_report_matrix(steif_report *r, const char *name, size_t rows,
                                      size_t columns, const sunrealtype *value);

/* STEIF_TABLE: fields as "name  value" lines, sheets as aligned columns with 6 or so digits;
 * STEIF_CSV: the first sheet with a header line (or the fields as one row, a list as x1, x2, ..,
 * a matrix as A1_1, A1_2, ..); STEIF_JSON: one object
 * on one line. STEIF_IO when the stream fails. */
STEIF_EXPORT int steif_report_write(steif_report *r, enum steif_format format, FILE *stream);
/* The same into a file; an unwritable path leaves no file. */
STEIF_EXPORT int steif_report_save(steif_report *r, enum steif_format format, const char *path);

/* Rows as they come: those of the first sheet that are new since the last call, each of which is complete, to the file
 * `path` as in STEIF_CSV and to `stream` as in STEIF_TABLE, below the fields that were there when the first came.
 * Either may be NULL; give the same ones every time. What steif_report_write then writes as STEIF_TABLE is the rest;
 * steif_report_save writes all. A pipe or a device is left to that. */
STEIF_EXPORT int steif_report_flow(steif_report *r, const char *path, FILE *stream);
/* Before the first row: texts of so many characters may come in its first column, whose name this is, so that rows
 * that are shown as they come are in line. */
STEIF_EXPORT void steif_report_reserve(steif_report *r, const char *column, size_t width);

/* Rows of numbers as comma-separated values with a header line, like those of STEIF_CSV, each written out as it
 * comes: what a run that is killed has made is in the file, whose former content is lost. NULL and STEIF_IO where
 * it cannot be written. */
typedef struct steif_rows steif_rows;
STEIF_EXPORT steif_rows *steif_rows_new(steif_context *ctx, const char *path, size_t columns,
                                        const char *const *name);
STEIF_EXPORT int steif_rows_add(steif_rows *r,
                                const sunrealtype *value); /* one for each column */
STEIF_EXPORT int steif_rows_close(steif_rows **r);

/* List or matrix i of the fields, in their order: its name, rows, columns (0: a list) and, where value is not
 * NULL, its numbers by rows; NULL past the end. Empty ones are left out, members of objects have their own
 * names. */
STEIF_EXPORT const char *steif_report_array_at(const steif_report *r, size_t i, size_t *rows,
                                               size_t *columns, sunrealtype *value);

/* An array of a file for numpy: rows numbers, or rows x columns by rows; or rows texts in UTF-8. */
typedef struct steif_array {
  const char *name;
  size_t rows, columns; /* columns 0: one dimension */
  const sunrealtype *value;
  const char *const *text; /* instead of numbers, columns 0; NULL: numbers */
} steif_array;
/* Up to 16 arrays as an .npz file: numpy.load(path)[name]. At most 4 GB (STEIF_UNSUPPORTED). */
STEIF_EXPORT int steif_npz_save(steif_context *ctx, const char *path, size_t count,
                                const steif_array *array);
/* Arrays as an HDF5 file, a data set of doubles or texts each: h5py.File(path)[name], MATLAB's h5read, which
 * counts the dimensions the other way round. By the libhdf5, 1.10 or later, of the system; STEIF_UNSUPPORTED: there is none. Threads of one
 * program must not call it at the same time, unless that library was built for it. */
STEIF_EXPORT int steif_h5_save(steif_context *ctx, const char *path, size_t count,
                               const steif_array *array);

/* A picture of curves. Points that are not finite, or not positive on a log axis, are gaps. */
typedef struct steif_curve {
  const char *label;
  size_t count;
  const sunrealtype *x, *y;
  int marks; /* 1: draw points, 0: a line only, 2: points only */
} steif_curve;
typedef struct steif_plot {
  const char *title, *x_label, *y_label;
  int log_x, log_y;
  int equal; /* same scale on both axes (regions) */
  size_t count;
  const steif_curve *curve;
  int (*inside)(sunrealtype x, sunrealtype y, void *user); /* shaded where it returns 1; NULL:
                                                               nothing is; linear axes only */
  void *user;
} steif_plot;

/* SVG is drawn by the library, PNG by gnuplot (STEIF_UNSUPPORTED with the remedy when missing);
 * the ending of the path decides. An unwritable path leaves no file. */
STEIF_EXPORT int steif_plot_save(steif_context *ctx, const steif_plot *plot, const char *path);

/* Panels one below another, with the title of the first and the x label of the last; up to 8. */
STEIF_EXPORT int steif_panels_save(steif_context *ctx, size_t count, const steif_plot *panel,
                                   const char *path);

/* The first 8 components of a solution over t: rows y(t_0), y(t_1), ... of n numbers; names: n of them, NULL:
 * y1, y2, .... Components whose largest values differ by more than a factor of 30 are drawn in panels of
 * their own; t beyond 1e4 has a logarithmic axis. */
STEIF_EXPORT int steif_plot_components(steif_context *ctx, const char *title, size_t count,
                                       size_t n, const char *const *names, const sunrealtype *t,
                                       const sunrealtype *y, const char *path);

#ifdef __cplusplus
}
#endif
#endif
