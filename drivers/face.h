/* face.h: what the verbs of the program share: options, exit codes, sentences, output.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef FACE_H
#define FACE_H

#include <stdbool.h>
#include <stdio.h>
#include <steif/steif.h>

enum { EXIT_OK, EXIT_FAILED, EXIT_USAGE, EXIT_FILE, EXIT_SINGULAR, EXIT_UNCERTIFIED };
enum { EXIT_INTERRUPTED = 130 }; /* 128 + SIGINT, as shells have it */

enum option_kind {
  FLAG,
  REAL,     /* finite */
  POSITIVE, /* finite and > 0 */
  NATURAL,  /* whole, >= 0 */
  COUNT,    /* whole, >= 1 */
  WORD,
  CHOICE, /* one of the words of `argument`, separated by | */
  REALS,  /* finite, > 0, separated by commas */
  TIMES,  /* finite, separated by commas */
  OUTPUT  /* a file to be written */
};
struct option {
  const char *name; /* "--rtol"; NULL ends a table */
  enum option_kind kind;
  const char *argument, *about; /* how the value is called in the help */
};

struct call;
struct verb {
  const char *name, *about, *usage; /* usage: the words after the verb */
  int least, most;                  /* how many words */
  const struct option *option;      /* besides --json, --csv, --plot, --quiet, --help */
  const char *const (*clash)[2]; /* pairs that contradict each other, ends with NULL; or NULL */
  int (*run)(struct call *call); /* returns an exit code */
};

/* One run of the program, parsed. */
enum { WORDS = 64, GIVEN = 32, REALS_MOST = 32 };
struct call {
  const struct verb *verb;
  steif_context *ctx;
  int words, options;
  const char *word[WORDS];
  struct {
    const struct option *option;
    const char *text;
  } given[GIVEN];
  bool json, quiet, help;
  const char *csv, *plot, *npz;
};

/* EXIT_OK, or the exit code after the sentence has been said. */
int call_parse(struct call *call, int argc, char **argv);
void call_help(const struct verb *verb);

bool given(const struct call *call, const char *name);
double real_of(const struct call *call, const char *name, double fallback);
long whole_of(const struct call *call, const char *name, long fallback);
const char *word_of(const struct call *call, const char *name, const char *fallback);
/* The numbers of a list option, at most REALS_MOST; 0 when not given. */
size_t reals_of(const struct call *call, const char *name, double *value);

/* The name nearest to `wrong`, by name_at(list, i), NULL past the end. */
const char *nearest(const char *wrong, const char *(*name_at)(const void *list, size_t i),
                    const void *list);

int exit_of(int code);
/* "steif solve: sentence" on stderr. */
void say(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);
int refuse(const struct call *call, const char *format, ...)
  STEIF_PRINTF(2, 3); /* EXIT_USAGE */
/* Say the context's message (as a JSON object too, when asked for); its exit code. */
int fail(const struct call *call);

/* A line on a terminal that the next one replaces; NULL wipes it. */
void progress(const struct call *call, const char *format, ...) STEIF_PRINTF(2, 3);

/* The report on stdout in the form asked for; EXIT_OK or the exit code after a sentence. */
int show(const struct call *call, steif_report *report);
/* The same followed by --csv of the same report. */
int present(const struct call *call, steif_report *report);
int save_csv(const struct call *call, steif_report *report);
/* Nothing to do when the path is NULL. */
int save_plot(const struct call *call, const steif_plot *plot, const char *path);
/* Before a long run: can the files asked for be written? */
int check_outputs(const struct call *call);

#endif
