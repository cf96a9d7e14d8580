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

/* The tokens of text number `which`, appended to `tokens`. A line goes on while
 * a bracket is open or its last token is an operator, '=' or ','. */
int stf_lex(stf_sources *sources, size_t which, stf_words *words, stf_vector *tokens);

#endif
