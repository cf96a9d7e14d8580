/* given_parameters.c: the parameters of a model as those of its problem, with exact derivatives.
 *
 * Start values that the text fixes are expressions in p. Those that are computed, so that the equations
 * are fulfilled, are differentiated by differences of the whole computation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "products.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <string.h>

/* What is not finite is handed on: it is told with the parameter by whoever needs it. */
static int by_parameter(sunrealtype t, N_Vector y, N_Vector yp, int k, N_Vector out, void *user)
{
  stf_model *m = user;
  if (stf_products_ready(m)) return -1;
  double *q = m->products->direction;
  memset(q, 0, (size_t)m->parameters * sizeof *q);
  q[k] = 1;
  const bool before = stf_silence(m->ctx, true);
  const int code = stf_tangent(m, t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), NULL, NULL,
                               q, N_VGetArrayPointer(out));
  stf_silence(m->ctx, before);
  return code == STEIF_RETRY ? 0 : code;
}

static int transposed(sunrealtype t, N_Vector y, N_Vector yp, N_Vector w, sunrealtype *out,
                      void *user)
{
  stf_model *m = user;
  const int code =
    stf_adjoint(m, t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), N_VGetArrayPointer(w));
  if (code) return code;
  for (int k = 0; k < m->given.count; k++) out[k] += m->products->gradient[2 * m->n + k];
  return 0;
}

/* ---- start values ----------------------------------------------------------------------------- */

static int one(stf_model *m, stf_builder *b, const stf_expression *e, int k, double *to)
{
  int32_t node;
  STEIF_TRY(stf_build(b, e, &node));
  STEIF_TRY(stf_formulas_differentiate(b->g, node, STF_OP_PARAMETER, &m->sweep, &m->partials));
  for (size_t i = 0; i < m->partials.count; i++) {
    const stf_partial p = *STF_AT(m->partials, stf_partial, i);
    if (stf_node_at(b->g, p.leaf)->a == k) return stf_fixed_value(m, b->g, p.value, to);
  }
  return STEIF_OK;
}

static int of_statement(stf_model *m, stf_builder *b, const stf_statement *said, int k,
                        double *S0)
{
  const stf_symbol *s = stf_symbol_of(m, said->name);
  if (!said->start || (said->primes >= s->order && said->primes)) return STEIF_OK;
  for (int32_t i = 0; i < s->size; i++) {
    b->bindings.count = 0;
    STEIF_TRY(stf_bind_element(b, said, s, i));
    STEIF_TRY(one(m, b, &said->value, k, S0 + s->first[said->primes] + i));
  }
  b->bindings.count = 0;
  return STEIF_OK;
}

static int of_text(stf_model *m, int k, double *S0)
{
  stf_formulas g = {.ctx = m->ctx};
  stf_builder b;
  int code = stf_builder_open(&b, m, &g, false);
  for (size_t i = 0; !code && i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind == STF_SAY_STATE) code = of_statement(m, &b, s, k, S0);
  }
  stf_builder_close(&b);
  stf_formulas_free(&g);
  return code;
}

/* Components that the text leaves open. */
static bool computed(const stf_model *m)
{
  bool any = false;
  for (int32_t i = 0; i < m->n; i++) any = any || m->start[i] != '=';
  return any && m->form != STEIF_ODE;
}

static int by_differences(const stf_model *m, int k, double *S0)
{
  const double p = m->p[k], d = cbrt(STF_EPS) * (p != 0 ? fabs(p) : 1);
  const volatile double side[2] = {p + d, p - d};
  for (int i = 0; i < 2; i++) {
    steif_problem moved;
    STEIF_TRY(stf_model_moved(m, m->parameter_name[k], side[i], &moved));
    for (int32_t j = 0; j < m->n; j++)
      if (m->start[j] != '=') S0[j] += (i ? -1 : 1) * moved.y0[j] / (side[0] - side[1]);
    stf_model_close(m->ctx, &moved);
  }
  return STEIF_OK;
}

static int start(int k, N_Vector S0, void *user)
{
  stf_model *m = user;
  double *to = N_VGetArrayPointer(S0);
  memset(to, 0, (size_t)m->n * sizeof *to);
  int code = of_text(m, k, to);
  if (!code && computed(m)) {
    for (int32_t j = 0; j < m->n; j++)
      if (m->start[j] != '=') to[j] = 0;
    code = by_differences(m, k, to);
  }
  return code < 0 ? -1 : code;
}

/* ---- the list --------------------------------------------------------------------------------- */

static int tell_varying(stf_model *m)
{
  static const char form[] =
    "the discrete value '%s' depends on unknowns, the time or parameters, and would have "
    "derivatives of its own: make it an unknown u with u' = 0, which events may assign too";
  const size_t room = sizeof form + strlen(m->varying);
  char *sentence = stf_pool_array(m->pool, room, 1);
  if (!sentence) return STEIF_NO_MEMORY;
  snprintf(sentence, room, form, m->varying);
  m->given.obstacle = sentence;
  return STEIF_OK;
}

int stf_parameter_members(stf_model *m, steif_problem *problem)
{
  m->parameter_name = stf_pool_array(m->pool, (size_t)m->parameters, sizeof *m->parameter_name);
  if (!m->parameter_name) return STEIF_NO_MEMORY;
  m->given = (steif_parameters){.value = m->p,
                                .name = m->parameter_name,
                                .dFdp = by_parameter,
                                .start = start,
                                .dFdp_transposed = transposed,
                                .break_slope = stf_model_break_slope,
                                .moved = stf_model_follow};
  for (size_t i = 0; i < m->symbols.count; i++) {
    const stf_symbol *s = stf_symbol_at(m, (int32_t)i);
    if (s->kind != STF_IS_PARAMETER || s->which < 0) continue;
    m->parameter_name[s->which] = stf_named(m, s->word);
    m->given.count += !stf_statement_at(m, s->statement)->whole;
  }
  if (m->varying) STEIF_TRY(tell_varying(m));
  problem->parameters = m->given.count ? &m->given : NULL;
  return STEIF_OK;
}
