/* linear.h: a descriptor system from the words of a call.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef LINEAR_H
#define LINEAR_H

#include "face.h"

/* From two Matrix Market files E F, one .mat file, or the name of a problem of the collection. */
struct linear {
  steif_linear system;
  steif_problem problem; /* of the collection; its name is NULL otherwise */
  steif_function *function;
  SUNMatrix C, D; /* of y = C x + D u; NULL: none */
  steif_names *read;        /* of --names or a .mat file */
  const steif_names *names; /* these, or the problem's own; NULL: none */
  double *x0; /* --x0, or the start of the problem; NULL: none */
  double t0;
  sunindextype n;
};

/* Rows of an option table: of every analysis, and of those that start somewhere. */
#define ANALYSIS_ROWS                                                                          \
  {"--names", WORD, "FILE",                                                                    \
   "a line UNKNOWN or UNKNOWN, EQUATION for each (of a .mat file: unknowns, equations)"},      \
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A"},          \
    {"--algorithm", CHOICE, "auto|staircase|qz|contour|drazin|array", "how it is analysed"},   \
    {"--radius", POSITIVE, "R", "of the contour (default: raised until certified)"},           \
  {                                                                                            \
    "--points", COUNT, "N", "of the contour (default 16)"                                      \
  }
#define START_ROWS                                                                             \
  {"--x0", WORD, "X.mtx", "x(0-), a column of as many rows as E"},                             \
    {"--forcing", WORD, "FILE",                                                                \
     "f: an expression in t per line, or samples t,f1,... in .csv"},                           \
    {"--f", WORD, "TEXT", "the same expressions separated by ';' (default 0)"},                \
    {"--input", WORD, "B.mtx", "f = B u: these are u (of a .mat file: its B)"},                \
    {"--output", WORD, "C.mtx", "show y = C x, too (of a .mat file: its C)"},                  \
    {"--feedthrough", WORD, "D.mtx", "y = C x + D u (of a .mat file: its D)"},                 \
  {                                                                                            \
    "--t0", REAL, "T", "time of the jump (default 0, or the problem's)"                        \
  }

/* The system of words `from` and, of files, from + 1: EXIT_OK, or the exit code after a sentence;
 * close it in any case. start: x(0-) and f too. */
int linear_open(struct call *call, struct linear *l, int from, bool start);
/* l->x0 of l->n values from --x0, where it is given. */
int linear_read_x0(struct call *call, struct linear *l);
/* EXIT_OK when there is an x(0-), else a sentence and EXIT_USAGE. */
int linear_started(const struct call *call, const struct linear *l);
/* Has the collection its own x(0-) and f here, unchanged? */
bool linear_as_published(const struct call *call, const struct linear *l);
void linear_close(struct call *call, struct linear *l);
/* Is the word a file rather than a problem of the collection? */
bool linear_is_file(const char *word);
steif_analysis linear_analysis(const struct call *call, const struct linear *l);
/* Say why there is no solution, with the first equations and unknowns to look at; EXIT_SINGULAR. */
int linear_singular(const struct call *call, const struct linear *l, const steif_structure *s);
/* fail(), where input is to blame and came from a file: EXIT_FILE. */
int linear_fail(const struct call *call);
int linear_no_memory(const struct call *call, const char *what);

#endif
