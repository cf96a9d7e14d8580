/* operations.c: the table of operations.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "operations.h"
#include <math.h>
#include <string.h>

static const char *const words[STF_OP_KINDS] = {
#define STF_ONE(name, word, value) [STF_OP_##name] = word,
  STF_UNARY(STF_ONE) STF_BINARY(STF_ONE)
#undef STF_ONE
};

int stf_operands(int kind)
{
  if (kind < STF_OP_NEGATIVE) return 0;
  if (kind < STF_OP_ADD || kind == STF_OP_LOOKUP || kind == STF_OP_TILT) return 1;
  return kind >= STF_OP_SELECT ? 3 : 2;
}

int stf_function_of(const char *word, int *operands)
{
  for (int k = 0; k < STF_OP_KINDS; k++)
    if (words[k] && !strcmp(words[k], word)) {
      *operands = stf_operands(k);
      return k;
    }
  return -1;
}

size_t stf_function_words(const char **list)
{
  size_t count = 0;
  for (int k = 0; k < STF_OP_KINDS; k++)
    if (words[k]) list[count++] = words[k];
  return count;
}

const char *stf_operation_word(int kind)
{
  switch (kind) {
  case STF_OP_ADD: return "+";
  case STF_OP_SUBTRACT:
  case STF_OP_NEGATIVE: return "-";
  case STF_OP_MULTIPLY: return "*";
  case STF_OP_DIVIDE: return "/";
  case STF_OP_POWER: return "^";
  default: return kind < STF_OP_KINDS && words[kind] ? words[kind] : "";
  }
}

double stf_operate(int kind, double a, double b, double c)
{
  switch (kind) {
#define STF_ONE(name, word, value)                                                             \
  case STF_OP_##name: return value;
    STF_UNARY(STF_ONE)
    STF_BINARY(STF_ONE)
#undef STF_ONE
  case STF_OP_SELECT: return a != 0 ? b : c;
  default: return NAN;
  }
}
