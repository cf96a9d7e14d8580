/* members.h: members of a result under the keys of a report, as data.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef MEMBERS_H
#define MEMBERS_H

#include <stdbool.h>
#include <stddef.h>
#include <steif/report.h>

enum member_kind {
  A_REAL,    /* sunrealtype */
  A_NUMBER,  /* sunrealtype; null where it is NaN */
  A_WHOLE,   /* int */
  A_NATURAL, /* int; null where it is negative */
  A_LONG,    /* long */
  A_INDEX,   /* sunindextype; null where it is negative */
  A_TRUTH,   /* int */
  A_TEXT,    /* const char *; null where it is NULL */
  A_WORD     /* char [] */
};
struct member {
  const char *key; /* NULL ends a list */
  enum member_kind kind;
  size_t at; /* offsetof */
};
/* A member shown under its own name, and the end of a list. */
#define MEMBER(type, name, kind)                                                               \
  {                                                                                            \
#name, kind, offsetof(type, name)                                                          \
  }
#define MEMBERS_END                                                                            \
  {                                                                                            \
    NULL, A_REAL, 0                                                                            \
  }

/* Members of `of` under "prefixkey". */
void report_members(steif_report *r, const char *prefix, const struct member *member,
                    const void *of);
/* Under "prefixkey" the value, or null where there is none. */
void report_maybe(steif_report *r, const char *prefix, const char *key, bool there,
                  double value);
/* A whole number, or null where it is negative. */
void report_natural(steif_report *r, const char *name, long value);
void report_wholes(steif_report *r, const char *name, size_t count, const sunindextype *value);
/* Names of the components listed: given ones, else the letter and the number from 1, "e3". */
void report_names(steif_report *r, const char *name, const char *const *given, char letter,
                  size_t count, const sunindextype *component);
/* x of rows x columns stored by columns, as a list of rows. */
void report_dense(steif_report *r, const char *name, int rows, int columns, const double *x);

#endif
