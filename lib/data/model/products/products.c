/* products.c: products with the derivatives of a model, and the functions of steif/model.h for them.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "pencil.h"
#include "products.h"
#include "model_file.h"
#include <math.h>
#include <nvector/nvector_serial.h>
#include <steif/model.h>
#include <string.h>

static stf_block *block_at(const stf_model *m, size_t i)
{
  return *STF_AT(m->blocks, stf_block *, i);
}

int32_t stf_residual_node(const stf_model *m, stf_block *block, const stf_equation *e)
{
  if (m->form == STEIF_IMPLICIT || !e->own) return e->residual;
  const int32_t slope = stf_leaf(&block->graph, STF_OP_SLOPE, e->row, e->stride);
  return slope < 0 ? -1 : stf_apply2(&block->graph, STF_OP_SUBTRACT, slope, e->value);
}

int stf_products_open(stf_model *m)
{
  m->products = stf_pool_array(m->pool, 1, sizeof *m->products);
  return m->products ? STEIF_OK : STEIF_NO_MEMORY;
}

void stf_products_free(stf_model *m)
{
  if (!m->products) return;
  stf_quantity_free(m, &m->products->tangent);
  stf_quantity_free(m, &m->products->adjoint);
}

static size_t lengths(const stf_model *m) { return 2 * (size_t)m->n + (size_t)m->parameters; }

int stf_products_ready(stf_model *m)
{
  stf_products *s = m->products;
  if (s->tangent_made) return STEIF_OK;
  stf_quantity_free(m, &s->tangent);
  if (!s->none) s->none = stf_pool_array(m->pool, lengths(m), sizeof *s->none);
  if (!s->direction)
    s->direction = stf_pool_array(m->pool, (size_t)m->parameters, sizeof *s->direction);
  if (!s->none || !s->direction) return STEIF_NO_MEMORY;
  for (size_t i = 0; i < m->blocks.count; i++)
    STEIF_TRY(stf_tangent_tape(m, block_at(m, i), &s->tangent));
  STEIF_TRY(stf_quantity_close(m, &s->tangent, m->n));
  s->tangent_made = true;
  return STEIF_OK;
}

static int adjoint_ready(stf_model *m)
{
  stf_products *s = m->products;
  if (s->adjoint_made) return STEIF_OK;
  stf_quantity_free(m, &s->adjoint);
  s->rows = m->n;
  for (size_t i = 0; i < m->blocks.count; i++)
    STEIF_TRY(stf_adjoint_tape(m, block_at(m, i), &s->rows, &s->adjoint));
  s->weight = stf_pool_array(m->pool, (size_t)s->rows, sizeof *s->weight);
  s->gradient = stf_pool_array(m->pool, lengths(m), sizeof *s->gradient);
  if (!s->weight || !s->gradient) return STEIF_NO_MEMORY;
  STEIF_TRY(stf_quantity_close(m, &s->adjoint, (int64_t)lengths(m)));
  s->adjoint_made = true;
  return STEIF_OK;
}

/* A frozen branch without a value is taken literally, as f is. */
static int evaluate(stf_model *m, const stf_quantity *q, stf_feed *feed, size_t count,
                    double *out)
{
  stf_quantity_run(m, q, feed, out);
  if (stf_all_finite(out, count)) return STEIF_OK;
  if (m->switches) {
    stf_take_literally(m, feed);
    stf_quantity_run(m, q, feed, out);
    if (stf_all_finite(out, count)) return STEIF_OK;
  }
  return STEIF_RECOVER(m->ctx, STEIF_NOT_FINITE,
                       "a derivative of the model is not finite at t = %.12g", feed->t);
}

int stf_tangent(stf_model *m, double t, const double *y, const double *yp, const double *v,
                const double *vp, const double *q, double *out)
{
  STEIF_TRY(stf_products_ready(m));
  const double *none = m->products->none;
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y;
  feed.yp = yp;
  feed.along[0] = v ? v : none;
  feed.along[1] = vp ? vp : none;
  feed.along[2] = q ? q : none;
  return evaluate(m, &m->products->tangent, &feed, (size_t)m->n, out);
}

