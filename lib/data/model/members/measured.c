/* measured.c: what a model says of measurements, `data "FILE.csv", column = expression sd s` and `fit k1, k2 log`.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <string.h>

static int said(const stf_model *m, int kind)
{
  int count = 0;
  for (size_t i = 0; i < m->syntax.statements.count; i++)
    count += stf_statement_at(m, (int32_t)i)->kind == kind;
  return count;
}

static int complain(stf_model *m, const stf_statement *s, const char *what)
{
  return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT, "%s", what);
}

static int column(stf_model *m, const stf_statement *s)
{
  stf_measured *d = &m->measured;
  double *sd = d->sd + d->columns;
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  const bool itself = s->value.to == s->value.from + 1; /* else it was refused as an output */
  if (symbol && symbol->kind != STF_IS_STATE && itself)
    return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                        "'%s' (line %d) is no state and no output, which columns of data are; "
                        "write '%s_data = %s' and name the column so in the file",
                        stf_named(m, s->name),
                        (int)stf_statement_at(m, symbol->statement)->line,
                        stf_named(m, s->name), stf_named(m, s->name));
  d->column[d->columns++] = stf_named(m, s->name);
  if (s->other.to == s->other.from) return STEIF_OK;
  STEIF_TRY(stf_number_of(m, &s->other, sd));
  return *sd > 0 && isfinite(*sd)
           ? STEIF_OK
           : complain(m, s, "a standard deviation must be a positive number");
}

static int file(stf_model *m, const stf_statement *s)
{
  stf_sources *sources = &m->syntax.sources;
  if (m->measured.path)
    return complain(m, s, "a model has one 'data' statement; name one file");
  return stf_source_path(sources, m->pool, s->string - 1, stf_source_at(sources, s->string),
                         s->strlength, &m->measured.path);
}

/* Parameters that are whole numbers change sizes and are no unknowns of a fit. */
static int fitted(stf_model *m, const stf_statement *s)
{
  stf_measured *d = &m->measured;
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  if (!symbol || symbol->kind != STF_IS_PARAMETER ||
      stf_statement_at(m, symbol->statement)->whole)
    return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                        "'%s' is no parameter that can be fitted; declare it: param %s = ...",
                        stf_named(m, s->name), stf_named(m, s->name));
  if (d->fitted && d->log != (s->whole != 0))
    return complain(m, s,
                    "'log' stands after all parameters of 'fit' or after none: logarithms "
                    "are fitted of all or of none");
  d->log = s->whole != 0;
  d->parameter[d->fitted++] = s->name;
  return STEIF_OK;
}

int stf_find_measured(stf_model *m)
{
  const size_t columns = (size_t)said(m, STF_SAY_COLUMN), names = (size_t)said(m, STF_SAY_FIT);
  stf_measured *d = &m->measured;
  *d = (stf_measured){0};
  d->column = stf_pool_array(m->pool, columns + 1, sizeof *d->column);
  d->sd = stf_pool_array(m->pool, columns + 1, sizeof *d->sd);
  d->parameter = stf_pool_array(m->pool, names + 1, sizeof *d->parameter);
  if (!d->column || !d->sd || !d->parameter) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    int code = STEIF_OK;
    if (s->kind == STF_SAY_DATA) code = file(m, s);
    if (s->kind == STF_SAY_COLUMN) code = column(m, s);
    if (s->kind == STF_SAY_FIT) code = fitted(m, s);
    if (code == STEIF_NO_MEMORY) return code;
  }
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : STEIF_OK;
}
