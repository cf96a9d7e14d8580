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
  long count; /* 0: of no list and without a count */
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
struct member_record;
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

struct old_rows;      /* of --resume */
struct sweep_picture; /* of --plot */
struct sweep {
  struct call *call;
  const steif_problem *problem;
  steif_options options;
  struct axes axes;
  enum collect collect;
  size_t n;        /* columns of y */
  size_t points;   /* rows of a member that goes to its end: --points or --at, else 1 */
  bool on_the_way; /* with --points or --at */
  double at[REALS_MOST];
  FILE *csv; /* NULL: none */
  char *line;
  size_t room;
  struct old_rows *old; /* NULL: none */
  struct sweep_picture *picture;
  long long rows, done, ok; /* written; members */
  int first_code;           /* of the first failure */
  long long first_member;
  char first_message[320];
  uint64_t fingerprint; /* FNV-1a of the rows as --csv has them */
};

/* The next member that is done, numbered among those that were to be run; nonzero when it cannot be written. */
int sweep_show(struct sweep *s, long long k, const struct member_record *r);
/* The rows of a member on stdout, in the file and in the fingerprint; nonzero when they cannot be written. */
int sweep_head(struct sweep *s);
int sweep_rows(struct sweep *s, long long i, const struct member_record *r);
/* The same of an earlier run, as its file has them. */
int sweep_rows_kept(struct sweep *s, char *const line[], size_t count);
/* The status and the rest of a line. */
const char *sweep_status(const struct sweep *s, const char *line);
int sweep_foot(struct sweep *s, bool stopped);
/* How many columns are collected. */
size_t sweep_columns(const struct sweep *s);
/* --plot: open (EXIT_OK or an exit code), rows as they come, save; without one nothing is done. */
int sweep_picture_open(struct sweep *s);
int sweep_picture_row(struct sweep *s, long long i, double t, const double *value);
int sweep_picture_save(struct sweep *s,
                       const char *(*column)(const struct sweep *s, size_t j, char *room));
void sweep_picture_close(struct sweep *s);
/* The header and the member of a line of the file. */
size_t sweep_header(const struct sweep *s, char *text, size_t room);
size_t sweep_begin(const struct sweep *s, long long i, char *text, size_t room);

/* --resume: EXIT_OK or an exit code. The members still to be run: how many, and number k of them. */
int old_open(struct sweep *s, const char *path);
long long old_missing(const struct sweep *s);
long long old_number(const struct sweep *s, long long k);
/* Rows before member i; nonzero when they cannot be written. */
int old_before(struct sweep *s, long long i);
void old_close(struct sweep *s);

int sweep_run(struct call *call, const steif_problem *p);

#endif
