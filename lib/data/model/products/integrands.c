/* integrands.c: expressions that a model integrates beside its unknowns. Their relations are kept between events, as
 * those of equations are, so that runs end their steps where an integrand has a kink or a jump.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "integrands.h"
#include "model_file.h"
#include "pencil.h"
#include "products.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <steif/model.h>
#include <string.h>

struct stf_integrands {
  stf_quantity values, adjoint; /* count; by y, y' and p with weights */
  double *weight, *gradient;
};

/* ---- making ------------------------------------------------------------------------------------ */

int stf_integrands_mark(stf_model *m, int count)
{
  m->integrand_count = count;
  for (size_t i = m->syntax.statements.count; count > 0 && i-- > 0;) {
    stf_statement *s = STF_AT(m->syntax.statements, stf_statement, i);
    if (s->kind != STF_SAY_OUTPUT) continue;
    s->kind = STF_SAY_INTEGRAND;
    count--;
  }
  return count ? STEIF_FAIL(m->ctx, STEIF_BAD_INPUT, "an integrand is one expression")
               : STEIF_OK;
}

int stf_integrands_build(stf_model *m)
{
  stf_builder b;
  int32_t row = 0;
  if (!m->integrand_count) return STEIF_OK;
  int code = stf_builder_open(&b, m, &m->event_block->graph, false);
  b.block = m->event_block, b.events = true;
  for (size_t i = 0; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_INTEGRAND) continue;
    stf_equation *e = stf_vector_push(m->ctx, &m->event_block->equations, sizeof *e);
    int32_t node = 0;
    code = e ? stf_build(&b, &s->value, &node) : STEIF_NO_MEMORY;
    if (e) *e = (stf_equation){.statement = (int32_t)i, .residual = node, .value = -1};
    if (e) e->row = row++;
    if (!code && (stf_node_at(b.g, node)->on & STF_ON_SLOPE))
      stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                   "an integrand is of t, unknowns and parameters, without slopes: write what "
                   "the equations say of them");
  }
  stf_builder_close(&b);
  return m->syntax.sources.errors ? stf_complaints(&m->syntax.sources) : code;
}

static int compile_values(stf_model *m, stf_quantity *q)
{
  stf_vector stores = {0};
  int code = STEIF_OK;
  for (size_t k = 0; !code && k < m->event_block->equations.count; k++) {
    const stf_equation *e = STF_AT(m->event_block->equations, stf_equation, k);
    stf_store *to = stf_vector_push(m->ctx, &stores, sizeof *to);
    if (to) *to = (stf_store){.from = e->residual, .a = e->row};
    if (!to) code = STEIF_NO_MEMORY;
  }
  if (!code) code = stf_compile_quantity(m, m->event_block, &stores, q);
  stf_vector_free(m->ctx, &stores);
  return code;
}

static size_t lengths(const stf_model *m) { return 2 * (size_t)m->n + (size_t)m->parameters; }

int stf_integrands_compile(stf_model *m)
{
  int64_t rows = m->integrand_count;
  if (!m->integrand_count) return STEIF_OK;
  stf_integrands *g = m->integrands = stf_pool_array(m->pool, 1, sizeof *g);
  if (!g) return STEIF_NO_MEMORY;
  g->weight = stf_pool_array(m->pool, (size_t)rows, sizeof *g->weight);
  g->gradient = stf_pool_array(m->pool, lengths(m), sizeof *g->gradient);
  if (!g->weight || !g->gradient) return STEIF_NO_MEMORY;
  STEIF_TRY(compile_values(m, &g->values));
  STEIF_TRY(stf_quantity_close(m, &g->values, rows));
  STEIF_TRY(stf_adjoint_tape(m, m->event_block, &rows, &g->adjoint));
  return stf_quantity_close(m, &g->adjoint, (int64_t)lengths(m));
}

void stf_integrands_follow(const stf_model *m)
{
  if (!m->integrands) return;
  stf_quantity_prepare(m, &m->integrands->values);
  stf_quantity_prepare(m, &m->integrands->adjoint);
}

