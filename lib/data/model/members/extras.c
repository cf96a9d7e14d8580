/* extras.c: breaks, constraints, invariants and reference values of a model.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "products.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int ascending(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Those inside the interval, once each. */
static int breaks(stf_model *m, steif_problem *p)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_BREAK) continue;
    double value;
    STEIF_TRY(stf_number_of(m, &s->value, &value));
    double *to = stf_vector_push(m->ctx, &m->breaks, sizeof *to);
    if (!to) return STEIF_NO_MEMORY;
    *to = value;
  }
  double *all = m->breaks.data;
  size_t count = 0;
  if (m->breaks.count) qsort(all, m->breaks.count, sizeof *all, ascending);
  for (size_t i = 0; i < m->breaks.count; i++) {
    const bool ahead = all[i] > m->t0 && all[i] < INFINITY;
    if (ahead && (!count || all[i] > all[count - 1])) all[count++] = all[i];
  }
  p->breaks = count ? all : NULL;
  p->break_count = m->break_count = (int)count;
  return STEIF_OK;
}

/* ---- requirements
 * ----------------------------------------------------------------------------
 */

/* x >= 0: 1, x > 0: 2, x <= 0: -1, x < 0: -2 of unknown *i; 0: another
 * requirement. */
static int sign_of(const stf_formulas *g, int32_t node, int32_t *i)
{
  const stf_node *n = stf_node_at(g, node);
  if (n->kind != STF_OP_LESS && n->kind != STF_OP_LESS_EQUAL) return 0;
  const stf_node *a = stf_node_at(g, n->a), *b = stf_node_at(g, n->b);
  const int strict = n->kind == STF_OP_LESS ? 2 : 1;
  *i = a->kind == STF_OP_STATE ? a->a : b->a;
  if (stf_is_number(g, n->a, 0) && b->kind == STF_OP_STATE) return strict;
  return stf_is_number(g, n->b, 0) && a->kind == STF_OP_STATE ? -strict : 0;
}

static bool kept(int sign, double x)
{
  return sign == 1 ? x >= 0 : sign == 2 ? x > 0 : sign == -1 ? x <= 0 : x < 0;
}

static int requirement(stf_model *m, stf_builder *b, int32_t statement)
{
  static const char *const word[] = {"< 0", "<= 0", "", ">= 0", "> 0"};
  const stf_statement *s = stf_statement_at(m, statement);
  int32_t node, i;
  STEIF_TRY(stf_build(b, &s->value, &node));
  const int sign = sign_of(b->g, node, &i);
  if (!sign) return STEIF_OK;
  m->constraint_of[statement] = 1;
  m->constraint[i] = sign;
  m->constrained = true;
  if (m->start[i] != '=' || kept(sign, m->y0[i])) return STEIF_OK;
  return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                      "%s = %.12g at the start contradicts 'require %s %s'", m->unknown[i],
                      m->y0[i], m->unknown[i], word[sign + 2]);
}

int stf_build_constraints(stf_model *m)
{
  stf_builder b;
  stf_formulas g = {.ctx = m->ctx};
  m->constraint = stf_pool_array(m->pool, (size_t)m->n, sizeof *m->constraint);
  m->constraint_of = stf_pool_array(m->pool, m->syntax.statements.count, 1);
  if (!m->constraint || !m->constraint_of) return STEIF_NO_MEMORY;
  int code = stf_builder_open(&b, m, &g, false);
  for (size_t i = 0; !code && i < m->syntax.statements.count; i++)
    if (stf_statement_at(m, (int32_t)i)->kind == STF_SAY_REQUIRE)
      code = requirement(m, &b, (int32_t)i);
  stf_builder_close(&b);
  stf_formulas_free(&g);
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : code;
}

/* ---- invariants
 * ------------------------------------------------------------------------------
 */

static int invariant_values(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const stf_model *m = user;
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = N_VGetArrayPointer(y);
  memset(value, 0, (size_t)m->invariant_count * sizeof *value);
  stf_quantity_run(m, &m->invariants, &feed, value);
  return 0;
}

/* `data "d.csv", x = 2*x`: the output x that it makes has the name of another thing. */
static int clashing_column(stf_model *m, const stf_statement *s, int line, bool measurable)
{
  const char *name = stf_named(m, s->name);
  char itself[2 * STF_NAME_BYTES + 40] = "";
  if (measurable) snprintf(itself, sizeof itself, "write '%s = %s' for that, or ", name, name);
  return stf_complain(
    &m->syntax.sources, s->at, STEIF_BAD_INPUT,
    "'%s' has this name already (line %d), and the column is an output of its own; "
    "%sgive the column another name, in the file too",
    name, line, itself);
}

/* The name of an output or invariant is its own. */
static int check_name(stf_model *m, int32_t statement)
{
  const stf_statement *s = stf_statement_at(m, statement);
  const stf_symbol *symbol = stf_symbol_of(m, s->name);
  int line = symbol ? (int)stf_statement_at(m, symbol->statement)->line : 0;
  for (int32_t i = 0; i < statement && !line; i++) {
    const stf_statement *before = stf_statement_at(m, i);
    if (before->kind == s->kind && before->name == s->name) line = (int)before->line;
  }
  if (!line) return STEIF_OK;
  const bool column = (size_t)statement + 1 < m->syntax.statements.count && s[1].at == s->at &&
                      s[1].kind == STF_SAY_COLUMN;
  if (column) return clashing_column(m, s, line, !symbol || symbol->kind == STF_IS_STATE);
  return stf_complain(
    &m->syntax.sources, s->at, STEIF_BAD_INPUT,
    "'%s' has this name already (line %d); an output or invariant needs one of "
    "its own",
    stf_named(m, s->name), line);
}

