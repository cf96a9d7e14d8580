/* syntax.h: a model as statements, and its expressions as codes in postfix
 * order. SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_SYNTAX_H
#define STF_SYNTAX_H

#include "lexer.h"
#include "operations.h"

typedef struct stf_code {
  uint8_t kind;   /* of enum stf_kind */
  uint8_t primes; /* of names and elements */
  uint16_t count; /* indices of an element */
  uint32_t at;
  union {
    double number;
    struct {
      int32_t a, b;
    };
  };
} stf_code;

/* Codes from .. to-1; to == from: there is none. */
typedef struct stf_expression {
  uint32_t from, to;
} stf_expression;

/* name in low:high; without a name, low alone. */
typedef struct stf_range {
  int32_t name;
  stf_expression low, high;
} stf_range;

enum { STF_DIMENSIONS = 3 };

enum stf_statement_kind {
  STF_SAY_TITLE,
  STF_SAY_PARAM,
  STF_SAY_CONST,
  STF_SAY_STATE,
  STF_SAY_DISCRETE,
  STF_SAY_LET,
  STF_SAY_FUNCTION, /* arguments: its children of kind NAME */
  STF_SAY_NAME,
  STF_SAY_BOUNDARY,
  STF_SAY_TABLE, /* pairs: children of kind PAIR */
  STF_SAY_PAIR,
  STF_SAY_EQUATION,
  STF_SAY_FOR,
  STF_SAY_WHEN,
  STF_SAY_AT, /* times: children of kind INSTANT */
  STF_SAY_INSTANT,
  STF_SAY_EVERY,
  STF_SAY_ASSIGN,
  STF_SAY_STOP,
  STF_SAY_OUTPUT,
  STF_SAY_INTEGRAND, /* an output that a functional has added */
  STF_SAY_INVARIANT,
  STF_SAY_REQUIRE,
  STF_SAY_BREAK,
  STF_SAY_TIME,
  STF_SAY_TOLERANCE,
  STF_SAY_FORM,
  STF_SAY_REFERENCE, /* values: children of kind VALUE */
  STF_SAY_VALUE,
  STF_SAY_DATA, /* columns: children of kind COLUMN; other: the standard deviation */
  STF_SAY_COLUMN,
  STF_SAY_FIT
};

typedef struct stf_statement {
  uint8_t kind, primes, dimensions;
  uint8_t start;              /* of a state: '=', '~' or 0 */
  uint8_t whole;              /* a parameter: whole; a table: 0 linear, 1 cubic, 2 steps;
                        when: 'r', 'f', 'c' or 0 */
  uint8_t error;              /* a table: it ends at its nodes */
  int32_t name;               /* word; -1: none */
  int32_t parent;             /* statement around it; -1: none */
  uint32_t at, line;          /* of its name */
  uint32_t string, strlength; /* place of a string, or of a unit */
  stf_expression value, other, third;
  stf_range range[STF_DIMENSIONS];
} stf_statement;

typedef struct stf_syntax {
  stf_sources sources;
  stf_pool *pool;
  int depth; /* of files included by files */
  stf_words words;
  stf_vector tokens, statements, codes, indices; /* indices: of stf_range */
} stf_syntax;

/* Token by token; shared by the two files of the parser. */
typedef struct stf_parser {
  stf_syntax *syntax;
  size_t at;
  int level;
  bool boolean; /* is the expression just read a condition? */
} stf_parser;

/* expressions.c */
const stf_token *stf_next(const stf_parser *p);
bool stf_next_is(const stf_parser *p, int mark);
bool stf_next_word(const stf_parser *p, int word);
bool stf_take(stf_parser *p, int mark);
bool stf_take_word(stf_parser *p, int word);
int stf_expected(stf_parser *p, const char *what);
/* habits.c: where `what` is expected, what another language would write there, in the words of this one; NULL:
 * nothing is known of it. */
const char *stf_habit(const stf_parser *p, const char *what);
/* The complaint about "==", or "=" in a condition, which is next. */
int stf_equality(const stf_parser *p);
/* A number, an expression that may be a condition, a condition. */
int stf_parse_number(stf_parser *p, stf_expression *e);
int stf_parse_any(stf_parser *p, stf_expression *e);
int stf_parse_condition(stf_parser *p, stf_expression *e);
/* "[" has been taken: low, low:high or name in low:high up to "]". */
int stf_parse_ranges(stf_parser *p, stf_range *range, uint8_t *dimensions);

/* statements.c: all of text number `which`. */
int stf_parse(stf_syntax *syntax, size_t which);

#endif
