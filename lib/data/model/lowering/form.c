/* form.c: which row each equation takes, and the simplest form that all
 * equations fit. SPDX-License-Identifier: BSD-3-Clause */
#include "model.h"
#include <math.h>
#include <string.h>

int stf_fixed_value(stf_model *m, const stf_formulas *g, int32_t node, double *value)
{
  STEIF_TRY(stf_reach(g, node, &m->sweep.mark, &m->sweep.list));
  stf_vector x = {0};
  STEIF_TRY(stf_vector_resize(m->ctx, &x, g->nodes.count, sizeof(double)));
  double *v = x.data;
  for (size_t i = 0; i < m->sweep.list.count; i++) {
    int32_t c[3];
    const int32_t k = *STF_AT(m->sweep.list, int32_t, i);
    const stf_node *n = stf_node_at(g, k);
    const int count = stf_children(n, c);
    v[k] = n->kind == STF_OP_NUMBER ? n->number
           : n->kind == STF_OP_PARAMETER
             ? m->p[n->a]
             : stf_operate(n->kind, count > 0 ? v[c[0]] : 0, count > 1 ? v[c[1]] : 0,
                           count > 2 ? v[c[2]] : 0);
  }
  *value = v[node];
  stf_vector_free(m->ctx, &x);
  return STEIF_OK;
}

/* ---- passes and rows
 * ------------------------------------------------------------------------- */

/* "x", "u[3]" or "x'" of unknown i. */
static const char *unknown(const stf_model *m, int32_t i) { return m->unknown[i]; }

static int32_t line_of(const stf_model *m, const stf_equation *e)
{
  return e->statement < 0 ? 0 : (int32_t)stf_statement_at(m, e->statement)->line;
}

/* All rows of an explicit equation; taken_by: line that took a row. */
static int take(stf_model *m, const stf_block *block, const stf_equation *e, int32_t *taken_by)
{
  const int64_t count = stf_passes(&block->box);
  for (int64_t k = 0; k < count; k++) {
    const int32_t row = stf_at_pass(&block->box, k, e->row, e->stride);
    if (taken_by[row])
      return stf_complain(&m->syntax.sources, stf_statement_at(m, e->statement)->at,
                          STEIF_BAD_INPUT,
                          "the derivative of '%s' is given twice (first in line %d)",
                          unknown(m, row), (int)taken_by[row]);
    taken_by[row] = e->statement < 0 ? -1 : line_of(m, e);
  }
  return STEIF_OK;
}

static bool all_free(const stf_block *block, int32_t a, const int32_t *stride,
                     const int32_t *taken_by)
{
  const int64_t count = stf_passes(&block->box);
  for (int64_t k = 0; k < count; k++)
    if (taken_by[stf_at_pass(&block->box, k, a, stride)]) return false;
  return true;
}

/* ---- equations that are not written x' = f
 * ---------------------------------------------------- */

static int why_not(stf_model *m, int form, const char *why)
{
  if (form > m->form) {
    m->form = form;
    m->why = why;
  }
  return STEIF_OK;
}

/* c(p) x' = ... with c not 0 now: the row of x, and its value. */
static int divide(stf_model *m, stf_block *block, stf_equation *e, int32_t *taken_by,
                  int32_t rest)
{
  const stf_partial p = *STF_AT(m->partials, stf_partial, 0);
  const stf_node leaf = *stf_node_at(&block->graph, p.leaf);
  const int32_t stride[STF_LOOPS] = {leaf.b, leaf.stride[0], leaf.stride[1]};
  double value;
  STEIF_TRY(stf_fixed_value(m, &block->graph, p.value, &value));
  if (value == 0) return why_not(m, STEIF_MASS, "a coefficient of a derivative is 0");
  if (!all_free(block, leaf.a, stride, taken_by))
    return why_not(m, STEIF_MASS, "a derivative occurs in two equations");
  e->own = true;
  e->row = leaf.a;
  memcpy(e->stride, stride, sizeof stride);
  const int32_t minus = stf_apply1(&block->graph, STF_OP_NEGATIVE, rest);
  e->value = minus < 0 ? -1 : stf_apply2(&block->graph, STF_OP_DIVIDE, minus, p.value);
  return e->value < 0 ? STEIF_NO_MEMORY : take(m, block, e, taken_by);
}

