/* expression.c: expressions in t, by recursive descent into postfix programs:
 *   sum     = product { (+|-) product }
 *   product = signed { (*|/) signed }
 *   signed  = (+|-) signed | power
 *   power   = atom [ ^ signed ]               so that -t^2 = -(t^2) and 2^3^2 = 2^9
 *   atom    = number | t | pi | name ( sum ) | min ( sum , sum ) | max ( sum , sum ) | ( sum )
 * SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 100 };                /* nesting, so that recursion is bounded */
static const double largest = 1 << 30; /* whole exponents beyond it go by exp and log */

static const struct {
  const char *name;
  enum stf_operation operation;
} known[] = {{"t", STF_TIME},    {"pi", STF_NUMBER}, {"sin", STF_SIN},   {"cos", STF_COS},
             {"tan", STF_TAN},   {"exp", STF_EXP},   {"log", STF_LOG},   {"sqrt", STF_SQRT},
             {"sinh", STF_SINH}, {"cosh", STF_COSH}, {"tanh", STF_TANH}, {"atan", STF_ATAN},
             {"abs", STF_ABS},   {"step", STF_STEP}, {"ramp", STF_RAMP}, {"min", STF_MIN},
             {"max", STF_MAX}};
enum { KNOWN = sizeof known / sizeof *known };

/* How an expression depends on t; what is linear is found by these rules only. */
enum { FIXED, LINEAR, GENERAL };

typedef struct parser {
  steif_context *ctx;
  const stf_source *source;
  const char *text;
  size_t length, at;
  stf_program *program;
  int level, height; /* of nesting; of the stack */
} parser;

static int sum(parser *p, int *degree);
static int signed_power(parser *p, int *degree);

/* "file, line 3, position 14: " and what to say. */
static int reject(const parser *p, size_t at, int code, const char *sentence)
{
  const stf_source *s = p->source;
  return STEIF_FAIL(p->ctx, code, "%s%s%s %ld, position %zu: %s", s->name ? s->name : "",
                    s->name ? ", " : "", s->name ? "line" : "expression", s->line, at + 1,
                    sentence);
}

static char next(parser *p)
{
  while (p->at < p->length && isspace((unsigned char)p->text[p->at])) p->at++;
  return p->at < p->length ? p->text[p->at] : 0;
}

static int expected(parser *p, const char *what)
{
  char shown[STF_SHOWN], sentence[192], rest[STF_SHOWN] = "";
  const char c = next(p);
  for (size_t i = 0; i + 1 < sizeof rest && p->at + i < p->length; i++) {
    rest[i] = p->text[p->at + i];
    rest[i + 1] = 0;
  }
  stf_input_shown(rest, shown);
  snprintf(sentence, sizeof sentence, "expected %s, found %s%s%s", what, c ? "'" : "",
           c ? shown : "the end", c ? "'" : "");
  return reject(p, p->at, STEIF_BAD_INPUT, sentence);
}

static void emit(parser *p, enum stf_operation operation, size_t place, sunrealtype number)
{
  const bool pushes = operation == STF_NUMBER || operation == STF_TIME || operation == STF_STEP;
  p->program->code[p->program->length++] =
    (stf_instruction){.operation = operation, .place = (int)place, .number = number};
  if (operation >= STF_ADD && operation <= STF_POWER && operation != STF_NEGATE) p->height--;
  if (pushes && ++p->height > p->program->depth) p->program->depth = p->height;
}

/* The instructions from `start` on, which leave one series: its value b and slope a at t = 0; for
 * what is linear this is a t + b. They are taken away when `drop`. */
static int value_of(parser *p, int start, bool drop, sunrealtype *b, sunrealtype *a)
{
  int place;
  const stf_program part = {p->program->code + start, p->program->length - start,
                            p->program->depth};
  stf_series *stack = stf_allocate(p->ctx, (size_t)part.depth + STF_SCRATCH, sizeof *stack);
  if (!stack) return STEIF_NO_MEMORY;
  const char *wrong = stf_program_run(&part, 0, 1, stack, &place);
  *b = stack->c[0];
  *a = stack->c[1];
  stf_release(p->ctx, stack);
  if (wrong) return reject(p, (size_t)place, STEIF_BAD_INPUT, wrong);
  if (!isfinite(*b) || !isfinite(*a))
    return reject(p, (size_t)part.code->place, STEIF_NOT_FINITE,
                  "a constant that is not finite");
  if (drop) {
    p->program->length = start;
    p->height--;
  }
  return STEIF_OK;
}

