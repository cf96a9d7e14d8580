/* command_line.h: verbs, their tables of options, and a command line parsed by them.
 *
 * A table says all there is to know of an option: it is parsed, checked and explained by its row,
 * and has the value of the row where the user gives none.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef COMMAND_LINE_H
#define COMMAND_LINE_H

#include <stdbool.h>
#include <steif/base.h>

enum option_kind {
  FLAG,
  REAL,     /* finite */
  POSITIVE, /* finite and > 0 */
  NATURAL,  /* whole, >= 0 */
  COUNT,    /* whole, >= 1 */
  WORD,
  REPEATED, /* a word; the option may be given several times */
  CHOICE,   /* one of the words of `argument`, separated by | */
  REALS,    /* finite, > 0, separated by commas */
  TIMES,    /* finite, separated by commas */
  OUTPUT    /* a file to be written */
};
struct option {
  const char *name; /* "--rtol"; NULL ends a table */
  enum option_kind kind;
  const char *argument,
    *about;             /* how the help calls the value, and what it says of the option */
  const char *fallback; /* the value where none is given, in words of the user; NULL: none */
};
#define OPTIONS_END                                                                            \
  {                                                                                            \
    NULL, FLAG, NULL, NULL, NULL                                                               \
  }

enum rule_kind {
  REQUIRED, /* the option must be given */
  NEEDS,    /* it goes with one of `other`, "--method|--vs" */
  EXCLUDES, /* it contradicts `other` */
  AT_MOST   /* its number is at most `other` */
};
struct rule {
  const char *option; /* NULL ends a table */
  enum rule_kind kind;
  const char *other;
};
#define RULES_END                                                                              \
  {                                                                                            \
    NULL, REQUIRED, NULL                                                                       \
  }

struct call;
struct verb {
  const char *name, *about, *usage; /* usage: the words after the verb */
  int least, most;                  /* how many words */
  const char *method;            /* the word after the least where it is left out; NULL: none */
  bool picture;                  /* can it draw one? */
  bool matrices;                 /* does it make some, for --npz, --h5 and --mtx? */
  const struct option *option;   /* besides the common ones; or NULL */
  const struct rule *rule;       /* or NULL */
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
  const char *csv, *plot, *npz, *h5, *mtx;
  const char *continues;       /* the checkpoint that a run goes on from; NULL: it begins */
  const struct shares *shares; /* of a sweep over ranks; NULL: one process does it all */
};

/* Of every verb: --json to --help. */
extern const struct option common_options[];
/* Option i of a verb, its own before the common ones; NULL past the end. */
const struct option *option_at(const struct verb *verb, size_t i);

/* Is --json among the arguments? Errors of the others are told as JSON then, too. */
bool call_wants_json(int argc, char **argv);
/* EXIT_OK, or the exit code after the sentence has been said. */
int call_parse(struct call *call, int argc, char **argv);
/* What the value of an option must be where `text` is none, or NULL. */
const char *option_objection(const struct option *option, const char *text);
/* The words and options of a verb, on stdout. */
void call_help(const struct verb *verb);

bool given(const struct call *call, const char *name);
/* Value i of a REPEATED option; NULL past the last. */
const char *repeated_of(const struct call *call, const char *name, int i);
/* The value given, else the one in the table; NULL and 0 where there is neither. */
const char *word_of(const struct call *call, const char *name);
double real_of(const struct call *call, const char *name);
long whole_of(const struct call *call, const char *name);
/* The place of a word in "dense|band|sparse", from 0; -1 where it is not there. */
int word_place(const char *words, const char *text);
/* That of the value of a CHOICE; 0 where there is none. */
int choice_of(const struct call *call, const char *name);
/* The numbers of a list, at most REALS_MOST; returns how many. */
size_t reals_of(const struct call *call, const char *name, double *value);
/* The value given, else another. */
double real_or(const struct call *call, const char *name, double otherwise);
long whole_or(const struct call *call, const char *name, long otherwise);

#endif
