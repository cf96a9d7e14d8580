/* operations.h: what expressions of a model are made of, from the text to the
 * machine: the leaves, the functions with their names, and what only the text
 * has.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef STF_OPERATIONS_H
#define STF_OPERATIONS_H

#include <stddef.h>
#include <stdint.h>

/* X(name, word in the text or NULL, value at (a, b)). */
#define STF_UNARY(X)                                                                           \
  X(NEGATIVE, NULL, -a)                                                                        \
  X(NOT, NULL, (double)!(a != 0))                                                              \
  X(SIN, "sin", sin(a))                                                                        \
  X(COS, "cos", cos(a))                                                                        \
  X(TAN, "tan", tan(a))                                                                        \
  X(ASIN, "asin", asin(a))                                                                     \
  X(ACOS, "acos", acos(a))                                                                     \
  X(ATAN, "atan", atan(a))                                                                     \
  X(SINH, "sinh", sinh(a))                                                                     \
  X(COSH, "cosh", cosh(a))                                                                     \
  X(TANH, "tanh", tanh(a))                                                                     \
  X(ASINH, "asinh", asinh(a))                                                                  \
  X(ACOSH, "acosh", acosh(a))                                                                  \
  X(ATANH, "atanh", atanh(a))                                                                  \
  X(EXP, "exp", exp(a))                                                                        \
  X(EXPM1, "expm1", expm1(a))                                                                  \
  X(LOG, "log", log(a))                                                                        \
  X(LOG10, "log10", log10(a))                                                                  \
  X(LOG1P, "log1p", log1p(a))                                                                  \
  X(SQRT, "sqrt", sqrt(a))                                                                     \
  X(CBRT, "cbrt", cbrt(a))                                                                     \
  X(ERF, "erf", erf(a))                                                                        \
  X(ABS, "abs", fabs(a))                                                                       \
  X(SIGN, "sign", (double)((a > 0) - (a < 0)))                                                 \
  X(STEP, "step", (double)(a >= 0))                                                            \
  X(RAMP, "ramp", a > 0 ? a : 0)                                                               \
  X(FLOOR, "floor", floor(a))

#define STF_BINARY(X)                                                                          \
  X(ADD, NULL, a + b)                                                                          \
  X(SUBTRACT, NULL, a - b)                                                                     \
  X(MULTIPLY, NULL, a *b)                                                                      \
  X(DIVIDE, NULL, a / b)                                                                       \
  X(POWER, NULL, pow(a, b))                                                                    \
  X(LESS, NULL, (double)(a < b))                                                               \
  X(LESS_EQUAL, NULL, (double)(a <= b))                                                        \
  X(AND, NULL, (double)((a != 0) && (b != 0)))                                                 \
  X(OR, NULL, (double)((a != 0) || (b != 0)))                                                  \
  X(ATAN2, "atan2", atan2(a, b))                                                               \
  X(MIN, "min", a < b ? a : b)                                                                 \
  X(MAX, "max", a > b ? a : b)                                                                 \
  X(MOD, "mod", a - b * floor(a / b))                                                          \
  X(HYPOT, "hypot", hypot(a, b))

enum stf_kind {
  /* leaves */
  STF_OP_NUMBER,
  STF_OP_TIME,
  STF_OP_PARAMETER, /* a: which */
  STF_OP_STATE,     /* a + strides times the loop counters: which unknown */
  STF_OP_SLOPE,     /* its derivative */
  STF_OP_ALONG,     /* its component of a direction, and those of the next two */
  STF_OP_ALONG_SLOPE,
  STF_OP_ALONG_PARAMETER,
  STF_OP_WEIGHT,  /* of a row */
  STF_OP_MEMORY,  /* a discrete value or a switch */
  STF_OP_COUNTER, /* a: value of loop a */
#define STF_ONE(name, word, value) STF_OP_##name,
  STF_UNARY(STF_ONE) STF_BINARY(STF_ONE)
#undef STF_ONE
    STF_OP_LOOKUP, /* table b at a; c: of steps, whose slope is 0 */
  STF_OP_TILT,     /* its slope */
  STF_OP_SELECT,   /* a holds: b, else c */
  /* of the machine only: a b + c, a b - c, c - a b */
  STF_OP_TIMES_PLUS,
  STF_OP_TIMES_MINUS,
  STF_OP_MINUS_TIMES,
  /* c products of two or three factors, listed from b on, added one after the other */
  STF_OP_PAIRS,
  STF_OP_TRIPLES,
  STF_OP_PAIRS_2, /* two to six */
  STF_OP_PAIRS_3,
  STF_OP_PAIRS_4,
  STF_OP_PAIRS_5,
  STF_OP_PAIRS_6,
  STF_OP_KINDS,
  /* of the text only */
  STF_OP_NAME = STF_OP_KINDS, /* a: word; count: primes */
  STF_OP_ELEMENT,             /* a: first of its indices in `indices`; count: primes; b:
                     word */
  STF_OP_CALL,                /* a: word, b: arguments */
  STF_OP_SKIP,                /* a: so many codes on are read by others */
  STF_OP_LITERAL,             /* a: 1 where noevent(...) begins, -1 where it ends */
  STF_OP_SUM                  /* a: its indices (word, from, to); b: codes of the term, which
                follow */
};

/* Operands: 0 of leaves, 1, 2 or 3. */
int stf_operands(int kind);
/* The function of a word, or -1; *operands as many as it takes. */
int stf_function_of(const char *word, int *operands);
/* The words of all functions into `list`; how many there are, fewer than STF_OP_KINDS - 2. */
size_t stf_function_words(const char **list);
/* How it is written: "sqrt", "+"; "" for what has no sign. */
const char *stf_operation_word(int kind);
/* The value of an operation on numbers. */
double stf_operate(int kind, double a, double b, double c);

#endif
