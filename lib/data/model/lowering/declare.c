/* declare.c: what a model declares: one symbol for each name, values of
 * parameters, sizes of arrays. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

stf_symbol *stf_symbol_of(const stf_model *m, int32_t word)
{
  if (word < 0 || (size_t)word >= m->symbol_of.count) return NULL;
  const int32_t i = *STF_AT(m->symbol_of, int32_t, word);
  return i ? stf_symbol_at(m, i - 1) : NULL;
}

static int kind_of(int said)
{
  switch (said) {
  case STF_SAY_PARAM: return STF_IS_PARAMETER;
  case STF_SAY_CONST: return STF_IS_CONST;
  case STF_SAY_STATE: return STF_IS_STATE;
  case STF_SAY_DISCRETE: return STF_IS_DISCRETE;
  case STF_SAY_LET: return STF_IS_LET;
  case STF_SAY_FUNCTION: return STF_IS_FUNCTION;
  case STF_SAY_TABLE: return STF_IS_TABLE;
  default: return STF_IS_NOTHING;
  }
}

static const char *kind_name(int kind)
{
  static const char *const names[STF_IS_KINDS] = {"name",     "parameter", "constant", "state",
                                                  "discrete", "let",       "function", "table"};
  return names[kind];
}

static int twice(stf_model *m, const stf_statement *s, const stf_symbol *before, int kind)
{
  const char *name = stf_named(m, s->name);
  const int line = (int)stf_statement_at(m, before->statement)->line;
  if (before->kind == kind)
    return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                        "'%s' is already a %s (line %d); a later line never "
                        "replaces an earlier one",
                        name, kind_name(kind), line);
  return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                      "'%s' is a %s (line %d) and cannot be a %s too; rename one", name,
                      kind_name(before->kind), line, kind_name(kind));
}

static int declare(stf_model *m, int32_t i)
{
  const stf_statement *s = stf_statement_at(m, i);
  const int kind = kind_of(s->kind);
  if (!kind || (s->kind == STF_SAY_STATE && s->primes)) return STEIF_OK;
  const stf_symbol *before = stf_symbol_of(m, s->name);
  if (before) {
    twice(m, s, before, kind);
    return STEIF_OK;
  }
  stf_symbol *new = stf_vector_push(m->ctx, &m->symbols, sizeof *new);
  const char **name = new ? stf_vector_push(m->ctx, &m->names, sizeof *name) : NULL;
  if (!name) return STEIF_NO_MEMORY;
  *name = stf_named(m, s->name);
  *new = (stf_symbol){
    .kind = (uint8_t)kind, .word = s->name, .statement = i, .which = -1, .order = 1};
  *STF_AT(m->symbol_of, int32_t, s->name) = (int32_t)m->symbols.count;
  return STEIF_OK;
}

/* ---- parameters
 * ------------------------------------------------------------------------------
 */

/* A number alone has a register; what follows others is an expression, unless
 * it is given. */
bool stf_literal(const stf_model *m, const stf_statement *s)
{
  for (uint32_t i = s->value.from; i < s->value.to; i++)
    if (STF_AT(m->syntax.codes, stf_code, i)->kind == STF_OP_NAME &&
        STF_AT(m->syntax.codes, stf_code, i)->a != STF_WORD_PI)
      return false;
  return true;
}

static int unknown_parameter(stf_model *m, const char *key)
{
  const char **list = stf_allocate(m->ctx, m->symbols.count + 1, sizeof *list);
  if (!list) return STEIF_NO_MEMORY;
  char all[300] = "";
  size_t count = 0;
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_PARAMETER) continue;
    list[count] = stf_named(m, s->word);
    if (strlen(all) + strlen(list[count]) + 3 < sizeof all)
      strcat(strcat(all, count ? ", " : ""), list[count]);
    count++;
  }
  const char *near = stf_nearest(key, list, count, sizeof *list);
  stf_release(m->ctx, list);
  const char *file = STF_AT(m->syntax.sources.texts, stf_text, 0)->name;
  if (!count)
    return STEIF_FAIL(m->ctx, STEIF_UNKNOWN_NAME, "%s has no parameters, so no '%s'", file,
                      key);
  if (!near)
    return STEIF_FAIL(m->ctx, STEIF_UNKNOWN_NAME, "%s has no parameter '%s'. It has %s", file,
                      key, all);
  return STEIF_FAIL(m->ctx, STEIF_UNKNOWN_NAME,
                    "%s has no parameter '%s'; the nearest is '%s'. It has %s", file, key, near,
                    all);
}