static int number(parser *p)
{
  const size_t start = p->at;
  const char *s = p->text;
  size_t i = start;
  while (i < p->length && isdigit((unsigned char)s[i])) i++;
  if (i < p->length && s[i] == '.')
    for (i++; i < p->length && isdigit((unsigned char)s[i]);) i++;
  size_t e = i;
  if (e < p->length && (s[e] == 'e' || s[e] == 'E')) {
    e++;
    if (e < p->length && (s[e] == '+' || s[e] == '-')) e++;
    if (e < p->length && isdigit((unsigned char)s[e]))
      for (i = e; i < p->length && isdigit((unsigned char)s[i]);) i++;
  }
  char *end;
  const double x = strtod(s + start, &end);
  if (end != s + i) return expected(p, "a decimal number such as 0.25 or 1e-3");
  if (!isfinite(x)) return reject(p, start, STEIF_NOT_FINITE, "a number beyond 1.8e308");
  p->at = i;
  emit(p, STF_NUMBER, start, x);
  return STEIF_OK;
}

/* step(...) and ramp(...) of t - c, or of any a t + b with a /= 0: the break is at -b / a. */
static int broken(parser *p, enum stf_operation operation, size_t place, int start, int degree)
{
  sunrealtype a = 0, b = 0;
  if (degree == LINEAR) STEIF_TRY(value_of(p, start, operation == STF_STEP, &b, &a));
  const sunrealtype c = a == 1 ? -b : -b / a;
  if (degree != LINEAR || a == 0 || !isfinite(c))
    return reject(p, place, STEIF_BAD_INPUT,
                  "expected t - c with a constant c between the parentheses of step or ramp");
  emit(p, operation, place, c);
  p->program->code[p->program->length - 1].rising = a > 0;
  return STEIF_OK;
}

/* abs of what is linear, min and max of two such: the break is where the argument, or the difference,
 * is 0; the instructions from `start` on leave the first. */
typedef struct line {
  int degree;
  sunrealtype a, b; /* a t + b */
} line;

static int line_of(parser *p, int start, int degree, line *l)
{
  *l = (line){.degree = degree};
  return degree == GENERAL ? STEIF_OK : value_of(p, start, false, &l->b, &l->a);
}

static void emit_switch(parser *p, enum stf_operation operation, size_t place, const line *l,
                        const line *m)
{
  const sunrealtype a = l->a - m->a, b = l->b - m->b;
  const bool linear = l->degree != GENERAL && m->degree != GENERAL && a != 0;
  emit(p, operation, place, linear ? (a == 1 ? -b : -b / a) : NAN);
  p->program->code[p->program->length - 1].rising = a > 0;
}

/* The second argument of min and max. */
static int second(parser *p, line *l)
{
  int degree;
  if (next(p) != ',') return expected(p, "',' and a second argument");
  p->at++;
  const int start = p->program->length;
  STEIF_TRY(sum(p, &degree));
  return line_of(p, start, degree, l);
}

static int call(parser *p, int which, size_t place, int *degree)
{
  char what[64];
  int inner;
  const int start = p->program->length;
  const enum stf_operation operation = known[which].operation;
  snprintf(what, sizeof what, "'(' after '%s'", known[which].name);
  if (next(p) != '(') return expected(p, what);
  p->at++;
  STEIF_TRY(sum(p, &inner));
  const bool two = operation == STF_MIN || operation == STF_MAX;
  line l = {0}, m = {0};
  if (two || (operation == STF_ABS && inner == LINEAR)) STEIF_TRY(line_of(p, start, inner, &l));
  if (two) STEIF_TRY(second(p, &m));
  if (next(p) != ')') return expected(p, "')' or an operator");
  p->at++;
  *degree = inner == FIXED && m.degree == FIXED ? FIXED : GENERAL;
  if (two || operation == STF_ABS) {
    emit_switch(p, operation, place, &l, &m);
    return STEIF_OK;
  }
  if (operation == STF_STEP || operation == STF_RAMP) {
    *degree = GENERAL;
    return broken(p, operation, place, start, inner);
  }
  emit(p, operation, place, 0);
  return STEIF_OK;
}

