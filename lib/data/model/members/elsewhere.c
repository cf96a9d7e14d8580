/* elsewhere.c: names that other languages have, and what they are called here.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* The state x of a name such as dx, dxdt, dx_dt, xdot, x_dot; NULL: it is none. */
static const stf_symbol *slope_of(const stf_model *m, const char *name)
{
  static const struct {
    const char *head, *tail;
  } forms[] = {{"d", ""}, {"d", "dt"}, {"d", "_dt"}, {"", "dot"}, {"", "_dot"}};
  const size_t length = strlen(name);
  for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
    const size_t head = strlen(forms[i].head), tail = strlen(forms[i].tail);
    if (length <= head + tail || strncmp(name, forms[i].head, head) ||
        strcmp(name + length - tail, forms[i].tail))
      continue;
    const stf_symbol *s =
      stf_symbol_of(m, stf_word_known(&m->syntax.words, name + head, length - head - tail));
    if (s && s->kind == STF_IS_STATE) return s;
  }
  return NULL;
}

const char *stf_elsewhere(const stf_model *m, const char *name, char *room, size_t size)
{
  static const struct {
    const char *name, *here;
  } words[] = {{"ln", "'ln' is written log, which is natural here"},
               {"pow", "'pow': a power is written x^y"},
               {"power", "'power': a power is written x^y"},
               {"fabs", "'fabs' is written abs"},
               {"sgn", "'sgn' is written sign"},
               {"heaviside", "'heaviside' is written step"},
               {"arcsin", "'arcsin' is written asin"},
               {"arccos", "'arccos' is written acos"},
               {"arctan", "'arctan' is written atan"},
               {"der", "'der(x)' is written x'"},
               {"diff", "'diff(x, t)' is written x'"},
               {"ddt", "'ddt(x)' is written x'"},
               {"dt", "'dt': a derivative dx/dt is written x'"},
               {"pre", "'pre(x)': an event assigns from the values before it; write x"},
               {"delay", "'delay': an equation has no values of other times"},
               {"true", "'true': a switch is a number, 1, and 's > 0.5' a condition"},
               {"True", "'True': a switch is a number, 1, and 's > 0.5' a condition"},
               {"false", "'false': a switch is a number, 0, and 's > 0.5' a condition"},
               {"False", "'False': a switch is a number, 0, and 's > 0.5' a condition"},
               {"\xcf\x80", "'\xcf\x80' is written pi"},
               {"e", "'e' is written exp(1), and e^x exp(x)"}};
  char small[STEIF_SPEC_WORD];
  int operands;
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (!strcmp(name, words[i].name)) return words[i].here;
  const stf_symbol *s = slope_of(m, name);
  if (s) {
    const char *state = stf_named(m, s->word);
    snprintf(room, size, "'%s' is not declared; the derivative of '%s' is written %s'", name,
             state, state);
    return room;
  }
  for (size_t i = 0; i < sizeof small; i++) small[i] = (char)tolower((unsigned char)name[i]);
  small[sizeof small - 1] = 0;
  if (!strcmp(small, name) || (stf_function_of(small, &operands) < 0 && strcmp(small, "pi")))
    return NULL;
  snprintf(room, size, "'%s' is written %s", name, small);
  return room;
}

/* A line `r = expr` wants a declaration, or is the interval of another language. */
int stf_undeclared(stf_model *m, const stf_code *c, const char *name)
{
  static const char *const ends[] = {"tend",    "t_end", "tf",   "tfinal",
                                     "t_final", "tmax",  "tspan"};
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
    if (!strcmp(name, ends[i]))
      return stf_complain(&m->syntax.sources, c->at, STEIF_UNKNOWN_NAME,
                          "'%s' is not declared; the interval is written 'time 0 to 10', an "
                          "abbreviation 'let %s = ...'",
                          name, name);
  return stf_complain(&m->syntax.sources, c->at, STEIF_UNKNOWN_NAME,
                      "'%s' is not declared; write 'let %s = ...' for an abbreviation, "
                      "'state %s' for an unknown, 'param %s = ...' for a number",
                      name, name, name, name);
}

/* x(0) = 3, x(t), u(i) and x(1 - x) of a name that is declared. */
void stf_no_function(stf_model *m, const stf_statement *s, const stf_code *c,
                     const stf_symbol *f)
{
  const char *name = stf_named(m, c->a);
  const stf_code *argument = c - 1; /* the last code of it */
  const bool state = f->kind == STF_IS_STATE;
  const bool side = s->kind == STF_SAY_EQUATION && s->value.to == s->value.from + 2 &&
                    c == STF_AT(m->syntax.codes, stf_code, s->value.from) + 1;
  char remedy[3 * STF_NAME_BYTES] = "write * for a product";
  if (stf_statement_at(m, f->statement)->dimensions)
    snprintf(remedy, sizeof remedy, "elements are written %s[i]", name);
  else if (state && side && argument->kind == STF_OP_NUMBER)
    snprintf(remedy, sizeof remedy, "a start is written 'state %s = ...'", name);
  else if (state && argument->kind == STF_OP_NAME && argument->a == STF_WORD_T)
    snprintf(remedy, sizeof remedy, "write %s without (t)", name);
  stf_complain(&m->syntax.sources, c->at, STEIF_BAD_INPUT, "'%s' is no function; %s", name,
               remedy);
}