/* Weights of the equations with slots are brought into the order of their passes. */
static void sort_weights(const stf_model *m, const double *w)
{
  double *to = m->products->weight + m->n;
  memcpy(m->products->weight, w, (size_t)m->n * sizeof *w);
  for (size_t i = 0; i < m->blocks.count; i++) {
    const stf_block *block = block_at(m, i);
    const int64_t count = stf_passes(&block->box);
    for (size_t k = 0; block->box.dims && k < block->equations.count; k++) {
      const stf_equation *e = STF_AT(block->equations, stf_equation, k);
      for (int64_t pass = 0; e->slot && pass < count; pass++) *to++ = w[e->slot[pass]];
    }
  }
}

int stf_adjoint(stf_model *m, double t, const double *y, const double *yp, const double *w)
{
  STEIF_TRY(adjoint_ready(m));
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = y;
  feed.yp = yp;
  sort_weights(m, w);
  feed.along[3] = m->products->weight;
  return evaluate(m, &m->products->adjoint, &feed, lengths(m), m->products->gradient);
}

/* ---- steif/model.h ---------------------------------------------------------------------------- */

static double *array(N_Vector v) { return v ? N_VGetArrayPointer(v) : NULL; }

int steif_model_tangent(steif_context *ctx, const steif_problem *p, sunrealtype t, N_Vector y,
                        N_Vector yp, N_Vector v, N_Vector vp, const sunrealtype *q,
                        N_Vector out)
{
  STEIF_CHECK(p && p->destroy == stf_model_close && y && yp && out, ctx, STEIF_BAD_INPUT,
              "a problem made from a text, y, y' and a place for the product are needed");
  stf_model *m = p->user;
  STEIF_TRY(stf_products_ready(m));
  double *direction = m->products->direction;
  memset(direction, 0, (size_t)m->parameters * sizeof *direction);
  if (q) memcpy(direction, q, (size_t)m->given.count * sizeof *direction);
  return stf_tangent(m, t, array(y), array(yp), array(v), array(vp), direction, array(out));
}

int steif_model_adjoint(steif_context *ctx, const steif_problem *p, sunrealtype t, N_Vector y,
                        N_Vector yp, N_Vector w, N_Vector by_y, N_Vector by_yp,
                        sunrealtype *by_p)
{
  STEIF_CHECK(p && p->destroy == stf_model_close && y && yp && w, ctx, STEIF_BAD_INPUT,
              "a problem made from a text, y, y' and weights are needed");
  stf_model *m = p->user;
  STEIF_TRY(stf_adjoint(m, t, array(y), array(yp), array(w)));
  const double *gradient = m->products->gradient;
  const size_t n = (size_t)m->n;
  if (by_y) memcpy(array(by_y), gradient, n * sizeof *gradient);
  if (by_yp) memcpy(array(by_yp), gradient + n, n * sizeof *gradient);
  for (int k = 0; by_p && k < m->given.count; k++) by_p[k] = gradient[2 * n + (size_t)k];
  return STEIF_OK;
}

int steif_model_output_tangent(steif_context *ctx, const steif_problem *p, sunrealtype t,
                               N_Vector y, N_Vector v, const sunrealtype *q, sunrealtype *value)
{
  STEIF_CHECK(p && p->destroy == stf_model_close && y && value, ctx, STEIF_BAD_INPUT,
              "a problem made from a text, y and a place for the derivatives are needed");
  stf_model *m = p->user;
  STEIF_TRY(stf_products_ready(m));
  STEIF_TRY(stf_output_slopes(m));
  double *direction = m->products->direction;
  memset(direction, 0, (size_t)m->parameters * sizeof *direction);
  if (q) memcpy(direction, q, (size_t)m->given.count * sizeof *direction);
  stf_feed feed = m->feed;
  feed.t = t;
  feed.y = array(y);
  feed.along[0] = v ? array(v) : m->products->none;
  feed.along[1] = m->products->none;
  feed.along[2] = direction;
  memset(value, 0, (size_t)m->output_count * sizeof *value);
  stf_quantity_run(m, &m->output_slopes, &feed, value);
  return stf_all_finite(value, (size_t)m->output_count)
           ? STEIF_OK
           : STEIF_RECOVER(ctx, STEIF_NOT_FINITE,
                           "a derivative of the outputs is not finite at t = %.12g", t);
}
