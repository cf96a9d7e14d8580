/* words.h: the names of a model, each kept once and known by a number; reserved
 * words come first. SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_WORDS_H
#define STF_WORDS_H

#include "vector.h"
#include <stdint.h>

#define STF_RESERVED(X)                                                                        \
  X(T, "t")                                                                                    \
  X(PI, "pi")                                                                                  \
  X(MODEL, "model")                                                                            \
  X(PARAM, "param")                                                                            \
  X(CONST, "const")                                                                            \
  X(STATE, "state")                                                                            \
  X(DISCRETE, "discrete")                                                                      \
  X(LET, "let")                                                                                \
  X(FUNCTION, "function")                                                                      \
  X(BOUNDARY, "boundary")                                                                      \
  X(TABLE, "table")                                                                            \
  X(FOR, "for")                                                                                \
  X(IN, "in")                                                                                  \
  X(END, "end")                                                                                \
  X(IF, "if")                                                                                  \
  X(THEN, "then")                                                                              \
  X(ELSE, "else")                                                                              \
  X(ELSEIF, "elseif")                                                                          \
  X(AND, "and")                                                                                \
  X(OR, "or")                                                                                  \
  X(NOT, "not")                                                                                \
  X(WHEN, "when")                                                                              \
  X(AT, "at")                                                                                  \
  X(EVERY, "every")                                                                            \
  X(STOP, "stop")                                                                              \
  X(OUTPUT, "output")                                                                          \
  X(INVARIANT, "invariant")                                                                    \
  X(REQUIRE, "require")                                                                        \
  X(TIME, "time")                                                                              \
  X(TOLERANCE, "tolerance")                                                                    \
  X(BREAKS, "breaks")                                                                          \
  X(REFERENCE, "reference")                                                                    \
  X(DATA, "data")                                                                              \
  X(FIT, "fit")                                                                                \
  X(WHOLE, "whole")                                                                            \
  X(SCALE, "scale")                                                                            \
  X(INCLUDE, "include")                                                                        \
  X(FORM, "form")                                                                              \
  X(SUM, "sum")

enum stf_reserved {
#define STF_ONE(name, text) STF_WORD_##name,
  STF_RESERVED(STF_ONE)
#undef STF_ONE
    STF_WORDS_RESERVED
};

typedef struct stf_words {
  steif_context *ctx;
  stf_pool *pool;
  stf_vector names; /* of const char * */
  stf_vector slots; /* of int32_t: 1 + number, by hash */
} stf_words;

int stf_words_open(stf_words *words, steif_context *ctx, stf_pool *pool);
void stf_words_close(stf_words *words);
/* The number of a name, new or old; -1 when memory is short. */
int stf_word(stf_words *words, const char *text, size_t length);
/* The number of an old name, else -1. */
int stf_word_known(const stf_words *words, const char *text, size_t length);
const char *stf_word_text(const stf_words *words, int name);

#endif
