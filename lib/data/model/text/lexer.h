/* lexer.h: a text into tokens.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_LEXER_H
#define STF_LEXER_H

#include "source.h"
#include "words.h"

enum stf_token_kind {
  STF_TOKEN_END,    /* of a line; the last token of a text too */
  STF_TOKEN_NUMBER, /* number */
  STF_TOKEN_NAME,   /* word */
  STF_TOKEN_STRING, /* without its quotes */
  STF_TOKEN_UNIT,   /* without its braces */
  STF_TOKEN_MARK    /* word: the character, or of two, < and = as 'l', > and = as
                    'g', == as 'e' */
};

typedef struct stf_token {
  uint8_t kind;
  int32_t word;
  uint32_t at, length, line; /* place, bytes; line of its text */
  double number;
} stf_token;

/* Where a text is read. */
typedef struct stf_lexer {
  stf_sources *sources;
  stf_words *words;
  stf_vector *tokens;
  const char *text;
  uint32_t base, length, at, line;
  int open;    /* brackets */
  bool single; /* a line is whole: none goes on in the next */
  bool ended;  /* the last token has been told */
  bool broken; /* something in this line has no meaning: the rest of it is left out */
} stf_lexer;

/* Text number `which`, whose tokens will be appended to `tokens`. */
int stf_lex_open(stf_lexer *l, stf_sources *sources, size_t which, stf_words *words,
                 stf_vector *tokens);
/* The tokens of the next line up to its END, which the last line has too. A line goes on while a bracket is open or
 * its last token is an operator, '=' or ','. */
int stf_lex_line(stf_lexer *l);

#endif