void stf_integrands_free(stf_model *m)
{
  if (m->event_block) stf_vector_free(m->ctx, &m->event_block->equations);
  if (!m->integrands) return;
  stf_quantity_free(m, &m->integrands->values);
  stf_quantity_free(m, &m->integrands->adjoint);
}

/* ---- values and slopes --------------------------------------------------------------------------- */

/* A frozen branch without a value is taken literally, as that of f is. */
static int evaluate(const stf_model *m, const stf_quantity *q, double t, N_Vector y,
                    size_t count, double *out)
{
  stf_feed feed = m->feed;
  feed.t = t, feed.y = N_VGetArrayPointer(y);
  feed.along[3] = m->integrands->weight;
  stf_quantity_run(m, q, &feed, out);
  if (!m->switches || stf_all_finite(out, count)) return 0;
  stf_take_literally(m, &feed);
  stf_quantity_run(m, q, &feed, out);
  return 0;
}

int steif_model_integrand_values(sunrealtype t, N_Vector y, sunrealtype *value, void *user)
{
  const stf_model *m = user;
  if (!m->integrands) return -1;
  return evaluate(m, &m->integrands->values, t, y, (size_t)m->integrand_count, value);
}

/* gradient := derivatives of integrand i. */
static int differentiate(const stf_model *m, double t, N_Vector y, int i)
{
  const stf_integrands *g = m->integrands;
  memset(g->weight, 0, (size_t)m->integrand_count * sizeof *g->weight);
  g->weight[i] = 1;
  return evaluate(m, &g->adjoint, t, y, lengths(m), g->gradient);
}

int steif_model_integrand_along(sunrealtype t, N_Vector y, N_Vector dy, int k, sunrealtype *out,
                                void *user)
{
  const stf_model *m = user;
  if (!m->integrands) return -1;
  const double *by = m->integrands->gradient, *v = N_VGetArrayPointer(dy);
  for (int i = 0; i < m->integrand_count; i++) {
    if (differentiate(m, t, y, i)) return -1;
    out[i] = by[2 * m->n + k];
    for (int32_t j = 0; j < m->n; j++) out[i] += by[j] * v[j];
  }
  return 0;
}

int steif_model_integrand_slopes(const steif_problem *p, sunrealtype t, N_Vector y, int i,
                                 N_Vector dy, sunrealtype *dp)
{
  const stf_model *m = p && stf_model_is(p) ? p->user : NULL;
  if (!m || !y || !dy || i < 0 || i >= m->integrand_count) return STEIF_BAD_INPUT;
  if (differentiate(m, t, y, i)) return STEIF_CALLBACK;
  const double *by = m->integrands->gradient;
  memcpy(N_VGetArrayPointer(dy), by, (size_t)m->n * sizeof *by);
  if (dp) memcpy(dp, by + 2 * m->n, (size_t)m->given.count * sizeof *by);
  return STEIF_OK;
}

/* ---- the model with them ------------------------------------------------------------------------- */

int steif_model_integrands(steif_context *ctx, const steif_problem *p, int count,
                           const char *const *expression, steif_problem *out)
{
  STEIF_CHECK(p && stf_model_is(p) && count > 0 && expression && out, ctx, STEIF_BAD_INPUT,
              "a problem made from a text, expressions and a place for the new problem are "
              "needed");
  const char *text = stf_model_text(p);
  size_t room = strlen(text) + 2;
  for (int i = 0; i < count; i++) room += strlen(expression[i]) + 40;
  char *longer = stf_allocate(ctx, room, 1);
  if (!longer) return STEIF_NO_MEMORY;
  size_t at = (size_t)snprintf(longer, room, "%s\n", text);
  for (int i = 0; i < count; i++)
    at += (size_t)snprintf(longer + at, room - at, "output integrand__%d = %s\n", i + 1,
                           expression[i]);
  const int code = stf_model_rewrite(ctx, p, longer, count, out);
  stf_release(ctx, longer);
  return code;
}
