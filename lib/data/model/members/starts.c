/* starts.c: names of unknowns and equations, and start values.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *keep(stf_model *m, const char *text)
{
  char *copy = stf_pool_array(m->pool, strlen(text) + 1, 1);
  return copy ? strcpy(copy, text) : NULL;
}

/* "u[2,3]''" */
static const char *element_name(stf_model *m, const stf_symbol *s, int32_t k, int primes)
{
  char text[2 * STF_NAME_BYTES], index[80] = "";
  int32_t at[STF_DIMENSIONS];
  for (int d = s->dims; d--; k /= s->count[d]) at[d] = s->low[d] + k % s->count[d];
  for (int d = 0; d < s->dims; d++)
    snprintf(index + strlen(index), sizeof index - strlen(index), "%s%d", d ? "," : "[",
             (int)at[d]);
  snprintf(text, sizeof text, "%s%s%s%.*s", stf_named(m, s->word), index, s->dims ? "]" : "",
           primes, "''''''''");
  return keep(m, text);
}

int stf_name_unknowns(stf_model *m)
{
  m->unknown = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->unknown);
  m->start = stf_pool_array(m->pool, (size_t)m->n, 1);
  m->y0 = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->y0);
  m->owner = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->owner);
  if (!m->unknown || !m->start || !m->y0 || !m->owner) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    for (int level = 0; s->kind == STF_IS_STATE && level < s->order; level++)
      for (int32_t k = 0; k < s->size; k++) {
        const int32_t at = s->first[level] + k;
        m->owner[at] = (int32_t)i;
        if (!(m->unknown[at] = element_name(m, s, k, level))) return STEIF_NO_MEMORY;
      }
  }
  return STEIF_OK;
}

int stf_bind_element(stf_builder *b, const stf_statement *said, const stf_symbol *s, int32_t k)
{
  for (int d = s->dims; d--; k /= s->count[d])
    if (said->range[d].name >= 0)
      STEIF_TRY(stf_bind_index(b, said->range[d].name,
                               &(stf_affine){.c = s->low[d] + k % s->count[d]}));
  return STEIF_OK;
}

/* A slope of the highest order is no unknown, but where its search begins. */
static int slope(stf_model *m, stf_builder *b, const stf_statement *said)
{
  const stf_symbol *s = stf_symbol_of(m, said->name);
  if (said->primes > s->order || !said->start) return STEIF_OK;
  if (!m->slope && !(m->slope = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->slope)))
    return STEIF_NO_MEMORY;
  for (int32_t k = 0; k < s->size; k++) {
    sunrealtype *at = m->slope + s->first[s->order - 1] + k;
    b->bindings.count = 0;
    STEIF_TRY(stf_bind_element(b, said, s, k));
    STEIF_TRY(stf_value(b, &said->value, at));
    if (!isfinite(*at))
      return stf_complain(&m->syntax.sources, said->at, STEIF_NOT_FINITE,
                          "the slope of '%s' at the start is %g",
                          m->unknown[s->first[s->order - 1] + k], *at);
  }
  b->bindings.count = 0;
  return STEIF_OK;
}

/* Start values of one statement; those of order `primes` where that is an
 * unknown. */
static int start(stf_model *m, stf_builder *b, const stf_statement *said)
{
  const stf_symbol *s = stf_symbol_of(m, said->name);
  if (said->primes >= s->order && said->primes) return slope(m, b, said);
  for (int32_t k = 0; k < s->size; k++) {
    const int32_t at = s->first[said->primes] + k;
    if (m->start[at] && said->primes)
      return stf_complain(&m->syntax.sources, said->at, STEIF_BAD_INPUT,
                          "the start of '%s' is given twice", m->unknown[at]);
    m->start[at] = said->start;
    if (!said->start) continue;
    b->bindings.count = 0;
    STEIF_TRY(stf_bind_element(b, said, s, k));
    STEIF_TRY(stf_value(b, &said->value, m->y0 + at));
    if (!isfinite(m->y0[at]))
      return stf_complain(&m->syntax.sources, said->at, STEIF_NOT_FINITE,
                          "the start value of '%s' is %g", m->unknown[at], m->y0[at]);
  }
  b->bindings.count = 0;
  return STEIF_OK;
}

/* A state whose derivative occurs needs a start. */
static void missing(stf_model *m)
{
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_STATE || !s->differentiated) continue;
    for (int level = 0; level < s->order; level++)
      if (!m->start[s->first[level]]) {
        const char *name = m->unknown[s->first[level]];
        stf_complain(
          &m->syntax.sources, stf_statement_at(m, s->statement)->at, STEIF_BAD_INPUT,
          "'%s' needs a start value since its derivative occurs (line %d); write 'state %s "
          "= ...', or '~' for a guess. Only states without derivative may leave it out",
          name, stf_line_of(&m->syntax.sources, s->slope_at), name);
        break;
      }
  }
}

int stf_build_start(stf_model *m)
{
  stf_formulas g = {.ctx = m->ctx};
  stf_builder b;
  int code = stf_builder_open(&b, m, &g, true);
  for (size_t i = 0; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind == STF_SAY_STATE) code = start(m, &b, s);
  }
  stf_builder_close(&b);
  stf_formulas_free(&g);
  if (!code) missing(m);
  const int told = stf_complaints(&m->syntax.sources);
  return told ? told : code;
}
