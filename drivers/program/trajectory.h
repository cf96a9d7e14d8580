/* trajectory.h: what a run was: its steps or the solution at times asked for, events and jumps; as
 * rows, files and a picture.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef TRAJECTORY_H
#define TRAJECTORY_H

#include "attributes.h"
#include "program.h"
#include <stdint.h>

/* The first components and outputs as a picture shows them, between the steps, too. */
enum { DRAWN = 8 };
struct drawn {
  size_t n, count, room; /* curves; points */
  size_t unknowns;       /* of the curves; the others are outputs */
  double *t, *y, *row;   /* row: unknowns, then all outputs, of one point */
};

typedef struct trajectory {
  const struct call *call;
  const steif_problem *problem;
  const steif_names *names; /* of the components; NULL: none */
  struct drawn drawn;       /* count 0: the steps kept are drawn */
  size_t n, count, room;
  size_t outputs;        /* of a model, beside the unknowns */
  double *output;        /* by rows, as many values each */
  double h;              /* constant step; 0: others */
  double t0, t1, *t, *y; /* y by rows, n values each */
  size_t asked, next;    /* times asked for, those kept already; 0: every step is kept */
  bool waiting; /* the last row is of the end of the last step: an event may change it */
  double *at;
  int *attributes;  /* of the start values; NULL: those of the problem */
  N_Vector between; /* the solution at one of them */
  size_t events, event_room;
  double *event_t, *event_which,
    *event_direction;   /* one row per function that changed its sign */
  size_t *event_number; /* from 0: functions that change it together have one number */
  size_t happened;
  bool short_of_memory, live;
  double shown;               /* when the progress line was written */
  steif_report *report;       /* takes jumps as they come; NULL: they are not kept */
  steif_rows *csv;            /* NULL: no row has come, or it cannot be written: */
  int csv_code;               /* why; its sentence was said */
  double *line;               /* one of its rows */
  size_t written, shown_rows; /* rows in it, and on the terminal */
  const char *checkpoint;     /* NULL: none */
  uint64_t files;             /* of the call when it began (saved_note.h) */
  double every, saved_at;     /* seconds between two, time of the last */
  bool saved;                 /* there is one */
} trajectory;

/* EXIT_OK, or an exit code after a sentence about --at. Observers are set in *options. */
int trajectory_open(struct call *call, const steif_problem *problem, steif_options *options,
                    trajectory *tr);
/* One more row; nonzero when memory is short. */
int trajectory_keep(trajectory *tr, double t, N_Vector y);
/* Room for so many rows and events; nonzero when memory is short. */
int trajectory_room(trajectory *tr, size_t rows, size_t events);
/* The step just made to the points of the picture; nonzero when memory is short. */
int trajectory_draw(trajectory *tr, steif_solver *s, double t, N_Vector y);
void trajectory_free(trajectory *tr);
/* Sheets "output" (times asked for, of --json alone: else they are on the terminal) and "events" (--events); jumps
 * are there already. */
void trajectory_fill(steif_report *r, const trajectory *tr);
/* The rows kept since the last call to --csv, and where times are asked for to the terminal. */
void trajectory_stream(trajectory *tr);
/* The run has ended at (t, y). */
void trajectory_end(trajectory *tr, double t, N_Vector y);
/* The rest of them, and --npz; --plot. */
int trajectory_save(const struct call *call, trajectory *tr);
int trajectory_plot(const struct call *call, const trajectory *tr, const char *title);

/* One row of a sheet with columns t, kind and x, or instead of x one for each name. */
void report_vector(steif_report *r, const char *sheet, const char *const *name,
                   const char *kind, double t, size_t n, const double *x);
/* The rows of such a sheet: x-, c0, c1, ..., x+ of one jump. */
void report_jump(steif_report *r, const char *sheet, const char *const *name, double t,
                 const double *before, const steif_impulse *i);

#endif