static int classify(stf_model *m, stf_block *block, stf_equation *e, int32_t *taken_by)
{
  stf_formulas *g = &block->graph;
  STEIF_TRY(stf_formulas_differentiate(g, e->residual, STF_OP_SLOPE, &m->sweep, &m->partials));
  for (size_t i = 0; i < m->partials.count; i++) {
    const int on = stf_node_at(g, STF_AT(m->partials, stf_partial, i)->value)->on;
    if (on & STF_ON_SLOPE)
      return why_not(m, STEIF_IMPLICIT, "an equation is not linear in the derivatives");
    if (on & ~STF_ON_PARAMETER)
      return why_not(m, STEIF_IMPLICIT,
                     "a coefficient of a derivative depends on unknowns or on time");
  }
  if (m->partials.count == 0) return why_not(m, STEIF_MASS, "an equation has no derivative");
  if (m->partials.count > 1)
    return why_not(m, STEIF_MASS, "an equation has several derivatives");
  const stf_partial p = *STF_AT(m->partials, stf_partial, 0);
  const int32_t rest = stf_without(g, e->residual, STF_OP_SLOPE, &m->sweep);
  if (rest < 0) return STEIF_NO_MEMORY;
  *STF_AT(m->partials, stf_partial, 0) = p;
  return divide(m, block, e, taken_by, rest);
}

/* The rows that are left, in the order of the file. */
static int others(stf_model *m, int32_t *taken_by)
{
  int32_t next = 0;
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    const int64_t count = stf_passes(&block->box);
    for (size_t k = 0; k < block->equations.count; k++) {
      stf_equation *e = STF_AT(block->equations, stf_equation, k);
      if (e->own) continue;
      e->slot = stf_pool_array(m->pool, (size_t)count, sizeof *e->slot);
      if (!e->slot) return STEIF_NO_MEMORY;
      for (int64_t pass = 0; pass < count; pass++) {
        while (next < m->n && taken_by[next]) next++;
        e->slot[pass] = next++;
      }
    }
  }
  return STEIF_OK;
}

static int each(stf_model *m, int32_t *taken_by, bool explicit)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    for (size_t k = 0; k < block->equations.count; k++) {
      stf_equation *e = STF_AT(block->equations, stf_equation, k);
      if (explicit && e->own) STEIF_TRY(take(m, block, e, taken_by));
      if (!explicit && !e->own) STEIF_TRY(classify(m, block, e, taken_by));
    }
  }
  return STEIF_OK;
}

/* A form that the text asks for: a more general one is taken, a simpler one cannot be. */
static int wished(stf_model *m)
{
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_FORM) continue;
    m->wished = s->whole;
    if (m->wished == STEIF_DESCRIPTOR && m->form != STEIF_IMPLICIT) return STEIF_OK;
    if (m->wished < m->form || m->wished == STEIF_DESCRIPTOR)
      return stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                          "the form is %s: %s; leave this line out", steif_form_name(m->form),
                          m->why);
    m->form = m->wished;
    m->why = "the text asks for this form";
  }
  return STEIF_OK;
}

int stf_deduce_form(stf_model *m)
{
  int32_t *taken_by = stf_allocate(m->ctx, (size_t)m->n, sizeof *taken_by);
  if (!taken_by) return STEIF_NO_MEMORY;
  m->form = STEIF_ODE;
  m->why = "every equation is solved for a derivative of its own";
  int code = each(m, taken_by, true);
  if (!code) code = stf_count_equations(m, taken_by);
  if (!code && m->syntax.sources.errors) code = STEIF_BAD_INPUT;
  if (!code) code = each(m, taken_by, false);
  if (!code) code = others(m, taken_by);
  if (!code) code = wished(m);
  stf_release(m->ctx, taken_by);
  const int told = stf_complaints(&m->syntax.sources);
  return told ? told : code;
}
