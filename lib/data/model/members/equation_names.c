/* equation_names.c: equations by what they are in the text: "x' (line 4)", "rod (line 6)".
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <stdio.h>
#include <string.h>

enum { NAMED = 20000, ROOM = 3 * STF_NAME_BYTES };

/* "line 4"; of an included file its name, too. */
static void place(const stf_model *m, const stf_statement *s, size_t room, char *text)
{
  const stf_text *source = stf_text_of(&m->syntax.sources, s->at);
  const bool own = source == m->syntax.sources.texts.data;
  snprintf(text, room, "%.60s%sline %d", own ? "" : source->name, own ? "" : ", ",
           (int)s->line);
}

/* Of the row of an unknown its derivative, else the label, else the line; element number `element` of several. */
static const char *name_of(stf_model *m, const stf_equation *e, int32_t row, int32_t element)
{
  char text[ROOM], line[90], which[30] = "";
  const char *unknown = m->unknown[row];
  const stf_statement *s = e->statement < 0 ? NULL : stf_statement_at(m, e->statement);
  if (s) place(m, s, sizeof line, line);
  if (element) snprintf(which, sizeof which, ", element %d", (int)element);
  if (!s)
    snprintf(text, sizeof text, "velocity of %s", unknown);
  else if (s->name >= 0)
    snprintf(text, sizeof text, "%s (%s%s)", stf_named(m, s->name), line, which);
  else if (e->own)
    snprintf(text, sizeof text, "%s' (%s)", unknown, line);
  else
    snprintf(text, sizeof text, "%s%s", line, which);
  char *to = stf_pool_array(m->pool, strlen(text) + 1, 1);
  return to ? strcpy(to, text) : NULL;
}

static int32_t row_of(const stf_block *block, const stf_equation *e, int64_t pass)
{
  return e->slot ? e->slot[pass] : stf_at_pass(&block->box, pass, e->row, e->stride);
}

/* All rows of an equation; `elements` and `next` by statement: how many there are of it, and how many have names. */
static int name_rows(stf_model *m, const stf_block *block, const stf_equation *e,
                     const int32_t *elements, int32_t *next)
{
  const int64_t count = stf_passes(&block->box);
  for (int64_t pass = 0; pass < count; pass++) {
    const int32_t row = row_of(block, e, pass);
    const bool several = e->statement >= 0 && elements[e->statement] > 1;
    if (!(m->equation[row] = name_of(m, e, row, several ? ++next[e->statement] : 0)))
      return STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

int stf_name_equations(stf_model *m)
{
  if (m->n > NAMED) return STEIF_OK;
  const size_t statements = m->syntax.statements.count;
  int32_t *elements = stf_pool_array(m->pool, 2 * statements + 1, sizeof *elements);
  m->equation = elements ? stf_pool_array(m->pool, (size_t)m->n, sizeof *m->equation) : NULL;
  if (!m->equation) return STEIF_NO_MEMORY;
  for (int naming = 0; naming < 2; naming++)
    for (size_t i = 0; i < m->blocks.count; i++) {
      const stf_block *block = *STF_AT(m->blocks, stf_block *, i);
      for (size_t k = 0; k < block->equations.count; k++) {
        const stf_equation *e = STF_AT(block->equations, stf_equation, k);
        if (naming)
          STEIF_TRY(name_rows(m, block, e, elements, elements + statements));
        else if (e->statement >= 0)
          elements[e->statement] += (int32_t)stf_passes(&block->box);
      }
    }
  for (int32_t i = 0; i < m->n; i++)
    if (!m->equation[i]) m->equation[i] = m->unknown[i];
  return STEIF_OK;
}
