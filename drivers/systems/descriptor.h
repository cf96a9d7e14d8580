/* descriptor.h: a descriptor system E x' + F x = f from the words of a call.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef DESCRIPTOR_H
#define DESCRIPTOR_H

#include "program.h"

/* From two Matrix Market files E F, one .mat file, or the name of a problem of the collection. */
struct descriptor {
  steif_linear system;
  steif_problem problem; /* of the collection; its name is NULL otherwise */
  steif_function *function;
  SUNMatrix C, D;           /* of y = C x + D u; NULL: none */
  steif_names *read;        /* of --names or a .mat file */
  const steif_names *names; /* these, or the problem's own; NULL: none */
  double *x0;               /* --x0, or the start of the problem; NULL: none */
  double t0;
  sunindextype n;
};

/* Rows of an option table: of every analysis, and of those that start somewhere; and their rules. */
/* clang-format off */
#define ANALYSIS_OPTIONS                                                                       \
  {"--names", WORD, "FILE",                                                                    \
   "names: a line UNKNOWN or UNKNOWN, EQUATION for each (of a .mat file: its names)", NULL}, \
  {"--state-space", FLAG, NULL, "the second file is A of E x' = A x + f, so F = -A", NULL},    \
  {"--algorithm", CHOICE, "auto|staircase|qz|contour", "algorithm of the analysis", "auto"}, \
  {"--radius", POSITIVE, "R", "radius of the contour (default: raised until certified)", NULL},       \
  {"--points", COUNT, "N", "points of the contour (default: 16)", NULL},                       \
  {"--snap", FLAG, NULL,                                                                       \
   "exact ranks: a diagonal within 4 ulp of the negative sum of its row is that sum", NULL}
#define START_OPTIONS                                                                          \
  {"--x0", WORD, "X.mtx", "x(0-), a column of as many rows as E", NULL},                       \
  {"--forcing", WORD, "FILE", "f: an expression in t per line, or samples t,f1,... in .csv",   \
   NULL},                                                                                      \
  {"--f", WORD, "TEXT", "f as expressions separated by ';' (default: 0)", NULL},                \
  {"--input", WORD, "B.mtx", "B of f = B u: --forcing or --f are u (of a .mat file: its B)",   \
   NULL},                                                                                      \
  {"--output", WORD, "C.mtx", "show y = C x, too (of a .mat file: its C)", NULL},              \
  {"--feedthrough", WORD, "D.mtx", "D of y = C x + D u (of a .mat file: its D)", NULL},             \
  {"--t0", REAL, "T", "time of the jump (default: 0, or the problem's)", NULL}
#define START_RULES                                                                            \
  {"--forcing", EXCLUDES, "--f"}, {"--input", NEEDS, "--forcing|--f"},                         \
  {"--feedthrough", NEEDS, "--output"}
/* clang-format on */

/* The system of words `from` and, of files, from + 1: EXIT_OK, or the exit code after a sentence;
 * close it in any case. start: x(0-), f and y too. */
int descriptor_open(struct call *call, struct descriptor *l, int from, bool start);
/* The same with the problem of the word, where it has been found (.name): standard input is read once. */
int descriptor_open_found(struct call *call, struct descriptor *l, int from, bool start,
                          const steif_problem *found);
/* l->x0 of l->n values from --x0, where it is given. */
int descriptor_read_x0(struct call *call, struct descriptor *l);
/* f = B u and y = C x + D u, where there are any; path: of E. */
int descriptor_read_ports(struct call *call, struct descriptor *l, const char *path);
/* EXIT_OK when there is an x(0-), else a sentence and EXIT_USAGE. */
int descriptor_started(const struct call *call, const struct descriptor *l);
/* Has the collection its own x(0-) and f here, unchanged? */
bool descriptor_as_published(const struct call *call, const struct descriptor *l);
void descriptor_close(struct call *call, struct descriptor *l);
/* Is the word a file rather than a problem of the collection? */
bool descriptor_is_file(const char *word);
bool ends_in(const char *word, const char *ending);
/* A file of matrices by names: .mat or .h5. */
bool holds_system(const char *word);
steif_analysis descriptor_analysis(const struct call *call, const struct descriptor *l);
/* Say why there is no solution, with the first equations and unknowns to look at; EXIT_SINGULAR, or
 * EXIT_UNCERTIFIED where the entries exactly as given are regular. presented: JSON shows s already. */
int descriptor_singular(const struct call *call, const struct descriptor *l,
                        const steif_structure *s, bool presented);
/* fail(), where input is to blame and came from a file: EXIT_FILE. */
int descriptor_fail(const struct call *call);

#endif
