/* sweep.h: many members of one problem: axes, rows, files that go on.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef SWEEP_H
#define SWEEP_H

#include "integration.h"
#include <stdint.h>

enum { AXES = 8, AXIS_VALUES = 64, COLUMN = 128, SWEEP_PANELS = 8 };

/* --p NAME=FROM:TO:COUNT[:log] or NAME=V,V,...; with --random NAME=FROM:TO[:log] or a list. */
struct axis {
  char name[STEIF_SPEC_KEY];
  double from, to;
  long double decimal[2]; /* the same as written */
  long count;             /* 0: of no list and without a count */
  bool log, list;
  double value[AXIS_VALUES];
};
struct axes {
  int count;
  struct axis axis[AXES];
  const char *name[AXES];
  long long members;
  bool random;
  unsigned long long seed;
};
/* From the options; EXIT_OK, or an exit code after a sentence. */
int axes_read(const struct call *call, struct axes *axes);
/* The parameters of member i, the last axis fastest. */
void axes_at(const struct axes *axes, long long i, double *value);

enum collect { COLLECT_Y, COLLECT_DIGITS, COLLECT_STATS };
/* What a member leaves: rows of t and y, the last one where it ended. */
struct member_record {
  int code;
  double scd, mescd;
  steif_stats stats;
  char message[320];
  size_t rows;
  double row[]; /* t and n numbers each */
};

struct sweep;
struct sweep_clock;
/* Members shared with other processes, as ranks: all of them have the same sweep, the first one shows it. */
struct shares {
  bool first;
  int processes;
  /* As in ensemble.h. */
  long long (*take)(long long chunk, void *of);
  /* Before the members: 0, or the exit code of one that cannot begin. */
  int (*agree)(int code, void *of);
  /* Member k is done here: nonzero when it cannot be kept. */
  int (*keep)(struct sweep *s, long long k, const struct member_record *r, size_t bytes,
              void *of);
  /* After the members: what is still to be shown; the code of all. */
  int (*join)(struct sweep *s, int code, void *of);
  void *of;
};

enum { SETS = 64 };
/* --set NAME=NUMBER, for members are made from the problem's name. */
struct set_values {
  int count;
  char text[SETS][STEIF_SPEC_KEY];
  double value[SETS];
};

struct old_rows;      /* of --resume */
struct sweep_picture; /* of --plot */
struct sweep {
  struct call *call;
  const steif_problem *problem;
  steif_problem
    first; /* the first member that can be made, which names the columns; else the problem */
  bool made;
  steif_options options;
  struct axes axes;
  struct set_values sets;
  enum collect collect;
  size_t n;        /* columns of y */
  size_t points;   /* rows of a member that goes to its end: --points or --at, else 1 */
  bool on_the_way; /* with --points or --at */
  double at[REALS_MOST];
  int lock;         /* of FILE.part; -1: none */
  FILE *csv;        /* NULL: none */
  const char *file; /* its name */
  char *line;
  size_t room;
  struct old_rows *old; /* NULL: none */
  bool checking;        /* members kept are run again, to be compared */
  struct sweep_picture *picture;
  struct sweep_clock *clock;
  long long rows, done, ok; /* written; members */
  long long fresh;          /* of them, run here */
  int first_code;           /* of the first failure */
  char first_message[320];
  uint64_t fingerprint;  /* FNV-1a of the rows as --csv has them */
  const char *unwritten; /* a file that a row could not be written to, */
  int reason;            /* and errno */
  bool complete;         /* everything that is kept and was run is in the file */
  int failure;           /* a code that ended the sweep, and its sentence */
  char why[1000];
};

/* The next member that is done, numbered among those that were to be run; nonzero when it cannot be written. */
int sweep_show(struct sweep *s, long long k, const struct member_record *r);
size_t sweep_record_size(const struct sweep *s);
/* Members of the sweep, as old_number has them, or those to be compared. */
/* Member i of the sweep from the problem `like`. */
int sweep_vary(steif_context *ctx, const struct sweep *s, long long i,
               const steif_problem *like, steif_problem *to);
