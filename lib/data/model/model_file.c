/* model_file.c: from a text to a model that can be solved, and back.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "model_file.h"
#include "integrands.h"
#include "products.h"
#include "reactions.h"
#include "text.h"
#include <steif/model.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- reading
 * ---------------------------------------------------------------------------------
 */

static int take_text(stf_model *m, const char *path, const char *text)
{
  const size_t length = strlen(text);
  STEIF_CHECK(length <= STF_LARGEST_TEXT, m->ctx, STEIF_BAD_INPUT,
              "%s: %zu bytes; %d are the most. Use loops", path, length, STF_LARGEST_TEXT);
  stf_text *to = stf_vector_push(m->ctx, &m->syntax.sources.texts, sizeof *to);
  char *copy = to ? stf_pool_array(m->pool, length + 1, 1) : NULL;
  if (!copy) return STEIF_NO_MEMORY;
  *to = (stf_text){path, strcpy(copy, text), 0, (uint32_t)length};
  return STEIF_OK;
}

int stf_number_of(stf_model *m, const stf_expression *e, double *value)
{
  stf_formulas g = {.ctx = m->ctx};
  stf_builder b;
  int code = stf_builder_open(&b, m, &g, true);
  if (!code) code = stf_value(&b, e, value);
  stf_builder_close(&b);
  stf_formulas_free(&g);
  if (code) return stf_complaints(&m->syntax.sources) ? steif_status(m->ctx) : code;
  return STEIF_OK;
}

/* ---- the whole
 * -------------------------------------------------------------------------------
 */

/* Without `time` the model begins at 0 and has no end: runs say theirs. */
static int interval(stf_model *m)
{
  m->t1 = INFINITY;
  for (size_t i = 0; i < m->syntax.statements.count; i++) {
    const stf_statement *s = stf_statement_at(m, (int32_t)i);
    if (s->kind != STF_SAY_TIME) continue;
    STEIF_TRY(stf_number_of(m, &s->value, &m->t0));
    STEIF_TRY(stf_number_of(m, &s->other, &m->t1));
    if (m->t1 > m->t0) return STEIF_OK;
    stf_complain(&m->syntax.sources, s->at, STEIF_BAD_INPUT,
                 "the interval from %.12g to %.12g; the end lies after the start", m->t0,
                 m->t1);
    return stf_complaints(&m->syntax.sources);
  }
  return STEIF_OK;
}

double stf_span(const stf_model *m) { return isfinite(m->t1) ? m->t1 - m->t0 : 1; }

static int open_events(stf_model *m)
{
  m->piece = INFINITY;
  m->reactions = stf_pool_array(m->pool, 1, sizeof *m->reactions);
  m->event_block = stf_pool_array(m->pool, 1, sizeof *m->event_block);
  if (!m->reactions || !m->event_block) return STEIF_NO_MEMORY;
  m->event_block->graph.ctx = m->ctx;
  return STEIF_OK;
}

static int lower(stf_model *m, const steif_spec *spec)
{
  STEIF_TRY(open_events(m));
  STEIF_TRY(stf_declare(m, spec));
  STEIF_TRY(stf_number_unknowns(m));
  STEIF_TRY(stf_name_unknowns(m));
  m->feed = (stf_feed){.p = m->p};
  STEIF_TRY(stf_read_tables(m));
  STEIF_TRY(stf_build_blocks(m));
  STEIF_TRY(stf_deduce_form(m));
  STEIF_TRY(stf_build_start(m));
  STEIF_TRY(interval(m));
  STEIF_TRY(stf_build_constraints(m));
  STEIF_TRY(stf_build_events(m));
  return stf_build_tapes(m);
}

static void blocks_free(stf_model *m)
{
  for (size_t i = 0; i < m->blocks.count; i++) {
    stf_block *block = *STF_AT(m->blocks, stf_block *, i);
    stf_formulas_free(&block->graph);
    stf_vector_free(m->ctx, &block->equations);
    stf_vector_free(m->ctx, &block->switches);
  }
  stf_vector_free(m->ctx, &m->blocks);
  if (m->event_block) stf_formulas_free(&m->event_block->graph);
  if (m->event_block) stf_vector_free(m->ctx, &m->event_block->switches);
}