int stf_setting_add(steif_context *ctx, stf_vector *settings, const char *name, double value)
{
  size_t i = 0;
  while (i < settings->count && strcmp(STF_AT(*settings, stf_setting, i)->name, name)) i++;
  stf_setting *s = i < settings->count ? STF_AT(*settings, stf_setting, i)
                                       : stf_vector_push(ctx, settings, sizeof *s);
  if (!s) return STEIF_NO_MEMORY;
  snprintf(s->name, sizeof s->name, "%s", name);
  s->value = value;
  return STEIF_OK;
}

/* A parameter of a spec: the name is there, the value a number. */
static int read_setting(stf_model *m, const char *key, const char *text)
{
  if (!*key) return unknown_parameter(m, text);
  char *end;
  const double value = strtod(text, &end);
  STEIF_CHECK(*text && !*end && isfinite(value), m->ctx, STEIF_BAD_INPUT,
              "parameter %s=%s must be a finite number", key, text);
  return stf_setting_add(m->ctx, &m->settings, key, value);
}

static int give(stf_model *m, const stf_setting *setting)
{
  const int word = stf_word_known(&m->syntax.words, setting->name, strlen(setting->name));
  stf_symbol *s = word < 0 ? NULL : stf_symbol_of(m, word);
  if (!s || s->kind != STF_IS_PARAMETER) return unknown_parameter(m, setting->name);
  STEIF_CHECK(isfinite(setting->value), m->ctx, STEIF_BAD_INPUT,
              "parameter %s=%g must be a finite number", setting->name, setting->value);
  s->value = setting->value;
  s->given = true;
  s->visit = 2;
  return STEIF_OK;
}

/* Within its bounds and whole, as declared. */
static int check_value(stf_model *m, stf_builder *b, const stf_symbol *s)
{
  const stf_statement *said = stf_statement_at(m, s->statement);
  const char *name = stf_named(m, s->word);
  double low, high;
  if (!isfinite(s->value))
    return stf_complain(&m->syntax.sources, said->at, STEIF_NOT_FINITE, "%s = %g is not finite",
                        name, s->value);
  if (said->whole && s->value != floor(s->value))
    return stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                        "%s = %.12g must be a whole number as declared", name, s->value);
  if (said->other.to == said->other.from) return STEIF_OK;
  STEIF_TRY(stf_value(b, &said->other, &low));
  STEIF_TRY(stf_value(b, &said->third, &high));
  if (s->value >= low && s->value <= high) return STEIF_OK;
  return stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                      "%s = %.12g must lie in [%.12g, %.12g]", name, s->value, low, high);
}

static int values(stf_model *m)
{
  stf_formulas g = {.ctx = m->ctx};
  stf_builder b;
  int code = stf_builder_open(&b, m, &g, true);
  for (size_t i = 0; !code && i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    double value;
    if (s->kind != STF_IS_PARAMETER && s->kind != STF_IS_CONST) continue;
    const uint32_t from = (uint32_t)m->syntax.codes.count;
    stf_code *c = stf_vector_push(m->ctx, &m->syntax.codes, sizeof *c);
    if (!c) code = STEIF_NO_MEMORY;
    if (c)
      *c = (stf_code){
        .kind = STF_OP_NAME, .at = stf_statement_at(m, s->statement)->at, .a = s->word};
    if (!code) code = stf_value(&b, &(stf_expression){from, from + 1}, &value);
    m->syntax.codes.count = from;
    if (!code) {
      stf_symbol_at(m, (int32_t)i)->value = value;
      check_value(m, &b, stf_symbol_at(m, (int32_t)i));
    }
    if (code && code != STEIF_NO_MEMORY && m->syntax.sources.errors) code = STEIF_OK;
  }
  stf_builder_close(&b);
  stf_formulas_free(&g);
  if (!code) code = stf_complaints(&m->syntax.sources);
  return code;
}

/* Those that are whole numbers come last. */
static void number_parameters(stf_model *m, bool whole)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_PARAMETER || s->assigned) continue;
    const stf_statement *said = stf_statement_at(m, s->statement);
    if (said->whole != whole || !(s->given || stf_literal(m, said))) continue;
    s->which = m->parameters++;
  }
}

static int registers(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *said = stf_statement_at(m, (int32_t)i);
    stf_symbol *s = said->kind == STF_SAY_ASSIGN ? stf_symbol_of(m, said->name) : NULL;
    if (s && s->kind == STF_IS_PARAMETER) s->assigned = true;
  }
  for (size_t i = 0; i < m->symbols.count; i++) {
    stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind == STF_IS_DISCRETE) s->which = m->discretes++;
    if (s->assigned) s->memory = m->discretes++;
    if (s->kind == STF_IS_TABLE) s->which = m->tables++;
  }
  number_parameters(m, false);
  number_parameters(m, true);
  m->memories = m->discretes;
  m->p = stf_pool_array(m->pool, (size_t)m->parameters, sizeof *m->p);
  if (!m->p) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind == STF_IS_PARAMETER && s->which >= 0) m->p[s->which] = s->value;
  }
  return STEIF_OK;
}