int sweep_members(struct sweep *s, long long count);
/* The rows of a member on stdout, in the file and in the fingerprint; nonzero when they cannot be written. */
int sweep_head(struct sweep *s);
int sweep_rows(struct sweep *s, long long i, const struct member_record *r);
int sweep_foot(struct sweep *s, bool stopped);
int sweep_json_foot(const struct sweep *s);

/* sweep_lines.c. How many columns are collected; headings of them and of parameter k: "p:NAME" and "y:NAME" where
 * NAME is the heading of another column. */
size_t sweep_columns(const struct sweep *s);
const char *sweep_column(const struct sweep *s, size_t j, char room[COLUMN]);
const char *sweep_parameter(const struct sweep *s, int k, char room[COLUMN]);
/* Row number `row` of a member: its code; t and y; a number that is collected; its sentence. */
int sweep_code(const struct member_record *r, size_t row);
const double *sweep_numbers(const struct sweep *s, const struct member_record *r, size_t row);
double sweep_cell(const struct sweep *s, const struct member_record *r, size_t row, size_t j);
const char *sweep_message(const struct member_record *r, size_t row);
/* The header, what the lines of a member begin with, and a whole one in s->line: their lengths. */
size_t sweep_header(const struct sweep *s, char *text, size_t room);
size_t sweep_begin(const struct sweep *s, long long i, char *text, size_t room);
size_t sweep_line(const struct sweep *s, long long i, const struct member_record *r,
                  size_t row);
/* A line of member i as the next row of r: is it, character by character, as it would be written? */
bool sweep_read(const struct sweep *s, long long i, const char *line, struct member_record *r);

/* --plot: open (EXIT_OK or an exit code), rows as they come, save; without one nothing is done. */
int sweep_picture_open(struct sweep *s);
int sweep_picture_row(struct sweep *s, long long i, double t, const double *value);
int sweep_picture_save(struct sweep *s);
void sweep_picture_close(struct sweep *s);

/* sweep_clock.c: the progress line, twice a second, with the time that is left. Another member is done, in any
 * thread. */
int sweep_clock_open(struct sweep *s, long long missing);
void sweep_clock_tick(struct sweep *s);
void sweep_clock_close(struct sweep *s);

/* sweep_resume.c: --resume: EXIT_OK or an exit code. The members still to be run: how many, and number k of them. */
int old_open(struct sweep *s);
long long old_missing(const struct sweep *s);
long long old_number(const struct sweep *s, long long k);
/* Rows before member i; nonzero when they cannot be written. */
int old_before(struct sweep *s, long long i);
/* Are there rows in other files than the first? All of them as a file: errno, or 0. */
bool old_scattered(const struct sweep *s);
int old_write(struct sweep *s, FILE *file);
void old_close(struct sweep *s);
/* sweep_check.c: the first and the last member kept, made again: EXIT_OK when they come out as they are. */
int old_check(struct sweep *s);
long long old_checked(const struct sweep *s, long long k);
int old_compare(struct sweep *s, long long k, const struct member_record *r);

/* sweep_file.c: the file of --csv. With --resume rows go into FILE.part, which takes the place of FILE when all is written. */
int sweep_file_write(struct sweep *s, const char *path, int (*run)(struct sweep *s));
/* Before anything of --resume is read: EXIT_OK, or an exit code where another sweep has FILE.part. */
int sweep_file_lock(struct sweep *s);
void sweep_file_unlock(struct sweep *s);
/* Files that rows of an earlier run may be in: --resume, then what killed runs have left. */
enum { OLD_FILES = 3, PATH_ROOM = 4096 };
int sweep_file_old(const struct sweep *s, char path[OLD_FILES][PATH_ROOM]);

int sweep_run(struct call *call, const steif_problem *p);

#endif
