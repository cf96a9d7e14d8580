/* model_facts.c: what a model is, its parameters and outputs.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "reactions.h"
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/model.h>
#include <string.h>

static const stf_model *model_of(const steif_problem *p)
{
  return p && p->destroy == stf_model_close ? p->user : NULL;
}

static long operations(const stf_quantity *q)
{
  int64_t count = 0;
  for (size_t i = 0; i < q->tapes.count; i++)
    count += STF_AT(q->tapes, stf_tape, i)->operations;
  return (long)count;
}

int steif_model_describe(steif_context *ctx, const steif_problem *p, steif_model_facts *facts)
{
  const stf_model *m = model_of(p);
  STEIF_CHECK(m && facts, ctx, STEIF_BAD_INPUT, "problem '%s' was not made from a text",
              p && p->name ? p->name : "NULL");
  *facts = (steif_model_facts){.form = m->form,
                               .why = m->why,
                               .n = m->n,
                               .entries = m->A.entries,
                               .entries_E = m->E.entries,
                               .relations = p->events,
                               .breaks = p->break_count,
                               .operations = operations(&m->f)};
  for (size_t i = 0; i < m->symbols.count; i++)
    facts->parameters += stf_symbol_at(m, (int32_t)i)->kind == STF_IS_PARAMETER;
  for (size_t i = 0; i < m->blocks.count; i++)
    facts->loops += (*STF_AT(m->blocks, stf_block *, i))->box.dims > 0;
  for (size_t i = 0; i < m->syntax.statements.count; i++)
    facts->equations += stf_statement_at(m, (int32_t)i)->kind == STF_SAY_EQUATION;
  return STEIF_OK;
}

const char *steif_model_parameter(const steif_problem *p, size_t which, sunrealtype *value)
{
  const stf_model *m = model_of(p);
  for (size_t i = 0; m && i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_PARAMETER || which--) continue;
    if (value) *value = s->value;
    return stf_named(m, s->word);
  }
  return NULL;
}

/* The first line that assigns it. */
static long assigned_in(const stf_model *m, const stf_symbol *s)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *said = stf_statement_at(m, (int32_t)i);
    if (said->kind == STF_SAY_ASSIGN && said->name == s->word) return (long)said->line;
  }
  return 0;
}

void steif_model_obstacle(const steif_problem *p, const char *name, size_t size, char *room)
{
  const stf_model *m = model_of(p);
  if (!room || !size) return;
  *room = 0;
  for (size_t i = 0; m && name && i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_PARAMETER || strcmp(stf_named(m, s->word), name)) continue;
    const stf_statement *said = stf_statement_at(m, s->statement);
    if (s->assigned)
      snprintf(room, size,
               "is assigned in line %ld and so is no number that solutions have derivatives "
               "by: make it an unknown that events assign, state %s = %s0 with %s' = 0 and "
               "param %s0",
               assigned_in(m, s), name, name, name, name);
    else if (s->which < 0)
      snprintf(room, size, "follows others in line %ld: take those", (long)said->line);
    else if (said->whole)
      snprintf(room, size, "is a whole number: it has no derivatives");
  }
}

int steif_model_data_find(steif_context *ctx, const steif_problem *p, steif_model_data *data)
{
  const stf_model *m = model_of(p);
  STEIF_CHECK(data, ctx, STEIF_BAD_INPUT, "no place for what the model says: it is NULL");
  *data = (steif_model_data){0};
  if (!m) return STEIF_OK;
  const stf_measured *d = &m->measured;
  *data = (steif_model_data){.path = d->path,
                             .columns = d->columns,
                             .column = d->column,
                             .sd = d->sd,
                             .fitted = d->fitted,
                             .log = d->log};
  return STEIF_OK;
}

const char *steif_model_fitted(const steif_problem *p, size_t which)
{
  const stf_model *m = model_of(p);
  return m && which < (size_t)m->measured.fitted ? stf_named(m, m->measured.parameter[which])
                                                 : NULL;
}

int steif_model_attribute(const steif_problem *p, sunindextype i)
{
  const stf_model *m = model_of(p);
  return m && i >= 0 && i < p->n ? (int)stf_kind_of_start(m, (size_t)i) : -1;
}

const char *steif_model_start(const steif_problem *p)
{
  const stf_model *m = model_of(p);
  return m ? m->moved : "";
}

const char *steif_model_turn(const steif_problem *p, int event, int direction)
{
  const stf_model *m = model_of(p);
  return m && event >= 0 && event < p->events ? stf_event_turn(m, event, direction) : NULL;
}

/* Is `name`, x, x' or u[3]', declared by a statement, or the array that it is an element of? */
static bool declares(const stf_model *m, const stf_statement *s, const char *name)
{
  const size_t stem = strcspn(name, "['"), length = strlen(name);
  int32_t primes = 0;
  if (s->kind == STF_SAY_TIME) return !strcmp(name, "t");
  if (s->kind != STF_SAY_STATE && s->kind != STF_SAY_PARAM && s->kind != STF_SAY_OUTPUT &&
      s->kind != STF_SAY_COLUMN)
    return false;
  while (length > stem + (size_t)primes && name[length - 1 - (size_t)primes] == '\'') primes++;
  const char *own = stf_named(m, s->name);
  return primes == s->primes && strlen(own) == stem && !strncmp(own, name, stem);
}

void steif_model_unit(const steif_problem *p, const char *name, size_t room, char *unit)
{
  const stf_model *m = model_of(p);
  if (!unit || !room) return;
  *unit = 0;
  for (size_t i = 0; m && name && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (!s->strlength || !declares(m, s, name)) continue;
    const size_t most = s->strlength < room ? s->strlength : room - 1;
    memcpy(unit, stf_source_at(&m->syntax.sources, s->string), most);
    unit[most] = 0;
    return;
  }
}

const char *steif_model_output(const steif_problem *p, size_t which)
{
  const stf_model *m = model_of(p);
  for (size_t i = 0; m && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind == STF_SAY_OUTPUT && !which--) return stf_named(m, s->name);
  }
  return NULL;
}

int steif_model_outputs(const steif_problem *p, sunrealtype t, N_Vector y, sunrealtype *value)
{
  const stf_model *m = model_of(p);
  if (!m || !y || !value) return STEIF_BAD_INPUT;
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = N_VGetArrayPointer(y);
  memset(value, 0, (size_t)m->output_count * sizeof *value);
  stf_quantity_run(m, &m->outputs, &feed, value);
  return STEIF_OK;
}