void stf_model_free(stf_model *m)
{
  steif_context *ctx = m->ctx;
  stf_pool *pool = m->pool;
  stf_vector *all[] = {&m->syntax.sources.texts,
                       &m->syntax.tokens,
                       &m->syntax.statements,
                       &m->syntax.codes,
                       &m->syntax.indices,
                       &m->symbols,
                       &m->symbol_of,
                       &m->names,
                       &m->partials,
                       &m->settings,
                       &m->breaks};
  blocks_free(m);
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) stf_vector_free(ctx, all[i]);
  stf_words_close(&m->syntax.words);
  if (m->reactions) stf_quantity_free(m, &m->reactions->conditions);
  stf_reactions_free(m);
  stf_quantity_free(m, &m->events);
  stf_quantity_free(m, &m->invariants);
  stf_quantity_free(m, &m->outputs);
  stf_quantity_free(m, &m->output_slopes);
  stf_quantity_free(m, &m->f);
  stf_quantity_free(m, &m->A.quantity);
  stf_quantity_free(m, &m->E.quantity);
  stf_products_free(m);
  stf_integrands_free(m);
  stf_native_free(m);
  stf_sweep_free(ctx, &m->sweep);
  stf_pool_free(&pool);
}

int stf_model_new(steif_context *ctx, stf_model **model)
{
  stf_pool *pool = stf_pool_new(ctx);
  stf_model *m = pool ? stf_pool_array(pool, 1, sizeof *m) : NULL;
  if (!m) {
    stf_pool_free(&pool);
    return STEIF_NO_MEMORY;
  }
  m->ctx = m->syntax.sources.ctx = ctx;
  m->pool = pool;
  m->syntax.words.ctx = ctx;
  *model = m;
  return stf_words_open(&m->syntax.words, ctx, pool);
}

static int build(stf_model *m, const char *path, const char *text, const steif_spec *spec,
                 steif_problem *p)
{
  m->syntax.pool = m->pool;
  STEIF_TRY(text ? take_text(m, path, text)
                 : stf_source_read(&m->syntax.sources, m->pool, path, path));
  STEIF_TRY(stf_parse(&m->syntax, 0));
  STEIF_TRY(stf_integrands_mark(m, m->integrand_count));
  STEIF_TRY(stf_complaints(&m->syntax.sources));
  stf_vector_free(m->ctx, &m->syntax.tokens);
  STEIF_TRY(stf_vector_trim(m->ctx, &m->syntax.codes, sizeof(stf_code)));
  STEIF_TRY(stf_vector_trim(m->ctx, &m->syntax.statements, sizeof(stf_statement)));
  STEIF_TRY(lower(m, spec));
  return stf_model_fill(m, p);
}

/* Values of another model of the text, and `count` more; how many integrands stand at its end. */
typedef struct change {
  const stf_vector *settings;
  int count;
  const char *const *name;
  const double *value;
  int integrands;
} change;

static int take_settings(stf_model *m, const change *with)
{
  for (size_t i = 0; i < with->settings->count; i++) {
    const stf_setting *s = STF_AT(*with->settings, stf_setting, i);
    STEIF_TRY(stf_setting_add(m->ctx, &m->settings, s->name, s->value));
  }
  for (int k = 0; k < with->count; k++)
    STEIF_TRY(stf_setting_add(m->ctx, &m->settings, with->name[k], with->value[k]));
  m->integrand_count = with->integrands;
  return STEIF_OK;
}

static int open_model(steif_context *ctx, const char *path, const char *text,
                      const steif_spec *spec, const change *with, steif_problem *p)
{
  stf_model *m = NULL;
  stf_plain plain;
  int code = stf_model_new(ctx, &m);
  p->user = m;
  if (!code) code = stf_plain_begin(ctx, &plain);
  if (code) return code;
  if (with) code = take_settings(m, with);
  if (!code) code = build(m, path, text, spec, p);
  if (code && code != STEIF_NO_MEMORY && m->syntax.sources.errors)
    code = stf_complaints(&m->syntax.sources);
  stf_plain_end(&plain);
  return code;
}

int stf_model_open(steif_context *ctx, const char *path, const steif_spec *spec,
                   steif_problem *p)
{
  return open_model(ctx, path, NULL, spec, NULL, p);
}

void stf_model_close(steif_context *ctx, steif_problem *p)
{
  (void)ctx;
  if (p->user) stf_model_free(p->user);
  p->user = NULL;
}

