/* reader.h: one text being read, statement by statement.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_READER_H
#define STF_READER_H

#include "syntax.h"

typedef struct stf_reader {
  stf_parser p;
  int32_t parent; /* open for or when; -1 */
} stf_reader;

/* declarations.c */
int stf_reader_fail(stf_reader *r, uint32_t at, const char *what);
int stf_reader_keep(stf_reader *r, const stf_statement *s);
stf_statement stf_reader_fresh(const stf_reader *r, int kind);
/* A name that may be declared; a text in quotes; a unit, where there is one. */
int stf_reader_name(stf_reader *r, stf_statement *s);
int stf_reader_string(stf_reader *r, stf_statement *s);
void stf_reader_unit(stf_reader *r, stf_statement *s);
int stf_reader_demand(stf_reader *r, int mark, const char *what);
/* A word that is not reserved. */
bool stf_reader_take(stf_reader *r, const char *text);
/* What is declared one after the other, separated by commas. */
int stf_reader_list(stf_reader *r, int kind, int (*one)(stf_reader *, stf_statement *));
int stf_reader_item(stf_reader *r, stf_statement *s);
int stf_reader_state(stf_reader *r, stf_statement *s);
int stf_reader_assignment(stf_reader *r, stf_statement *s);
int stf_reader_requirement(stf_reader *r, stf_statement *s);
int stf_reader_value(stf_reader *r, stf_statement *s);
int stf_reader_tolerance(stf_reader *r, stf_statement *s);
int stf_reader_fit(stf_reader *r, stf_statement *s);
int stf_reader_function(stf_reader *r);
int stf_reader_table(stf_reader *r);

#endif