int stf_declare(stf_model *m, const steif_spec *spec)
{
  STEIF_TRY(
    stf_vector_resize(m->ctx, &m->symbol_of, m->syntax.words.names.count, sizeof(int32_t)));
  for (size_t i = 0; i < m->syntax.statements.count; i++) STEIF_TRY(declare(m, (int32_t)i));
  for (int i = 0; spec && i < spec->count; i++)
    STEIF_TRY(read_setting(m, spec->param[i].key, spec->param[i].value));
  for (size_t i = 0; i < m->settings.count; i++)
    STEIF_TRY(give(m, STF_AT(m->settings, stf_setting, i)));
  STEIF_TRY(stf_check_names(m));
  STEIF_TRY(values(m));
  return registers(m);
}

/* ---- unknowns
 * --------------------------------------------------------------------------------
 */

static int size_of(stf_model *m, stf_builder *b, const stf_statement *said, stf_symbol *s)
{
  int64_t size = 1;
  s->dims = said->dimensions;
  for (int d = 0; d < s->dims; d++) {
    const stf_range *r = said->range + d;
    const bool range = r->high.to > r->high.from;
    double low = 1, high = 1;
    STEIF_TRY(stf_value(b, &r->low, &low));
    if (range) STEIF_TRY(stf_value(b, &r->high, &high));
    const double count = range ? high - low + 1 : 0;
    if (high != floor(high) || low != floor(low))
      return stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                          "the size n = %.12g must be a whole number from 1 to 1e7; declare "
                          "'param n = %.0f whole'",
                          high != floor(high) ? high : low,
                          floor(high != floor(high) ? high : low));
    if (!range || !(count >= 1 && count * (double)size <= STF_UNKNOWNS) || fabs(low) > 1e9)
      return stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                          range ? "'%s' would have %.12g elements; from 1 to 1e7 are possible"
                                : "'%s' needs a range such as 1:n for each index",
                          stf_named(m, s->word), count * (double)size);
    s->low[d] = (int32_t)low;
    s->count[d] = (int32_t)count;
    size *= (int64_t)count;
  }
  s->size = (int32_t)size;
  return STEIF_OK;
}

/* How often each state is differentiated. */
static void orders(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.codes.count; i++) {
    const stf_code *c = STF_AT(m->syntax.codes, stf_code, i);
    if (c->kind != STF_OP_NAME && c->kind != STF_OP_ELEMENT) continue;
    stf_symbol *s = stf_symbol_of(m, c->kind == STF_OP_NAME ? c->a : c->b);
    if (!s || s->kind != STF_IS_STATE || !c->primes) continue;
    if (!s->differentiated) s->slope_at = c->at;
    s->differentiated = 1;
    if (c->primes > s->order) s->order = c->primes;
  }
}

static int number_level(stf_model *m, int level)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_STATE || level >= s->order) continue;
    if (s->size > STF_UNKNOWNS - m->n)
      return stf_complain(&m->syntax.sources, stf_statement_at(m, s->statement)->at,
                          STEIF_BAD_INPUT, "more than %d unknowns; make the arrays smaller",
                          STF_UNKNOWNS);
    s->first[level] = m->n;
    m->n += s->size;
  }
  return STEIF_OK;
}

int stf_number_unknowns(stf_model *m)
{
  stf_formulas g = {.ctx = m->ctx};
  stf_builder b;
  orders(m);
  int code = stf_builder_open(&b, m, &g, true);
  for (size_t i = 0; !code && i < m->symbols.count; i++) {
    stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_STATE) continue;
    m->states++;
    const stf_statement *said = stf_statement_at(m, s->statement);
    code = size_of(m, &b, said, s);
    if (!code && s->order > 7)
      code = stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                          "derivatives of order %d of '%s'; 7 is the highest", s->order,
                          stf_named(m, s->word));
  }
  stf_builder_close(&b);
  stf_formulas_free(&g);
  for (int level = 0; !code && level < 7; level++) code = number_level(m, level);
  if (!code && !m->n)
    code = stf_complain(&m->syntax.sources, STF_NOWHERE, STEIF_BAD_INPUT,
                        "no unknowns; declare them as 'state x = ...'");
  const int told = stf_complaints(&m->syntax.sources);
  return told ? told : code;
}