/* ---- texts ----------------------------------------------------------------------------------- */

static int no_build(steif_context *ctx, const steif_spec *spec, steif_problem *self)
{
  (void)spec;
  return STEIF_FAIL(ctx, STEIF_UNSUPPORTED, "problem '%s' is made from a text already",
                    self->name);
}

int steif_model_parse(steif_context *ctx, const char *text, const char *name,
                      const steif_spec *parameters, steif_problem *p)
{
  STEIF_CHECK(text && name && p, ctx, STEIF_BAD_INPUT,
              "a text, its name and a place for the problem are needed, got NULL");
  char *copy = stf_allocate(ctx, strlen(name) + 1, 1);
  if (!copy) return STEIF_NO_MEMORY;
  *p =
    (steif_problem){.name = strcpy(copy, name), .build = no_build, .destroy = stf_model_close};
  const int code = open_model(ctx, copy, text, parameters, NULL, p);
  if (!code) return STEIF_OK;
  stf_model_close(ctx, p);
  stf_release(ctx, copy);
  *p = (steif_problem){0};
  return code;
}

/* The text of m with other values, as a problem that stf_model_close ends. */
static int moved(steif_context *ctx, const stf_model *m, const char *path, int count,
                 const char *const *name, const double *value, steif_problem *p)
{
  const stf_text *text = STF_AT(m->syntax.sources.texts, stf_text, 0);
  *p = (steif_problem){.name = path, .destroy = stf_model_close};
  for (int k = 0; k < count; k++)
    STEIF_CHECK(strlen(name[k]) <= STF_NAME_BYTES, ctx, STEIF_UNKNOWN_NAME,
                "%s has no parameter '%.40s...'; names have at most %d characters", path,
                name[k], STF_NAME_BYTES);
  const change with = {&m->settings, count, name, value, m->integrand_count};
  const int code = open_model(ctx, path, text->text, NULL, &with, p);
  if (code) stf_model_close(ctx, p);
  return code;
}

int stf_model_moved(const stf_model *m, const char *name, double value, steif_problem *p)
{
  const stf_text *text = STF_AT(m->syntax.sources.texts, stf_text, 0);
  return moved(m->ctx, m, text->name, 1, &name, &value, p);
}

bool stf_model_is(const steif_problem *p) { return p->destroy == stf_model_close; }

/* A problem made from a text is named by a string of its own; code: that of making it. */
static int named(steif_context *ctx, char *own, int code, steif_problem *out)
{
  if (code) {
    stf_release(ctx, own);
    *out = (steif_problem){0};
    return code;
  }
  out->name = own;
  out->build = no_build;
  return STEIF_OK;
}

int stf_model_vary(steif_context *ctx, const steif_problem *p, int count,
                   const char *const *name, const sunrealtype *value, steif_problem *out)
{
  char *own = stf_allocate(ctx, strlen(p->name) + 1, 1);
  if (!own) return STEIF_NO_MEMORY;
  strcpy(own, p->name);
  return named(ctx, own, moved(ctx, p->user, own, count, name, value, out), out);
}

const char *stf_model_text(const steif_problem *p)
{
  const stf_model *m = p->user;
  return STF_AT(m->syntax.sources.texts, stf_text, 0)->text;
}

int stf_model_rewrite(steif_context *ctx, const steif_problem *p, const char *text,
                      int integrands, steif_problem *out)
{
  const stf_model *m = p->user;
  const change with = {.settings = &m->settings, .integrands = integrands};
  char *own = stf_allocate(ctx, strlen(p->name) + 1, 1);
  if (!own) return STEIF_NO_MEMORY;
  *out = (steif_problem){.name = strcpy(own, p->name), .destroy = stf_model_close};
  const int code = open_model(ctx, own, text, NULL, &with, out);
  if (code) stf_model_close(ctx, out);
  return named(ctx, own, code, out);
}

int steif_model_set(steif_context *ctx, steif_problem *p, const char *name, sunrealtype value)
{
  STEIF_CHECK(p && name && p->destroy == stf_model_close, ctx, STEIF_BAD_INPUT,
              "a problem made from a text and the name of a parameter are needed");
  steif_problem next;
  STEIF_TRY(stf_model_moved(p->user, name, value, &next));
  next.name = p->name;
  next.build = p->build;
  stf_model_close(ctx, p);
  *p = next;
  return STEIF_OK;
}