/* The values of all statements of a kind, or their derivatives along a direction, as one quantity. */
static int collect(stf_model *m, int kind, bool along, stf_quantity *q, int32_t *count)
{
  stf_block block = {.graph = {.ctx = m->ctx}};
  stf_builder b;
  stf_vector stores = {0};
  int code = stf_builder_open(&b, m, &block.graph, false);
  for (size_t i = 0; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    int32_t node = 0;
    if (s->kind != kind) continue;
    if (s->dimensions)
      code = stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                          "an output or invariant has no index");
    if (!code) code = check_name(m, (int32_t)i);
    if (!code) code = stf_build(&b, &s->value, &node);
    stf_store *to = code ? NULL : stf_vector_push(m->ctx, &stores, sizeof *to);
    if (!code && !to) code = STEIF_NO_MEMORY;
    if (to) *to = (stf_store){.from = node, .a = (*count)++};
  }
  stf_builder_close(&b);
  if (!code && stores.count)
    code = along ? stf_tangents_of(m, &block, &stores, q)
                 : stf_compile_quantity(m, &block, &stores, q);
  stf_vector_free(m->ctx, &stores);
  stf_formulas_free(&block.graph);
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : code;
}

static int invariants(stf_model *m, steif_problem *p)
{
  STEIF_TRY(collect(m, STF_SAY_INVARIANT, false, &m->invariants, &m->invariant_count));
  p->invariants = m->invariant_count;
  p->invariant = m->invariant_count ? invariant_values : NULL;
  return collect(m, STF_SAY_OUTPUT, false, &m->outputs, &m->output_count);
}

int stf_output_slopes(stf_model *m)
{
  int32_t count = 0;
  if (m->output_slopes.tapes.count) return STEIF_OK;
  return collect(m, STF_SAY_OUTPUT, true, &m->output_slopes, &count);
}

/* ---- reference
 * -------------------------------------------------------------------------------
 */

static const char *text_of(stf_model *m, const stf_statement *s)
{
  char *copy = stf_pool_array(m->pool, (size_t)s->strlength + 1, 1);
  return copy ? memcpy(copy, stf_source_at(&m->syntax.sources, s->string), s->strlength) : NULL;
}

/* The values of a reference statement; count of them where value is NULL. */
static int listed(stf_model *m, int32_t statement, double *value, sunindextype *component,
                  sunindextype *count)
{
  stf_builder b;
  stf_formulas g = {.ctx = m->ctx};
  int code = stf_builder_open(&b, m, &g, true);
  *count = 0;
  for (size_t i = (size_t)statement + 1; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent != statement) break;
    int32_t at = 0;
    code = stf_component(m, &b, s, &at);
    if (!code && value) code = stf_value(&b, &s->value, value + *count);
    if (!code && value) component[*count] = at;
    ++*count;
  }
  stf_builder_close(&b);
  stf_formulas_free(&g);
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : code;
}

/* Is a parameter given that has another value in the file? */
static int other_parameters(stf_model *m, bool *other)
{
  *other = false;
  for (size_t i = 0; i < m->settings.count && !*other; i++) {
    const stf_setting *given = STF_AT(m->settings, stf_setting, i);
    const int word = stf_word_known(&m->syntax.words, given->name, strlen(given->name));
    const stf_symbol *s = word < 0 ? NULL : stf_symbol_of(m, word);
    double own = given->value;
    if (s) STEIF_TRY(stf_number_of(m, &stf_statement_at(m, s->statement)->value, &own));
    *other = own != given->value;
  }
  return STEIF_OK;
}

/* Numbers are those of the parameters that the file has; formulas may follow others. */
static bool has_numbers(const stf_model *m, int32_t statement)
{
  for (size_t i = (size_t)statement + 1; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->parent != statement) break;
    if (stf_literal(m, s)) return true;
  }
  return false;
}

static int reference(stf_model *m, steif_problem *p)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    double digits = 0;
    bool other;
    if (s->kind != STF_SAY_REFERENCE) continue;
    STEIF_TRY(other_parameters(m, &other));
    if (other && has_numbers(m, (int32_t)i)) return STEIF_OK;
    steif_reference *r = &m->reference;
    STEIF_TRY(stf_number_of(m, &s->value, &r->t));
    if (s->other.to > s->other.from) STEIF_TRY(stf_number_of(m, &s->other, &digits));
    STEIF_TRY(listed(m, (int32_t)i, NULL, NULL, &r->count));
    double *value = stf_pool_array(m->pool, (size_t)r->count, sizeof *value);
    sunindextype *component = stf_pool_array(m->pool, (size_t)r->count, sizeof *component);
    if (!value || !component) return STEIF_NO_MEMORY;
    STEIF_TRY(listed(m, (int32_t)i, value, component, &r->count));
    r->value = value;
    r->component = component;
    r->digits = digits >= 0 && digits <= 17 ? (int)digits : 0;
    r->source = s->strlength ? text_of(m, s) : "the file of the model";
    p->reference = r;
    return r->source ? STEIF_OK : STEIF_NO_MEMORY;
  }
  return STEIF_OK;
}

int stf_finish(stf_model *m, steif_problem *p)
{
  STEIF_TRY(breaks(m, p));
  STEIF_TRY(invariants(m, p));
  p->constraint = m->constrained ? m->constraint : NULL;
  STEIF_TRY(stf_find_measured(m));
  return reference(m, p);
}