static int name(parser *p, int *degree)
{
  const size_t start = p->at;
  char word[STF_SHOWN] = "", sentence[192];
  size_t used = 0;
  for (; p->at < p->length && (isalnum((unsigned char)p->text[p->at]) || p->text[p->at] == '_');
       p->at++)
    if (used + 1 < sizeof word) word[used++] = p->text[p->at];
  int which = 0;
  while (which < KNOWN && strcmp(known[which].name, word)) which++;
  if (which == KNOWN) {
    char guess[STF_GUESS];
    snprintf(sentence, sizeof sentence, "unknown name '%s'%s", word,
             stf_guess(word, known, KNOWN, sizeof *known, guess));
    return reject(p, start, STEIF_UNKNOWN_NAME, sentence);
  }
  *degree = known[which].operation == STF_TIME ? LINEAR : FIXED;
  if (known[which].operation > STF_TIME) return call(p, which, start, degree);
  emit(p, known[which].operation, start, acos(-1));
  return STEIF_OK;
}

static int atom(parser *p, int *degree)
{
  const char c = next(p);
  *degree = FIXED;
  if (isdigit((unsigned char)c) || c == '.') return number(p);
  if (isalpha((unsigned char)c)) return name(p, degree);
  if (c != '(') return expected(p, "a number, t, pi, a function or '('");
  p->at++;
  STEIF_TRY(sum(p, degree));
  if (next(p) != ')') return expected(p, "')' or an operator");
  p->at++;
  return STEIF_OK;
}

static int power(parser *p, int *degree)
{
  STEIF_TRY(atom(p, degree));
  if (next(p) != '^') return STEIF_OK;
  const size_t place = p->at++;
  const int start = p->program->length;
  int of_exponent;
  sunrealtype exponent, slope;
  STEIF_TRY(signed_power(p, &of_exponent));
  const bool constant = of_exponent == FIXED;
  if (*degree != FIXED || !constant) *degree = GENERAL;
  if (!constant) {
    emit(p, STF_POWER, place, 0);
    return STEIF_OK;
  }
  STEIF_TRY(value_of(p, start, true, &exponent, &slope));
  const bool whole = exponent == floor(exponent) && fabs(exponent) <= largest;
  emit(p, whole ? STF_POWER_WHOLE : STF_POWER_REAL, place, exponent);
  return STEIF_OK;
}

static int signed_power(parser *p, int *degree)
{
  const char c = next(p);
  const size_t place = p->at;
  if (++p->level > DEEPEST)
    return reject(p, p->at, STEIF_BAD_INPUT, "nested more than 100 deep; simplify it");
  if (c == '+' || c == '-') {
    p->at++;
    STEIF_TRY(signed_power(p, degree));
    if (c == '-') emit(p, STF_NEGATE, place, 0);
  } else {
    STEIF_TRY(power(p, degree));
  }
  p->level--;
  return STEIF_OK;
}

static int product(parser *p, int *degree)
{
  STEIF_TRY(signed_power(p, degree));
  for (char c = next(p); c == '*' || c == '/'; c = next(p)) {
    const size_t place = p->at++;
    int right;
    STEIF_TRY(signed_power(p, &right));
    const int larger = right > *degree ? right : *degree;
    const bool scaled = right == FIXED || (c == '*' && *degree == FIXED);
    *degree = scaled ? larger : GENERAL;
    emit(p, c == '*' ? STF_MULTIPLY : STF_DIVIDE, place, 0);
  }
  return STEIF_OK;
}

static int sum(parser *p, int *degree)
{
  STEIF_TRY(product(p, degree));
  for (char c = next(p); c == '+' || c == '-'; c = next(p)) {
    const size_t place = p->at++;
    int right;
    STEIF_TRY(product(p, &right));
    if (right > *degree) *degree = right;
    emit(p, c == '+' ? STF_ADD : STF_SUBTRACT, place, 0);
  }
  return STEIF_OK;
}

int stf_program_parse(steif_context *ctx, const stf_source *source, const char *text,
                      size_t length, stf_program *program)
{
  parser p = {.ctx = ctx, .source = source, .text = text, .length = length, .program = program};
  int degree;
  program->length = program->depth = 0;
  STEIF_TRY(sum(&p, &degree));
  return next(&p) ? expected(&p, "an operator or the end of the expression") : STEIF_OK;
}
