/* report.h: the model of a report, output files, numbers as text, axes of pictures.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_REPORT_H
#define STF_REPORT_H

#include "base.h"
#include <jansson.h>
#include <steif/report.h>

/* One JSON object: scalars, lists and matrices are fields, arrays of objects are sheets. The first
 * failure is kept in `code`; its sentence is in the context. */
/* Rows of the first sheet as they come (steif_report_flow). */
typedef struct stf_flow {
  size_t shown, written;  /* rows on the terminal, in the file */
  json_t *widths, *names; /* columns there; NULL: no row has come */
  FILE *file;             /* NULL: not open */
  bool whole; /* the file is written at the end: it is a pipe, or could not be written */
} stf_flow;
struct steif_report {
  steif_context *ctx;
  json_t *root;
  int code;
  stf_flow flow;
};
/* The rows that the terminal has not seen, and the sentences of all. */
int stf_flow_rest(steif_report *r, json_t *sheet, FILE *stream);
void stf_flow_close(stf_flow *flow);

int stf_report_json(steif_report *r, FILE *stream);
int stf_report_csv(steif_report *r, FILE *stream);
int stf_report_table(steif_report *r, FILE *stream);
/* Names of columns with the lengths of their lists from the members of `row`; a row below them. */
int stf_csv_collect(json_t *columns, json_t *row);
void stf_csv_line(FILE *stream, json_t *columns, json_t *row);
json_t *stf_report_first_sheet(json_t *root);

/* Lines for a terminal: of the fields before the first sheet, and of a sheet. Columns have the widths of the rows
 * from `from` on; where more will come, of the longest number that may. A row that is NULL: their names. */
enum { STF_CELL = 1024, STF_LINE = 96 };
void stf_table_fields(steif_report *r, FILE *stream);
int stf_table_measure(json_t *sheet, size_t from, bool more, json_t *columns);
void stf_table_line(FILE *stream, json_t *columns, const json_t *row);
/* "  name: sentence" for every row that has one other than "ok". */
void stf_table_notes(FILE *stream, json_t *sheet);
int stf_table_sheet(json_t *sheet, FILE *stream);
void stf_table_pad(FILE *stream, size_t used, size_t width);
/* Text broken at spaces, further lines indented to where it began. */
void stf_table_wrapped(FILE *stream, const char *text, size_t indent);

/* Arrays of objects. */
bool stf_report_is_sheet(const json_t *value);
/* Numbers, and the texts that stand for NaN and infinities. */
bool stf_report_is_number(const json_t *value);

/* %.*g, %.*e or %.*f with a decimal point in every locale; "nan", "inf", "-inf". */
void stf_report_number(char *out, size_t size, char conversion, int precision, double value);
/* One value as a person reads it: about six digits, exact values with more; lists shortened. */
void stf_report_cell(char *out, size_t size, const char *key, const json_t *value);
/* The characters that a value of this kind takes at most, or nearly always. */
size_t stf_report_most(const char *key, const json_t *value);
/* A text as a cell of comma-separated values. */
void stf_report_quoted(FILE *stream, const char *text);
/* Characters (not bytes) of UTF-8. */
size_t stf_report_width(const char *text);

/* A file that appears under its name when complete, and not at all otherwise. */
enum { STF_PATH = 4096 };
typedef struct stf_output {
  FILE *stream;
  char path[STF_PATH], part[STF_PATH + 32]; /* part empty: devices are written directly */
} stf_output;
int stf_output_open(steif_context *ctx, const char *path, stf_output *output);
/* Keep the file when `code` is STEIF_OK and all was written; returns the first failure. */
int stf_output_close(steif_context *ctx, stf_output *output, int code);

/* One axis of a picture: values (their logarithms on a log axis) lo .. hi to pixels p0 .. p1. */
enum { STF_TICKS = 64 };
typedef struct stf_tick {
  double at; /* in axis coordinates */
  bool major;
  char label[32];  /* empty for minor ticks */
  int power, lead; /* with `decade`: the label is lead 10^power */
  bool decade;
} stf_tick;
typedef struct stf_axis {
  bool log;
  double lo, hi, p0, p1;
  int scale; /* linear labels are in units of 10^scale */
  int ticks;
  stf_tick tick[STF_TICKS];
} stf_axis;

/* False for values that cannot be drawn: not finite, absurdly large, not positive on a log axis. */
bool stf_axis_value(const stf_axis *axis, double value, double *coordinate);
double stf_axis_pixel(const stf_axis *axis, double coordinate);
/* The range of the x (or y) of all drawable points with a margin; 0 .. 1 when there is none. */
void stf_axis_range(stf_axis *axis, const steif_plot *plot, bool vertical);
/* The same number of units per pixel on both. */
void stf_axis_equal(stf_axis *x, stf_axis *y);
void stf_axis_ticks(stf_axis *axis, int about);

enum { STF_COLOURS = 8 };
extern const char *const stf_colours[]; /* "#rrggbb" of the curves in turn */
/* The pieces of the line from (lo, y) to (hi, y) that are shaded; returns how many. */
enum { STF_PIECES = 32 };
size_t stf_shade_row(const steif_plot *plot, double y, double lo, double hi,
                     double piece[STF_PIECES][2]);

enum { STF_PANELS = 8 };
int stf_plot_svg(size_t count, const steif_plot *panel, FILE *stream);
int stf_plot_gnuplot(steif_context *ctx, size_t count, const steif_plot *panel, FILE *stream);

#endif
